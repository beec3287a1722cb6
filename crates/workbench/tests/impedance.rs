//! A virtual impedance in the loop: its limits, its port, a load that yields to it, and the
//! equivalent position loop.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{answer, try_answer};
use num_complex::Complex64;
use phea_dynamics::controller::VirtualImpedance;
use phea_dynamics::frequency::passivity;
use phea_dynamics::linear::TransferFunction;
use phea_hydraulics::impedance::closed_loop_port;
use phea_hydraulics::linear::transfer_functions;
use phea_hydraulics::plant::{LinearPlant, PlantInMotion};
use phea_hydraulics::signal::Signal;
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_workbench::audit::audit_project;
use phea_workbench::command::{AlternativesRequest, Request};
use phea_workbench::linearize::linearize;
use phea_workbench::project::{self, Project};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{ScenarioRun, simulate_project};
use phea_workbench::source::Memory;
use serde_json::Value;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
/// The benchmark without kinks, in equilibrium before its reference steps.
const SMOOTH: [&str; 4] = [
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
    "simulation.tolerance=1e-8",
];
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"500 N.s/m\" }";
const GENTLE: &str = "controller.numerator=0.0002*s + 0.0016";

fn read(text: &str, settings: &[&str]) -> Project {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

fn benchmark(settings: &[&str]) -> Project {
    let from_rest: Vec<&str> = BENCHMARK.lines().filter(|line| !line.starts_with("start = ")).collect();
    read(&from_rest.join("\n"), &[&SMOOTH, settings].concat())
}

fn driven(project: &Project) -> ScenarioRun {
    let mut project = project.clone();
    project.scenarios.truncate(1);
    simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap().remove(0)
}

#[test]
fn an_impedance_of_zero_is_absent() {
    let zero = "controller.impedance={ stiffness = 0, damping = 0, mass = 0, filter_time = \"2 ms\" }";
    for load in [&[][..], &[SPRUNG, GENTLE]] {
        let [with, without] = [benchmark(&[load, &[zero]].concat()), benchmark(load)];
        let seen = |project: &Project| Setup::rig_of(project).unwrap().in_loop().plant.coefficients();
        assert_eq!(seen(&with), seen(&without));
        assert_eq!(driven(&with).record, driven(&without).record);
    }
}

/// The nominal plant of the example rig with a load that is moved.
fn moved() -> LinearPlant {
    Setup::rig_of(&read(HOSE, &[])).unwrap().plant
}

/// Z = (Z_o + G P Z_v/s)/(1 + G P), which tends to Z_v/s as G grows.
#[test]
fn the_port_tends_to_the_required_impedance() {
    let impedance = VirtualImpedance { stiffness: 2e5, damping: 4e3, mass: 30.0, filter_time_s: 1e-3 };
    let plant = moved();
    let own = transfer_functions(&plant.coefficients()).unwrap();
    let s = Complex64::new(0.0, 30.0);
    let required = impedance.response(s) / s;
    let mut last = f64::INFINITY;
    for gain in [1e-4, 1e-2, 1.0, 1e2] {
        let controller = TransferFunction::gain_only(gain);
        let with = LinearPlant { virtual_impedance: Some(impedance), ..plant };
        let shown = closed_loop_port(&with, &controller).unwrap().evaluate(s);
        let [command, motion] = [own.command.evaluate(s), own.load_position.evaluate(s)];
        let expected = (gain * command * required - motion / s) / (1.0 + gain * command);
        assert!((shown / expected - 1.0).norm_sqr() < 1e-16, "{gain}: {shown}, not {expected}");
        let off = (shown / required - 1.0).norm_sqr().sqrt();
        assert!(off < 0.1 * last, "{gain}: {off} after {last}");
        last = off;
    }
    assert!(last < 1e-4, "{last}");
}

/// The spring of a lagging loop is active by -K_v tau at low frequencies; a damper of that size
/// compensates for it.
///
/// ```text
/// G = K_p + K_i/s:   Re Z(0) = B_v - K_v (1/(K_i P(0)) + n tau_f)        n the order of the filter
/// ```
#[test]
fn a_damper_makes_a_late_spring_passive() {
    let plant = moved();
    let steady = transfer_functions(&plant.coefficients()).unwrap().command.dc_gain();
    let controller =
        TransferFunction::from_factors(1e-3, vec![Complex64::new(-8.0, 0.0)], vec![Complex64::ZERO]).unwrap();
    let (stiffness, filter_time_s) = (1e5, 2e-3);
    let needed = stiffness * (1.0 / (8e-3 * steady) + filter_time_s);
    for (fraction, passive) in [(0.98, false), (1.02, true)] {
        let impedance = VirtualImpedance { stiffness, damping: fraction * needed, mass: 0.0, filter_time_s };
        let with = LinearPlant { virtual_impedance: Some(impedance), ..plant };
        let port = closed_loop_port(&with, &controller).unwrap();
        let resistance = port.at_frequency(0.01).re;
        assert_eq!(resistance > 0.0, passive, "{fraction}: {resistance}");
        assert!((resistance / ((fraction - 1.0) * needed) - 1.0).abs() < 0.05, "{fraction}: {resistance}");
        let found = passivity(&port).unwrap();
        assert_eq!(found.bands.iter().all(|band| band.from_rad_per_s > 0.01), passive, "{found:?}");
        let spring = found.imaginary_poles.iter().find(|pole| pole.frequency_rad_per_s == 0.0).unwrap();
        assert!(spring.passive && (spring.residue.unwrap().re / stiffness - 1.0).abs() < 1e-6);
    }
}

/// The values printed by `linearize` are those of the port to which its band and its points refer.
#[test]
fn the_printed_impedance_is_that_of_the_port() {
    let project = read(
        HOSE,
        &[
            "controller.impedance={ stiffness = \"100 kN/m\", damping = \"3000 N.s/m\", filter_time = \"2 ms\" }",
        ],
    );
    let setup = Setup::new(&project).unwrap();
    let found = linearize(setup.rig().unwrap(), setup.controller.as_ref(), &setup.sensor).unwrap();
    let (port, required) = (found.closed_loop.unwrap(), found.required_impedance.unwrap());
    for point in &required.points {
        let expected = port.impedance.at_frequency(point.frequency_rad_per_s);
        assert!((point.achieved / expected - 1.0).norm_sqr().sqrt() < 1e-6, "{point:?}, not {expected}");
    }
    let [from, to] = required.follows_rad_per_s.unwrap();
    assert!(from < 0.1 && to > 1.0 && to < 1e3, "{from} to {to}");
    // a spring remains: -K_v times a millimetre
    assert!((port.final_force_n.unwrap() / -100.0 - 1.0).abs() < 1e-6);
}

/// A spring of k on the ground of the load: F_e = F_r/(1 + K_v/k) at the end; verdict and machine
/// agree on stability.
#[test]
fn a_load_that_yields_changes_the_loop() {
    let impedance = |stiffness: &str| format!("controller.impedance={{ stiffness = \"{stiffness}\" }}");
    let reference = "scenario.0.reference=[{ at = 0.1, force = \"200 N\" }]";
    let timed =
        ["scenario.0.duration=12 s", "scenario.0.output_step=5 ms", "scenario.0.load_motion.distance=1e-9"];
    for (stiffness, steady, stable) in [("100 kN/m", 200.0 / 1.5, true), ("4 MN/m", f64::NAN, false)] {
        let impedance = impedance(stiffness);
        let project = benchmark(&[&[SPRUNG, GENTLE, &impedance, reference][..], &timed].concat());
        let setup = Setup::new(&project).unwrap();
        let compensation = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
        let member = compensation.member(setup.rig().unwrap().in_loop().plant.coefficients()).unwrap();
        let status = member_stability(&member, &compensation).status;
        assert_eq!(status == StabilityStatus::Stable, stable, "{stiffness}: {status:?}");
        let run = driven(&project);
        let force = run.record.signal(Signal::Force);
        let last = &force[force.len() * 4 / 5..];
        let [low, high] = last.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], force| {
            [low.min(*force), high.max(*force)]
        });
        assert_eq!(high - low < 1.0, stable, "{stiffness}: {low} to {high}");
        if stable {
            assert!((high / steady - 1.0).abs() < 1e-2, "{high}, not {steady}");
            let given = run.record.signal(Signal::VirtualForce);
            assert!((force.last().unwrap() + given.last().unwrap() - 200.0).abs() < 2.0);
        }
    }
}

