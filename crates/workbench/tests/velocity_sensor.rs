//! The sensor of the load velocity that is fed forward: its limits, its noise at the valve, its
//! gain error as a coordinate of the family and in campaigns.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use phea_workbench::audit::{ProjectAudit, audit_project, noise_sentence};
use phea_workbench::campaign::{Effort, Plan};
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded, Project};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{ScenarioRun, simulate_project};
use phea_workbench::source::Memory;
use serde_json::Value;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");
const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");
const FED: &str = "controller.load_velocity_feed_forward.gain=20";
const SAMPLED: [&str; 2] = ["controller.sample_time=1 ms", "controller.delay=0.5 ms"];
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"500 N.s/m\" }";

fn loaded(text: &str, settings: &[&str]) -> Loaded {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// The rig of the hose with only one specification.
fn rig(settings: &[&str]) -> Project {
    let specification = "specification=[{ kind = \"load_motion\", limit = 1e7, frequencies = [1, 20, 100], band = [0.1, 300] }]";
    loaded(HOSE, &[settings, &[specification]].concat()).project.without_uncertainty()
}

fn simulated(project: &Project) -> ScenarioRun {
    simulate_project(&Memory::default(), &Setup::new(project).unwrap(), &mut |_| true).unwrap().remove(0)
}

fn audited(project: &Project) -> ProjectAudit {
    audit_project(&Memory::default(), &Setup::new(project).unwrap(), &mut |_| true).unwrap()
}

/// The worst margin of the first specification, dB.
fn worst(project: &Project) -> f64 {
    audited(project).audit.specifications[0].worst.as_ref().unwrap().margin_db
}

/// A sensor without error changes no bit of a run and of a verdict; one with an error changes both.
#[test]
fn a_sensor_without_error_has_no_effect() {
    for settings in [vec![FED], vec![FED, SPRUNG], [&[FED], &SAMPLED[..]].concat()] {
        let with = |sensor: &[&str]| rig(&[&settings[..], sensor].concat());
        let (none, exact) = (with(&[]), with(&["velocity_sensor={ gain_error = 0, delay = 0, noise = 0 }"]));
        assert!(none != exact);
        let forces = [&none, &exact].map(|project| simulated(project).record.signal(Signal::Force));
        assert!(forces[0].iter().zip(&forces[1]).all(|(one, other)| one.to_bits() == other.to_bits()));
        assert_eq!(worst(&none).to_bits(), worst(&exact).to_bits());
        for wrong in ["gain_error = 0.1", "delay = \"1 ms\"", "filter_frequency = \"40 Hz\""] {
            let other = with(&[&format!("velocity_sensor={{ {wrong} }}")]);
            assert!((worst(&other) - worst(&none)).abs() > 1e-3, "{settings:?} {wrong}");
            let force = simulated(&other).record.signal(Signal::Force);
            assert!(force.iter().zip(&forces[0]).any(|(one, other)| (one - other).abs() > 1.0), "{wrong}");
        }
    }
}

/// The error of the sensor's gain acts as an error of the feed-forward gain: K (1 + e). With static
/// friction a load that yields would oscillate until the last bit differs.
#[test]
fn its_gain_error_is_one_of_the_gain() {
    for settings in [vec![], vec![SPRUNG], SAMPLED.to_vec(), vec!["controller.delay=1 ms", SPRUNG]] {
        let friction = "cylinder.friction={ model = \"viscous\", viscous = \"1000 N.s/m\" }";
        let of = |more: &[&str]| rig(&[&settings[..], &[friction], more].concat());
        let shown = of(&[FED, "velocity_sensor.gain_error=-25 %"]);
        let other = of(&["controller.load_velocity_feed_forward.gain=15"]);
        assert!((worst(&shown) - worst(&other)).abs() < 1e-9, "{settings:?}");
        let forces = [&shown, &other].map(|project| simulated(project).record.signal(Signal::Force));
        let apart = forces[0].iter().zip(&forces[1]).map(|(one, other)| (one - other).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 0.1, "{settings:?}: {apart} N");
    }
}

/// The force due to a prescribed motion is linear in e, so that the worst of a range is one of its
/// ends; with a load that yields no error of the range is worse than the verdict over the range,
/// and one of them is as bad.
#[test]
fn its_gain_error_is_a_coordinate_of_the_family() {
    let range = "uncertainty={ \"velocity_sensor.gain_error\" = { nominal = 0, minimum = -0.3, maximum = 0.2, points = 3 } }";
    let delayed = vec!["controller.delay=2 ms", FED];
    for settings in [
        vec![FED],
        delayed.clone(),
        [&[FED], &SAMPLED[..]].concat(),
        vec![FED, SPRUNG],
        [&delayed[..], &[SPRUNG]].concat(),
    ] {
        let bare = ["linear={}", "velocity_sensor={ delay = \"0.3 ms\", filter_frequency = \"150 Hz\" }"];
        let all = [&settings[..], &bare].concat();
        let specification = "specification=[{ kind = \"load_motion\", limit = 1e7, frequencies = [1, 20, 100], band = [0.1, 300] }]";
        let text = HOSE.replace("[uncertainty]", "[uncertainty_of_before]");
        let (before, rest) = text.split_once("[uncertainty_of_before]").unwrap();
        let (_, after) = rest.split_once("[[specification]]").unwrap();
        let text = format!("{before}[[specification]]{after}");
        let family = loaded(&text, &[&all[..], &[specification, range]].concat()).project;
        let of_family = worst(&family);
        let count: u32 = if settings.contains(&SPRUNG) { 20 } else { 1 };
        let errors = (0..=count).map(|index| -0.3 + 0.5 * f64::from(index) / f64::from(count));
        let margins = errors.map(|error| {
            let one = loaded(&text, &[&all[..], &[specification]].concat()).project;
            worst(&one.with_number("velocity_sensor.gain_error", error).unwrap())
        });
        let least = margins.fold(f64::INFINITY, f64::min);
        let allowed = if count == 1 { 1e-6 } else { 0.02 };
        assert!(
            of_family <= least + 1e-6 && of_family > least - allowed,
            "{settings:?}: {of_family} {least}"
        );
    }
}

/// The rig of the hose with these settings instead of its family.
fn with_family(settings: &[&str]) -> Loaded {
    let (before, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    let range =
        "uncertainty={ \"velocity_sensor.gain_error\" = { nominal = 0, minimum = -0.1, maximum = 0.1 } }";
    let specification =
        "specification=[{ kind = \"load_motion\", limit = 1e8, frequencies = [1, 10], band = [0.1, 100] }]";
    let text = format!("{before}[[specification]]{after}");
    loaded(&text, &[settings, &[range, specification, "linear={}"]].concat())
}

/// Filters leave the plants quotients of polynomials: the result of the search is proven over every
/// error of the gain. A delay does not, and the verdict with proof reports this and is not met.
#[test]
fn stability_is_proven_for_rational_plants() {
    let filter = "velocity_sensor={ filter_frequency = \"200 Hz\" }";
    let delay = "velocity_sensor={ delay = \"0.5 ms\" }";
    let damped = SPRUNG.replace("500 N.s/m", "2000 N.s/m");
    let proven = |settings: &[&str]| -> Value {
        let loaded = with_family(&[settings, &["controller.load_velocity_feed_forward.gain=15"]].concat());
        let request = Request::Verify { proof: true, on_machine: false };
        let answer = command::answer(&Memory::default(), &loaded, &[], &request).unwrap();
        parsed(&answer.json)
    };
    for load in ["load={}", &damped] {
        let answer = proven(&[load, filter]);
        assert_eq!((answer["verdict"].as_str(), answer["evidence"].as_str()), (Some("met"), Some("proof")));
        let ends = answer["specifications"][0]["enclosure_db"].as_array().unwrap();
        let margin = answer["specifications"][0]["worst_margin_db"].as_f64().unwrap();
        let [least, most] = [&ends[0], &ends[1]].map(|end| end.as_f64().unwrap());
        assert!(least <= -margin + 1e-6 && -margin <= most + 1e-6, "{load}: {least} {margin} {most}");
        let answer = proven(&[load, delay]);
        assert_eq!(answer["verdict"].as_str(), Some("not_proven"), "{load}");
    }
}

/// The machine of the worst plant has that plant's error, and behaves like its linear loop.
#[test]
fn the_worst_error_is_tested_on_the_machine() {
    let sensor = "velocity_sensor={ filter_frequency = \"200 Hz\", delay = \"0.5 ms\" }";
    let loaded = with_family(&["controller.load_velocity_feed_forward={}", sensor]);
    let answer = command::answer(
        &Memory::default(),
        &loaded,
        &[],
        &Request::Verify { proof: false, on_machine: true },
    )
    .unwrap();
    let answer: Value = parsed(&answer.json);
    let runs = answer["machine"]["runs"].as_array().unwrap();
    let worst = runs.iter().find(|run| run["what"].as_str().unwrap().contains("worst plant")).unwrap();
    assert_eq!(worst["agrees"].as_bool(), Some(true), "{worst}");
    assert_eq!(
        answer["specifications"][0]["plant"]["velocity_sensor.gain_error"].as_f64().map(f64::abs),
        Some(0.1)
    );
}

/// The benchmark at rest, with equal edges and viscous friction: linear for small noise.
fn still(settings: &[&str]) -> Project {
    let (rig, _) = BENCHMARK.split_once("[[scenario]]").unwrap();
    let rig = rig.replace("[3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7]", "[3e-7, 3e-7, 3e-7, 3e-7]");
    let rig = rig.replace("[2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9]", "[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]");
    let text = format!(
        "{rig}[[scenario]]\nname = \"still\"\nduration = \"20 s\"\n[[specification]]\nkind = \"robust_stability\"\nlimit = 100\nfrequencies = [1, 10]\n"
    );
    loaded(&text, settings).project
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Commands and forces of the machine at the samples, minus their initial values.
fn samples(project: &Project) -> [Vec<f64>; 2] {
    let run = simulated(project);
    assert_eq!(run.stopped(), None);
    let held: &[f64] = &run.record.signal(Signal::Control);
    [held, &run.record.signal(Signal::Force)].map(|values| {
        let at_samples: Vec<f64> = values.iter().copied().step_by(run.samples_per_row).skip(1000).collect();
        let mean = at_samples.iter().sum::<f64>() / at_samples.len() as f64;
        at_samples.iter().map(|value| value - mean).collect()
    })
}

/// Command and force of the machine have the rms that `verify` states: the command within five
/// standard errors of 19,000 samples that are nearly independent, the force, whose samples are
/// correlated over some 20 ms, of a twentieth as many.
#[test]
fn noise_in_command_and_force_agrees_with_the_verdict() {
    let control = "controller={ numerator = \"0.0002*s + 0.002\", denominator = \"s\", sample_time = \"1 ms\", delay = \"0.5 ms\", load_velocity_feed_forward = { gain = 20 } }";
    let friction = "cylinder.friction={ model = \"viscous\", viscous = \"300 N.s/m\" }";
    let noise =
        "velocity_sensor={ noise = \"1 mm/s\", resolution = \"1 mm/s\", filter_frequency = \"100 Hz\" }";
    for load in ["load={}", SPRUNG] {
        let project = still(&[control, friction, noise, load]);
        let view = audited(&project);
        let noise = view.velocity_noise.as_ref().unwrap();
        assert!((noise.rms - 1e-3 * (13.0_f64 / 12.0).sqrt()).abs() < 1e-12);
        let effect = noise.effect.as_ref().unwrap();
        // K times the noise passes with a prescribed load at rest, and the controller reacts little
        if load != SPRUNG {
            assert!((effect.command_rms_v / (20.0 * noise.rms) - 1.0).abs() < 0.02, "{effect:?}");
        }
        let [commands, forces] = samples(&project);
        let [command, force] = [rms(&commands) / effect.command_rms_v, rms(&forces) / effect.force_rms_n];
        assert!((command - 1.0).abs() < 0.03, "{load}: {command}");
        assert!((force - 1.0).abs() < 0.12, "{load}: {force}");
        assert!(
            noise_sentence(noise, &view.names).contains("mV rms"),
            "{}",
            noise_sentence(noise, &view.names)
        );
    }
}

/// Noise of pressures that are fed back, which reaches the command through its filters, has the
/// stated rms too.
#[test]
fn pressure_noise_in_command_and_force_agrees_with_the_verdict() {
    let control = "controller={ numerator = \"0.0002*s + 0.002\", denominator = \"s\", sample_time = \"1 ms\", delay = \"0.5 ms\" }";
    let friction = "cylinder.friction={ model = \"viscous\", viscous = \"300 N.s/m\" }";
    for (filters, load) in [("", "load={}"), (", high_pass = \"2 Hz\", low_pass = \"150 Hz\"", SPRUNG)] {
        let feedback =
            format!("controller.pressure_feedback={{ gain = \"0.1 V/bar\", noise = \"0.2 bar\"{filters} }}");
        let project = still(&[control, &feedback, friction, load]);
        let view = audited(&project);
        let noise = view.pressure_noise.as_ref().unwrap();
        assert_eq!((noise.rms, view.velocity_noise.is_none()), (0.2e5, true));
        let effect = noise.effect.as_ref().unwrap();
        if filters.is_empty() {
            // little returns within a sample: k n
            assert!((effect.command_rms_v / 0.02 - 1.0).abs() < 0.1, "{effect:?}");
        }
        let [commands, forces] = samples(&project);
        let [command, force] = [rms(&commands) / effect.command_rms_v, rms(&forces) / effect.force_rms_n];
        assert!((command - 1.0).abs() < 0.03, "{load}: {command}");
        assert!((force - 1.0).abs() < 0.15, "{load}: {force}");
        assert!(
            noise_sentence(noise, &view.names).contains("mV rms"),
            "{}",
            noise_sentence(noise, &view.names)
        );
    }
}

/// Samples are rounded to whole steps after the noise is added; equal seeds give equal bits, and
/// other seeds others.
#[test]
fn the_sensor_reading_is_rounded_and_reproducible() {
    let control = "controller={ elements = [{ kind = \"gain\", value = 1e-15 }], sample_time = \"1 ms\", load_velocity_feed_forward = { gain = 20 } }";
    let of = |seed: u32, sensor: &str| {
        let seed = format!("simulation.seed={seed}");
        let project = still(&[control, &seed, sensor, "scenario.0.duration=2 s"]);
        simulated(&project).record.signal(Signal::Control)
    };
    let noisy = "velocity_sensor={ noise = \"1 mm/s\" }";
    let rounded = "velocity_sensor={ noise = \"1 mm/s\", resolution = \"0.5 mm/s\" }";
    assert_eq!(of(1, noisy), of(1, noisy));
    assert!(of(1, noisy) != of(2, noisy));
    let (plain, steps) = (of(1, noisy), of(1, rounded));
    assert!(plain.iter().zip(&steps).all(|(plain, step)| (plain - step).abs() <= 0.5 * 0.01 * (1.0 + 1e-6)));
    assert!(steps.iter().all(|step| ((step / 0.01) - (step / 0.01).round()).abs() < 1e-6));
    assert!(steps.iter().any(|step| step.abs() > 0.02));
}

/// Each machine of a campaign has its own gain error, in a single run and in lanes, and its own
/// seed if there is noise.
#[test]
fn a_campaign_draws_the_gain_error() {
    let short = [
        "scenario.0.duration=0.4 s",
        "scenario.0.reference.0.at=0.05 s",
        "scenario.0.load_motion.start=0.2 s",
    ];
    let drawn = "campaign.parameters={ \"velocity_sensor.gain_error\" = { minimum = -0.5, maximum = 0.5 } }";
    let sensor = "velocity_sensor={ delay = \"1 ms\", filter_frequency = \"100 Hz\", noise = \"2 mm/s\" }";
    let fed = "controller.load_velocity_feed_forward={}";
    for more in [vec![], vec![SAMPLED[0]]] {
        let settings = [&short[..], &[drawn, sensor, fed], &more].concat();
        let loaded = loaded(CAMPAIGN, &settings);
        let source = Memory::default().with("rig.toml", CAMPAIGN);
        let plan = Plan::new(&source, &loaded, 1).unwrap();
        let one_by_one = plan.rows(0..12, Effort { threads: 1, lanes: false }).unwrap();
        assert_eq!(
            plan.table(&plan.rows(0..12, Effort { threads: 2, lanes: true }).unwrap()),
            plan.table(&one_by_one)
        );
        for run in 0..2 {
            let force_n = plan.forces(run..run + 1, Effort { threads: 1, lanes: true }).unwrap().remove(0);
            let values = plan.settings(&plan.draw(run));
            assert!(values.iter().any(|value| value.starts_with("velocity_sensor.gain_error=")));
            assert_eq!(values.iter().any(|value| value.starts_with("simulation.seed=")), !more.is_empty());
            let all: Vec<&str> = settings.iter().copied().chain(values.iter().map(String::as_str)).collect();
            let run = simulated(&self::loaded(CAMPAIGN, &all).project);
            let seen = run.record.signal(Signal::Force);
            let shown = seen.iter().step_by(run.samples_per_row);
            assert!(shown.clone().count() >= 100);
            assert!(
                force_n.iter().zip(shown).filter(|(one, other)| one.to_bits() != other.to_bits()).count()
                    == 0
            );
        }
    }
}
