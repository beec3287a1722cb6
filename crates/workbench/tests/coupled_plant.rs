//! The plant of every verdict is that of the declared rig, with its load and its leakage; effects
//! that it does not include are reported first.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use num_complex::Complex64;
use phea_dynamics::portable::exp;
use phea_qft::specification::ClosedLoop;
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::Verdict;
use phea_workbench::audit;
use phea_workbench::command::Request;
use phea_workbench::engineering::audit::{ProjectAudit, audit_project};
use phea_workbench::engineering::caveat::{Caveat, LoopWithRig, OutsideFamily, UncountedEffect};
use phea_workbench::engineering::linear_loop::linear_loop;
use phea_workbench::engineering::linearize::{Linearization, linearize};
use phea_workbench::engineering::robust::robust_problem;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::simulate_project;
use phea_workbench::engineering::specification::SpecificationName;
use phea_workbench::project::{self, Project};
use phea_workbench::source::Memory;
use serde_json::Value;

use super::run_command::{answer, project_of};

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
/// 100 kg between the load cell and a spring of 200 kN/m.
const SPRUNG: [&str; 4] =
    ["load.model=spring_mass_damper", "load.mass=100", "load.stiffness=2e5", "load.damping=500"];

/// A capacity of the sensor that leaves no room for steps larger than a tenth of the force.
const TENTH_ONLY: &str = "force_sensor.capacity=3.4 kN";

fn linearized(project: &Project) -> Linearization {
    linearize(&Setup::rig_of(project).unwrap(), None, &Setup::new(project).unwrap().sensor).unwrap()
}

/// Overshoot of a step of the reference in percent, by the linear plant.
fn overshoot(project: &Project) -> f64 {
    let given = Setup::new(project).unwrap().controller.unwrap();
    let plant = linearized(project).plant.command;
    let closed = linear_loop(&plant, &given, &Setup::new(project).unwrap().sensor, 1.0).unwrap();
    closed.step.unwrap().metrics.overshoot_percent
}

/// Yielding load: it turns a loop without overshoot into one that overshoots by a quarter, and the
/// linear plant predicts this. The machine, which has friction, overshoots a little less.
#[test]
fn a_load_that_yields_is_in_the_loop() {
    let [prescribed, sprung] = [project_of(HOSE, &[]), project_of(HOSE, &SPRUNG)];
    // ORIGIN: recomputed by comparisons/recompute_plant.py
    let expected = [0.41, 27.98];
    for (project, expected) in [&prescribed, &sprung].into_iter().zip(expected) {
        assert!((overshoot(project) - expected).abs() < 0.01, "{} instead of {expected}", overshoot(project));
    }
    let runs = simulate_project(&Memory::default(), &Setup::new(&sprung).unwrap(), &mut |_| true).unwrap();
    let machine = runs[0].windows[0].1.overshoot_percent.unwrap();
    assert!((25.0..expected[1]).contains(&machine), "{machine}");
}

/// Leakage across the piston adds to the valve's: the slow pole moves by the factor (K_c + G)/K_c.
#[test]
fn leakage_across_the_piston_moves_the_slow_pole() {
    let slowest = |settings: &[&str]| {
        let plant = linearized(&project_of(HOSE, settings)).plant.command;
        plant.poles().iter().map(|pole| pole.norm_sqr()).fold(f64::INFINITY, f64::min).sqrt()
    };
    // ORIGIN: recomputed by comparisons/recompute_plant.py
    assert!((slowest(&[]) - 0.51584).abs() < 1e-5);
    assert!((slowest(&["cylinder.internal_leakage=1e-11"]) - 8.5508).abs() < 1e-4);
}

/// The load feels the leakage too: slow motions act on a damper of A^2/(K_c + G) and the friction.
/// The impedance at the load does not contain the load itself.
#[test]
fn the_load_feels_the_leakage_and_not_itself() {
    let damper = |settings: &[&str]| {
        let view = linearized(&project_of(HOSE, settings)).open_loop;
        assert!((view.asymptotes[0].coefficient / view.impedance.dc_gain() - 1.0).abs() < 1e-9);
        view.impedance.dc_gain()
    };
    let (area, coefficient) = (1.583_363e-3, 6.42e-13);
    for leakage in [1e-12, 1e-11] {
        let expected = area * area / (coefficient + leakage) + 100.0;
        let setting = format!("cylinder.internal_leakage={leakage}");
        let found = damper(&[&setting]);
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        let sprung = [&SPRUNG[..], &[&setting]].concat();
        assert_eq!(damper(&sprung), found);
    }
}

