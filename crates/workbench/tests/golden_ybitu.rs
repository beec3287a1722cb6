//! The published rig: results of `check`, `size` and `linearize`, compared with printed and
//! recomputed values.
//!
//! The tolerance is one unit of the last printed digit for the thesis, and half of the last digit
//! written here for recomputed numbers.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{
    self, HOSE, PIPE, candidate, check, derived, linearize, near, number, size, size_for_gain, within,
};
use serde_json::Value;

const EATON: &str = "eaton_synflex_3130_08";

/// The parameters of section 6.2, replacing those of the rig.
const SECTION_6_2: [&str; 3] = [
    "linear.viscous_friction=299",
    // ORIGIN: thesis Table 6.1: 5.7e-13 gives its poles, 5.71e-13 a real pole of -2.963
    "linear.flow_pressure_coefficient=5.7e-13",
    "force_sensor.stiffness=\"9.81e7 N/m\"",
];

/// `linearize` with the parameters of section 6.2 and this stiffness.
fn section_6_2(hydraulic_stiffness: &str) -> Value {
    let stiffness = format!("linear.hydraulic_stiffness={hydraulic_stiffness}");
    let mut settings = SECTION_6_2.to_vec();
    settings.push(&stiffness);
    linearize(HOSE, &settings)
}

/// The pole of a list that is nearest to this one.
fn nearest(poles: &Value, re: f64, im: f64) -> [f64; 2] {
    let all: Vec<[f64; 2]> = serde_json::from_value(poles.clone()).unwrap();
    let distance = |pole: &[f64; 2]| (pole[0] - re).hypot(pole[1] - im);
    all.into_iter().min_by(|one, other| distance(one).total_cmp(&distance(other))).unwrap()
}

#[test]
fn areas_and_moduli_of_the_hose_rig() {
    let check = check(HOSE, &[]);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    within(derived(&check, "cylinder.area_a"), 1.5833627e-3, 5e-11);
    within(derived(&check, "cylinder.area_b"), 1.5833627e-3, 5e-11);
    within(derived(&check, "linear.piston_area"), 1.5833627e-3, 5e-11);
    within(derived(&check, "line.static_modulus"), 63_630_085.0, 0.5);
    within(derived(&check, "line.effective_modulus"), 2.6090434e8, 5.0);
    within(derived(&check, "stiffness.uniform.minimum"), 2_232_961.6, 0.05);
    within(derived(&check, "stiffness.uniform.maximum"), 4_108_630.5, 0.05);
    within(derived(&check, "stiffness.by_volume.minimum"), 4_630_311.5, 0.05);
    within(derived(&check, "stiffness.by_volume.maximum"), 4_944_558.5, 0.05);
    // The project declares `uniform`, least stiffening 4, greatest 5.
    assert_eq!(derived(&check, "stiffness.minimum"), derived(&check, "stiffness.uniform.minimum"));
    within(derived(&check, "stiffness.minimum_softest_wall"), 1_853_054.8, 0.05);
    within(derived(&check, "stiffness.maximum_stiffest_wall"), 4_108_630.5, 0.05);
    // ORIGIN: analytic: a modulus of the wall is r_beta times the static one
    near(derived(&check, "line.dynamic_modulus"), 5.0 * derived(&check, "line.static_modulus"), 1e-14);
    // ORIGIN: thesis sections 6.4.1 and 6.4.2
    within(derived(&check, "line.static_modulus"), 6.36e7, 0.01e7);
    within(derived(&check, "stiffness.minimum"), 2.24e6, 0.01e6);
    within(derived(&check, "stiffness.maximum"), 4.11e6, 0.01e6);
}

#[test]
fn stiffness_of_the_pipe_rig() {
    let linear = linearize(PIPE, &[]);
    for range in ["by_volume", "uniform"] {
        // A rigid wall leaves the fluid's modulus everywhere, so that both models agree.
        // ORIGIN: recomputed by comparisons/recompute_rig.py
        within(number(&linear, &format!("stiffness.{range}.0")), 17_060_791.0, 0.5);
        within(number(&linear, &format!("stiffness.{range}.1")), 1.2437026e8, 5.0);
    }
    within(number(&linear, "stiffness.minimum_n_per_m"), 17_060_791.0, 0.5);
    within(number(&linear, "stiffness.maximum_n_per_m"), 1.2437026e8, 5.0);
    within(number(&linear, "stiffness.minimum_position_m"), 0.25, 1e-12);
}

