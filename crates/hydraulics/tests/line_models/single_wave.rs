//! Lumped lines, segments, creep and the transmission line compared with the exact line.

use num_complex::Complex64;
use phea_dynamics::scalar::{Lanes, Parameters};
use phea_hydraulics::line::{
    Conduit, DynamicLine, END_SHARE, LaminarFriction, Line, LineError, LineModel, LineResponse, LineWall,
    Segments, StandardLinearSolid, StiffeningMember, TransmissionLine, friction_factor,
};
use phea_hydraulics::reference_rig::{hose, hose_line, pipe_line};

use super::oracle::{at, conduit, errors, fluid, impedances, size, transfer_matrix};

fn exact(conduit: Conduit) -> impl Fn(Complex64) -> LineResponse {
    move |s| conduit.response(s, friction_factor(s / conduit.viscous_rate()))
}

fn transmission_line(conduit: &Conduit, end_share: f64) -> DynamicLine {
    DynamicLine::TransmissionLine(TransmissionLine::of_conduit(conduit, end_share).unwrap())
}

fn segments(conduit: &Conduit, count: usize, friction: LaminarFriction) -> DynamicLine {
    DynamicLine::Segments(Segments::new(conduit, count, friction).unwrap())
}

/// Frequencies up to w T = `highest` for a delay T.
fn frequencies(delay: f64, highest: f64) -> impl Iterator<Item = f64> {
    (1..=200).map(move |index| highest / delay * f64::from(index) / 200.0)
}

/// Speed, delay, impedance and the exact transfer matrix of the thesis' hose.
#[test]
fn the_exact_line_is_that_of_bessel_functions() {
    let hose = conduit();
    // ORIGIN: recomputed by comparisons/recompute_lines.py
    for (found, expected) in [
        (hose.effective_bulk_modulus, 2.490178e8),
        (hose.bore, 0.013083889),
        (hose.speed(), 535.002),
        (hose.delay(), 0.00280373),
        (hose.characteristic_impedance(), 3.46187e9),
        (hose.dissipation_number(), 0.00301356),
    ] {
        assert!((found / expected - 1.0).abs() < 2e-6, "{found} against {expected}");
    }
    for (frequency, factor, t11, t12) in [
        (10.0, (1.3154022, -0.91842407), (0.99948301, 0.00036091904), (8.9112874e7, 1.276636e8)),
        (300.0, (1.0840319, -0.095965968), (0.64024664, 0.029770792), (2.1200179e8, 2.7710623e9)),
        (3000.0, (1.0267502, -0.027861466), (-0.62493726, 0.090851533), (-2.1481745e8, 2.7721923e9)),
    ] {
        let s = at(frequency);
        let found = friction_factor(s / hose.viscous_rate());
        let [[a, b], [c, d]] = hose.response(s, found).transfer_matrix();
        for (found, (re, im)) in [(found, factor), (a, t11), (b, t12)] {
            let expected = Complex64::new(re, im);
            assert!(size(found - expected) < 1e-7 * size(expected), "{found} against {expected}");
        }
        assert!(size(a * d - b * c - 1.0) < 1e-9);
    }
}

/// Ten half waves, and the dissipation numbers of a hose, a short pipe and a long thin one.
#[test]
fn the_transmission_line_follows_the_exact_line() {
    let hose = conduit();
    for (viscosity, [t11, t12, t21]) in
        [(15e-6, [2.5e-3, 4e-3, 2e-3]), (46e-6, [4e-3, 6.5e-3, 3.5e-3]), (150e-6, [9e-3, 14e-3, 8e-3])]
    {
        let conduit = Conduit { kinematic_viscosity: viscosity, ..hose };
        let line = transmission_line(&conduit, 1e-6);
        let found = errors(&line, exact(conduit), frequencies(conduit.delay(), 30.0));
        assert!(found[0] < t11 && found[1] < t12 && found[2] < t21, "{viscosity}: {found:?}");
    }
    // the end volumes have little effect up to the first resonances
    let found = errors(&transmission_line(&hose, END_SHARE), exact(hose), frequencies(hose.delay(), 3.0));
    assert!(found.iter().all(|error| *error < 0.035), "{found:?}");
}