/// The hose with this specification only, which the given controller satisfies over its family.
fn satisfied(settings: &[&str]) -> Project {
    let mut project = project_of(HOSE, settings);
    project.specifications.truncate(1);
    project.specifications[0].limit = Some(project::DeclaredLimit::Constant(1000.0));
    project
}

fn audited(project: &Project) -> ProjectAudit {
    audit_project(&Memory::default(), &Setup::new(project).unwrap(), &mut |_| true).unwrap()
}

/// Declared effects that are not in the linear loop are reported above everything else, and no
/// verdict is met.
#[test]
fn uncounted_effects_are_reported_first() {
    let met = audited(&satisfied(&[]));
    assert_eq!(met.audit.verdict, Verdict::Met);
    for (settings, key) in [
        (
            &["supply.model=pump_limited", "supply.flow=0.5 L/min"][..],
            "supply.model = \"pump_limited\" has no equilibrium at the operating point, where the valve takes",
        ),
        (
            &[
                "load.model=wall",
                "load.stiffness=1e6",
                "load.damping=10",
                "load.relative_damping=0.1",
                "load.gap=0.001",
            ],
            "load.model = \"wall\" is not included without load.mass: this is the loop with a load that does not move",
        ),
    ] {
        let view = audited(&satisfied(settings));
        assert_eq!(view.audit.verdict, Verdict::NotProven, "{key}");
        let text = audit::output(&view, None).text();
        let first: Vec<&str> = text.lines().take(3).map(str::trim).collect();
        assert_eq!(first[0], "Verdict: not proven");
        assert!(first[1..].iter().any(|line| line.starts_with(key)), "{text}");
    }
}

/// A prefilter before the samples: a step of 910/(s^2 + 83 s + 910) reaches the loop with its value
/// between any two samples.
#[test]
fn a_prefilter_before_the_samples_acts_in_continuous_time() {
    let project = project_of(HOSE, &["controller.sample_time=5 ms", "prefilter.continuous=true"]);
    let plant = linearized(&project).plant.command;
    let given = Setup::new(&project).unwrap().controller.unwrap();
    let step = linear_loop(&plant, &given, &Setup::new(&project).unwrap().sensor, 1.0).unwrap().step.unwrap();
    let root = (83.0_f64 * 83.0 - 4.0 * 910.0).sqrt();
    let [fast, slow] = [(83.0 + root) / 2.0, (83.0 - root) / 2.0];
    for (time_s, value) in step.times_s.iter().zip(&step.filtered_reference).take(200) {
        let expected = 1.0 + (slow * exp(-fast * time_s) - fast * exp(-slow * time_s)) / root;
        assert!((value - expected).abs() < 1e-9, "{time_s} {value} {expected}");
    }
    let problem = robust_problem(&Memory::default(), &Setup::new(&project).unwrap()).unwrap();
    let filtered = problem.compensation.response(400.0).prefilter;
    let expected = 910.0 / Complex64::new(910.0 - 400.0 * 400.0, 83.0 * 400.0);
    assert!((filtered / expected - 1.0).norm_sqr() < 1e-24, "{filtered} {expected}");
    assert!(problem.caveats.is_empty(), "{:?}", problem.caveats);
}

/// A limited pump that delivers the flow taken is in the linear loop; a caveat reports that only a
/// simulation shows larger steps.
#[test]
fn a_limited_pump_is_counted() {
    let view = audited(&satisfied(&["supply.model=pump_limited"]));
    assert_eq!(view.audit.verdict, Verdict::Met);
    let of_pump = |caveat: &&Caveat| matches!(caveat.effect, UncountedEffect::LimitedPump { .. });
    let pump = view.caveats.iter().find(of_pump).unwrap();
    let UncountedEffect::LimitedPump { taken, delivered, .. } = pump.effect else { unreachable!() };
    assert!(taken < delivered && !pump.unproven, "{pump:?}");
    let rig = Setup::rig_of(&project_of(HOSE, &["supply.model=pump_limited"])).unwrap();
    let found = rig.supply.unwrap();
    // the flow of the pump above the flow taken goes through a relief valve that opens over 5 bar
    let falls = 5e5 * found.taken / (9.8e-3 / 60.0);
    assert!((found.supply.pressure - (70e5 - falls)).abs() < 1e-3, "{found:?}");
}

/// The hose as a single rig without uncertainty.
fn without_uncertainty() -> String {
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, specifications) = rest.split_once("[[specification]]").unwrap();
    format!("{start}[[specification]]{specifications}")
}