#[test]
fn stiffness_of_the_hose_rig() {
    let linear = linearize(HOSE, &[]);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    let expected = [
        ("minimum_n_per_m", 2_232_961.6),
        ("maximum_n_per_m", 4_108_630.5),
        ("uniform.0", 2_232_961.6),
        ("uniform.1", 4_108_630.5),
        ("by_volume.0", 4_630_311.5),
        ("by_volume.1", 4_944_558.5),
        ("minimum_softest_wall_n_per_m", 1_853_054.8),
        ("maximum_stiffest_wall_n_per_m", 4_108_630.5),
    ];
    for (name, value) in expected {
        within(number(&linear, &format!("stiffness.{name}")), value, 0.05);
    }
    // The other model on request.
    let other = linearize(HOSE, &["line.compliance=by_volume"]);
    within(number(&other, "stiffness.minimum_n_per_m"), 4_630_311.5, 0.05);
}

/// K_H and L_ho of Table 6.2 for a gain K_p given on the command line.
fn table_6_2_row(settings: &[&str], gain: &str) -> (f64, f64) {
    let size = size_for_gain(HOSE, settings, gain);
    let found = candidate(&size, EATON, "uniform");
    assert_eq!(number(found, "proportional_gain_v_per_n"), gain.parse::<f64>().unwrap());
    (number(found, "iterations.0.stiffness_n_per_m"), number(found, "length_m"))
}

#[test]
fn table_6_2_with_the_example_s_constants() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    for (gain, stiffness, length) in [
        ("0.01", 56_465.774, 179.765),
        ("0.001", 575_536.96, 14.818463),
        ("0.0005", 1_176_254.8, 5.6547663),
        ("0.00025", 2_460_146.0, 1.072918),
    ] {
        let found = table_6_2_row(&[], gain);
        near(found.0, stiffness, 5e-8);
        near(found.1, length, 5e-6);
    }
}

#[test]
fn table_6_2_as_printed() {
    // ORIGIN: thesis Table 6.2. A flow gain of 5.625e-5 gives all eight numbers; the 5.62e-5 of the
    // example misses two of them by one and two units (1.176e6 and 14.82).
    for (gain, stiffness, length) in [
        ("0.01", (5.65e4, 0.01e4), (180.0, 1.0)),
        ("0.001", (5.76e5, 0.01e5), (14.84, 0.01)),
        ("0.0005", (1.175e6, 0.001e6), (5.66, 0.01)),
        ("0.00025", (2.46e6, 0.01e6), (1.07, 0.01)),
    ] {
        let found = table_6_2_row(&["sizing.flow_gain=5.625e-5"], gain);
        within(found.0, stiffness.0, stiffness.1);
        within(found.1, length.0, length.1);
    }
}

#[test]
fn the_gain_for_the_hose_that_was_bought() {
    let gain = |settings: &[&str], compliance: &str| {
        let size = run_command::size_for_length(HOSE, settings, "1.5 m");
        number(candidate(&size, EATON, compliance), "proportional_gain_v_per_n")
    };
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    within(gain(&[], "uniform"), 2.7330293e-4, 5e-12);
    within(gain(&["sizing.flow_gain=5.4e-5"], "uniform"), 2.844375e-4, 5e-11);
    within(gain(&[], "by_volume"), 1.4265153e-4, 5e-12);
    // ORIGIN: thesis section 6.4.1
    within(gain(&[], "uniform"), 2.7e-4, 0.1e-4);
}

#[test]
fn the_pole_of_the_gain_and_the_reach_of_a_proportional_loop() {
    let size = size(HOSE, &[]);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    within(number(&size, "pole_gain_v_per_n"), 2.0959013e-5, 5e-13);
    let bought = run_command::size_for_length(HOSE, &[], "1.5 m");
    let bought = candidate(&bought, EATON, "uniform");
    // The gain is 2.733e-4 here and 2.73e-4 in the thesis.
    within(number(bought, "steady_state_gain.0"), 0.974, 5e-4);
    within(number(bought, "steady_state_gain.1"), 0.26, 5e-3);
}

#[test]
fn a_negative_length_means_that_no_hose_is_needed() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py: without a hose K_H is 3.3048496e6
    // (uniform) and 1.8367007e7 (by_volume) at mid stroke; K_p = 1e-4 requires 7.1288871e6, K_p =
    // 3e-5 requires 6.2324420e7.
    let size = size_for_gain(HOSE, &[], "1e-4");
    let uniform = candidate(&size, EATON, "uniform");
    near(number(uniform, "iterations.0.stiffness_n_per_m"), 7.1288871e6, 5e-8);
    near(number(uniform, "stiffness_n_per_m"), 3.3048496e6, 5e-8);
    assert_eq!(number(uniform, "length_m"), 0.0);
    assert_eq!(uniform["accepted"], false);
    assert!(run_command::reasons(uniform).contains("no hose is needed"), "{uniform}");
    assert!(number(candidate(&size, EATON, "by_volume"), "length_m") > 0.0);

    let size = size_for_gain(HOSE, &[], "3e-5");
    let by_volume = candidate(&size, EATON, "by_volume");
    near(number(by_volume, "stiffness_n_per_m"), 1.8367007e7, 5e-8);
    assert_eq!(number(by_volume, "length_m"), 0.0);
    assert!(run_command::reasons(by_volume).contains("no hose is needed"), "{by_volume}");
}

