//! Transfer functions and state space: one system in two forms, connected in two ways, badly
//! scaled.
#![cfg(test)]

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{cos, magnitude, pow, sin};

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

/// Seeded numbers in [0, 1): splitmix64.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64).floor() as usize
    }

    /// `count` roots with magnitudes from 0.01 up over this number of decades, a fifth of them in
    /// the right half plane.
    fn roots(&mut self, count: usize, decades: f64) -> Vec<Complex64> {
        let mut roots = Vec::new();
        while roots.len() < count {
            let size = pow(10.0, -2.0 + decades * self.next());
            let side = if self.next() < 0.8 { -1.0 } else { 1.0 };
            if self.next() < 0.5 || roots.len() + 2 > count {
                roots.push(c(side * size, 0.0));
            } else {
                let angle = 1.5 * self.next();
                let root = c(side * size * cos(angle), size * sin(angle));
                roots.extend([root, root.conj()]);
            }
        }
        roots
    }

    fn system(&mut self, order: usize, zeros: usize) -> TransferFunction {
        self.system_over(order, zeros, 6.0)
    }

    fn system_over(&mut self, order: usize, zeros: usize, decades: f64) -> TransferFunction {
        let (zeros, poles) = (self.roots(zeros, decades), self.roots(order, decades));
        let mut gain = 1.0 + self.next();
        for (index, pole) in poles.iter().enumerate() {
            gain *= magnitude(*pole) / zeros.get(index).map_or(1.0, |zero| magnitude(*zero));
        }
        TransferFunction::from_factors(gain, zeros, poles).unwrap()
    }
}

fn relative(a: Complex64, b: Complex64) -> f64 {
    magnitude(a - b) / magnitude(b)
}

fn largest(system: &TransferFunction) -> f64 {
    FREQUENCIES.iter().map(|&w| magnitude(system.at_frequency(w))).fold(0.0, f64::max)
}

const FREQUENCIES: [f64; 9] = [1e-4, 1e-2, 0.3, 1.0, 7.0, 55.0, 1e3, 1e4, 1e6];

#[test]
fn a_transfer_function_and_its_cascade_are_one_system() {
    let mut seeded = Seeded(11);
    for _ in 0..200 {
        let order = 1 + seeded.below(8);
        let zeros = seeded.below(order + 1);
        let system = seeded.system(order, zeros);
        let states = StateSpace::from_transfer_function(&system).unwrap();
        for w in FREQUENCIES {
            let truth = system.at_frequency(w);
            let error = relative(states.at_frequency(w, 0, 0).unwrap(), truth);
            // sums of states are exact to the rounding of the largest response, not of the smallest
            let scale = largest(&system) / magnitude(truth);
            assert!(error < 1e-14 * scale, "{error:e} at {w} of {system:?}");
        }
        let back = states.to_transfer_function(0, 0).unwrap();
        assert_eq!(back.zeros().len(), system.zeros().len());
        for w in FREQUENCIES {
            let truth = system.at_frequency(w);
            let error = relative(back.at_frequency(w), truth);
            let scale = largest(&system) / magnitude(truth);
            assert!(error < 1e-9 * scale, "{error:e} at {w} of {system:?}");
        }
        for (found, pole) in back.poles().iter().zip(system.poles()) {
            assert!(relative(*found, *pole) < 1e-13, "{found} {pole}");
        }
    }
}

#[test]
fn joining_factors_joins_responses() {
    let mut seeded = Seeded(12);
    let one = c(1.0, 0.0);
    for _ in 0..200 {
        let (order, other_order) = (1 + seeded.below(5), 1 + seeded.below(4));
        let (zeros, other_zeros) = (seeded.below(order), seeded.below(other_order));
        let (p, h) = (seeded.system(order, zeros), seeded.system(other_order, other_zeros));
        let (series, parallel, closed) =
            (p.series(&h).unwrap(), p.parallel(&h).unwrap(), p.feedback(&h).unwrap());
        assert_eq!(closed.poles().len(), order + other_order);
        for w in FREQUENCIES {
            let (a, b) = (p.at_frequency(w), h.at_frequency(w));
            assert!(relative(series.at_frequency(w), a * b) < 1e-13);
            // cancellation in the sum itself is not an error of the factors
            let lost = (magnitude(a) + magnitude(b)) / magnitude(a + b);
            assert!(relative(parallel.at_frequency(w), a + b) < 1e-12 * lost);
            let lost = (1.0 + magnitude(a * b)) / magnitude(one + a * b);
            assert!(relative(closed.at_frequency(w), a / (one + a * b)) < 1e-12 * lost);
        }
    }
}

