//! Margins, phases and passivity: closed forms, limits, and equivalence with closed-loop poles.
#![cfg(test)]

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::frequency::{FrequencyResponse, logarithmic_grid, margins, passivity};
use phea_dynamics::linear::{Discretization, LinearError, Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable::{atan, cos, exp, magnitude, pow, sin};

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    TransferFunction::from_polynomials(
        &Polynomial::new(numerator.to_vec()),
        &Polynomial::new(denominator.to_vec()),
    )
    .unwrap()
}

fn close(found: f64, truth: f64, tolerance: f64) {
    assert!((found - truth).abs() <= tolerance * truth.abs(), "{found} is not {truth}");
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

    fn stable_roots(&mut self, count: usize) -> Vec<Complex64> {
        let mut roots = Vec::new();
        while roots.len() < count {
            let size = pow(10.0, -1.0 + 4.0 * self.next());
            if self.next() < 0.5 || roots.len() + 2 > count {
                roots.push(c(-size, 0.0));
            } else {
                let angle = 1.5 * self.next();
                roots.extend([
                    c(-size * cos(angle), size * sin(angle)),
                    c(-size * cos(angle), -size * sin(angle)),
                ]);
            }
        }
        roots
    }
}

#[test]
fn margins_of_a_third_order_loop() {
    // ORIGIN: analytic. 1/(s (s + 1)(s + 2)): -180 deg at sqrt 2 rad/s with |L| = 1/6
    let result = margins(&rational(&[1.0], &[1.0, 3.0, 2.0, 0.0]));
    let critical = result.gain_increase().unwrap();
    close(critical.factor, 6.0, 1e-14);
    close(critical.frequency_rad_per_s, 2.0_f64.sqrt(), 1e-14);
    assert_eq!(result.gain_decrease_factor(), 0.0);
    let phase = result.critical_phase().unwrap();
    let w = phase.frequency_rad_per_s;
    close(w * ((w * w + 1.0) * (w * w + 4.0)).sqrt(), 1.0, 1e-14);
    close(phase.phase_deg, (PI / 2.0 - atan(w) - atan(w / 2.0)).to_degrees(), 1e-13);
    close(phase.delay_s, phase.phase_deg.to_radians() / w, 1e-15);
}

#[test]
fn margins_with_dead_time() {
    // ORIGIN: analytic. k exp(-s tau)/s: crosses one at k; -180 deg at pi/(2 tau), 5 pi/(2 tau),
    // ...
    let (k, tau) = (3.0, 0.1);
    let integrator = rational(&[k], &[1.0, 0.0]).with_dead_time(tau).unwrap();
    let result = margins(&integrator);
    close(result.gain_increase_factor(), PI / (2.0 * tau) / k, 1e-14);
    close(result.phase_margin_deg(), 90.0 - (k * tau).to_degrees(), 1e-13);
    close(result.delay_margin_s(), PI / 2.0 / k - tau, 1e-13);
    for (index, margin) in result.gain_margins.iter().take(20).enumerate() {
        close(margin.frequency_rad_per_s, (2.0 * index as f64 + 0.5) * PI / tau, 1e-13);
    }
    // modulus: min |1 + k exp(-j x)/(j x)| over x = w tau, by its own stationarity on a fine scan
    let distance = |w: f64| magnitude(c(1.0, 0.0) + integrator.at_frequency(w));
    let scan = (1..400_000).map(|i| distance(f64::from(i) * 1e-4)).fold(f64::INFINITY, f64::min);
    close(result.modulus_margin.distance, scan, 1e-8);
    assert!(result.modulus_margin.distance <= scan);
}

#[test]
fn a_conditionally_stable_loop_has_both_gain_margins() {
    // ORIGIN: analytic. k (s + 1)^2/s^3 crosses the axis at L(j) = -2 k; with k = 2 the gain may
    // fall to a quarter
    let result = margins(&rational(&[2.0, 4.0, 2.0], &[1.0, 0.0, 0.0, 0.0]));
    let decrease = result.gain_decrease().unwrap();
    close(decrease.frequency_rad_per_s, 1.0, 1e-14);
    close(decrease.factor, 0.25, 1e-14);
    assert_eq!(result.gain_increase_factor(), f64::INFINITY);
}

