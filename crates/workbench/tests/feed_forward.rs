//! The page on the feed-forward of the load's velocity: its equations compared with the linear
//! model, its tables with the machine.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use num_complex::Complex64;
use phea_dynamics::controller::RateFilter;
use phea_dynamics::linear::TransferFunction;
use phea_hydraulics::linear::{LinearParameters, linear_model};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{Cause, Metrics, RunStatus, simulate_project};
use phea_workbench::project::{self, Project};
use phea_workbench::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const PIPE: &str = include_str!("../../../examples/ybitu/pipe.toml");
const PAGE: &str = include_str!("../../../book/src/theory/feed_forward.md");

fn load(line: &str, settings: &[String]) -> Project {
    let text = match line {
        "pipe" => PIPE,
        "hose" => HOSE,
        other => panic!("{other}"),
    };
    let source = Memory::default().with("rig.toml", text);
    project::read(&source, "rig.toml", settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

/// Default gain A/K_qU, V s/m.
fn static_gain(parameters: &LinearParameters) -> f64 {
    parameters.useful_area / parameters.flow_gain
}

/// Exact gain K_x(s) of the page.
fn exact_gain(parameters: &LinearParameters, s: Complex64) -> Complex64 {
    let LinearParameters { useful_area: area, valve_natural_frequency: frequency, .. } = *parameters;
    let spool = frequency * frequency
        / (s * s + 2.0 * parameters.valve_damping_ratio * frequency * s + frequency * frequency);
    let fluid = s / parameters.hydraulic_stiffness + parameters.flow_pressure_coefficient / (area * area);
    static_gain(parameters) * (1.0 + fluid * (parameters.moving_mass * s + parameters.viscous_friction))
        / spool
}

/// Lag tau of the page, s.
fn lag(parameters: &LinearParameters) -> f64 {
    let area = parameters.useful_area;
    2.0 * parameters.valve_damping_ratio / parameters.valve_natural_frequency
        + parameters.viscous_friction / parameters.hydraulic_stiffness
        + parameters.flow_pressure_coefficient * parameters.moving_mass / (area * area)
}

#[test]
fn the_exact_gain_cancels_the_load_in_the_linear_model() {
    for line in ["pipe", "hose"] {
        let parameters = Setup::rig_of(&load(line, &[])).unwrap().linear;
        let model = linear_model(&parameters).unwrap();
        for frequency in [0.01, 1.0, 10.0, 300.0, 1e3, 1e4] {
            let s = Complex64::new(0.0, frequency);
            let cancels =
                -model.load_position.at_frequency(frequency) / (s * model.command.at_frequency(frequency));
            let exact = exact_gain(&parameters, s);
            assert!((cancels / exact - 1.0).norm_sqr() < 1e-18, "{line}, {frequency}: {cancels} {exact}");
        }
    }
}

/// The remaining fraction of the force of a slow motion is 1 - a + a tau s.
#[test]
fn the_remainder_grows_with_the_lag() {
    // ORIGIN: recomputed by book/recompute_theory.py
    for (line, quoted) in [("hose", 1.69e-3), ("pipe", 1.65e-3)] {
        let tau = lag(&Setup::rig_of(&load(line, &[])).unwrap().linear);
        assert!((tau - quoted).abs() < 0.005e-3, "{line}: {tau}");
    }
    let parameters = Setup::rig_of(&load("pipe", &[])).unwrap().linear;
    let tau = lag(&parameters);
    for (fraction, frequency) in [(1.0, 10.0), (0.7, 1.0), (1.3, 5.0)] {
        let s = Complex64::new(0.0, frequency);
        let left = 1.0 - fraction * static_gain(&parameters) / exact_gain(&parameters, s);
        let first_order = 1.0 - fraction + fraction * tau * s;
        // the next term is (tau s)^2, and the leakage of a piston with friction gives 3e-5
        let next = 2.0 * tau * tau * frequency * frequency + 4e-5;
        assert!(
            (left - first_order).norm_sqr() < next * next,
            "{fraction}, {frequency}: {left} {first_order}"
        );
    }
}

/// Real part of Z for the loop with feed-forward: it changes its sign at low frequency where (1 -
/// a)(K_p + K_c/(A K_qU)) = tau K_i.
#[test]
fn a_little_less_than_the_gain_is_passive() {
    for (line, proportional, integral, less_percent, filtered_percent) in
        [("pipe", 5e-4, 2e-3, 0.65, 4.4), ("hose", 1e-3, 8e-3, 1.3, 8.6)]
    {
        let parameters = Setup::rig_of(&load(line, &[])).unwrap().linear;
        let model = linear_model(&parameters).unwrap();
        let zero = Complex64::new(-integral / proportional, 0.0);
        let controller =
            TransferFunction::from_factors(proportional, vec![zero], vec![Complex64::new(0.0, 0.0)]).unwrap();
        let frequency = 0.02;
        let resistance = |fraction: f64| {
            let plant = model.command.at_frequency(frequency);
            let remainder =
                exact_gain(&parameters, Complex64::new(0.0, frequency)) - fraction * static_gain(&parameters);
            (plant * remainder / (1.0 + plant * controller.at_frequency(frequency))).re
        };
        let leak = parameters.flow_pressure_coefficient / (parameters.useful_area * parameters.flow_gain);
        let less = lag(&parameters) * integral / (proportional + leak);
        assert!((100.0 * less - less_percent).abs() < 0.05, "{line}: {less}");
        // friction in addition to leakage makes the gain at rest 3e-5 greater than A/K_qU
        assert!(resistance(1.0 - less - 1e-4) > 0.0 && resistance(1.0 - less + 1e-4) < 0.0, "{line}");
        assert!(resistance(1.0) < 0.0 && resistance(0.0) > 0.0, "{line}");
        // the lag T of a filter requires more: (1 - a)(K_p + K_c/(A K_qU)) = (tau + a T) K_i
        let filter = RateFilter::FirstOrder { frequency_rad_per_s: 100.0 };
        let through = |fraction: f64| {
            let s = Complex64::new(0.0, frequency);
            let fed = fraction * static_gain(&parameters) * filter.response(s);
            let plant = model.command.at_frequency(frequency);
            let closed = plant / (1.0 + plant * controller.at_frequency(frequency));
            (closed * (exact_gain(&parameters, s) - fed)).re
        };
        let less = (lag(&parameters) + 0.01) * integral / (proportional + leak + 0.01 * integral);
        assert!((100.0 * less - filtered_percent).abs() < 0.05, "{line}: {less}");
        assert!(through(1.0 - less - 2e-4) > 0.0 && through(1.0 - less + 2e-4) < 0.0, "{line}: {less}");
    }
}

/// Metrics of the force after a prescribed motion of the load.
fn of_the_motion(line: &str, settings: &[String]) -> Metrics {
    let mut project = load(line, settings);
    project.scenarios.truncate(1);
    let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    // a loop that the fed gain makes swing for good has its numbers too
    assert!(run.stopped().is_none_or(|stopped| stopped.status == RunStatus::Diverged), "{line} {settings:?}");
    let (_, metrics) = run.windows.into_iter().find(|(window, _)| window.cause == Cause::LoadMotion).unwrap();
    metrics
}

/// Rows of the page's table with this heading: labels and numbers, and the labels of the columns.
fn table(head: &str) -> (Vec<String>, Vec<(String, Vec<f64>)>) {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect()
    };
    let mut lines = PAGE.lines().skip_while(|line| !line.starts_with(&format!("| {head}")));
    let columns = cells(lines.next().unwrap()).split_off(1);
    let rows = lines.skip(1).take_while(|line| line.starts_with('|')).map(|line| {
        let mut row = cells(line);
        let numbers = row.split_off(1).iter().map(|cell| cell.parse().unwrap()).collect();
        (row.remove(0), numbers)
    });
    (columns, rows.collect())
}

fn gain(fraction: f64) -> String {
    let parameters = Setup::rig_of(&load("pipe", &[])).unwrap().linear;
    format!("controller.load_velocity_feed_forward.gain={:e}", fraction * static_gain(&parameters))
}

/// Settings for a part of a row's label.
fn settings_of(part: &str) -> Vec<String> {
    let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_string()).collect();
    match part {
        "feed-forward" => owned(&["controller.load_velocity_feed_forward={}"]),
        "feed-forward 30 % too small" => vec![gain(0.7)],
        "feed-forward 30 % too large" => vec![gain(1.3)],
        "supply of 50 bar" => owned(&["supply.pressure=50 bar"]),
        "-4 kN" => owned(&["scenario.0.reference.0.force=-4 kN"]),
        "sampled" => owned(&["controller.sample_time=1 ms", "controller.delay=0.5 ms"]),
        "velocity 2 ms late" => owned(&["velocity_sensor.delay=2 ms"]),
        "velocity behind 50 Hz" => owned(&["velocity_sensor.filter_frequency=50 Hz"]),
        "velocity with 5 mm/s of noise" => owned(&["velocity_sensor.noise=5 mm/s"]),
        other => panic!("{other}"),
    }
}