#[test]
fn joining_states_joins_responses() {
    let mut seeded = Seeded(13);
    let one = c(1.0, 0.0);
    for _ in 0..100 {
        let (order, other_order) = (1 + seeded.below(4), 1 + seeded.below(4));
        let (p, h) =
            (seeded.system_over(order, order, 2.0), seeded.system_over(other_order, other_order, 2.0));
        let states = |system| StateSpace::from_transfer_function(system).unwrap();
        let (sp, sh) = (states(&p), states(&h));
        let joined = [sp.series(&sh), sp.parallel(&sh), sp.feedback(&sh)].map(|system| system.unwrap());
        for w in FREQUENCIES {
            let (a, b) = (p.at_frequency(w), h.at_frequency(w));
            let truths = [a * b, a + b, a / (one + a * b)];
            let lost = (1.0 + magnitude(a * b)) / magnitude(one + a * b) + 1.0 / magnitude(a + b);
            for (system, truth) in joined.iter().zip(truths) {
                let error = relative(system.at_frequency(w, 0, 0).unwrap(), truth);
                assert!(error < 1e-10 * (1.0 + lost), "{error:e} at {w}, lost {lost:e}");
            }
        }
    }
}

#[test]
fn a_common_pole_appears_once_in_a_sum() {
    let integrator = |gain: f64| TransferFunction::from_factors(gain, vec![], vec![c(0.0, 0.0)]).unwrap();
    let pi = TransferFunction::gain_only(3.0).parallel(&integrator(6.0)).unwrap();
    assert_eq!((pi.gain(), pi.zeros(), pi.poles()), (3.0, &[c(-2.0, 0.0)][..], &[c(0.0, 0.0)][..]));
    let sum = integrator(1.0).parallel(&integrator(2.0)).unwrap();
    assert_eq!((sum.gain(), sum.poles().len()), (3.0, 1));
    let nothing = integrator(1.0).parallel(&integrator(-1.0)).unwrap();
    assert_eq!(nothing.gain(), 0.0);
    assert_eq!(nothing.dc_gain(), 0.0);
}

#[test]
fn closing_a_loop_moves_a_slow_pole_next_to_a_fast_one() {
    // ORIGIN: analytic. (s + 1e-3)(s + 1e6) + 1e3 = s^2 + (1e6 + 1e-3) s + 2e3: the slow root is
    // -c/b (1 + c/b^2 + ...)
    let plant = TransferFunction::from_factors(1e3, vec![], vec![c(-1e-3, 0.0), c(-1e6, 0.0)]).unwrap();
    let closed = plant.feedback(&TransferFunction::gain_only(1.0)).unwrap();
    let (b, product) = (1e6 + 1e-3, 2e3);
    let slow = product / b * (1.0 + product / (b * b));
    assert!((closed.poles()[0].re + slow).abs() < 1e-15 * slow);
}

#[test]
fn dc_gain_counts_integrators() {
    let system = |zeros: Vec<Complex64>, poles: Vec<Complex64>| {
        TransferFunction::from_factors(-2.0, zeros, poles).unwrap()
    };
    let origin = c(0.0, 0.0);
    assert_eq!(system(vec![], vec![c(-4.0, 0.0)]).dc_gain(), -0.5);
    assert_eq!(system(vec![], vec![origin]).dc_gain(), f64::NEG_INFINITY);
    assert_eq!(system(vec![origin], vec![c(-4.0, 0.0)]).dc_gain(), 0.0);
    assert_eq!(system(vec![origin], vec![origin, c(-4.0, 0.0)]).dc_gain(), -0.5);
    let sampled = TimeDomain::Discrete { sample_time_s: 0.1 };
    let lag = system(vec![], vec![c(0.5, 0.0)]).in_domain(sampled).unwrap();
    assert_eq!(lag.dc_gain(), -4.0);
}