#[test]
fn margins_at_the_ends_of_the_axis() {
    // 2/(s - 1): L(0) = -2, so the gain may fall to one half
    let result = margins(&rational(&[2.0], &[1.0, -1.0]));
    let decrease = result.gain_decrease().unwrap();
    assert_eq!((decrease.frequency_rad_per_s, decrease.factor), (0.0, 0.5));
    // -0.25 (s + 4)/(s + 1) ends at -0.25
    let result = margins(&rational(&[-0.25, -0.5], &[1.0, 1.0]));
    assert!(result.gain_margins.iter().any(|m| m.frequency_rad_per_s == f64::INFINITY && m.factor == 4.0));
    // the double integrator runs along the axis: no crossing, no phase margin
    let result = margins(&rational(&[4.0], &[1.0, 0.0, 0.0]));
    assert!(result.gain_margins.is_empty());
    assert_eq!((result.phase_margin_deg(), result.delay_margin_s()), (0.0, 0.0));
    close(result.critical_phase().unwrap().frequency_rad_per_s, 2.0, 1e-15);
    assert_eq!(result.modulus_margin.distance, 0.0);
}

#[test]
fn a_constant_has_no_crossings() {
    let result = margins(&TransferFunction::gain_only(0.5));
    assert!(result.gain_margins.is_empty() && result.phase_margins.is_empty());
    assert_eq!(result.modulus_margin.distance, 1.5);
    assert_eq!(result.delay_margin_s(), f64::INFINITY);
    assert_eq!(margins(&TransferFunction::gain_only(0.0)).modulus_margin.distance, 1.0);
}

#[test]
fn a_narrow_resonance_is_not_stepped_over() {
    // |L| reaches one only within a bandwidth of 1e-6 of its frequency: quality 1e7, peak 1.2
    let (w, zeta) = (1000.0, 5e-8);
    let resonance = rational(&[1.2 * 2.0 * zeta * w * w], &[1.0, 2.0 * zeta * w, w * w]);
    let result = margins(&resonance);
    assert_eq!(result.phase_margins.len(), 2, "{:?}", result.phase_margins);
    for margin in &result.phase_margins {
        close(magnitude(resonance.at_frequency(margin.frequency_rad_per_s)), 1.0, 1e-8);
    }
}

#[test]
fn gain_margins_are_where_closed_loop_poles_cross() {
    let mut seeded = Seeded(21);
    let mut crossings = 0;
    for _ in 0..100 {
        let poles = seeded.stable_roots(5);
        let zeros = seeded.stable_roots(2);
        let open = TransferFunction::from_factors(1.0, zeros, poles).unwrap();
        let open = open.series(&TransferFunction::gain_only(2.0 / open.dc_gain())).unwrap();
        for margin in margins(&open).gain_margins.iter().filter(|m| m.frequency_rad_per_s.is_finite()) {
            let closed = open.feedback(&TransferFunction::gain_only(margin.factor)).unwrap();
            let w = margin.frequency_rad_per_s;
            let nearest =
                closed.poles().iter().map(|pole| magnitude(pole - c(0.0, w))).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-9 * w, "{margin:?}: nearest pole is {nearest:e} away");
            crossings += 1;
        }
    }
    assert!(crossings > 50, "{crossings}");
}

#[test]
fn modulus_margin_is_the_inverse_of_the_largest_sensitivity() {
    let mut seeded = Seeded(22);
    let unit = TransferFunction::gain_only(1.0);
    for _ in 0..50 {
        let (poles, zeros) = (seeded.stable_roots(6), seeded.stable_roots(3));
        let open = TransferFunction::from_factors(100.0, zeros, poles).unwrap();
        let sensitivity = unit.feedback(&open).unwrap();
        let grid = logarithmic_grid(1e-3, 1e6, 20_000).unwrap();
        let largest = grid.iter().map(|&w| magnitude(sensitivity.at_frequency(w))).fold(1.0, f64::max);
        let distance = margins(&open).modulus_margin.distance;
        assert!(1.0 / distance >= largest * (1.0 - 1e-12), "{} {largest}", 1.0 / distance);
        close(1.0 / distance, largest, 1e-4);
    }
}