/// A line is symmetric between its ends, and its transfer matrix has determinant 1: reciprocity.
#[test]
fn every_model_is_symmetric_and_reciprocal() {
    let hose = conduit();
    let wall = StandardLinearSolid::of_hose(
        &phea_hydraulics::reference_rig::hose(),
        StiffeningMember::Nominal,
        0.05,
    );
    let creeping = Segments::new(&hose, 3, LaminarFriction::FrequencyDependent).unwrap();
    for line in [
        transmission_line(&hose, END_SHARE),
        segments(&hose, 5, LaminarFriction::Steady),
        DynamicLine::Segments(creeping.with_creep(&hose, &wall).unwrap()),
    ] {
        for frequency in [3.0, 100.0, 900.0, 4000.0] {
            let [[a, b], [c, d]] = transfer_matrix(&line, at(frequency));
            assert!(size(a - d) < 1e-9 * (1.0 + size(a)), "{a} and {d} at {frequency} rad/s");
            assert!(size(a * d - b * c - 1.0) < 1e-9 * (1.0 + size(a * d)));
        }
    }
}

/// Compliance at rest is that of the lumped line in every model, and a steady flow obeys Hagen and
/// Poiseuille.
#[test]
fn every_model_has_the_compliance_and_the_resistance_of_the_lumped_line() {
    let hose = conduit();
    let lumped = hose_line().compliance(1.45e9, StiffeningMember::Nominal);
    for line in [
        DynamicLine::Segments(Segments::lumped(lumped)),
        segments(&hose, 1, LaminarFriction::Steady),
        segments(&hose, 7, LaminarFriction::FrequencyDependent),
        transmission_line(&hose, END_SHARE),
        transmission_line(&hose, 0.2),
    ] {
        let s = at(0.1);
        let [[_, resistance], [capacity, _]] = transfer_matrix(&line, s);
        assert!(size(capacity / (s * lumped) - 1.0) < 1e-5, "{line:?}");
        if line.states() > 0 {
            assert!((resistance.re / hose.steady_resistance() - 1.0).abs() < 1e-3, "{line:?}");
        }
    }
}

/// Volume of a hose at rest: for any dynamic model, it is the one stated by its sheet at the
/// operating pressure: creeping walls with the modulus at rest, all others with the dynamic one.
#[test]
fn every_model_of_a_hose_agrees_with_its_data_sheet() {
    // ORIGIN: analytic, dV/dp = epsilon L/r_beta + (A_ho + E(35 bar)) L/beta_0
    let oil = (std::f64::consts::FRAC_PI_4 * 12.7e-3 * 12.7e-3 + 7.774e-6) * 1.5 / 1.45e9;
    let (end_share, friction) = (END_SHARE, LaminarFriction::FrequencyDependent);
    let segments = |relaxation_time| LineModel::Segments { count: 8, friction, relaxation_time };
    for (r_beta, model) in [
        (5.0, LineModel::Lumped),
        (5.0, segments(None)),
        (5.0, LineModel::TransmissionLine { end_share }),
        (5.0, LineModel::TwoWave { end_share, wall: LineWall::default() }),
        (1.0, LineModel::Creeping { relaxation_time: 0.02 }),
        (1.0, segments(Some(0.02))),
    ] {
        let line = DynamicLine::new(&hose_line(), &fluid(), 35e5, StiffeningMember::Nominal, &model).unwrap();
        let s = at(0.01);
        let capacity = transfer_matrix(&line, s)[1][0] / s;
        let expected = 2.236e-12 * 1.5 / r_beta + oil;
        assert!(size(capacity / expected - 1.0) < 1e-3, "{model:?}: {capacity} against {expected}");
        assert!((capacity.re / expected - 1.0).abs() < 1e-6, "{model:?}: {capacity} against {expected}");
    }
}

/// A wall that creeps has r_beta times its dynamic compliance at rest and dissipates in between.
#[test]
fn a_creeping_wall_is_soft_at_rest_and_stiff_when_fast() {
    let (hose, conduit) = (hose().filled(), conduit());
    let wall = StandardLinearSolid::of_hose(&hose, StiffeningMember::Nominal, 0.02);
    let volume = hose_line().filled().volume();
    let (soft, stiff) = (
        volume * (1.0 / 1.45e9 + 1.0 / hose.static_modulus()),
        hose_line().compliance(1.45e9, StiffeningMember::Nominal),
    );
    for count in [0, 4] {
        let line = Segments::new(&conduit, count, LaminarFriction::Steady).unwrap();
        let line = DynamicLine::Segments(line.with_creep(&conduit, &wall).unwrap());
        let compliance = |frequency: f64| transfer_matrix(&line, at(frequency))[1][0] / at(frequency);
        assert!(size(compliance(1e-4) / soft - 1.0) < 1e-4);
        if count == 0 {
            assert!(size(compliance(1e6) / stiff - 1.0) < 1e-4);
            for frequency in [1.0, 10.0, 100.0] {
                let expected = volume * (1.0 / 1.45e9 + wall.compliance(at(frequency)));
                assert!(size(compliance(frequency) / expected - 1.0) < 1e-12);
                assert!(expected.im < 0.0, "a wall that creeps takes energy");
            }
        }
    }
}