#[test]
fn dead_time_turns_and_does_not_attenuate() {
    let lag = TransferFunction::from_factors(1.0, vec![], vec![c(-1.0, 0.0)]).unwrap();
    let late = lag.clone().with_dead_time(0.25).unwrap();
    let turn = late.at_frequency(2.0) / lag.at_frequency(2.0);
    assert!(magnitude(turn - c(cos(0.5), -sin(0.5))) < 1e-15);
    assert_eq!(late.at_frequency(2.0), late.evaluate(c(0.0, 2.0)));
    assert_eq!(late.series(&late).unwrap().dead_time_s(), 0.5);
    assert!(matches!(late.feedback(&lag), Err(LinearError::NotRational { .. })));
    assert!(matches!(late.parallel(&lag), Err(LinearError::NotRational { .. })));
    assert!(matches!(lag.clone().with_dead_time(-1.0), Err(LinearError::DeadTime { .. })));
    let sampled = lag.in_domain(TimeDomain::Discrete { sample_time_s: 0.1 }).unwrap();
    assert!(matches!(sampled.clone().with_dead_time(0.25), Err(LinearError::FractionalDeadTime { .. })));
    let two_samples = sampled.clone().with_dead_time(0.2).unwrap();
    let z = c(0.3, 0.8);
    assert!(relative(two_samples.evaluate(z), sampled.evaluate(z) / (z * z)) < 1e-14);
}

/// An actuator in its own units: pressures of 1e6 Pa, deflections of 1e-5 m, a slow leak, a valve.
///
/// States: spool command and its rate, load pressure, velocity, deflection of the load cell.
fn actuator() -> StateSpace {
    let (area, mass, friction, sensor) = (1.583e-3, 13.1, 299.0, 9.81e7);
    let (stiffness, leakage, flow_gain, natural, damping) = (1.5e6, 5.7e-13, 5.4e-5, 1099.0, 0.9);
    let capacity = area * area / stiffness;
    #[rustfmt::skip]
    let a = DMatrix::from_row_slice(5, 5, &[
        0.0, 1.0, 0.0, 0.0, 0.0,
        -natural * natural, -2.0 * damping * natural, 0.0, 0.0, 0.0,
        flow_gain / capacity, 0.0, -leakage / capacity, -area / capacity, 0.0,
        0.0, 0.0, area / mass, -friction / mass, -sensor / mass,
        0.0, 0.0, 0.0, 1.0, 0.0,
    ]);
    let b = DMatrix::from_row_slice(5, 1, &[0.0, natural * natural, 0.0, 0.0, 0.0]);
    let c = DMatrix::from_row_slice(1, 5, &[0.0, 0.0, 0.0, 0.0, sensor]);
    StateSpace::new(a, b, c, DMatrix::zeros(1, 1), TimeDomain::Continuous).unwrap()
}

#[test]
fn an_actuator_in_its_own_units() {
    let system = actuator();
    let poles = system.poles().unwrap();
    // ORIGIN: thesis Table 6.1, K_H = 1.5e6 N/m: -0.336, -11.41 +- 2757i, -989.1 +- 479.0i
    assert!((poles[0].re + 0.336).abs() < 1e-3, "{}", poles[0]);
    assert!(magnitude(poles[2] - c(-989.1, 479.0)) < 0.1, "{}", poles[2]);
    assert!(magnitude(poles[4] - c(-11.41, 2757.0)) < 1.0, "{}", poles[4]);
    // the valve is a separate block: its poles are exact
    let valve = c(-0.9 * 1099.0, 1099.0 * (1.0_f64 - 0.81).sqrt());
    assert!(relative(poles[2], valve) < 1e-15);
    // characteristic polynomial of the mechanical part, from the equations:
    // (s + k)(s^2 + f s + w2) + g s with k = leak/capacity, w2 = K_S/M, g = A^2/(C M)
    let capacity = 1.583e-3 * 1.583e-3 / 1.5e6;
    let (k, f, w2) = (5.7e-13 / capacity, 299.0 / 13.1, 9.81e7 / 13.1);
    let g = 1.583e-3 * 1.583e-3 / (capacity * 13.1);
    let cubic = Polynomial::new(vec![1.0, k + f, k * f + w2 + g, k * w2]);
    for (pole, truth) in [poles[0], poles[3], poles[4]].iter().zip(cubic.roots().unwrap()) {
        assert!((pole.re - truth.re).abs() <= 1e-12 * truth.re.abs(), "{pole} {truth}");
        assert!(relative(*pole, truth) < 1e-14, "{pole} {truth}");
    }
    let force = system.to_transfer_function(0, 0).unwrap();
    assert!(force.zeros().is_empty());
    // gain: natural^2 * K_qU/C * A/M * K_S
    let gain = 1099.0 * 1099.0 * 5.4e-5 / capacity * 1.583e-3 / 13.1 * 9.81e7;
    assert!((force.gain() / gain - 1.0).abs() < 1e-14);
}

