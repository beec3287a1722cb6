//! Printed values of a rig are those of the declared rig, its specimen and its leakage included, or
//! name the parts that they leave out.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{
    HOSE, answer, check, derived, linearize, load, near, number, size_for_gain, size_for_length,
};
use num_complex::Complex64;
use phea_workbench::command::Request;
use phea_workbench::engineering::linearize::{Linearization, linearize as linearized};
use phea_workbench::engineering::setup::Setup;
use serde_json::Value;

/// A differential cylinder without any stated value of its linear model.
pub(crate) const RIG: &str = r#"
schema = 1
title = "Press on a specimen"
[fluid]
bulk_modulus = "1.5 GPa"
density = "870 kg/m3"
kinematic_viscosity = "46 cSt"
[supply]
model = "constant"
pressure = "200 bar"
flow = "40 L/min"
[valve]
nominal_voltage = "10 V"
nominal_flow = "40 L/min"
nominal_pressure_drop = "70 bar"
null_leakage = "0.9 L/min"
null_leakage_pressure = "100 bar"
natural_frequency = "100 Hz"
damping_ratio = 0.8
leakage_shape = 60
[cylinder]
piston_diameter = "80 mm"
rod_diameters = ["0 mm", "56 mm"]
stroke = "300 mm"
moving_mass = "35 kg"
dead_volume = "60 mL"
friction = { model = "viscous", viscous = "2000 N.s/m" }
[line]
bore = "12.7 mm"
volumetric_expansion = "4 mL/m"
volumetric_expansion_pressure = "210 bar"
dynamic_stiffening = 1.5
length = "3 m"
[force_sensor]
stiffness = "500 MN/m"
[operating_point]
load_force = "30 kN"
"#;

fn specimen(stiffness: &str) -> String {
    format!(
        "load={{ model = \"spring_mass_damper\", mass = \"250 kg\", damping = \"3 kN.s/m\", stiffness = \"{stiffness}\" }}"
    )
}

/// The value of k Π(s - z)/Π(s - p) at j w.
fn response(factors: &Value, frequency: f64) -> Complex64 {
    let roots = |name: &str| -> Vec<Complex64> {
        let pair = |root: &Value| Complex64::new(root[0].as_f64().unwrap(), root[1].as_f64().unwrap());
        factors[name].as_array().unwrap().iter().map(pair).collect()
    };
    let s = Complex64::new(0.0, frequency);
    let product = |roots: Vec<Complex64>| roots.iter().map(|root| s - root).product::<Complex64>();
    number(factors, "gain") * product(roots("zeros")) / product(roots("poles"))
}

/// The plant integrates between its slow pole and its modes with the rate gain of `check`, and a
/// moved ground acts on the springs in series.
#[test]
fn rate_gain_and_stiffness_are_those_of_the_plant() {
    for stiffness in ["5 kN/mm", "15 kN/mm", "30 kN/mm", "400 kN/mm"] {
        let load = specimen(stiffness);
        let [output, linear] = [check(RIG, &[&load]), linearize(RIG, &[&load])];
        let frequency = 10.0;
        let rate = response(&linear["plant"]["command"], frequency).norm_sqr().sqrt() * frequency;
        near(derived(&output, "dynamics.force_rate_gain"), rate, 0.015);
        let held = response(&linear["plant"]["load_position"], frequency).norm_sqr().sqrt();
        near(derived(&output, "dynamics.equivalent_stiffness"), held, 0.015);
        assert_eq!(linear["load_step_moves"], "ground");
    }
    // nothing has changed without a load: both springs in series
    let without_specimen = check(RIG, &[]);
    let [k_h, k_s] = ["linear.hydraulic_stiffness", "linear.sensor_stiffness"]
        .map(|name| derived(&without_specimen, name));
    near(derived(&without_specimen, "dynamics.equivalent_stiffness"), k_h * k_s / (k_h + k_s), 1e-12);
}

