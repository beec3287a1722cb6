//! The command for a step of the reference: closed forms, a plant known only by its response, and
//! the nonlinear run.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::analytic::Disc;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_engineering::linear_step::linear_command_step;
use phea_engineering::robust::robust_problem;
use phea_qft::closed_loop::Compensation;
use phea_workbench::command::Request;
use phea_workbench::engineering::setup::Setup;

use crate::run_command::{HOSE, json, load, number, source, within};

const GAIN: f64 = 3.0;
const PLANT: f64 = 20.0;
const POLE: f64 = 5.0;
const SAMPLE_TIME_S: f64 = 1e-3;

/// A gain with the prefilter (s/10 + 1)/(s/40 + 1), or without one.
fn around(sample_time_s: Option<f64>, has_prefilter: bool) -> Compensation {
    let lead = vec![Element::RealZero { frequency: 10.0 }, Element::RealPole { frequency: 40.0 }];
    let controller = Controller {
        feedback: Compensator::new(vec![Element::Gain(GAIN)]),
        prefilter: if has_prefilter { Compensator::new(lead) } else { Compensator::default() },
        timing: Timing { sample_time_s, ..Timing::default() },
        ..Controller::default()
    };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

/// The plant 20/(s + 5).
fn lag() -> PlantCoefficients<f64> {
    let command = RationalCoefficients { numerator: vec![PLANT], denominator: vec![1.0, POLE] };
    PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None }
}

fn command(around: &Compensation) -> Vec<(f64, f64)> {
    let member = around.member(lag()).unwrap();
    let found = linear_command_step(&member, around, 0.2, 2000).unwrap();
    found.times_s.into_iter().zip(found.values).collect()
}

/// Command u = K (1 - y) with y = K k/(a + K k) (1 - exp(-(a + K k) t)); sampled, y(k+1) = d y(k) +
/// b u(k).
#[test]
fn a_gain_around_a_lag_in_closed_form() {
    let closed = POLE + GAIN * PLANT;
    for (time_s, found) in command(&around(None, false)) {
        let output = GAIN * PLANT / closed * (1.0 - (-closed * time_s).exp());
        within(found, GAIN * (1.0 - output), 1e-6);
    }
    let decay = (-POLE * SAMPLE_TIME_S).exp();
    let held = PLANT / POLE * (1.0 - decay);
    let mut output = 0.0;
    for (_, found) in command(&around(Some(SAMPLE_TIME_S), false)) {
        let own = GAIN * (1.0 - output);
        within(found, own, 1e-9);
        output = decay * output + held * own;
    }
}

/// The first command is K F(inf), for the continuous prefilter and for the sampled one.
#[test]
fn the_first_command_is_the_direct_feedthrough() {
    within(command(&around(None, true))[0].1, GAIN * 40.0 / 10.0, 1e-9);
    let sampled = around(Some(SAMPLE_TIME_S), true);
    let passes = sampled.prefilter_of_step().unwrap().gain();
    assert!(passes > 3.5, "{passes}");
    within(command(&sampled)[0].1, GAIN * passes, 1e-9);
}

/// The lag, known only by its response.
#[derive(Debug)]
struct Drawn;

impl RespondingPlant for Drawn {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        [PLANT / Complex64::new(POLE, frequency_rad_per_s), Complex64::new(0.0, 0.0)]
    }
    fn enclosure(&self, _: [f64; 2]) -> Disc {
        Disc::WHOLE
    }
    fn slow(&self) -> PlantCoefficients<f64> {
        lag()
    }
    fn roll_off(&self, _: f64) -> Option<f64> {
        None
    }
    fn unstable_poles(&self) -> Option<usize> {
        Some(0)
    }
    fn range_rad_per_s(&self) -> [f64; 2] {
        [0.01, 1e5]
    }
    fn echo_s(&self) -> f64 {
        0.0
    }
}

/// Commands a thousand times smaller, too: a response has equal accuracy in any unit.
#[test]
fn a_plant_known_by_its_response_takes_the_same_command() {
    let around = around(None, true);
    let drawn = around.responding(Arc::new(Drawn));
    let found = linear_command_step(&drawn, &around, 0.2, 2000).unwrap();
    for ((time_s, expected), value) in command(&around).into_iter().zip(found.values) {
        assert!((value - expected).abs() < 0.02 * GAIN, "{time_s} {value} {expected}");
    }
}