#[test]
fn units_of_states_do_not_matter() {
    let system = actuator();
    let units = [1e-6, 1e3, 1e-8, 1e5, 1e9];
    let scaled = StateSpace::new(
        DMatrix::from_fn(5, 5, |i, j| system.a()[(i, j)] * units[i] / units[j]),
        DMatrix::from_fn(5, 1, |i, _| system.b()[(i, 0)] * units[i]),
        DMatrix::from_fn(1, 5, |_, j| system.c()[(0, j)] / units[j]),
        DMatrix::zeros(1, 1),
        TimeDomain::Continuous,
    )
    .unwrap();
    let (first, second) = (system.to_transfer_function(0, 0), scaled.to_transfer_function(0, 0));
    let (first, second) = (first.unwrap(), second.unwrap());
    assert_eq!(first.zeros().len(), second.zeros().len());
    for w in [1e-3, 1.0, 100.0, 2757.0, 1e5] {
        assert!(relative(first.at_frequency(w), second.at_frequency(w)) < 1e-12);
        assert!(relative(scaled.at_frequency(w, 0, 0).unwrap(), first.at_frequency(w)) < 1e-10);
    }
}

#[test]
fn dense_coordinates_keep_poles_and_zeros() {
    let mut seeded = Seeded(14);
    for _ in 0..50 {
        let order = 2 + seeded.below(4);
        let zeros = seeded.below(order + 1);
        let truth = seeded.system_over(order, zeros, 3.0);
        let plain = StateSpace::from_transfer_function(&truth).unwrap();
        // a well-conditioned change of coordinates mixes all states
        let mix =
            DMatrix::from_fn(order, order, |i, j| if i == j { 1.5 } else { 0.6 * (seeded.next() - 0.5) });
        let back = mix.clone().try_inverse().unwrap();
        let mixed = StateSpace::new(
            &mix * plain.a() * &back,
            &mix * plain.b(),
            plain.c() * &back,
            plain.d().clone(),
            TimeDomain::Continuous,
        )
        .unwrap();
        let found = mixed.to_transfer_function(0, 0).unwrap();
        // rounding the mixed matrices adds zeros far away, never near
        let farthest =
            truth.zeros().iter().chain(truth.poles()).map(|root| magnitude(*root)).fold(0.0, f64::max);
        let near = found.zeros().iter().filter(|zero| magnitude(**zero) < 100.0 * farthest).count();
        assert_eq!(near, truth.zeros().len(), "{truth:?} {found:?}");
        for w in [0.01, 0.1, 1.0, 7.0] {
            let direct = mixed.at_frequency(w, 0, 0).unwrap();
            let error = relative(found.at_frequency(w), direct);
            let lost = largest(&truth) / magnitude(direct);
            assert!(error < 1e-9 + 1e-13 * lost, "{error:e} at {w} of {truth:?} found {found:?}");
        }
    }
}

#[test]
fn modes_that_do_not_reach_the_output_cancel() {
    // two parallel lags, of which only the first is driven
    let a = DMatrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, -5.0]);
    let (b, c_row) = (DMatrix::from_row_slice(2, 1, &[2.0, 0.0]), DMatrix::from_row_slice(1, 2, &[1.0, 1.0]));
    let system = StateSpace::new(a, b, c_row, DMatrix::zeros(1, 1), TimeDomain::Continuous).unwrap();
    let full = system.to_transfer_function(0, 0).unwrap();
    assert_eq!((full.zeros(), full.poles().len()), (&[c(-5.0, 0.0)][..], 2));
    let minimal = full.without_common_factors(1e-12);
    assert_eq!((minimal.gain(), minimal.zeros().len(), minimal.poles()), (2.0, 0, &[c(-1.0, 0.0)][..]));
    assert!(magnitude(minimal.at_frequency(3.0) - full.at_frequency(3.0)) < 1e-15);
    // a complex pair cancels as a pair, and not with a real root nearby
    let pair = [c(-2.0, 3.0), c(-2.0, -3.0)];
    let notch = TransferFunction::from_factors(
        4.0,
        vec![pair[0], pair[1], c(-7.0, 0.0)],
        vec![pair[0], pair[1], c(-7.0, 1e-9), c(-7.0, -1e-9)],
    );
    let minimal = notch.unwrap().without_common_factors(1e-6);
    assert_eq!((minimal.zeros(), minimal.poles().len()), (&[c(-7.0, 0.0)][..], 2));
}

