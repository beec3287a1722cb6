//! The band against brute force, closed forms and a published prefilter.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_qft::prefilter::{BandEdge, PrefilterBand, PrefilterError, tracking_extremes};
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};

use super::loops::{around, integrators, member, rational, servo, spaced, tracking};

const DECIBELS_PER_NEPER: f64 = 20.0 / std::f64::consts::LN_10;

/// The margin of every member with any F equals the margin of |F| to the band.
#[test]
fn the_band_agrees_with_every_member() {
    let (compensation, members, specification) = servo();
    let frequencies = spaced(0.05, 10.0, 17);
    let band = PrefilterBand::of_family(&compensation, &members, &frequencies, &specification).unwrap();
    let requested = band.points().iter().filter(|point| point.frequency_rad_per_s >= 0.05);
    for (point, &frequency) in requested.zip(&frequencies) {
        assert_eq!(point.frequency_rad_per_s, frequency);
        for prefilter in [Complex64::new(0.3, 0.1), Complex64::new(-1.1, 0.2), Complex64::new(0.0, 0.8)] {
            let margin = |member: &phea_qft::closed_loop::Member| {
                let response = member.response(frequency).unwrap();
                let response = LoopResponse {
                    plant: response.plant,
                    load_motion: response.load_motion,
                    controller: compensation.response(frequency).feedback,
                    prefilter,
                    sensor: response.sensor,
                };
                specification.margin_db(&response, frequency).unwrap()
            };
            let worst = members.iter().map(margin).fold(f64::INFINITY, f64::min);
            let magnitude = 10.0 * prefilter.norm_sqr().log10();
            let expected = (magnitude - point.least_db).min(point.greatest_db - magnitude);
            assert!((worst - expected).abs() < 1e-11, "{worst} {expected}");
        }
    }
}

/// Published prefilter that is 4e-5 dB too low at 0.09 rad/s, because it is too flat at zero:
/// ln|F| = 0.00125 w^2, where the slowest plant requires 0.0025 w^2.
// ORIGIN: recomputed by comparisons/recompute_audit.py
#[test]
fn the_published_prefilter_leaves_its_band_by_a_hair() {
    let (compensation, members, specification) = servo();
    let mut frequencies = spaced(0.01, 10.0, 301);
    frequencies.extend(spaced(0.011, 9.9, 300));
    frequencies.sort_by(f64::total_cmp);
    let band = PrefilterBand::of_family(&compensation, &members, &frequencies, &specification).unwrap();
    let published = rational(&[1.0], &[1.0 / 16.0, 0.35, 1.0]);
    let margins = band.margins(&published);
    let worst = margins.iter().map(|margin| margin.margin_db).fold(f64::INFINITY, f64::min);
    assert!((worst + 4.11e-5).abs() < 1e-6, "{worst}");
    assert!(margins.windows(2).all(|pair| pair[0].fraction() <= pair[1].fraction()));
}

