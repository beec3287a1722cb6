//! Models of lines in motion, chosen in a project: their limits, their refusals, and the numbers
//! that a campaign varies.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use phea_workbench::command::{self, Request};
use phea_workbench::engineering::campaign::{Effort, Plan};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{RunStatus, ScenarioRun, simulate_project};
use phea_workbench::project::{self, LineMotion, LineSegments, Loaded, Refusal};
use phea_workbench::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// Half the published gain, whose margin leaves no room for waves; half a second of motion. The
/// volumes of line and chamber are separate.
const SHORT: [&str; 7] = [
    "line.compliance=by_volume",
    "controller.numerator=0.0005*s + 0.004",
    "scenario.0.duration=0.6 s",
    "scenario.0.reference.0.at=0.02 s",
    "scenario.0.load_motion.start=0.3 s",
    "scenario.0.load_motion.duration=50 ms",
    "simulation.tolerance=1e-6",
];

fn read(settings: &[&str]) -> Result<Loaded, Refusal> {
    let settings: Vec<String> = SHORT.iter().chain(settings).map(|text| (*text).to_string()).collect();
    let first = HOSE.rfind("[[scenario]]").unwrap();
    let source = Memory::default().with("rig.toml", &HOSE[..first]);
    project::read(&source, "rig.toml", &settings, &[])
}

fn load(settings: &[&str]) -> Loaded {
    read(settings).unwrap_or_else(|report| panic!("{report}"))
}

fn run(settings: &[&str]) -> ScenarioRun {
    let run =
        simulate_project(&Memory::default(), &Setup::new(&load(settings).project).unwrap(), &mut |_| true)
            .unwrap()
            .remove(0);
    assert_eq!(run.stopped(), None, "{settings:?}");
    run
}

fn force(settings: &[&str]) -> Vec<f64> {
    run(settings).record.signal(Signal::Force).to_vec()
}

