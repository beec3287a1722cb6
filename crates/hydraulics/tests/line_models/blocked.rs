//! A line whose far end is blocked, compared with closed forms.

use num_complex::Complex64;
use phea_dynamics::portable::{cos, exp, ln, magnitude, pow, sin};
use phea_dynamics::simulation::{Input, InputSchedule, Profile, SimulationSettings, Status, simulate};
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid};
use phea_hydraulics::line::{
    BlockedLine, Conduit, DynamicLine, LaminarFriction, LineModel, Segments, StiffeningMember,
    TransmissionLine,
};
use phea_hydraulics::reference_rig::{components, hose_line, pipe_line};
use phea_hydraulics::stiffness::StiffnessModel;

const HOSE: Conduit = Conduit {
    length: 1.5,
    bore: 13.084e-3,
    density: 870.0,
    kinematic_viscosity: 46e-6,
    effective_bulk_modulus: 2.49e8,
};

/// A blocked line without friction has the impedance Z_c coth(sT).
#[test]
fn a_lossless_line_has_the_closed_form() {
    let conduit = Conduit { kinematic_viscosity: 1e-15, ..HOSE };
    // the end volumes change the response by their fraction of the compliance
    let line = TransmissionLine::of_conduit(&conduit, 1e-7).unwrap();
    let line = BlockedLine::of(DynamicLine::TransmissionLine(line));
    for angle in [0.01, 0.3, 1.0, 1.5, 2.0, 3.0, 4.5, 7.0] {
        let s = Complex64::new(0.0, angle / conduit.delay());
        let cotangent = Complex64::new(0.0, -cos(angle) / sin(angle));
        let exact = conduit.characteristic_impedance() * cotangent;
        let found = line.impedance(s);
        assert!(
            magnitude(found - exact) < 1e-5 * magnitude(exact).max(conduit.characteristic_impedance()),
            "{angle}"
        );
    }
}

/// The line with friction agrees with the exact line to the accuracy of each model: the entries of
/// the transfer matrix of waves are within 0.6 % of their root mean square, three times as much at
/// most, and sixteen segments have resonances 0.2 % low up to the quarter wave.
#[test]
fn a_line_with_friction_is_near_the_exact_one() {
    let waves = DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&HOSE, 1e-6).unwrap());
    let segments = Segments::new(&HOSE, 16, LaminarFriction::FrequencyDependent).unwrap();
    let lines = [(waves, 0.018), (DynamicLine::Segments(segments), 0.006)];
    for (line, tolerance) in lines {
        for angle in [0.05, 0.3, 0.8, 1.2] {
            let s = Complex64::new(0.0, angle / HOSE.delay());
            let factor = phea_hydraulics::line::friction_factor(s / HOSE.viscous_rate());
            let exact = HOSE.response(s, factor);
            let exact = (exact.in_phase + exact.in_opposition) / 2.0;
            let found = BlockedLine::of(line).impedance(s);
            let scale = magnitude(exact).min(HOSE.characteristic_impedance());
            assert!(magnitude(found - exact) < tolerance * scale, "{angle}: {found} {exact}");
        }
    }
}

/// Air in a lumped pipe: the volume pressed in between two pressures is the change of the logarithm
/// of the mixture's volume, plus that taken by the wall.
#[test]
fn a_pipe_with_air_has_the_compliance_of_its_mixture() {
    let clean = components(pipe_line(), StiffnessModel::ByVolume).fluid;
    let air = EntrainedAir { volume_fraction: 0.01, polytropic_exponent: 1.4 };
    let fluid = Fluid { entrained_air: Some(air), ..clean };
    let of = |fluid: &Fluid| {
        BlockedLine::new(&pipe_line(), fluid, 35e5, StiffeningMember::Nominal, &LineModel::Lumped).unwrap()
    };
    let [low, high] = [2e5, 60e5];
    let mixture = |pressure: f64| {
        let ratio = (pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE) / ATMOSPHERIC_PRESSURE_ABSOLUTE;
        0.99 * exp(-pressure / fluid.bulk_modulus) + 0.01 * pow(ratio, -1.0 / 1.4)
    };
    let volume = pipe_line().filled().volume();
    let wall = of(&clean).static_compliance(35e5) - volume / clean.bulk_modulus;
    let expected = volume * ln(mixture(low) / mixture(high)) + wall * (high - low);
    // in time: a steady flow for ten seconds brings it from one pressure to the other
    let line = of(&fluid);
    let schedule = InputSchedule {
        duration_s: 10.0,
        output_step_s: 1.0,
        inputs: vec![Input::Value(Profile::constant(expected / 10.0))],
    };
    let (state, waves) = line.rest(low);
    let settings = SimulationSettings { tolerance: 1e-9, ..SimulationSettings::default() };
    let found = simulate(&line, &[state, waves].concat(), &schedule, None, &settings, &mut |_| true).unwrap();
    assert_eq!(found.outcome.status, Status::Completed);
    let last = line.open_end(found.trajectory.states.last().unwrap());
    assert!((last / high - 1.0).abs() < 1e-6, "{last}");
}

/// Time and frequency models agree: a slow sine of flow moves the pressure by the impedance.
#[test]
fn time_and_frequency_agree() {
    let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
    let model = LineModel::Creeping { relaxation_time: 0.02 };
    let line = BlockedLine::new(&hose_line(), &fluid, 35e5, StiffeningMember::Nominal, &model).unwrap();
    let frequency = 30.0;
    let impedance = line.impedance(Complex64::new(0.0, frequency));
    let period = 2.0 * std::f64::consts::PI / frequency;
    let schedule = InputSchedule {
        duration_s: 20.0 * period,
        output_step_s: period / 64.0,
        inputs: vec![Input::Value(Profile::sine(0.0, 1e-6, frequency).unwrap())],
    };
    let (state, waves) = line.rest(35e5);
    let settings = SimulationSettings { tolerance: 1e-9, ..SimulationSettings::default() };
    let found = simulate(&line, &[state, waves].concat(), &schedule, None, &settings, &mut |_| true).unwrap();
    let pressures: Vec<f64> = found.trajectory.states.iter().map(|state| line.open_end(state)).collect();
    // the last whole period: the fundamental of sin is (a sin + b cos) with 2/N sums
    let rows = pressures.len() - 65..pressures.len() - 1;
    let sums = rows.fold(Complex64::new(0.0, 0.0), |sum, row| {
        let angle = frequency * found.trajectory.times_s[row];
        sum + pressures[row] * Complex64::new(sin(angle), cos(angle)) / 32.0
    });
    assert!(magnitude(sums / 1e-6 / impedance - 1.0) < 1e-5, "{sums} {impedance}");
}