#[test]
fn sampled_margins() {
    // ORIGIN: analytic. k/(z - 1), T = 1: L = -1 at z = -1 for k = 2; |L| = 1 where 2 sin(w/2) = k
    let open = TransferFunction::from_factors(1.0, vec![], vec![c(1.0, 0.0)])
        .and_then(|system| system.in_domain(TimeDomain::Discrete { sample_time_s: 1.0 }))
        .unwrap();
    let result = margins(&open);
    let increase = result.gain_increase().unwrap();
    close(increase.factor, 2.0, 1e-14);
    close(increase.frequency_rad_per_s, PI, 1e-15);
    let phase = result.critical_phase().unwrap();
    close(phase.frequency_rad_per_s, PI / 3.0, 1e-14);
    close(phase.phase_deg, 60.0, 1e-13);
    close(phase.delay_s, 1.0, 1e-13);
    // and the closed loop agrees: z - 1 + 2 = 0 at z = -1
    let closed = open.feedback(&TransferFunction::gain_only(2.0)).unwrap();
    assert_eq!(closed.poles(), [c(-1.0, 0.0)]);
}

#[test]
fn a_fast_sampled_loop_has_the_margins_of_the_continuous_one() {
    let open = rational(&[20.0, 20.0], &[1.0, 6.0, 8.0, 0.0]);
    let (continuous, step) = (margins(&open), 1e-4);
    let sampled = margins(&open.discretized(step, Discretization::Tustin).unwrap());
    close(sampled.phase_margin_deg(), continuous.phase_margin_deg(), 1e-6);
    close(sampled.modulus_margin.distance, continuous.modulus_margin.distance, 1e-6);
    // a hold costs half a sample of delay
    let held = margins(&open.discretized(step, Discretization::ZeroOrderHold).unwrap());
    close(held.delay_margin_s(), continuous.delay_margin_s() - step / 2.0, 1e-5);
}

#[test]
fn phase_is_continuous_and_right_modulo_a_turn() {
    let mut seeded = Seeded(23);
    let grid = logarithmic_grid(1e-3, 1e6, 3000).unwrap();
    for round in 0..60 {
        let mut zeros = seeded.stable_roots(3);
        let mut poles = seeded.stable_roots(5);
        // some in the right half plane
        zeros.iter_mut().for_each(|root| root.re *= if round % 2 == 0 { -1.0 } else { 1.0 });
        poles.iter_mut().for_each(|root| root.re *= if round % 3 == 0 { -1.0 } else { 1.0 });
        let sign = if round % 5 == 0 { -1.0 } else { 1.0 };
        let mut system = TransferFunction::from_factors(sign, zeros, poles).unwrap();
        if round % 4 == 0 {
            system = system.discretized(1e-3, Discretization::Tustin).unwrap();
        } else {
            system = system.with_dead_time(1e-3).unwrap();
        }
        let frequencies: Vec<f64> = grid.iter().copied().filter(|w| *w < 3000.0).collect();
        let response = FrequencyResponse::of(&system, &frequencies);
        for (value, phase) in response.values().iter().zip(response.phases_deg()) {
            let angle = phase.to_radians();
            let direction = c(cos(angle), sin(angle)) * magnitude(*value);
            assert!(magnitude(direction - value) < 1e-11 * magnitude(*value));
        }
        let jump = response.phases_deg().windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(jump < 60.0, "jump of {jump} degrees in {system:?}");
    }
}