/// Admittance u = C_x (x_r - x), x_r = x_0 + (F_r - F_e)/(M_v s^2 + B_v s + K_v), x after the
/// filter: closed by hand, and as declared.
#[test]
fn an_admittance_is_an_impedance() {
    let [spring, damper, filter] = [1e5, 2e3, 2e-3];
    let keys = "stiffness = 1e5, damping = 2e3, filter_time = \"2 ms\"";
    let inner = format!("controller.impedance={{ {keys}, form = \"admittance\" }}");
    let outer = format!("controller.impedance={{ {keys} }}");
    // C_x in V/m, and G = C_x/(B_v s + K_v)
    let position = ["controller.numerator=60*s + 300", "controller.denominator=s", &inner];
    let force = ["controller.numerator=60*s + 300", "controller.denominator=s*(2000*s + 100000)", &outer];
    for load in [&[][..], &[SPRUNG]] {
        let [admittance, impedance] = [position, force].map(|law| benchmark(&[load, &law].concat()));
        let [one, other] = [&admittance, &impedance].map(driven).map(|run| run.record.signal(Signal::Force));
        let apart = one.iter().zip(&other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        let largest = other.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()));
        assert!(apart < 1e-5 * largest, "{load:?}: {apart} of {largest}");
        let setup = Setup::new(&admittance).unwrap();
        let rig = setup.rig().unwrap();
        let feedback = setup.controller.as_ref().unwrap().feedback.transfer_function().unwrap();
        for frequency in [0.5, 5.0, 50.0, 500.0] {
            let s = Complex64::new(0.0, frequency);
            let own = PlantInMotion::lumped(&rig.plant);
            let [by_force, _] = own.response(s);
            let by_motion = own.load_velocity(s)[0] / s;
            let inner = 60.0 + 300.0 / s;
            let soft = damper * s + spring;
            let expected =
                inner / soft * by_force / (1.0 + inner * (by_force / soft + by_motion / (1.0 + filter * s)));
            let seen = rig.in_loop().plant.coefficients().command.at_frequency(frequency);
            let found = feedback.evaluate(s) * by_force / (1.0 + feedback.evaluate(s) * seen);
            assert!(
                (found / expected - 1.0).norm_sqr().sqrt() < 1e-9,
                "{frequency}: {found}, not {expected}"
            );
        }
    }
}

