//! The hose with two waves compared with the exponential of its four equations, and its limits.

use nalgebra::{Complex, DMatrix};
use num_complex::Complex64;
use phea_hydraulics::line::{
    BraidedWall, DynamicLine, END_SHARE, LineError, LineResponse, StiffeningMember, TransmissionLine,
    TwoWaveHose, friction_factor,
};
use phea_hydraulics::reference_rig::{hose, hose_line};

use super::oracle::{at, errors, exponential, fluid, impedance_errors, impedances, size, transfer_matrix};

/// A hose of round numbers.
fn round_hose() -> TwoWaveHose {
    TwoWaveHose {
        length: 1.5,
        bore: 12.7e-3,
        density: 870.0,
        kinematic_viscosity: 46e-6,
        fluid_modulus: 1.45e9,
        wall: BraidedWall {
            mass_per_length: 0.2,
            pressure_compliance: 3e-9,
            coupling_compliance: -6e-6,
            axial_compliance: 2e-5,
        },
    }
}

fn assumed_hose() -> TwoWaveHose {
    TwoWaveHose::assumed(&hose(), 1.5, &fluid(), 35e5, StiffeningMember::Nominal)
}

fn in_time(hose: &TwoWaveHose, end_share: f64) -> DynamicLine {
    DynamicLine::TwoWave(hose.in_time(end_share).unwrap())
}

fn friction_of(hose: &TwoWaveHose, s: Complex64) -> Complex64 {
    friction_factor(s / hose.fixed_end_conduit().viscous_rate())
}

/// The transfer matrix of the four equations, by the exponential of their matrix, wall held at both
/// ends.
fn by_exponential(hose: &TwoWaveHose, s: Complex64, factor: Complex64) -> [[Complex64; 2]; 2] {
    let area = hose.fixed_end_conduit().area();
    let wall = hose.wall;
    let drag = hose.density * (factor - 1.0);
    let radial = 1.0 / hose.fluid_modulus + wall.pressure_compliance;
    let zero = Complex::new(0.0, 0.0);
    // d/dx of pressure, tension over area, fluid and wall velocity, the first two in units of 1e6
    // Pa
    let unit = 1e6;
    let rows = [
        [zero, zero, -s * (hose.density + drag) / unit, s * drag / unit],
        [zero, zero, -s * drag / unit, s * (wall.mass_per_length / area + drag) / unit],
        [-s * radial * unit, -s * wall.coupling_compliance * area * unit, zero, zero],
        [s * area * wall.coupling_compliance * unit, s * wall.axial_compliance * area * unit, zero, zero],
    ];
    let t = exponential(&DMatrix::from_fn(4, 4, |row, column| rows[row][column] * hose.length));
    // u = 0 at x = 0 and at the end: the tension at x = 0 follows
    let tension = |column: usize| -t[(3, column)] / t[(3, 1)];
    let end = |row: usize, column: usize| t[(row, column)] + t[(row, 1)] * tension(column);
    let (a, b) = (end(0, 0), end(0, 2) * unit / area);
    let (c, d) = (end(2, 0) * area / unit, end(2, 2));
    // (p, q) at the end from those at the start; inverted, with the determinant 1
    [[d, -b], [-c, a]]
}

#[test]
fn the_modes_are_those_of_the_four_equations() {
    let [slow, fast] = round_hose().waves();
    // ORIGIN: recomputed by comparisons/recompute_lines.py
    for (found, expected) in [
        (slow.speed, 467.298),
        (fast.speed, 616.56051),
        (slow.modal_ratio, 1.1411981),
        (fast.modal_ratio, -0.48286478),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} against {expected}");
    }
    let hose = round_hose();
    let area = hose.fixed_end_conduit().area();
    // both lines in series have the compliance between fixed ends and the inertance of the fluid
    let elastance: f64 = [slow, fast].iter().map(|wave| wave.impedance * wave.speed / hose.length).sum();
    let inertance: f64 = [slow, fast].iter().map(|wave| wave.impedance / wave.speed * hose.length).sum();
    assert!((elastance * hose.fixed_end_conduit().compliance() - 1.0).abs() < 1e-12);
    assert!((inertance / (hose.density * hose.length / area) - 1.0).abs() < 1e-12);
    // friction acts between fluid and wall; both waves together have all of it
    let together = slow.friction_fraction + fast.friction_fraction;
    let both = 1.0 + hose.density * area / hose.wall.mass_per_length;
    assert!((together / both - 1.0).abs() < 1e-12);
}