#[test]
fn phases_start_where_they_should() {
    // ORIGIN: analytic. Multiples of 90 degrees
    let at = |system: &TransferFunction, w: f64| system.phase_rad(w).to_degrees();
    assert_eq!(at(&rational(&[-1.0], &[1.0]), 1.0), -180.0);
    assert_eq!(at(&rational(&[1.0], &[1.0, 0.0, 0.0]), 1.0), -180.0);
    assert_eq!(at(&rational(&[1.0, 0.0], &[1.0]), 1.0), 90.0);
    // (1 - s)/(1 + s): all-pass from 0 to -180
    close(at(&rational(&[-1.0, 1.0], &[1.0, 1.0]), 1.0), -90.0, 1e-15);
    // ORIGIN: analytic, an undamped pair turns the phase by -180 when passed
    let undamped = rational(&[1.0], &[1.0, 0.0, 4.0]);
    assert_eq!((at(&undamped, 1.999), at(&undamped, 2.001)), (0.0, -180.0));
}

#[test]
fn networks_of_passive_elements_are_passive() {
    // masses, springs and dampers in random ladders: Z = series or parallel of passive impedances
    let mut seeded = Seeded(24);
    for _ in 0..60 {
        let mut value = || pow(10.0, -2.0 + 5.0 * seeded.next());
        let element = |kind: u32, value: f64| match kind % 3 {
            0 => rational(&[value, 0.0], &[1.0]),
            1 => rational(&[value], &[1.0]),
            _ => rational(&[value], &[1.0, 0.0]),
        };
        let mut impedance = element(1, value());
        for rung in 0..4 {
            let other = element(rung + 2, value());
            impedance = if rung % 2 == 0 {
                impedance.parallel(&other).unwrap()
            } else {
                // 1/(1/Z + 1/Z_other) = Z/(1 + Z/Z_other)
                impedance.feedback(&other.inverse().unwrap()).unwrap().without_common_factors(1e-9)
            };
        }
        let report = passivity(&impedance).unwrap();
        assert!(report.passive, "{report:?} of {impedance:?}");
    }
}

#[test]
fn each_condition_of_passivity_can_fail_independently() {
    // 1: a single unstable pole. Re (s - 4)/(s - 1) = (4 + w^2)/(1 + w^2) on the axis
    let unstable = passivity(&rational(&[1.0, -4.0], &[1.0, -1.0])).unwrap();
    assert!(unstable.bands.is_empty());
    assert_eq!(unstable.right_half_plane_poles, [c(1.0, 0.0)]);
    assert!(!unstable.passive);
    // 2: a double pole at the origin
    let double = passivity(&rational(&[1.0, 1.0], &[1.0, 0.0, 0.0])).unwrap();
    assert_eq!(double.imaginary_poles.len(), 1);
    assert_eq!((double.imaginary_poles[0].multiplicity, double.imaginary_poles[0].residue), (2, None));
    assert!(!double.passive);
    // 2: a negative residue: 1 - 1/s fails at the origin, Re Z = 1 everywhere
    let negative = passivity(&rational(&[1.0, -1.0], &[1.0, 0.0])).unwrap();
    assert!(negative.bands.is_empty());
    assert_eq!(negative.imaginary_poles[0].residue, Some(c(-1.0, 0.0)));
    assert!(!negative.passive);
    // 2: an undamped pair: s/(s^2 + 9) has residue 1/2
    let lossless = passivity(&rational(&[1.0, 0.0], &[1.0, 0.0, 9.0])).unwrap();
    assert!(lossless.passive, "{lossless:?}");
    assert_eq!(lossless.imaginary_poles[0].frequency_rad_per_s, 3.0);
    assert_eq!(lossless.imaginary_poles[0].residue, Some(c(0.5, 0.0)));
    // 2 at infinity: s^2 grows too fast, -s has the wrong sign
    assert!(!passivity(&rational(&[1.0, 0.0, 0.0], &[1.0])).unwrap().passive);
    assert!(!passivity(&rational(&[-1.0, 0.0], &[1.0])).unwrap().passive);
    assert!(passivity(&rational(&[2.0, 0.0], &[1.0])).unwrap().passive);
    // 3: 1/(s + 1)^2: Re Z = (1 - w^2)/(1 + w^2)^2 is negative beyond 1 rad/s
    let lag = passivity(&rational(&[1.0], &[1.0, 2.0, 1.0])).unwrap();
    assert_eq!(lag.bands.len(), 1);
    close(lag.bands[0].from_rad_per_s, 1.0, 1e-14);
    assert_eq!(lag.bands[0].to_rad_per_s, f64::INFINITY);
}