#[test]
fn bores_and_velocities() {
    let size = size(HOSE, &[]);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    within(number(&size, "bore_range_m.0"), 6.7237809e-3, 5e-11);
    within(number(&size, "bore_range_m.1"), 9.9513689e-3, 5e-11);
    let bores = size["bores"].as_array().unwrap();
    let verdict = |name: &str| {
        let row = bores.iter().find(|row| row["name"] == name).unwrap();
        (number(row, "oil_velocity_m_per_s"), row["verdict"].as_str().unwrap())
    };
    for (name, velocity, expected) in [
        ("dash 4", 5.0772085, "too_fast"),
        ("dash 5", 3.3321977, "recommended"),
        ("dash 6", 2.3042932, "recommended"),
        ("dash 8", 1.2893698, "slow"),
        (EATON, 1.2893698, "slow"),
        ("dash 10", 0.82260377, "slow"),
    ] {
        let (found, word) = verdict(name);
        near(found, velocity, 5e-8);
        assert_eq!(word, expected, "{name}");
    }
    let sizes: Vec<f64> = bores.iter().map(|row| number(row, "bore_m")).collect();
    assert!(sizes.is_sorted(), "{sizes:?}");
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    near(derived(&check(HOSE, &[]), "line.oil_velocity"), 1.2893698, 5e-8);
    near(number(&size, "candidates.0.surge_pressure_pa"), 600_139.65, 5e-8);
}

#[test]
fn table_6_1() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py: stiffness, real pole, mechanical pair
    for (stiffness, real, mechanical) in [
        ("1.5e7", -2.9580891, [-11.638369, 2938.2752]),
        ("1.5e6", -0.33590383, [-11.414782, 2757.3399]),
        ("1.5e5", -0.034051931, [-11.41224, 2738.589]),
    ] {
        let poles = section_6_2(stiffness)["poles"]["full"].clone();
        assert_eq!(poles.as_array().unwrap().len(), 5);
        let pairs = [[real, 0.0], mechanical, [-989.1, 479.04299]];
        for [re, im] in pairs.into_iter().chain(pairs.map(|[re, im]| [re, -im])) {
            let found = nearest(&poles, re, im);
            within(found[0], re, 5e-7 * re.abs());
            within(found[1], im, 5e-8 * im.abs());
        }
    }
}

#[test]
fn table_6_1_as_printed() {
    // ORIGIN: thesis Table 6.1. Its real pole of -2.963 requires K_c = 5.71e-13, its other two rows
    // 5.7e-13 as well.
    for (stiffness, real, mechanical) in [
        ("1.5e7", (-2.963, 0.001), ((-11.6, 0.1), 2.93e3)),
        ("1.5e6", (-0.336, 0.001), ((-11.4, 0.1), 2.75e3)),
        ("1.5e5", (-0.034, 0.001), ((-11.4, 0.1), 2.73e3)),
    ] {
        let settings = [
            SECTION_6_2[0],
            "linear.flow_pressure_coefficient=5.71e-13",
            SECTION_6_2[2],
            &format!("linear.hydraulic_stiffness={stiffness}"),
        ];
        let poles = linearize(HOSE, &settings)["poles"]["full"].clone();
        within(nearest(&poles, real.0, 0.0)[0], real.0, real.1);
        let ((damping, unit), frequency) = mechanical;
        let found = nearest(&poles, damping, frequency);
        within(found[0], damping, unit);
        within(found[1], frequency, 10.0);
        let valve = nearest(&poles, -989.0, 479.0);
        within(valve[0], -989.0, 1.0);
        within(valve[1], 479.0, 1.0);
    }
}