/// The rig with only hoses: without dry friction, without load, with equal gain on both sides of
/// its null, and without scenarios.
pub(crate) fn simple_rig() -> String {
    let between = |text: &str, from: &str, to: &str, other: &str| {
        let (before, rest) = text.split_once(from).unwrap();
        format!("{before}{other}{to}{}", rest.split_once(to).unwrap().1)
    };
    let equal = |value: &str| {
        ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"]
            .map(|edge| format!("{edge} = {value}\n"))
            .concat()
    };
    let viscous = "[cylinder.friction]\nmodel = \"viscous\"\nviscous = \"100 N.s/m\"\n";
    let edges = format!(
        "[valve.flow_coefficients]\n{}[valve.leakage_coefficients]\n{}[operating_point]\nload_force = \"0 N\"\n",
        equal("3e-7"),
        equal("2.3e-9")
    );
    let text = HOSE.split("[[scenario]]").next().unwrap();
    let text = between(text, "[uncertainty]", "[[specification]]", "");
    let text = between(&text, "[cylinder.friction]", "[line]", viscous);
    between(&text, "[valve.flow_coefficients]", "[cylinder]", &edges)
}

/// The largest command of the nonlinear run of a small step is that of the operating point plus the
/// linear one.
#[test]
fn a_small_step_of_the_nonlinear_rig_takes_the_linear_command() {
    let text = simple_rig();
    let project = load(&text, &[], &[]).project;
    let setup = Setup::new(&project).unwrap();
    let problem = robust_problem(&source(&text), &setup).unwrap();
    let member = problem.nominal().unwrap().unwrap();
    let step_n = 500.0;
    let found = linear_command_step(&member, &problem.compensation, 1.0, 4000).unwrap();
    let largest = found.values.iter().fold(0.0_f64, |largest, value| largest.max(*value));
    let point = &setup.rig().unwrap().point;
    let (from_n, rest_v) = (point.hydraulic_force, point.command);
    let scenario = format!(
        "{text}\n[[scenario]]\nname = \"small\"\nduration = \"1.5 s\"\nreference = [{{ at = \"0 s\", force = {from_n} }}, {{ at = \"0.5 s\", force = {} }}]\n",
        from_n + step_n
    );
    let run = json(&scenario, &[], &[], &Request::Simulate(Default::default()));
    let peak = number(&run, "scenarios.0.events.0.metrics.control_peak_v");
    within(peak, (rest_v + largest * step_n).abs(), 0.05 * largest * step_n);
}

/// The command of a design for limits of tracking without a limit on it, then with a limit of 85 %
/// of it; and with a limit below the command that holds the force, which no controller satisfies.
/// The sensor's capacity is reached before the valve's.
// ORIGIN: analytic, fractions of the command of the unlimited design
#[test]
fn a_design_limits_the_command_of_its_step() {
    let text = simple_rig();
    let (rig, _) = text.split_once("[controller]").unwrap();
    let rig = rig.replace("[force_sensor]\n", "[force_sensor]\ncapacity = \"2.5 kN\"\n");
    let text = format!(
        "{rig}[design]\nstructure = \"pi\"\nhighest_bandwidth = \"inf\"\n[[scenario]]\nname = \"step\"\nduration = \"2 s\"\n\
         reference = [{{ at = \"0.5 s\", force = \"2 kN\" }}]\n"
    );
    let designed = |fraction: f64| {
        let setting = format!("design.command_of_steps={fraction}");
        json(&text, &[&setting], &[], &Request::Design { seed: None, stages: false, repair: false })
    };
    let own = |design: &serde_json::Value| {
        let limits = design["limits"].as_array().unwrap();
        limits.iter().find(|one| one["key"] == "command_of_steps").unwrap().clone()
    };
    let command = |design: &serde_json::Value, key: &str| number(&own(design), &format!("command.{key}"));
    let free = designed(1.0);
    assert_eq!(free["status"], "met", "{}", free["limits"]);
    let largest_v = command(&free, "largest_v");
    within(command(&free, "largest_step_n"), 2500.0, 1e-9);
    assert_eq!(own(&free)["command"]["step_limit"], "sensor");
    let fraction = 0.085 * largest_v;
    let limited = designed(fraction);
    assert_eq!(limited["status"], "met", "{}", limited["limits"]);
    assert!(command(&limited, "largest_v") <= 10.0 * fraction * 1.001);
    let at_rest_v = command(&free, "at_rest_v");
    let beyond = designed(0.05 * at_rest_v);
    assert_eq!(beyond["status"], "command_beyond_valve");
    within(command(&beyond, "at_rest_v"), at_rest_v, 0.02 * at_rest_v);
}