/// Prescribed motion of the load changes only the verdict on load_motion; a load that yields
/// changes all verdicts.
#[test]
fn the_verdict_is_about_the_declared_loop() {
    let margins = |settings: &[&str]| {
        let text = HOSE.to_string();
        let project = read(&text, settings);
        let view = audit_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap();
        let worst = view.audit.specifications.iter().filter_map(|one| Some(one.worst.as_ref()?.margin_db));
        worst.collect::<Vec<f64>>()
    };
    let spring = "controller.impedance={ stiffness = \"100 kN/m\" }";
    let prescribed = [margins(&[]), margins(&[spring])];
    assert!(!prescribed[0].is_empty());
    assert_eq!(prescribed[0], prescribed[1]);
    let [without, with] = [margins(&[SPRUNG]), margins(&[SPRUNG, spring])];
    assert!(without.iter().zip(&with).any(|(one, other)| (one - other).abs() > 0.1), "{without:?} {with:?}");
}

/// Active and passive compliance in one table: a pipe whose loop has a virtual spring and damper,
/// next to hose and pipe.
#[test]
fn alternatives_state_the_required_and_the_reached_impedance() {
    let (head, _) = HOSE.split_once("[uncertainty]").unwrap();
    let text = format!(
        "{head}{}",
        r#"
[[specification]]
kind = "robust_stability"
limit = 1.5
frequencies = [1, 10, 100]
band = [0, inf]

[[specification]]
kind = "sensitivity"
limit = { numerator = "s", denominator = "s + 5" }
frequencies = [1, 5]

[[alternative]]
name = "pipe"
[alternative.set]
"line" = { pipe = { bore = "10.5 mm" }, length = "0.35 m", compliance = "uniform" }

[[alternative]]
name = "pipe with a virtual spring"
[alternative.set]
"line" = { pipe = { bore = "10.5 mm" }, length = "0.35 m", compliance = "uniform" }
"controller.impedance" = { stiffness = "2 MN/m", damping = "400 kN.s/m", filter_time = "2 ms" }

[[alternative]]
name = "pipe with an inner position loop"
[alternative.set]
"line" = { pipe = { bore = "10.5 mm" }, length = "0.35 m", compliance = "uniform" }
"controller" = { gain = 1, zeros = [], poles = [-100, -100], impedance = { stiffness = "2 MN/m", damping = "400 kN.s/m", filter_time = "2 ms", form = "admittance" } }
"#
    );
    let request = Request::Alternatives(AlternativesRequest::default());
    let output = answer(&text, &[], &[], &request);
    let found: Value = parsed(&output.json);
    // both forms are one loop, and the design is that of the force
    let both = [2, 3].map(|index| found["alternatives"][index]["columns"].clone());
    assert_eq!(both[0], both[1]);
    assert!(
        output.text.contains(
            "pipe with an inner position loop: designed as the same loop with form = \"impedance\""
        )
    );
    let columns = |index: usize| found["alternatives"][index]["columns"].clone();
    let at = |index: usize, key: &str| columns(index)["impedance"][0][key].as_f64();
    // at 1 rad/s: |B_v + K_v/(jw)|
    let required = (2e6_f64 * 2e6 + 4e5 * 4e5).sqrt();
    assert!((at(2, "impedance_required_n_s_per_m").unwrap() / required - 1.0).abs() < 1e-12);
    assert_eq!((at(0, "impedance_required_n_s_per_m"), at(1, "impedance_required_n_s_per_m")), (None, None));
    let shown = [1, 2].map(|index| at(index, "impedance_closed_n_s_per_m").unwrap());
    // to within 1/(1 + L), at most 1/|1 - 5j| there, and the impedance of the pipe
    assert!((shown[1] / required - 1.0).abs() < 0.2 + shown[0] / required, "{shown:?}, {required}");
    assert!(shown[0] < 0.5 * required, "{shown:?}, {required}");
    // the load does not yield: the loop to be designed is unchanged
    for key in ["order", "modulus_margin", "delay_margin_s"] {
        let [pipe, spring] = [1, 2].map(|index| columns(index)[key].as_f64().unwrap());
        assert!((spring / pipe - 1.0).abs() < 1e-3, "{key}: {pipe}, {spring}");
    }
    assert_eq!(at(1, "impedance_open_n_s_per_m"), at(2, "impedance_open_n_s_per_m"));
}