/// A load that yields and is fed forward becomes unstable once the gain is too large, with lumped
/// lines and with waves in them, sampled and continuous: so do the machines of
/// theory/feed_forward.md, 0.7 and 1.3 times A/K_qU.
#[test]
fn a_load_velocity_that_is_fed_forward_is_in_the_loop() {
    let certain = without_uncertainty();
    let area_over_gain = 29.3;
    let creeping = ["line.model=creeping", "line.relaxation_time=0.01"];
    let sampled = ["controller.sample_time=1 ms"];
    for line in [&[][..], &creeping, &sampled, &[&creeping[..], &sampled].concat()] {
        for (fraction, stable) in [(0.0, true), (0.7, true), (1.3, false)] {
            let gain = format!("controller.load_velocity_feed_forward.gain={}", fraction * area_over_gain);
            let settings = [&SPRUNG[..], line, &[&gain]].concat();
            let problem =
                robust_problem(&Memory::default(), &Setup::new(&project_of(&certain, &settings)).unwrap())
                    .unwrap();
            let member = problem.nominal().unwrap().unwrap();
            let found = member_stability(&member, &problem.compensation).status;
            assert_eq!(found == StabilityStatus::Stable, stable, "{line:?} {fraction}: {found:?}");
            assert!(
                stable || matches!(found, StabilityStatus::Unstable(_)),
                "{line:?} {fraction}: {found:?}"
            );
            assert!(problem.caveats.is_empty(), "{:?}", problem.caveats);
        }
    }
}

/// A load that yields and is fed forward with delay: the loop is unstable after 8.5 ms, stable
/// after 10 and unstable after 13 again; without the feed-forward none of them is stable. The
/// machine with viscous friction agrees.
#[test]
fn a_late_feed_forward_is_in_the_loop() {
    let text = without_uncertainty();
    for (gain, delay_ms, stable) in
        [(15, 1.0, true), (15, 8.5, false), (15, 10.0, true), (15, 13.0, false), (0, 10.0, false)]
    {
        let delay = format!("controller.delay={delay_ms} ms");
        let fed = format!("controller.load_velocity_feed_forward.gain={gain}");
        let viscous = "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }";
        let output = answer(
            &text,
            &[&SPRUNG[..], &[viscous, &delay, &fed, TENTH_ONLY]].concat(),
            &[],
            &Request::Verify { proof: false, on_machine: true },
        );
        let object: Value = parsed(&output.json);
        assert_eq!(object["stable"], Value::from(stable), "{gain} {delay_ms}: {}", output.text());
        let run = &object["machine"]["runs"][0];
        let overshoot = |of: &str| run[of]["overshoot_percent"].as_f64();
        let machine = overshoot("machine").unwrap();
        assert_eq!(machine < 40.0, stable, "{gain} {delay_ms}: {run}");
        if let (true, Some(linear)) = (stable, overshoot("linear")) {
            assert!((machine - linear).abs() < 4.0, "{gain} {delay_ms}: {run}");
            assert_eq!(run["agrees"], Value::from(true), "{gain} {delay_ms}: {run}");
        }
        let words = "every plant by its response with the load's velocity fed forward late";
        assert_eq!(output.text().contains(words), gain != 0, "{}", output.text());
    }
}

/// A load that yields and is fed forward in samples, with viscous friction: the machine agrees with
/// the loop in z.
#[test]
fn a_sampled_feed_forward_is_in_the_loop() {
    let text = without_uncertainty();
    for (gain, sample_ms, delay_ms, stable) in
        [(20, 1.0, 0.0, true), (15, 2.0, 0.0, true), (40, 1.0, 0.0, false), (0, 2.0, 9.0, false)]
    {
        let timing =
            [format!("controller.sample_time={sample_ms} ms"), format!("controller.delay={delay_ms} ms")];
        let fed = format!("controller.load_velocity_feed_forward.gain={gain}");
        let viscous = "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }";
        let settings = [&SPRUNG[..], &[viscous, &timing[0], &timing[1], &fed, TENTH_ONLY]].concat();
        let output = answer(&text, &settings, &[], &Request::Verify { proof: false, on_machine: true });
        let object: Value = parsed(&output.json);
        assert_eq!(object["stable"], Value::from(stable), "{gain} {sample_ms} {delay_ms}: {}", output.text());
        let run = &object["machine"]["runs"][0];
        let overshoot = |of: &str| run[of]["overshoot_percent"].as_f64();
        let machine = overshoot("machine").unwrap();
        assert_eq!(machine < 40.0, stable, "{gain} {sample_ms} {delay_ms}: {run}");
        if stable {
            assert!((machine - overshoot("linear").unwrap()).abs() < 5.0, "{gain} {delay_ms}: {run}");
            assert_eq!(run["agrees"], Value::from(true), "{gain} {delay_ms}: {run}");
        }
        assert!(object["warnings"].as_array().unwrap().is_empty(), "{}", output.text());
    }
}