#[test]
fn delay_becomes_states() {
    let sampled = TransferFunction::from_factors(1.0, vec![], vec![c(0.5, 0.0)])
        .and_then(|lag| lag.in_domain(TimeDomain::Discrete { sample_time_s: 0.1 }))
        .and_then(|lag| lag.with_dead_time(0.3))
        .unwrap();
    let states = StateSpace::from_transfer_function(&sampled).unwrap();
    assert_eq!(states.poles().unwrap(), [c(0.0, 0.0), c(0.0, 0.0), c(0.0, 0.0), c(0.5, 0.0)]);
    for w in [0.1, 3.0, 30.0] {
        assert!(relative(states.at_frequency(w, 0, 0).unwrap(), sampled.at_frequency(w)) < 1e-14);
    }
}

#[test]
fn structure_gives_exact_poles() {
    // integrator - two tanks in exchange - integrator: the exchange conserves volume, so its matrix
    // is singular
    #[rustfmt::skip]
    let a = DMatrix::from_row_slice(5, 5, &[
        0.0, 1.0, 0.0, 0.0, 0.3,
        0.0, -0.1, 0.3, 0.0, 0.0,
        0.0, 0.1, -0.5, 0.7, 0.0,
        0.0, 0.0, 0.2, -0.7, 0.0,
        0.0, 0.0, 0.0, 0.0, -1e-3,
    ]);
    let system = StateSpace::new(
        a,
        DMatrix::from_element(5, 1, 1.0),
        DMatrix::from_element(1, 5, 1.0),
        DMatrix::zeros(1, 1),
        TimeDomain::Continuous,
    )
    .unwrap();
    let poles = system.poles().unwrap();
    assert_eq!(poles[..3], [c(0.0, 0.0), c(0.0, 0.0), c(-1e-3, 0.0)]);
    assert_eq!(system.is_stable(), Ok(false));
}

#[test]
fn refusals_are_typed() {
    let matrix = |rows, columns| DMatrix::from_element(rows, columns, 1.0);
    let new = |a, b, c, d| StateSpace::new(a, b, c, d, TimeDomain::Continuous);
    assert!(matches!(
        new(matrix(2, 2), matrix(3, 1), matrix(1, 2), matrix(1, 1)),
        Err(LinearError::Shape { matrix: "B", found: (3, 1), expected: (2, 1) })
    ));
    assert!(matches!(
        new(matrix(1, 1) * f64::NAN, matrix(1, 1), matrix(1, 1), matrix(1, 1)),
        Err(LinearError::NotFinite { .. })
    ));
    let system = new(matrix(1, 1), matrix(1, 1), matrix(1, 1), matrix(1, 1)).unwrap();
    assert!(matches!(system.at_frequency(1.0, 1, 0), Err(LinearError::NoSuchPort { port: "input", .. })));
    assert!(matches!(system.at_frequency(1.0, 0, 3), Err(LinearError::NoSuchPort { port: "output", .. })));
    let minus_one = TransferFunction::gain_only(-1.0);
    let unit = TransferFunction::gain_only(1.0);
    assert_eq!(minus_one.feedback(&unit), Err(LinearError::IllPosedLoop));
    assert_eq!(TransferFunction::gain_only(0.0).inverse(), Err(LinearError::NoInverse));
    let derivative = TransferFunction::from_factors(1.0, vec![c(0.0, 0.0)], vec![]).unwrap();
    assert!(matches!(StateSpace::from_transfer_function(&derivative), Err(LinearError::Improper { .. })));
    let lag = TransferFunction::from_factors(1.0, vec![], vec![c(-1.0, 0.0)]).unwrap();
    let sampled = lag.clone().in_domain(TimeDomain::Discrete { sample_time_s: 0.1 }).unwrap();
    assert_eq!(lag.series(&sampled), Err(LinearError::DomainMismatch));
    assert!(matches!(
        lag.clone().in_domain(TimeDomain::Discrete { sample_time_s: 0.0 }),
        Err(LinearError::SampleTime { .. })
    ));
    let late = sampled.with_dead_time(1e6).unwrap();
    assert!(matches!(
        StateSpace::from_transfer_function(&late),
        Err(LinearError::TooManyDelayStates { samples }) if samples == 1e7
    ));
    let zero = Polynomial::new(vec![0.0]);
    assert_eq!(TransferFunction::from_polynomials(&zero, &zero), Err(LinearError::ZeroPolynomial));
}