/// A load that yields to a gentle loop with an impedance.
fn yielding() -> String {
    let (head, _) = HOSE.split_once("[uncertainty]").unwrap();
    format!(
        "{head}{}",
        r#"
[load]
model = "spring_mass_damper"
mass = "100 kg"
stiffness = "200 kN/m"
damping = "5000 N.s/m"

[uncertainty]
viscous_friction = { nominal = "300 N.s/m", minimum = "200 N.s/m", maximum = "400 N.s/m", points = 2 }

[[specification]]
kind = "robust_stability"
limit = 4
frequencies = [1, 10, 100]
band = [0, inf]

[[specification]]
kind = "load_motion"
limit = 1e7
frequencies = [1, 10, 100]
band = [0, 1000]

[controller]
numerator = "0.0004*s + 0.0032"
denominator = "s"

[controller.impedance]
stiffness = "100 kN/m"
damping = "1000 N.s/m"
filter_time = "5 ms"
"#
    )
}

/// A load that yields: the proof is of the loop with its impedance, and the machine steps as this
/// loop predicts.
#[test]
fn a_proof_and_a_trial_include_the_impedance() {
    let text = yielding();
    let found = answer(&text, &[], &[], &Request::Verify { proof: true, on_machine: true });
    let found: Value = parsed(&found.json);
    assert_eq!(
        (found["verdict"].as_str(), found["evidence"].as_str()),
        (Some("met"), Some("proof")),
        "{found:#}"
    );
    let runs = found["machine"]["runs"].as_array().unwrap();
    assert!(runs.iter().all(|run| run["agrees"] == true), "{:#}", found["machine"]);
    let without = answer(
        &text,
        &["controller.impedance.stiffness=0", "controller.impedance.damping=0"],
        &[],
        &Request::Verify { proof: false, on_machine: false },
    );
    let without: Value = parsed(&without.json);
    let margin = |found: &Value| found["specifications"][0]["worst_margin_db"].as_f64().unwrap();
    assert!((margin(&found) - margin(&without)).abs() > 0.1, "{} {}", margin(&found), margin(&without));
}

/// Report, linear models and derived quantities state the impedance; a controller that is stated
/// for the position is not designed.
#[test]
fn every_answer_mentions_the_impedance() {
    let position = "controller.impedance.form=admittance";
    let law = "controller.numerator=60*s + 300";
    let page =
        answer(&yielding(), &[position, law], &[], &Request::Report { files: false, alternatives: false });
    let html = page.files.iter().find(|file| file.name == "report.html").unwrap();
    let html = String::from_utf8_lossy(&html.bytes);
    for words in
        ["The virtual impedance", "the port shows the virtual impedance", "controller.impedance is counted"]
    {
        assert!(html.contains(words), "{words}");
    }
    let of = |request: &Request| answer(&yielding(), &[], &[], request);
    let models: Value = parsed(&of(&Request::Linearize { sweep: None }).json);
    assert_eq!(models["virtual_impedance"]["stiffness_n_per_m"], 1e5);
    assert_eq!(models["virtual_impedance"]["points"].as_array().unwrap().len(), 5);
    assert!(of(&Request::Linearize { sweep: None }).text.contains("Impedance requested and achieved"));
    assert!(of(&Request::Check).json.contains("impedance.spring_below"));
    let design = Request::Design { seed: None, stages: false, repair: false };
    let refused = try_answer(&yielding(), &[position, law], &[], &design).unwrap_err().to_string();
    assert!(refused.contains("C_x = G (M_v s^2 + B_v s + K_v)"), "{refused}");
}