#[test]
fn the_tables_agree_with_the_machine() {
    let (columns, peaks) = table("peak, N");
    let (same_columns, commands) = table("rms, V");
    assert!(columns == same_columns && peaks.len() == 18 && commands.len() == 18);
    let mut wrong: Vec<String> = Vec::new();
    for ((label, peaks), (same_label, commands)) in peaks.iter().zip(&commands) {
        assert_eq!(label, same_label);
        let (line, parts) = label.split_once(", ").unwrap_or((label, ""));
        let parts = parts.split(", ").filter(|part| !part.is_empty());
        let row: Vec<String> = parts.flat_map(settings_of).collect();
        for ((column, peak), command) in columns.iter().zip(peaks).zip(commands) {
            let (distance, duration) = column.split_once(" in ").unwrap();
            let mut settings = row.clone();
            settings.push(format!("scenario.0.load_motion.distance={distance}"));
            settings.push(format!("scenario.0.load_motion.duration={duration}"));
            let found = of_the_motion(line, &settings);
            let (found_peak, found_rms) = (found.disturbance_peak_n.unwrap(), found.control_rms_v.unwrap());
            if (found_peak - peak).abs() >= 6.0 || (found_rms - command).abs() >= 0.006 {
                wrong.push(format!("{label}, {column}: {found_peak} N, {found_rms} V"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_load_that_reacts_agrees_with_the_page() {
    let mass = "load={ model = \"spring_mass_damper\", mass = 100, stiffness = 2e5, damping = 500 }";
    let (fractions, rows) = table("rms with a reacting load, V");
    assert!(fractions.len() == 6 && rows.len() == 2);
    for (line, commands) in rows {
        let found: Vec<Metrics> = fractions
            .iter()
            .map(|fraction| of_the_motion(&line, &[mass.to_string(), gain(fraction.parse().unwrap())]))
            .collect();
        for ((fraction, found), command) in fractions.iter().zip(&found).zip(commands) {
            let found = found.control_rms_v.unwrap();
            assert!((found - command).abs() < 0.006 * command.max(1.0), "{line}, {fraction}: {found} V");
        }
        let peak = |index: usize| found[index].disturbance_peak_n.unwrap();
        assert!(peak(2) < 0.51 * peak(0), "{line}");
    }
}