#[test]
fn the_exact_hose_is_the_exponential_of_its_four_equations() {
    for hose in [round_hose(), assumed_hose()] {
        for frequency in [3.0, 100.0, 700.0, 2500.0] {
            let s = at(frequency);
            for factor in [Complex64::new(1.0, 0.0), friction_of(&hose, s)] {
                let expected = by_exponential(&hose, s, factor);
                let found = hose.response(s, factor).transfer_matrix();
                for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                    assert!(size(found - expected) < 1e-8 * size(*expected), "{found} {expected}");
                }
            }
        }
    }
    // ORIGIN: recomputed by comparisons/recompute_lines.py
    let s = at(1000.0);
    let [[t11, _], [t21, _]] = round_hose().response(s, friction_of(&round_hose(), s)).transfer_matrix();
    assert!(size(t11 - Complex64::new(-1.1156791, 0.0094511118)) < 1e-6);
    assert!(size(t21 + Complex64::new(2.3202171e-11, 1.1694415e-10)) < 1e-16);
}

/// The model in time without friction equals the exponential, including delays; with friction it is
/// as accurate as with one wave.
#[test]
fn the_model_in_time_follows_the_exact_hose() {
    for hose in [round_hose(), assumed_hose()] {
        let frequencies = || (1..=150).map(|index| 40.0 * f64::from(index));
        let smooth = TwoWaveHose { kinematic_viscosity: 1e-30, ..hose };
        let found =
            errors(&in_time(&smooth, 1e-9), |s| smooth.response(s, Complex64::new(1.0, 0.0)), frequencies());
        assert!(found.iter().all(|error| *error < 1e-5), "{found:?}");
    }
    let to = |highest: f64| (1..=400).map(move |index| highest * f64::from(index) / 400.0);
    let errors_of = |hose: TwoWaveHose, highest: f64| {
        let exact = |s| hose.response(s, friction_of(&hose, s));
        impedance_errors(&in_time(&hose, 1e-6), exact, to(highest))
    };
    // first half wave of the slower wave of the assumed hose at 714 rad/s, the highest frequency
    // its ninth
    for (highest, [in_phase, in_opposition]) in [(500.0, [5e-4, 0.05]), (6000.0, [0.06, 0.07])] {
        let found = errors_of(assumed_hose(), highest);
        assert!(found[0] < in_phase && found[1] < in_opposition, "{highest}: {found:?}");
    }
    // the slower wave of the round hose moves its wall along (N = 1.14): sharp peaks, with good
    // agreement between them
    let found = errors_of(round_hose(), 500.0);
    assert!(found[0] < 5e-4 && found[1] < 0.04, "{found:?}");
}

/// An uncoupled hose has a wave of the fluid, which is the only one visible at the ends, and a wave
/// of the wall.
#[test]
fn without_coupling_one_wave_is_left() {
    let mut hose = round_hose();
    hose.wall.coupling_compliance = 0.0;
    let conduit = hose.fixed_end_conduit();
    let [wall, fluid] = hose.waves();
    assert!((wall.speed * (0.2_f64 * 2e-5).sqrt() - 1.0).abs() < 1e-12 && wall.modal_ratio.is_infinite());
    assert!((fluid.speed / conduit.speed() - 1.0).abs() < 1e-12 && fluid.modal_ratio == 0.0);
    assert_eq!((wall.impedance, fluid.friction_fraction), (0.0, 1.0));
    let one = DynamicLine::TransmissionLine(TransmissionLine::of_conduit(&conduit, END_SHARE).unwrap());
    let two = in_time(&hose, END_SHARE);
    for frequency in [1.0, 50.0, 700.0, 3000.0] {
        let (one, two) = (transfer_matrix(&one, at(frequency)), transfer_matrix(&two, at(frequency)));
        for (one, two) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!(size(one - two) < 1e-9 * size(*one), "{one} {two}");
        }
    }
    // weak coupling changes little
    hose.wall.coupling_compliance = -1e-8;
    let [_, near] = hose.waves();
    assert!((near.speed / fluid.speed - 1.0).abs() < 1e-5 && near.modal_ratio.abs() < 1e-2);
}