fn largest(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// Models with more segments approach each other with the square of the segment length, and the
/// line with exact delay to within the fit of its attenuation.
#[test]
fn segments_tend_to_the_transmission_line() {
    let waves = force(&["line.model=transmission_line", "line.end_share=0.001"]);
    let of = |count: &str| {
        let segments = format!("line.segments={count}");
        force(&["line.model=segments", &segments])
    };
    let lumped = largest(&waves, &force(&[]));
    let [eight, twelve, many] = [of("8"), of("12"), of("16")];
    let between = [largest(&eight, &twelve), largest(&twelve, &many)];
    // ORIGIN: analytic, (1/8^2 - 1/12^2) / (1/12^2 - 1/16^2)
    assert!((between[0] / between[1] - 2.857).abs() < 0.5, "{between:?} N");
    let peak = waves.iter().fold(0.0, |peak: f64, force| peak.max(force.abs()));
    let found = [largest(&waves, &eight), largest(&waves, &many)];
    assert!(found.iter().all(|apart| *apart < 0.1 * lumped && *apart < 3e-3 * peak), "{found:?}, {lumped} N");
}

/// The largest permitted number of segments can be simulated, and the next whole number is
/// rejected.
#[test]
fn the_most_segments_there_may_be() {
    for (most, more) in [
        (16, vec![]),
        (13, vec!["line.relaxation_time=0.1 s"]),
        (56, vec!["line.friction=steady"]),
        (37, vec!["line.friction=steady", "line.relaxation_time=0.1 s"]),
    ] {
        let settings = |count: u32, and: &[&str]| {
            let all = ["line.model=segments", "scenario.0.duration=5 ms", "scenario.0.reference=[]"];
            let all = all.iter().chain(&more).chain(and).map(|text| (*text).to_string());
            all.chain([format!("line.segments={count}")]).collect::<Vec<String>>()
        };
        let around = [
            "load={ model = \"wall\", mass = 10, stiffness = 1e6 }",
            "valve.hysteresis=0.1 V",
            "valve.threshold=0.05 V",
            "scenario.0.load_motion.start=0 s",
            "supply={ model = \"pump_limited\", pressure = \"70 bar\", flow = \"9.8 L/min\" }",
        ];
        let with_all = settings(most, &around);
        let with_all: Vec<&str> = with_all.iter().map(String::as_str).collect();
        assert!(run(&with_all).record.times_s.len() > 1);
        let too_many = settings(most + 1, &[]);
        let too_many: Vec<&str> = too_many.iter().map(String::as_str).collect();
        let report = read(&too_many).expect_err("too many").to_string();
        assert!(report.contains(&format!("{most}")) && report.contains("--set line.segments"), "{report}");
    }
}

/// Defaults are those of the guide: 8 segments, friction that depends on frequency, a hundredth of
/// the volume at each end.
#[test]
fn absent_keys_are_the_defaults() {
    let segments = force(&["line.model=segments"]);
    let written = ["line.model=segments", "line.segments=8", "line.friction=frequency_dependent"];
    assert_eq!(segments, force(&written));
    let steady = largest(&segments, &force(&["line.model=segments", "line.friction=steady"]));
    assert!(steady > 10.0, "{steady} N");
    for model in ["line.model=transmission_line", "line.model=two_wave"] {
        let one_percent = force(&[model]);
        assert_eq!(one_percent, force(&[model, "line.end_share=1 %"]));
        assert!(largest(&one_percent, &force(&[model, "line.end_share=5 %"])) > 0.1);
    }
}

/// A wall that creeps at once is as soft as in the catalogue, one that never creeps as stiff as
/// measured in motion; and so in segments.
#[test]
fn a_wall_that_creeps_is_between_its_moduli() {
    for model in ["creeping", "segments"] {
        let elastic = if model == "creeping" { "lumped" } else { "segments" };
        let of = |model: &str, last: &[&str]| {
            let model = format!("line.model={model}");
            let more: &[&str] = if model == "line.model=segments" { &["line.segments=4"] } else { &[] };
            force(&[&[model.as_str()], more, last].concat())
        };
        let soft = of(elastic, &["line.dynamic_stiffening=1"]);
        let stiff = of(elastic, &[]);
        let at_once = of(model, &["line.relaxation_time=1 us"]);
        let never = of(model, &["line.relaxation_time=1e7 s"]);
        let between = of(model, &["line.relaxation_time=50 ms"]);
        let apart = largest(&soft, &stiff);
        let figures = [largest(&at_once, &soft), largest(&never, &stiff)];
        assert!(figures.iter().all(|figure| *figure < 1e-3 * apart), "{model}: {figures:?} of {apart} N");
        for end in [&soft, &stiff] {
            assert!(largest(&between, end) > 0.1 * apart, "{model}");
        }
    }
}

/// The default wall, written out, is the default; unstated values follow from the catalogue's
/// expansion.
#[test]
fn the_wall_of_two_waves_is_assumed_or_stated() {
    let assumed = force(&["line.model=two_wave"]);
    let of = |settings: &[&str]| force(&[&["line.model=two_wave"], settings].concat());
    assert_eq!(assumed, of(&["line.wall={}"]));
    // ORIGIN: analytic, pi/4 (20.3^2 - 12.7^2) mm2 of 1150 kg/m3 and of r_beta 50 MPa, r_beta = 5
    let area = std::f64::consts::FRAC_PI_4 * (20.3e-3 * 20.3e-3 - 12.7e-3 * 12.7e-3);
    let mass = format!("line.wall.mass_per_length={}", 1150.0 * area);
    let axial = format!("line.wall.axial_compliance={}", 1.0 / (5.0 * 50e6 * area));
    let coupling = format!("line.wall.coupling_compliance={}", -1.0 / (5.0 * 50e6 * area));
    let written = largest(&assumed, &of(&[&mass, &axial, &coupling]));
    assert!(written < 1e-3, "{written} N");
    let heavy = largest(&assumed, &of(&["line.wall.mass_per_length=1 kg/m"]));
    assert!(heavy > 0.1, "{heavy} N");
    // a wall without coupling has one wave, whose compliance is that of a lumped line; the wave of
    // the wall is equally fast, because the steady resistance lags like the faster of both.
    // ORIGIN: analytic, 1/(535.002^2 1e-9) kg/m
    let uncoupled = [
        "line.wall.coupling_compliance=1e-12",
        "line.wall.axial_compliance=1e-9",
        "line.wall.mass_per_length=3493.74 kg/m",
    ];
    let one = force(&["line.model=transmission_line"]);
    let same = largest(&one, &of(&uncoupled));
    let apart = largest(&assumed, &one);
    assert!(same < 0.05 * apart, "{same} N of {apart} N");
}

#[test]
fn each_side_has_its_own_line_model() {
    let a = ["line.a.model=segments", "line.a.segments=12", "line.b.model=two_wave"];
    let project = load(&a).project;
    let lines = &project.actuator.as_ref().unwrap().line;
    let twelve = LineSegments { count: Some(12), ..LineSegments::default() };
    let waves = LineMotion::TwoWave { end_share: None, wall: None };
    assert_eq!([&lines.a.motion, &lines.b.motion], [&LineMotion::Segments(twelve), &waves]);
    let text = project::print(&project);
    let again = project::read(&Memory::default().with("p.toml", text.as_str()), "p.toml", &[], &[]);
    assert!(again.unwrap_or_else(|report| panic!("{report}")).project == project, "{text}");
    let both = force(&["line.model=segments", "line.segments=12"]);
    assert!(largest(&both, &force(&a)) > 0.01);
    // a choice for one side need not be reverted for the other
    let one = load(&["line.model=creeping", "line.relaxation_time=0.1 s", "line.b.model=lumped"]).project;
    let lines = one.actuator.unwrap().line;
    let creeping = LineMotion::Creeping { relaxation_time: 0.1 };
    assert_eq!([lines.a.motion, lines.b.motion], [creeping, LineMotion::Lumped]);
}

#[test]
fn incompatible_keys_are_refused_at_their_place() {
    let refused = |settings: &[&str], expected: [&str; 3]| {
        let report = read(settings).expect_err(settings[0]);
        let first = &report.diagnostics[0];
        let found = [first.message.as_str(), first.help.as_deref().unwrap_or_default(), first.file.as_str()];
        assert_eq!(found, expected, "{report}");
    };
    refused(
        &["line.segments=4"],
        [
            "`segments` has no effect with model \"lumped\"",
            "it belongs to model \"segments\"",
            "--set line.segments=4",
        ],
    );
    refused(
        &["line.model=two_wave", "line.relaxation_time=0.1 s"],
        [
            "`relaxation_time` has no effect with model \"two_wave\"",
            "it belongs to model \"creeping\" or \"segments\"",
            "--set line.relaxation_time=0.1 s",
        ],
    );
    let creeping = read(&["line.model=creeping"]).expect_err("no relaxation time").to_string();
    assert!(creeping.contains("model \"creeping\" needs it"), "{creeping}");
    assert!(creeping.contains("none is assumed"), "{creeping}");
    let wasted = load(&["line.model=creeping", "line.relaxation_time=0.1 s", "line.dynamic_stiffening=1"]);
    assert!(wasted.warnings.iter().any(|found| found.message.contains("nothing creeps")));
    let giving = load(&["line.model=two_wave", "line.wall.pressure_compliance=0"]);
    let giving = command::answer(&Memory::default(), &giving, &[], &Request::Simulate(Default::default()))
        .unwrap_err();
    assert!(giving.to_string().contains("[line] model: fixed_end_modulus is"), "{giving}");
}

/// Relaxation times, walls and fractions vary in a campaign like any number; the number of states
/// does not.
#[test]
fn a_campaign_varies_numbers_that_are_not_counts() {
    let vary = |path: &str, low: &str, high: &str| {
        format!("campaign.parameters.\"{path}\"={{ minimum = \"{low}\", maximum = \"{high}\" }}")
    };
    let creep = vary("line.relaxation_time", "10 ms", "1 s");
    let length = vary("line.length", "1.4 m", "1.6 m");
    let mass = vary("line.wall.mass_per_length", "0.2 kg/m", "0.3 kg/m");
    let segments = ["line.model=segments", "line.segments=2", "line.relaxation_time=0.1 s", &creep, &length];
    let walls = ["line.model=two_wave", "line.wall.mass_per_length=0.25 kg/m", &mass, &length];
    for settings in [&segments[..], &["line.model=creeping", "line.relaxation_time=0.1 s", &creep], &walls] {
        let settings =
            [settings, &["scenario.0.duration=0.1 s", "scenario.0.load_motion.start=0.05 s"]].concat();
        let plan = Plan::new(&Memory::default(), &load(&settings), 1).unwrap();
        let one_by_one = plan.rows(0..6, Effort { threads: 1, lanes: false }).unwrap();
        assert!(
            one_by_one.iter().all(|row| row.ran().is_some_and(|ran| ran.status == RunStatus::Completed)),
            "{settings:?}"
        );
        assert_eq!(one_by_one, plan.rows(0..6, Effort { threads: 1, lanes: true }).unwrap(), "{settings:?}");
        let peaks: Vec<_> = one_by_one.iter().map(|row| row.ran().unwrap().metrics.clone()).collect();
        assert!(peaks.windows(2).all(|pair| pair[0] != pair[1]));
    }
    for path in ["line.segments", "line.b.segments"] {
        let varied = format!("campaign.parameters.\"{path}\"={{ minimum = 2, maximum = 8 }}");
        let report = read(&["line.model=segments", "line.segments=4", &varied]).expect_err(path);
        assert_eq!(
            report.diagnostics[0].message,
            format!("`{path}` is a whole number: only quantities vary")
        );
    }
}

/// The motion of a line does not affect the linear model: it is not counted twice with its
/// stiffness, and is not a coordinate of a family.
#[test]
fn the_linear_model_ignores_waves() {
    let linear = |settings: &[&str]| {
        let answer =
            command::answer(&Memory::default(), &load(settings), &[], &Request::Linearize { sweep: None })
                .unwrap();
        parsed(&answer.json)["poles"].clone()
    };
    assert_eq!(linear(&[]), linear(&["line.model=segments", "line.relaxation_time=0.1 s"]));
    let range = "{ nominal = \"0.1 s\", minimum = \"0.1 s\", maximum = \"1 s\" }";
    let uncertain = format!("uncertainty.\"line.relaxation_time\"={range}");
    let project = load(&["line.model=creeping", "line.relaxation_time=0.1 s", &uncertain]);
    let error = command::answer(
        &Memory::default(),
        &project,
        &[],
        &Request::Verify { proof: false, on_machine: false },
    )
    .unwrap_err()
    .to_string();
    assert!(
        error.contains("`line.relaxation_time`") && error.contains("does not enter the linear model"),
        "{error}"
    );
}

/// A valve that does not leak is the limit of one that leaks ever less, behind lines with waves as
/// well: its response exists.
#[test]
fn a_valve_without_leakage_has_a_response_with_waves() {
    let response = |leakage: &str| {
        let edges = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"];
        let edges = edges.map(|edge| format!("valve.leakage_coefficients.{edge}={leakage}"));
        let settings: Vec<&str> =
            ["line.model=transmission_line"].into_iter().chain(edges.iter().map(String::as_str)).collect();
        let loaded = load(&settings);
        let setup = Setup::new(&loaded.project).unwrap();
        [1.0, 30.0, 900.0].map(|frequency| setup.rig().unwrap().response(frequency))
    };
    for (ideal, leaking) in response("0").into_iter().zip(response("1e-15")) {
        assert!((ideal - leaking).norm_sqr() < 1e-6 * leaking.norm_sqr(), "{ideal} {leaking}");
    }
}