/// Pi segments err by the square of their length. With the lags of friction they tend to the exact
/// line up to what the lags leave (0.5 % of the friction factor).
#[test]
fn segments_converge_to_the_exact_line() {
    let hose = conduit();
    let lossless = move |s| hose.response(s, 1.0 + 8.0 * hose.viscous_rate() / s);
    let of = |count| {
        errors(&segments(&hose, count, LaminarFriction::Steady), lossless, frequencies(hose.delay(), 3.0))
    };
    let (coarse, fine) = (of(8), of(16));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse} to {fine}");
    }
    let many = segments(&hose, 24, LaminarFriction::FrequencyDependent);
    let found = errors(&many, exact(hose), frequencies(hose.delay(), 3.0).step_by(10));
    assert!(found.iter().all(|error| *error < 5e-3), "{found:?}");
}

/// Impedances in phase and in opposition have no negative real part: no connected system gains
/// energy.
#[test]
fn the_transmission_line_is_passive_at_every_frequency() {
    let hose = conduit();
    for viscosity in [1e-8, 1e-6, 1e-5, 46e-6, 2e-4, 6e-4, 1.4e-3] {
        let line = transmission_line(&Conduit { kinematic_viscosity: viscosity, ..hose }, 1e-6);
        let mut frequency = 0.03;
        while frequency < 3e5 {
            let LineResponse { in_phase, in_opposition } = impedances(&line, at(frequency));
            // limit of rounding; comparisons/recompute_lines.py compares the impedances themselves
            // with zero
            let least = -2e-9 * (size(in_phase) + size(in_opposition));
            assert!(
                in_phase.re > least && in_opposition.re > least,
                "{viscosity} at {frequency} rad/s: {in_phase}, {in_opposition}"
            );
            frequency *= 1.013;
        }
    }
}

#[test]
fn a_line_without_waves_is_refused() {
    let of = |line: &Line| Conduit::of_line(line, &fluid(), 35e5, StiffeningMember::Nominal);
    assert_eq!(of(&Line::Hose { hose: hose(), length: 0.0 }), Err(LineError::NoLength));
    let volume = Line::Volume { volume: 1e-4, effective_bulk_modulus: 1e9 };
    assert_eq!(of(&volume), Err(LineError::NoBore));
    assert!(matches!(of(&Line::Hose { hose: hose(), length: -1.0 }), Err(LineError::Impossible { .. })));
    let thin = Conduit { bore: 1e-3, ..conduit() };
    let refused = TransmissionLine::of_conduit(&thin, END_SHARE);
    assert!(matches!(refused, Err(LineError::Overdamped { dissipation, .. }) if dissipation > 0.1));
    for end_fraction in [0.0, 0.5, f64::NAN] {
        assert!(matches!(
            TransmissionLine::of_conduit(&conduit(), end_fraction),
            Err(LineError::Impossible { .. })
        ));
    }
    let no_line = Segments::lumped(0.0);
    assert_eq!((no_line.states(), no_line.chamber_compliance()), (0, 0.0));
    assert_eq!(no_line.rates(1e-4, 35e5, &[], &mut []), 1e-4);
}

/// Lanes give the bits of the plain number.
#[test]
fn lanes_and_the_plain_number_agree_to_the_bit() {
    let pipe = Conduit::of_line(&pipe_line(), &fluid(), 35e5, StiffeningMember::Nominal).unwrap();
    for line in [transmission_line(&pipe, END_SHARE), segments(&pipe, 3, LaminarFriction::FrequencyDependent)]
    {
        let wide: DynamicLine<Lanes> = line.convert(&mut |value: f64| Lanes::from(value));
        let state: Vec<f64> = (0..line.states()).map(|index| 1e5 + 37.0 * index as f64).collect();
        let arriving: Vec<f64> = line.delays().iter().map(|delay| 1e9 * delay).collect();
        let widened =
            |values: &[f64]| values.iter().map(|value| Lanes([*value, 0.0, 0.0, 0.0])).collect::<Vec<_>>();
        let (mut rates, mut wide_rates) = (vec![0.0; line.states()], vec![Lanes::from(0.0); line.states()]);
        let flow = line.rates(1e-4, 3e5, &state, &arriving, &mut rates);
        let pressure = Lanes([3e5, 0.0, 0.0, 0.0]);
        let wide_flow = wide.rates(
            Lanes([1e-4, 0.0, 0.0, 0.0]),
            pressure,
            &widened(&state),
            &widened(&arriving),
            &mut wide_rates,
        );
        assert_eq!(flow, wide_flow.0[0]);
        assert!(rates.iter().zip(&wide_rates).all(|(rate, wide)| *rate == wide.0[0]));
    }
}
