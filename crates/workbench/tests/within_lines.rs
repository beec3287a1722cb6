//! Pressure within a line with waves: the exact line between the pressures of its ends.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use num_complex::Complex64;
use phea_dynamics::portable::{exp, exp_complex, ln, sqrt_complex};
use phea_dynamics::spectrum::Transform;
use phea_hydraulics::line::friction_factor;
use phea_hydraulics::signal::Signal;
use phea_workbench::command::Request;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::simulate_project;
use phea_workbench::source::Memory;

use super::run_command::{json, project_of};

/// Two pulses that meet within a line of 10 m with a bore of 10 mm, full of oil with 850 kg/m3 and
/// 1.4 GPa.
const PULSES: &str = include_str!("projects/meeting_pulses.toml");
const LENGTH_M: f64 = 10.0;
const RADIUS_M: f64 = 5e-3;
const START_PA: f64 = 17.5e5;
/// Remaining fraction of the first row at the end of the transform's window.
const LEFT: f64 = 1e-7;

/// The least pressure within the line, and its distance from the valve, m.
///
/// ```text
/// p(x) = [p_valve sinh Gamma (1 - x) + p_chamber sinh Gamma x]/sinh Gamma,    Gamma = s T sqrt(N(s R^2/nu))
/// ```
///
/// along s = sigma + jw, so that the transform of a row that ends is that of an infinite one.
fn exact(times_s: &[f64], ends: [Vec<f64>; 2], viscosity: f64) -> [f64; 2] {
    let (rows, step_s) = (times_s.len(), times_s[1] - times_s[0]);
    let count = 4 * rows;
    let window_s = count as f64 * step_s;
    let sigma = -ln(LEFT) / window_s;
    let travel_s = LENGTH_M / (1.4e9_f64 / 850.0).sqrt();
    let transform = Transform::new(count);
    let of = |end: &Vec<f64>| {
        let mut damped = vec![0.0; count];
        for ((place, time_s), pressure) in damped.iter_mut().zip(times_s).zip(end) {
            *place = (pressure - START_PA) * exp(-sigma * time_s);
        }
        transform.of_real(&damped)
    };
    let [valve, chamber] = ends.each_ref().map(of);
    let propagation: Vec<Complex64> = (0..=count / 2)
        .map(|bin| {
            let s = Complex64::new(sigma, std::f64::consts::TAU * bin as f64 / window_s);
            s * travel_s * sqrt_complex(friction_factor(s * RADIUS_M * RADIUS_M / viscosity))
        })
        .collect();
    let mut least = [f64::INFINITY, 0.0];
    for place in 1..32 {
        let part = f64::from(place) / 32.0;
        let mut spectrum = vec![Complex64::default(); count];
        for (bin, gamma) in propagation.iter().enumerate() {
            let way = |parts: f64| exp_complex(-gamma * parts);
            let forward = valve[bin] * (way(part) - way(2.0 - part));
            let back = chamber[bin] * (way(1.0 - part) - way(1.0 + part));
            let value = (forward + back) / (1.0 - way(2.0));
            // the inverse transform is the transform of the conjugate
            spectrum[bin] = value.conj();
            if bin > 0 && 2 * bin < count {
                spectrum[count - bin] = value;
            }
        }
        for (time_s, value) in times_s.iter().zip(transform.of(&spectrum)) {
            let pressure = START_PA + value.re / count as f64 * exp(sigma * time_s);
            if pressure < least[0] {
                least = [pressure, part * LENGTH_M];
            }
        }
    }
    least
}

/// The depth of a pressure drop within a line is that of the exact line to two percent, and rather
/// deeper, for thin oil and for thick.
#[test]
fn a_fall_within_a_line_is_as_deep_as_in_the_exact_line() {
    for viscosity_cst in [5.0, 20.0, 60.0] {
        let settings = [format!("fluid.kinematic_viscosity={viscosity_cst} cSt")];
        let settings = settings.each_ref().map(String::as_str);
        let run =
            json(PULSES, &settings, &[], &Request::Simulate(Default::default()))["scenarios"][0].clone();
        let exceeded = run["exceeded"].as_array().unwrap();
        let found = exceeded.iter().find(|one| one["place"] == "line_a").unwrap_or_else(|| panic!("{run}"));
        let [peak, distance_m] = ["peak", "distance_m"].map(|key| found[key].as_f64().unwrap());
        let exactly = ["simulation.tolerance=1e-9", "scenario.0.output_step=0.02 ms"];
        let project = project_of(PULSES, &[&settings[..], &exactly].concat());
        let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
            .unwrap()
            .remove(0);
        let ends =
            [Signal::PortPressureA, Signal::PressureA].map(|signal| run.record.signal(signal).to_vec());
        let [exact_pa, exact_m] = exact(&run.record.times_s, ends, viscosity_cst * 1e-6);
        let fall = START_PA - exact_pa;
        let deeper = (exact_pa - peak) / fall;
        assert!((-0.005..0.02).contains(&deeper), "{viscosity_cst} cSt: {peak} {exact_pa}");
        assert!(
            (distance_m - exact_m).abs() < 0.05 * LENGTH_M,
            "{viscosity_cst} cSt: {distance_m} {exact_m}"
        );
    }
}

/// The depth depends neither on the tolerance nor on the length of steps.
#[test]
fn a_fall_between_the_steps_is_found() {
    let of = |tolerance: &str| {
        let run =
            json(PULSES, &[tolerance], &[], &Request::Simulate(Default::default()))["scenarios"][0].clone();
        let exceeded = run["exceeded"].as_array().unwrap();
        exceeded.iter().find(|one| one["place"] == "line_a").unwrap()["peak"].as_f64().unwrap()
    };
    let [rough, fine] = ["simulation.tolerance=1e-5", "simulation.tolerance=1e-10"].map(of);
    assert!((rough / fine - 1.0).abs() < 1e-3, "{rough} {fine}");
}