/// The hose between fixed ends is at low frequency the lumped line `by_volume`, since its braid is
/// at the neutral angle.
#[test]
fn the_assumed_hose_has_its_catalogue_compliance_at_rest() {
    let lumped = hose_line().compliance(1.45e9, StiffeningMember::Nominal);
    let hose = assumed_hose();
    assert!((hose.fixed_end_conduit().compliance() / lumped - 1.0).abs() < 1e-12);
    let s = at(0.1);
    let [[_, resistance], [capacity, _]] = transfer_matrix(&in_time(&hose, END_SHARE), s);
    assert!(size(capacity / (s * lumped) - 1.0) < 1e-5);
    assert!((resistance.re / hose.fixed_end_conduit().steady_resistance() - 1.0).abs() < 1e-3);
}

#[test]
fn the_hose_is_passive_at_every_frequency() {
    let mut light = round_hose();
    light.wall.mass_per_length = 0.05;
    let mut heavy = round_hose();
    heavy.wall.mass_per_length = 1.0;
    heavy.kinematic_viscosity = 4e-4;
    for hose in [round_hose(), assumed_hose(), light, heavy] {
        let line = in_time(&hose, 1e-6);
        let passive = |response: LineResponse, least: f64| {
            response.in_phase.re > least * size(response.in_phase)
                && response.in_opposition.re > least * size(response.in_opposition)
        };
        let mut frequency = 0.03;
        while frequency < 1e5 {
            let s = at(frequency);
            let found = impedances(&line, s);
            assert!(passive(found, -1e-7), "{hose:?} at {frequency} rad/s: {found:?}");
            assert!(passive(hose.response(s, friction_of(&hose, s)), 0.0));
            frequency *= 1.013;
        }
    }
}

/// Random walls, fluids and lengths over decades.
#[test]
fn random_hoses_are_passive() {
    let mut seed = 20_260_101;
    let mut between = |low: f64, high: f64| {
        let ratio = phea_dynamics::portable::ln(high / low);
        low * phea_dynamics::portable::exp(ratio * (0.5 + 0.5 * super::time::next(&mut seed)))
    };
    let mut calculated = 0;
    for _ in 0..60 {
        let (bore, axial_compliance) = (between(4e-3, 3e-2), between(1e-6, 1e-4));
        let area = std::f64::consts::FRAC_PI_4 * bore * bore;
        // a positive energy: C_pp C_FF > A C_pF^2
        let free = between(1e-10, 2e-8);
        let coupling = -axial_compliance * between(0.03, 3.0);
        let hose = TwoWaveHose {
            length: between(0.1, 10.0),
            bore,
            density: 870.0,
            kinematic_viscosity: between(5e-6, 5e-4),
            fluid_modulus: between(3e8, 1.6e9),
            wall: BraidedWall {
                mass_per_length: between(0.03, 2.0),
                pressure_compliance: free + area * coupling * coupling / axial_compliance,
                coupling_compliance: coupling,
                axial_compliance,
            },
        };
        let line = match hose.in_time(1e-4) {
            Ok(line) => DynamicLine::TwoWave(line),
            Err(LineError::Overdamped { .. } | LineError::MixedByFriction { .. }) => continue,
            Err(error) => panic!("{error} for {hose:?}"),
        };
        calculated += 1;
        let mut part = 3e-4;
        while part < 300.0 {
            let found = impedances(&line, at(part / line.delays()[0]));
            for impedance in [found.in_phase, found.in_opposition] {
                assert!(impedance.re > -1e-8 * size(impedance), "{hose:?} at wT = {part}: {impedance}");
            }
            part *= 1.06;
        }
    }
    assert!(calculated > 30, "{calculated}");
}

#[test]
fn walls_that_would_give_energy_are_refused() {
    let mut hose = round_hose();
    hose.wall.coupling_compliance = -2.5e-5;
    let Err(LineError::Impossible { problems }) = hose.in_time(END_SHARE) else { panic!("accepted") };
    assert_eq!(problems[0].quantity, "fixed_end_modulus");
    // a wall much lighter than its fluid, dragged along by it
    let light = TwoWaveHose {
        bore: 30e-3,
        wall: BraidedWall {
            mass_per_length: 0.04,
            pressure_compliance: 2.7e-8,
            coupling_compliance: -3e-5,
            axial_compliance: 2.5e-5,
        },
        ..round_hose()
    };
    let refused = light.in_time(END_SHARE);
    assert!(
        matches!(refused, Err(LineError::MixedByFriction { needed, half_resistance }) if needed > half_resistance),
        "{refused:?}"
    );
    assert_eq!(TwoWaveHose { length: 0.0, ..round_hose() }.in_time(END_SHARE), Err(LineError::NoLength));
}