#[test]
fn bands_end_where_the_real_part_changes_sign() {
    // ORIGIN: analytic. Z = (s^2 + 2 a s + 1)/(s^2 + 2 b s + 1): Re Z has the sign of
    // (1 - x)^2 + 4 a b x, x = w^2; for a = -0.1, b = 0.4: x = 1.08 -+ sqrt(1.08^2 - 1)
    let report = passivity(&rational(&[1.0, -0.2, 1.0], &[1.0, 0.8, 1.0])).unwrap();
    assert_eq!(report.bands.len(), 1);
    let root = (1.08_f64 * 1.08 - 1.0).sqrt();
    close(report.bands[0].from_rad_per_s, (1.08 - root).sqrt(), 1e-13);
    close(report.bands[0].to_rad_per_s, (1.08 + root).sqrt(), 1e-13);
    close(report.bands[0].worst_frequency_rad_per_s, 1.0, 1e-3);
    close(report.bands[0].worst_impedance.re, -0.25, 1e-3);
    // scaled over eight decades: two such bands, a thousand and a hundred million rad/s
    let factor = |w: f64| rational(&[1.0, -0.2 * w, w * w], &[1.0, 0.8 * w, w * w]);
    let two = factor(1e3).series(&factor(1e8)).unwrap();
    let report = passivity(&two).unwrap();
    assert_eq!(report.bands.len(), 2);
    for (band, w) in report.bands.iter().zip([1e3, 1e8]) {
        close(band.from_rad_per_s, w * (1.08 - root).sqrt(), 1e-4);
        let sign = |frequency: f64| two.at_frequency(frequency).re;
        assert!(
            sign(band.from_rad_per_s * (1.0 - 1e-9)) > 0.0 && sign(band.from_rad_per_s * (1.0 + 1e-9)) < 0.0
        );
        assert!(sign(band.to_rad_per_s * (1.0 - 1e-9)) < 0.0 && sign(band.to_rad_per_s * (1.0 + 1e-9)) > 0.0);
    }
}

#[test]
fn random_bands_agree_with_a_dense_scan() {
    let mut seeded = Seeded(25);
    let grid = logarithmic_grid(1e-4, 1e7, 20_000).unwrap();
    let mut failing = 0;
    for _ in 0..80 {
        let (zeros, poles) = (seeded.stable_roots(6), seeded.stable_roots(6));
        let impedance = TransferFunction::from_factors(1.0, zeros, poles).unwrap();
        let report = passivity(&impedance).unwrap();
        failing += usize::from(!report.passive);
        for &w in &grid {
            let listed = report.bands.iter().any(|band| w >= band.from_rad_per_s && w <= band.to_rad_per_s);
            let value = impedance.at_frequency(w);
            if value.re.abs() > 1e-10 * magnitude(value) {
                assert_eq!(listed, value.re < 0.0, "{w} rad/s: {value} of {impedance:?}");
            }
        }
    }
    assert!(failing > 20, "{failing}");
}

#[test]
fn passivity_refuses_what_it_cannot_decide() {
    let late = rational(&[1.0], &[1.0, 1.0]).with_dead_time(0.1).unwrap();
    assert!(matches!(passivity(&late), Err(LinearError::NotRational { .. })));
    let sampled = rational(&[1.0], &[1.0, -exp(-1.0)]).in_domain(TimeDomain::Discrete { sample_time_s: 1.0 });
    assert!(matches!(passivity(&sampled.unwrap()), Err(LinearError::WrongDomain { .. })));
}

#[test]
fn grids_refuse_bad_ends() {
    for (from, to) in [(0.0, 1.0), (-1.0, 1.0), (2.0, 1.0), (1.0, f64::INFINITY), (f64::NAN, 1.0)] {
        assert!(matches!(logarithmic_grid(from, to, 3), Err(LinearError::Frequency { .. })));
    }
    assert_eq!(logarithmic_grid(2.0, 2.0, 1), Ok(vec![2.0]));
    assert_eq!(logarithmic_grid(1.0, 2.0, 0), Ok(vec![]));
}