/// Modes of the plant are listed with their damping, and the participations are those of its poles.
#[test]
fn modes_and_dominance_are_those_of_the_plant() {
    let settings: [&[&str]; 3] =
        [&[], &[&specimen("15 kN/mm")], &[&specimen("1 kN/mm"), "cylinder.internal_leakage=1e-12"]];
    for settings in settings {
        let [output, linear] = [check(RIG, settings), linearize(RIG, settings)];
        let pair = |root: &Value| [root[0].as_f64().unwrap(), root[1].as_f64().unwrap()];
        let poles: Vec<[f64; 2]> = linear["poles"]["plant"].as_array().unwrap().iter().map(pair).collect();
        let mut modes: Vec<[f64; 2]> = poles.iter().copied().filter(|[_, im]| *im > 0.0).collect();
        modes.sort_by(|[a, b], [c, d]| a.hypot(*b).total_cmp(&c.hypot(*d)));
        for (index, [re, im]) in modes.iter().enumerate() {
            let of = |key: &str| derived(&output, &format!("dynamics.mode_{}.{key}", index + 1));
            near(of("frequency"), re.hypot(*im), 1e-12);
            near(of("damping_ratio"), -re / re.hypot(*im), 1e-12);
        }
        assert!(modes.len() >= 2);
        let fractions = linear["dominance"].as_array().unwrap();
        assert_eq!(fractions.len(), poles.iter().filter(|[_, im]| *im >= 0.0).count());
        assert!(fractions.iter().all(|fraction| poles.contains(&pair(&fraction["pole"]))));
    }
}

/// The two-pressure model without a load is the plant, whatever the leakage across the piston.
#[test]
fn the_two_pressure_model_leaks() {
    for leakage in ["1e-13", "1e-12", "2e-11"] {
        let linear = linearize(RIG, &[&format!("cylinder.internal_leakage={leakage}")]);
        let of = |model: &str| -> Vec<f64> {
            let all = linear["poles"][model].as_array().unwrap();
            all.iter().map(|root| root[0].as_f64().unwrap()).collect()
        };
        let (plant, model) = (of("plant"), of("two_pressure"));
        assert_eq!(plant.len(), model.len());
        plant.iter().zip(model).for_each(|(plant, model)| near(model, *plant, 1e-6));
    }
}

/// Models that hold the load still are named as such, in text, JSON and table.
#[test]
fn the_component_that_holds_the_load_is_named() {
    let load = specimen("15 kN/mm");
    let request = Request::Linearize { sweep: None };
    let [with, without] = [&[&load[..]][..], &[]].map(|settings| answer(RIG, settings, &[], &request));
    assert!(with.text().contains("fifth order, load held still") && with.json.contains("load_held_still_in"));
    assert!(with.text().contains("first order, the load's stiffness in series"));
    assert!(with.text().contains("of the actuator, whatever its load"));
    assert!(!without.text().contains("held still") && !without.json.contains("load_held_still_in"));
    let groups = |settings: &[&str]| answer(RIG, settings, &[], &Request::Check).text();
    assert!(groups(&[&load]).contains("Dynamics with the load held still"));
    assert!(!groups(&[]).contains("held still"));
}

fn models(settings: &[&str]) -> Linearization {
    let loaded = load(RIG, settings, &[]);
    let setup = Setup::new(&loaded.project).unwrap();
    linearized(setup.rig().unwrap(), setup.controller.as_ref(), &setup.sensor).unwrap()
}

/// The moved ground of a specimen acts on K_H, K_S and the specimen in series; with the loop closed
/// by a gain K the stiffness is 1/(1 + K P) of that. A prescribed load acts on the port itself.
#[test]
fn a_moved_ground_meets_the_specimen_in_series() {
    let load = specimen("15 kN/mm");
    let gain = 3e-5;
    let controller = format!("controller={{ numerator = \"{gain}\", denominator = \"1\" }}");
    let [open, closed] = [models(&[&load]), models(&[&load, &controller])];
    let prescribed = models(&[]);
    for frequency in [0.1, 2.0, 40.0, 300.0, 2000.0] {
        let at = |of: &phea_dynamics::linear::TransferFunction| of.at_frequency(frequency);
        let s = Complex64::new(0.0, frequency);
        let plant = at(&open.plant.command);
        let expected = at(&open.plant.load_position) / s;
        assert!((-at(&open.open_loop.by_motion) / expected - 1.0).norm_sqr() < 1e-18);
        let by_loop = -at(&closed.closed_loop.as_ref().unwrap().by_motion);
        assert!((by_loop / (expected / (1.0 + gain * plant)) - 1.0).norm_sqr() < 1e-18);
        // the port is that of the actuator, whatever its load
        let ports = [&open, &prescribed].map(|models| at(&models.open_loop.impedance));
        assert!((ports[0] / ports[1] - 1.0).norm_sqr() < 1e-18);
        assert!((at(&prescribed.open_loop.by_motion) / ports[1] - 1.0).norm_sqr() < 1e-24);
    }
}

