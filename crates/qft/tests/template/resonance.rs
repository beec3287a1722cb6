use phea_dynamics::portable::magnitude;
use phea_qft::family::Spacing::{Linear, Logarithmic};
use phea_qft::family::UncertainFamily;
use phea_qft::template::{Resolution, TemplateOptions};

use super::support::{built, built_with, coefficients, family};

/// Plant k (s+a) w^2/(s^2 + 2 z w s + w^2).
fn resonant(damping: f64) -> UncertainFamily {
    let ranges = [
        ("k", 2.0, 5.0, Logarithmic),
        ("a", 1.0, 3.0, Linear),
        ("z", damping, 0.6, Linear),
        ("w", 4.0, 8.0, Linear),
    ];
    family(&ranges, 3, |p| {
        let gain = p[0] * p[3] * p[3];
        coefficients(vec![gain, gain * p[1]], vec![1.0.into(), p[2] * p[3] * 2.0.into(), p[3] * p[3]])
    })
}

fn unresolved_near(resolution: &Resolution) -> (f64, f64, &[f64]) {
    match resolution {
        Resolution::NotResolved { phase_deg, magnitude_db, near } => (*phase_deg, *magnitude_db, near),
        other => panic!("{other:?}"),
    }
}

/// Plant k w^2/(s^2 + w^2) at 6 rad/s with w from 4 to 8: real, positive above 6, negative below.
#[test]
fn an_undamped_resonance_is_named() {
    for points in [2, 3, 4] {
        let family = family(&[("k", 2.0, 5.0, Logarithmic), ("w", 4.0, 8.0, Linear)], points, |p| {
            coefficients(vec![p[0] * p[1] * p[1]], vec![1.0.into(), 0.0.into(), p[1] * p[1]])
        });
        let built = built(&family, 6.0);
        let (phase, _, near) = unresolved_near(&built.template.resolution);
        assert!((phase - 180.0).abs() < 1e-6 && (near[1] - 6.0).abs() < 1e-5, "{near:?}");
        assert!(built.evaluations <= family.members().len() + TemplateOptions::default().evaluations_maximum);
        assert!(built.template.points.iter().all(|point| magnitude(point.response).is_finite()));
        // the template splits into a positive and a negative part
        let sides = |sign: f64| {
            built.template.outlines.iter().filter(|outline| outline.iter().all(|r| r.re * sign > 0.0)).count()
        };
        assert!(sides(1.0) > 0 && sides(-1.0) > 0);
        assert_eq!(sides(1.0) + sides(-1.0), built.template.outlines.len());
    }
}

#[test]
fn damping_down_to_zero_does_not_close() {
    let family = resonant(0.0);
    for frequency in [5.0, 6.0, 7.0] {
        let built = built(&family, frequency);
        let (_, _, near) = unresolved_near(&built.template.resolution);
        assert!(near[2] < 1e-3 && (near[3] - frequency).abs() < 1e-2, "{near:?}");
        assert!(built.evaluations < 30_000, "{}", built.evaluations);
    }
}

/// The largest magnitude over w at one frequency is k |s+a| / (2 z sqrt(1 - z^2)).
#[test]
fn a_lightly_damped_resonance_closes_at_its_peak() {
    for damping in [0.3, 0.01, 0.001] {
        let built = built(&resonant(damping), 6.0);
        assert!(
            matches!(built.template.resolution, Resolution::Resolved { .. }),
            "{:?}",
            built.template.resolution
        );
        let peak = 5.0 * 45_f64.sqrt() / (2.0 * damping * (1.0 - damping * damping).sqrt());
        let highest = built.template.outlines.iter().flatten().map(|&r| magnitude(r)).fold(0.0, f64::max);
        assert!(highest <= peak * (1.0 + 1e-9) && highest > peak * 0.998, "{highest} of {peak}");
        assert!(built.evaluations < 8_000, "{}", built.evaluations);
    }
}

/// Damping from negative to positive: all edges close, but the phase turns by 360 degrees around
/// the box.
#[test]
fn a_pole_inside_the_box_is_noticed() {
    let family = family(&[("z", -0.11, 0.1, Linear), ("w", 4.0, 8.1, Linear)], 2, |p| {
        coefficients(vec![p[1] * p[1]], vec![1.0.into(), p[0] * p[1] * 2.0.into(), p[1] * p[1]])
    });
    let built = built(&family, 6.0);
    let (_, magnitude, near) = unresolved_near(&built.template.resolution);
    assert_eq!(magnitude, f64::INFINITY);
    assert!(near[0].abs() < 0.02 && (near[1] - 6.0).abs() < 0.3, "{near:?}");
    assert!(built.evaluations < 30_000, "{}", built.evaluations);
}

#[test]
fn a_spent_budget_is_reported() {
    for evaluations_maximum in [0, 10, 100, 300] {
        let options = TemplateOptions { evaluations_maximum, ..TemplateOptions::default() };
        let family = resonant(0.3);
        let built = built_with(&family, 6.0, options);
        assert!(matches!(built.template.resolution, Resolution::NotResolved { .. }));
        assert!(built.evaluations <= family.members().len() + evaluations_maximum);
    }
}

/// Folds inside a box are reached in several rounds; with fewer the template reports that it is not
/// resolved.
#[test]
fn rounds_that_do_not_settle_are_reported() {
    let unsettled = |rounds_maximum: usize| {
        let options = TemplateOptions { rounds_maximum, ..TemplateOptions::default() };
        let resolutions = (101..107).map(|seed| {
            built_with(&super::support::quadratic_family(4, seed), 1.0, options).template.resolution
        });
        resolutions.filter(|resolution| matches!(resolution, Resolution::NotResolved { .. })).count()
    };
    assert_eq!(unsettled(0), 6);
    assert!(unsettled(1) > 0);
    assert_eq!(unsettled(16), 0);
}