/// Delayed feed-forward of a prescribed load is a path of its motion: P_d + K s P, P delayed or
/// sampled, and the loop itself is unchanged.
#[test]
fn a_late_feed_forward_of_a_prescribed_load_is_a_path_of_its_motion() {
    let limit = "[[specification]]\nkind = \"load_motion\"\nlimit = 1e6\nfrequencies = [1, 10, 100]\n\n[[specification]]";
    let text = without_uncertainty().replacen("[[specification]]", limit, 1);
    let problem = |settings: &[&str]| {
        robust_problem(&Memory::default(), &Setup::new(&project_of(&text, settings)).unwrap()).unwrap()
    };
    for settings in
        [&["controller.delay=1 ms"][..], &["controller.delay=1.4 ms", "controller.sample_time=1 ms"]]
    {
        let fed = [settings, &["controller.load_velocity_feed_forward.gain=25"]].concat();
        let [own, fed] = [problem(settings), problem(&fed)];
        assert!(own.without_polynomials.is_none() && fed.without_polynomials.is_none());
        assert!(fed.caveats.is_empty(), "{:?}", fed.caveats);
        let [own, member] = [&own, &fed].map(|problem| problem.nominal().unwrap().unwrap());
        for frequency in [0.1, 10.0, 300.0, 2000.0] {
            let [own_response, seen] = [&own, &member].map(|member| member.response(frequency).unwrap());
            // delay and hold of the loop are within P
            let expected =
                own_response.load_motion + 25.0 * Complex64::new(0.0, frequency) * own_response.plant;
            assert!((seen.load_motion / expected - 1.0).norm_sqr() < 1e-18, "{frequency}");
            assert!((seen.plant / own_response.plant - 1.0).norm_sqr() < 1e-18, "{frequency}");
        }
        assert_eq!(member_stability(&member, &fed.compensation).status, StabilityStatus::Stable);
    }
}

/// A path that no specification limits is reported, but the verdict is unchanged.
#[test]
fn a_path_that_no_specification_limits_decides_nothing() {
    for (settings, warnings) in
        [(vec![], 1), (vec!["controller.delay=0.1 ms"], 1), (vec!["controller.sample_time=0.1 ms"], 1)]
    {
        let fed = [&["controller.load_velocity_feed_forward={}"], &settings[..]].concat();
        let view = audited(&satisfied(&fed));
        assert_eq!((view.audit.verdict, view.caveats.len()), (Verdict::Met, warnings), "{settings:?}");
    }
}

/// The box of Table 6.3 begins above the K_c of the edges of Table 5.1: the behaviour of the loop
/// with that rig is reported.
// ORIGIN: thesis, Table 6.3, and K_c of the edges of Table 5.1
#[test]
fn a_family_that_does_not_contain_the_rig_is_reported_first() {
    let view = audited(&satisfied(&[]));
    let [outside] = &view.caveats[..] else { panic!("{:?}", view.caveats) };
    let UncountedEffect::OutsideFamily(OutsideFamily { parameters, with_rig }) = &outside.effect else {
        panic!("{outside:?}")
    };
    let [coefficient] = &parameters[..] else { panic!("{parameters:?}") };
    assert_eq!(
        (coefficient.name.as_str(), coefficient.bounds),
        ("flow_pressure_coefficient", [6.42e-13, 7e-11])
    );
    assert!((coefficient.value / 5.929e-13 - 1.0).abs() < 1e-4, "{coefficient:?}");
    assert_eq!(*with_rig, LoopWithRig::Satisfied);
    // half the flow gain of the rig, and a limit that is satisfied for that gain only
    let range = "uncertainty.flow_gain={ nominal = 2.5e-5, minimum = 2.4e-5, maximum = 2.6e-5 }";
    let mut far = satisfied(&[range]);
    far.uncertainty.retain(|uncertain| uncertain.name == "flow_gain");
    far.specifications[0].limit = Some(project::DeclaredLimit::Constant(2.0));
    let view = audited(&far);
    assert_eq!(view.audit.verdict, Verdict::NotProven);
    assert_eq!(view.audit.specifications[0].verdict, Verdict::Met);
    let UncountedEffect::OutsideFamily(OutsideFamily { parameters, with_rig }) = &view.caveats[0].effect
    else {
        panic!("{:?}", view.caveats)
    };
    assert!((parameters[0].value / 5.2e-5 - 1.0).abs() < 0.02, "{parameters:?}");
    assert_eq!(
        *with_rig,
        LoopWithRig::Violates(vec![(1, SpecificationName::ClosedLoop(ClosedLoop::RobustStability))])
    );
}