/// Closed loop T = k/(s + k), so that ln|T| = -w^2/(2 k^2) near zero; the limits are lags of second
/// and first order.
#[test]
fn towards_zero_the_edges_have_the_curvatures_of_the_closed_form() {
    let (compensation, members) = integrators(&[1.0, 4.0, 2.0]);
    let lower = Limit::Rational(rational(&[1.0], &[1.0, 2.0, 1.0])); // ln = -w^2
    let upper = Limit::Rational(rational(&[1.0], &[0.2, 1.0])); // ln = -w^2/50
    let specification = tracking(lower, upper, [0.0, 10.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[0.1, 1.0], &specification).unwrap();
    let rest = band.points()[0];
    assert_eq!((rest.frequency_rad_per_s, rest.least_db, rest.greatest_db), (0.0, 0.0, 0.0));
    let lowest = band.points()[1];
    let scale = DECIBELS_PER_NEPER * lowest.frequency_rad_per_s * lowest.frequency_rad_per_s;
    let [least, greatest] = [lowest.least_db / scale, lowest.greatest_db / scale];
    assert!(lowest.frequency_rad_per_s < 0.1);
    assert!(
        (least + 0.5).abs() < 1e-3 && (greatest - (1.0 / 32.0 - 0.02)).abs() < 1e-3,
        "{least} {greatest}"
    );
    assert_eq!((lowest.least_member, lowest.greatest_member), (0, 1));
}

/// A band that begins above zero nevertheless requires the value at zero, if it is unique.
#[test]
fn the_limits_meet_at_zero_below_the_band_too() {
    let (compensation, members) = integrators(&[1.0, 4.0]);
    let lag = |corner: f64| Limit::Rational(rational(&[corner], &[1.0, corner]));
    let specification = tracking(lag(0.4), lag(5.0), [0.1, 10.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[0.05, 0.1, 1.0], &specification).unwrap();
    let frequencies: Vec<f64> = band.points().iter().map(|point| point.frequency_rad_per_s).collect();
    assert_eq!(frequencies, [0.0, 0.1, 1.0]);
    // limits that are apart at zero require nothing there
    let apart = tracking(Limit::Constant(0.5), Limit::Constant(2.0), [0.1, 10.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[0.1, 1.0], &apart).unwrap();
    assert_eq!(band.points().len(), 2);
}

/// Plants without an integrator, whose T(0) = k/(1 + k) differs: 1/2 and 4/5, which limits of 0.9
/// and 1.1 cannot both contain.
#[test]
fn plants_that_differ_at_rest_close_the_band_there() {
    let compensation = around(TransferFunction::gain_only(1.0));
    let members = [1.0, 4.0].map(|k| member(&compensation, &[k], &[1.0, 1.0]));
    let lower = Limit::Rational(rational(&[0.9], &[4.0, 1.0])); // above zero it leaves more room
    let specification = tracking(lower, Limit::Constant(1.1), [0.0, 1.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[0.5], &specification).unwrap();
    let rest = band.points()[0];
    let decibels = |ratio: f64| 20.0 * ratio.log10();
    assert!((rest.least_db - decibels(0.9 / 0.5)).abs() < 1e-12);
    assert!((rest.greatest_db - decibels(1.1 / 0.8)).abs() < 1e-12);
    let closed = band.closed(0.001).unwrap();
    assert_eq!((closed.frequency_rad_per_s, closed.least_member, closed.greatest_member), (0.0, 0, 1));
    assert!((closed.width_db() - decibels(1.1 / 0.9 / 1.6)).abs() < 1e-12);
    assert_eq!(band.closed(2.0), None); // a tolerance of 2 dB at either edge opens it
}

/// Closed loop T that falls as 1/s, with an upper limit as 1/s^2 and a lower one as 1/s^3: F must
/// fall as 1/s or 1/s^2.
#[test]
fn the_limits_at_infinity_bound_the_relative_degree() {
    let (compensation, members) = integrators(&[1.0, 4.0]);
    let upper = Limit::Rational(rational(&[1.0], &[0.01, 0.2, 1.0]));
    let lower = Limit::Rational(rational(&[1.0], &[1.0, 3.0, 3.0, 1.0]));
    let everywhere = tracking(lower.clone(), upper.clone(), [0.0, f64::INFINITY]);
    let band = PrefilterBand::of_family(&compensation, &members, &[1.0, 50.0], &everywhere).unwrap();
    assert_eq!(band.relative_degree(), [1, 2]);
    assert_eq!(band.points().last().map(|point| point.frequency_rad_per_s), Some(50_000.0));
    let bounded = tracking(lower, upper, [0.0, 50.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[1.0, 50.0], &bounded).unwrap();
    assert_eq!(band.relative_degree(), [0, usize::MAX]);
}

/// A prefilter is listed at zero frequency if it is wrong there, and not for having no room.
#[test]
fn a_prefilter_with_a_wrong_gain_is_reported_at_rest() {
    let (compensation, members) = integrators(&[2.0]);
    let lag = |corner: f64| Limit::Rational(rational(&[corner], &[1.0, corner]));
    let specification = tracking(lag(0.5), lag(5.0), [0.0, 10.0]);
    let band = PrefilterBand::of_family(&compensation, &members, &[1.0], &specification).unwrap();
    let right = band.margins(&TransferFunction::gain_only(1.0));
    assert!(right.iter().all(|margin| margin.frequency_rad_per_s > 0.0 && margin.margin_db > 0.0));
    let wrong = band.margins(&TransferFunction::gain_only(1.1))[0];
    let expected = -20.0 * 1.1f64.log10();
    assert_eq!((wrong.frequency_rad_per_s, wrong.edge), (0.0, BandEdge::Greatest));
    assert!((wrong.margin_db - expected).abs() < 1e-12);
}

#[test]
fn an_empty_band_has_its_reason() {
    let (compensation, members) = integrators(&[1.0]);
    let constant = || tracking(Limit::Constant(0.5), Limit::Constant(2.0), [1.0, 10.0]);
    let of = |members, frequencies: &[f64], specification: &Specification| {
        PrefilterBand::of_family(&compensation, members, frequencies, specification).unwrap_err()
    };
    assert_eq!(of(&members, &[0.1], &constant()), PrefilterError::NoFrequency);
    assert_eq!(of(&[], &[2.0], &constant()), PrefilterError::NoMember);
    let requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0));
    let sensitivity = Specification { requirement, ..constant() };
    assert_eq!(of(&members, &[2.0], &sensitivity), PrefilterError::NotTracking);
    let nowhere = [member(&compensation, &[f64::NAN], &[1.0, 0.0, 4.0])];
    let error = PrefilterError::NoResponse { member: 0, frequency_rad_per_s: 2.0 };
    assert_eq!(of(&nowhere, &[2.0], &constant()), error);
}

/// Plant k/(s^2 + 4), which has no response at 2 rad/s; its closed loop k/(s^2 + 4 + k) is 1 there.
#[test]
fn an_undamped_pole_is_an_ordinary_point() {
    let around = around(TransferFunction::gain_only(1.0));
    let members = [3.0, 5.0].map(|k| member(&around, &[k], &[1.0, 0.0, 4.0]));
    let found = tracking_extremes(&around, &members, &[1.0, 2.0]).unwrap();
    assert!((found[0].greatest - 5.0 / 8.0).abs() < 1e-14 && (found[0].least - 3.0 / 6.0).abs() < 1e-14);
    assert!((found[1].greatest - 1.0).abs() < 1e-8 && (found[1].least - 1.0).abs() < 1e-8, "{found:?}");
}