#[test]
fn poles_of_the_simpler_models() {
    let poles = section_6_2("1.5e7")["poles"].clone();
    // ORIGIN: analytic, K_eq = K_H K_S/(K_H + K_S), s = -K_c K_eq/A^2, s^2 + d_1 s + (K_H + K_S)/M
    let (stiffness, sensor, leak, mass, friction) = (1.5e7, 9.81e7, 5.7e-13, 13.1, 299.0);
    let area = std::f64::consts::FRAC_PI_4 * (0.05_f64.powi(2) - 0.022_f64.powi(2));
    let rate = leak * stiffness * sensor / (stiffness + sensor) / (area * area);
    assert_eq!(poles["first_order"].as_array().unwrap().len(), 1);
    near(number(&poles, "first_order.0.0"), -rate, 1e-12);
    let damping: f64 = friction / mass + leak * stiffness * stiffness / (area * area * (stiffness + sensor));
    let frequency = ((stiffness + sensor) / mass - damping * damping / 4.0).sqrt();
    let (valve, ratio): (f64, f64) = (1099.0, 0.9);
    let ring = valve * (1.0 - ratio * ratio).sqrt();
    assert_eq!(poles["decomposed"].as_array().unwrap().len(), 5);
    for (re, im) in [(-rate, 0.0), (-damping / 2.0, frequency), (-valve * ratio, ring)] {
        let found = nearest(&poles["decomposed"], re, im);
        near(found[0], re, 1e-9);
        within(found[1], im, 1e-9 * im);
    }
    assert_eq!(poles["two_pressure"].as_array().unwrap().len(), 6);
}

#[test]
fn errors_of_the_decomposition() {
    let errors = section_6_2("1.5e7")["decomposition_error"].clone();
    let low = |path: &str| number(&errors, &format!("{path}below_1000_rad_per_s.magnitude_db"));
    let low_phase = |path: &str| number(&errors, &format!("{path}below_1000_rad_per_s.phase_deg"));
    // ORIGIN: recomputed by comparisons/recompute_rig.py: below 1000 rad/s the largest is at 1000
    // rad/s
    assert!(low("as_printed.") <= 1.1778353e-5 && low("as_printed.") > 1.0e-5);
    assert!(low_phase("as_printed.") <= 3.3948699e-3 && low_phase("as_printed.") > 3.2e-3);
    assert!(low("") <= 1.022429e-5 && low_phase("") <= 2.9816028e-5);
    // ORIGIN: recomputed by comparisons/recompute_rig.py: around the resonance, 2938 rad/s
    within(number(&errors, "as_printed.magnitude_db"), 0.1704, 5e-4);
    within(number(&errors, "as_printed.phase_deg"), 0.566, 5e-3);
    within(number(&errors, "as_printed.magnitude_at_rad_per_s"), 2938.3, 2.0);
    within(number(&errors, "magnitude_db"), 5.7342732e-4, 3e-6);
    within(number(&errors, "phase_deg"), 7.5275999e-3, 4e-5);
}

#[test]
fn the_published_closed_loop_is_not_passive() {
    let passivity = linearize(HOSE, &[])["passivity"].clone();
    assert_eq!(passivity["open_loop"]["passive"], true);
    assert_eq!(passivity["open_loop"]["bands"].as_array().unwrap().len(), 0);
    assert_eq!(passivity["closed_loop"]["passive"], false);
    assert_eq!(passivity["closed_loop"]["bands"].as_array().unwrap().len(), 1);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    within(number(&passivity, "closed_loop.bands.0.0"), 446.62935, 5e-6);
    within(number(&passivity, "closed_loop.bands.0.1"), 921.59055, 5e-6);
}

#[test]
fn proposition_6_2() {
    for project in [HOSE, PIPE] {
        let linear = linearize(project, &[]);
        assert_eq!(number(&linear, "load_step_final_force_n.open_loop"), 0.0);
        assert_eq!(number(&linear, "load_step_final_force_n.closed_loop"), 0.0);
    }
}

/// Kind, coefficient and power of each asymptote.
fn asymptotes(impedance: &Value) -> Vec<(String, f64, i64)> {
    let rows = impedance["asymptotes"].as_array().unwrap();
    let row = |row: &Value| {
        (
            row["kind"].as_str().unwrap().to_string(),
            number(row, "coefficient"),
            row["power"].as_i64().unwrap(),
        )
    };
    rows.iter().map(row).collect()
}

#[test]
fn asymptotes_of_the_impedance() {
    let impedance = linearize(HOSE, &[])["impedance"].clone();
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    let plateau = ("compliance_plateau".to_string(), 2_014_388.5, -1);
    // ORIGIN: analytic, the stiffness of the cell
    let limit = ("sensor_limit".to_string(), 2e7, -1);
    let damper = ("low_frequency".to_string(), 3_905_142.7, 0);
    let mass = ("low_frequency".to_string(), 3665.2853, 1);
    for (view, first) in [("open_loop", damper), ("closed_loop", mass)] {
        let found = asymptotes(&impedance[view]);
        assert_eq!(found.len(), 3);
        for ((kind, coefficient, power), expected) in found.iter().zip([&first, &plateau, &limit]) {
            assert_eq!((kind, *power), (&expected.0, expected.2), "{view}");
            near(*coefficient, expected.1, 5e-8);
        }
    }
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    let end = number(&linearize(HOSE, &[]), "compliance_hidden_above_rad_per_s");
    within(end, 413.51223, 5e-6);
}
