//! The bounds against the elementary method: the quadratic inequality of every plant, and for
//! tracking of every pair of plants, as given in the literature.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::bound::{BoundFunction, GainIntervals, TemplateFill};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::template::{Template, TemplatePoint};

use super::random::{Numbers, random_requirements, random_template, template_of};

/// Gains g > 0 with a g^2 + b g + c < 0, by the textbook formula.
fn school(a: f64, b: f64, c: f64) -> Vec<[f64; 2]> {
    let end = f64::INFINITY;
    if a == 0.0 {
        return match (b < 0.0, c < 0.0) {
            (true, _) => vec![[(-c / b).max(0.0), end]],
            (false, true) => vec![[0.0, -c / b]],
            (false, false) => vec![],
        };
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return if a < 0.0 { vec![[0.0, end]] } else { vec![] };
    }
    let roots = [(-b - discriminant.sqrt()) / (2.0 * a), (-b + discriminant.sqrt()) / (2.0 * a)];
    let (low, high) = (roots[0].min(roots[1]).max(0.0), roots[0].max(roots[1]).max(0.0));
    if a > 0.0 { vec![[low, high]] } else { vec![[0.0, low], [high, end]] }
}

/// Bound plant by plant, and pair by pair for tracking (Chait and Yaniv 1993), with the sensor H in
/// loop and closed loops.
fn plain(template: &Template, requirement: &Requirement, phase_rad: f64) -> GainIntervals {
    let direction = Complex64::new(portable::cos(phase_rad), portable::sin(phase_rad));
    let limit = |limit: &Limit| limit.magnitude(template.frequency_rad_per_s).unwrap();
    let (lower, upper) = requirement.limits();
    let w = limit(upper) * limit(upper);
    let mut found = Vec::new();
    for point in &template.points {
        let q = template.nominal / point.response;
        let (size, c) = (q.norm_sqr(), (q.conj() * direction).re);
        let plant = (point.response / point.sensor).norm_sqr();
        match requirement.closed_loop() {
            ClosedLoop::RobustStability => found.extend(school(w - 1.0, 2.0 * w * c, w * size)),
            ClosedLoop::Sensitivity => found.extend(school(w, 2.0 * w * c, (w - 1.0) * size)),
            ClosedLoop::PlantInputDisturbance => found.extend(school(w, 2.0 * w * c, (w - plant) * size)),
            ClosedLoop::ControlEffort => {
                found.extend(school(w - 1.0 / point.response.norm_sqr(), 2.0 * w * c, w * size))
            }
            ClosedLoop::LoadMotion => {
                found.extend(school(w, 2.0 * w * c, (w - point.load_motion.norm_sqr()) * size))
            }
            ClosedLoop::Tracking => {
                let d = limit(upper) / lower.map(limit).unwrap();
                for other in &template.points {
                    found.extend(pair(template, point, other, d * d, direction));
                }
            }
        }
    }
    GainIntervals::union_of(found)
}

/// Inequality |P_i G/(1 + L_i)| <= d |P_k G/(1 + L_k)| with x = P H/(P0 H0).
fn pair(
    template: &Template,
    i: &TemplatePoint,
    k: &TemplatePoint,
    d_squared: f64,
    direction: Complex64,
) -> Vec<[f64; 2]> {
    let (xi, xk) = (i.response / template.nominal, k.response / template.nominal);
    let (yi, yk) = (xi / i.sensor, xk / k.sensor);
    let (si, sk) = (yi.norm_sqr(), yk.norm_sqr());
    school(
        d_squared * sk * xi.norm_sqr() - si * xk.norm_sqr(),
        2.0 * (d_squared * sk * (xi * direction).re - si * (xk * direction).re),
        d_squared * sk - si,
    )
}

/// Gaps narrower than rounding errors are closed in both bounds, then every end must agree.
fn assert_same(found: &GainIntervals, expected: &GainIntervals, about: &str) {
    let closed = |union: &GainIntervals| {
        let widened = union.intervals().iter().map(|&[low, high]| [low, high * (1.0 + 1e-9)]);
        GainIntervals::union_of(
            widened.filter(|[low, high]| high - low > 3e-9 * high || high.is_infinite()).collect(),
        )
    };
    let (ours, theirs) = (closed(found), closed(expected));
    let agree = ours.intervals().len() == theirs.intervals().len()
        && ours
            .intervals()
            .iter()
            .flatten()
            .zip(theirs.intervals().iter().flatten())
            .all(|(ours, theirs)| ours == theirs || (ours - theirs).abs() <= 1e-9 * theirs.abs());
    assert!(agree, "{about}: {found:?} and plainly {expected:?}");
}

#[test]
fn the_same_intervals_as_the_plain_method() {
    let mut numbers = Numbers(0x2545_F491_4F6C_DD1D);
    let mut intervals = [0; 3];
    for trial in 0..300 {
        let template = random_template(&mut numbers);
        for requirement in random_requirements(&mut numbers, &template) {
            let function = BoundFunction::new(&template, &requirement, TemplateFill::Points).unwrap();
            for _ in 0..6 {
                let phase = numbers.between(-std::f64::consts::TAU, 0.0);
                let (found, expected) = (function.forbidden(phase), plain(&template, &requirement, phase));
                assert_same(&found, &expected, &format!("trial {trial}, {requirement:?}, {phase}"));
                intervals[found.intervals().len().min(2)] += 1;
            }
        }
    }
    assert!(intervals.iter().all(|&count| count > 100), "{intervals:?}");
}

#[test]
fn the_same_intervals_for_a_thousand_plants() {
    let mut numbers = Numbers(0x6A09_E667_F3BC_C909);
    for trial in 0..12 {
        let template = template_of(&mut numbers, 1000);
        for requirement in random_requirements(&mut numbers, &template) {
            let function = BoundFunction::new(&template, &requirement, TemplateFill::Points).unwrap();
            let tracking = requirement.is_tracking();
            for _ in 0..if tracking { 2 } else { 40 } {
                let phase = numbers.between(-std::f64::consts::TAU, 0.0);
                let (found, expected) = (function.forbidden(phase), plain(&template, &requirement, phase));
                assert_same(&found, &expected, &format!("trial {trial}, {requirement:?}, {phase}"));
            }
        }
    }
}