/// A specimen in series reduces the gain, and the stiffness of the hose, in closed form, in both
/// branches.
///
/// ```text
/// K_p(k) = K_p + A/(tau k K_qU)           1/K_H(k) = 1/K_H - 1/k
/// ```
#[test]
fn sizing_has_the_specimen_in_series() {
    let hose = |settings: &[&str]| size_for_length(HOSE, settings, "1.5 m");
    let by_gain = |settings: &[&str]| size_for_gain(HOSE, settings, "4e-4");
    let row = |size: &Value, index: usize, key: &str| number(&size["candidates"][index], key);
    let area = derived(&check(HOSE, &[]), "linear.piston_area");
    let [own, own_by_gain] = [hose(&[]), by_gain(&[])];
    assert_eq!(own["load"], "prescribed");
    for stiffness in [3e6, 15e6, 30e6] {
        let load = specimen(&format!("{stiffness} N/m"));
        let found = hose(&[&load]);
        assert_eq!(found["load"], "in_series");
        near(number(&found, "load_stiffness_n_per_m"), stiffness, 1e-12);
        for index in 0..2 {
            // ORIGIN: analytic, A/(tau k K_qU) with tau and K_qU of the example's [sizing]
            let more = area / (0.05 * stiffness * 5.62e-5);
            let [with, without] = [&found, &own].map(|size| row(size, index, "proportional_gain_v_per_n"));
            near(with, without + more, 1e-9);
            near(row(&found, index, "time_constant_s.0"), 0.05, 1e-9);
        }
        let found = by_gain(&[&load]);
        let [with, without] =
            [&found, &own_by_gain].map(|size| row(size, 0, "iterations.0.stiffness_n_per_m"));
        near(1.0 / with, 1.0 / without - 1.0 / stiffness, 1e-9);
    }
}

/// A piston with one rod, with another time constant, and with a spring on the rod: the specimen
/// reduces the gain too.
#[test]
fn a_specimen_takes_its_gain_whatever_the_rig() {
    let one_rod = HOSE.replace("rod_diameter = \"22 mm\"", "rod_diameters = [\"22 mm\", \"0 mm\"]");
    let spring = format!("{HOSE}\n[series]\nstiffness = \"3 kN/mm\"\n");
    let load = specimen("8e6 N/m");
    for (text, settings, time_constant) in [
        (&one_rod, vec![], 0.05),
        (&spring, vec![], 0.05),
        (&spring, vec!["sizing.time_constant=0.2 s"], 0.2),
        (&one_rod, vec!["sizing.flow_gain=4e-5"], 0.05),
    ] {
        let gain = |more: &[&str]| {
            let size = size_for_length(text, &[&settings[..], more].concat(), "1.5 m");
            number(&size["candidates"][0], "proportional_gain_v_per_n")
        };
        let area = derived(&check(text, &settings), "linear.piston_area");
        let flow_gain = if settings.iter().any(|one| one.contains("flow_gain")) { 4e-5 } else { 5.62e-5 };
        // ORIGIN: analytic, A/(tau k K_qU)
        near(gain(&[&load]) - gain(&[]), area / (time_constant * 8e6 * flow_gain), 1e-6);
    }
}

/// A load that no stiffness holds is not in series with anything, and this is reported.
#[test]
fn a_free_mass_is_held_still_and_named() {
    let load =
        "load={ model = \"spring_mass_damper\", mass = \"250 kg\", damping = \"3 kN.s/m\", stiffness = 0 }";
    let settings = [load, "operating_point={ position = \"150 mm\" }"];
    let request = crate::run_command::size_request(None, Some("1.5 m"));
    let sized = answer(HOSE, &[load], &[], &request);
    assert!(sized.text().contains("the load held still, as no stiffness holds it"), "{}", sized.text());
    let output = answer(RIG, &settings, &[], &Request::Check);
    assert!(output.text().contains("Dynamics with the load held still, as no stiffness holds it"));
}
