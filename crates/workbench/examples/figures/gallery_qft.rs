//! Figures of two published examples: k/((s + a)(s + b)) with a controller that fails between its design frequencies, and
//! k a/(s (s + a)) with a prefilter. Bounds from the quadratics of each plant, plant by plant.

use num_complex::Complex64;
use phea_dynamics::portable::{cos, magnitude, pow, sin};
use phea_qft::bound::{Bound, GainIntervals};
use phea_qft::template::{Resolution, Template, TemplatePoint};
use phea_workbench::figure::*;

/// Every figure once.
pub(crate) fn all() -> Vec<Figure> {
    vec![stability_bounds(), specifications(), worst_case(), templates_of_servo()]
}

fn frequencies(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from * pow(to / from, i as f64 / (count - 1) as f64)).collect()
}

fn evenly(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// A plant of either example as its response at s.
type Plant = Box<dyn Fn(Complex64) -> Complex64>;

/// k/((s + a)(s + b)), the nominal plant (1, 5, 30) first.
fn double_lag() -> Vec<Plant> {
    let plant = |k: f64, a: f64, b: f64| -> Plant { Box::new(move |s| k / ((s + a) * (s + b))) };
    let mut plants = vec![plant(1.0, 5.0, 30.0)];
    plants.extend(evenly(1.0, 5.0, 10).into_iter().flat_map(|a| [plant(10.0, a, 20.0), plant(1.0, a, 30.0)]));
    plants.extend(evenly(1.0, 10.0, 10).into_iter().flat_map(|k| [plant(k, 5.0, 30.0), plant(k, 1.0, 20.0)]));
    plants
}

/// Around the box of k a/(s (s + a)), k and a from 1 to 10, beginning with the nominal plant (1, 1).
fn servo() -> Vec<Plant> {
    let steps = frequencies(1.0, 10.0, 7);
    let (up, down): (Vec<f64>, Vec<f64>) = (steps.clone(), steps.into_iter().rev().collect());
    let sides = [(&up, 1.0, true), (&up, 10.0, false), (&down, 10.0, true), (&down, 1.0, false)];
    let mut plants: Vec<Plant> = Vec::new();
    for (values, other, moves_gain) in sides {
        for &value in values.iter().take(values.len() - 1) {
            let (k, a) = if moves_gain { (value, other) } else { (other, value) };
            plants.push(Box::new(move |s| k * a / (s * (s + a))));
        }
    }
    plants
}

fn servo_controller(s: Complex64) -> Complex64 {
    ((3.0787e6 * s + 3.5365e8) * s + 3.8529e8) / (((s + 1528.8) * s + 1.0636e6) * s + 4.281e7)
}

/// The controller of the first example that fails at 67 rad/s.
fn lag_controller(s: Complex64) -> Complex64 {
    379.0 * (s / 42.0 + 1.0) / (s / 165.0 + 1.0)
}

fn response(of: impl Fn(Complex64) -> Complex64, frequencies: &[f64]) -> Vec<Complex64> {
    frequencies.iter().map(|w| of(Complex64::new(0.0, *w))).collect()
}

/// Which closed loop is limited.
#[derive(Clone, Copy)]
enum Limited {
    Complementary,
    Sensitivity,
    PlantInput,
}

/// The gains that one plant forbids at one phase: between the roots of a g^2 + b g + c, or outside of them.
fn forbidden(
    limited: Limited,
    plant: Complex64,
    nominal: Complex64,
    limit: f64,
    phase: f64,
) -> Vec<[f64; 2]> {
    let ratio = nominal / plant;
    let (square, q) = (limit * limit, ratio.norm_sqr());
    let c = (ratio.conj() * Complex64::new(cos(phase), sin(phase))).re;
    let (a, b, c) = match limited {
        Limited::Complementary => (square - 1.0, 2.0 * square * c, square * q),
        Limited::Sensitivity => (square, 2.0 * square * c, (square - 1.0) * q),
        Limited::PlantInput => (square, 2.0 * square * c, square * q - nominal.norm_sqr()),
    };
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return Vec::new();
    }
    let root = discriminant.sqrt();
    vec![[((-b - root) / (2.0 * a)).max(0.0), ((-b + root) / (2.0 * a)).max(0.0)]]
}

fn bound(plants: &[Plant], limited: Limited, limit: impl Fn(Complex64) -> f64, frequency: f64) -> Bound {
    let s = Complex64::new(0.0, frequency);
    let nominal = plants[0](s);
    let phases: Vec<f64> = (0..=180).map(|i| (2.0 * f64::from(i) - 360.0).to_radians()).collect();
    let forbidden = phases.iter().map(|phase| {
        let all = plants.iter().flat_map(|p| forbidden(limited, p(s), nominal, limit(s), *phase));
        GainIntervals::union_of(all.collect())
    });
    Bound { frequency_rad_per_s: frequency, forbidden: forbidden.collect(), phases_rad: phases }
}

fn template(plants: &[Plant], frequency: f64, is_filled: bool) -> Template {
    let s = Complex64::new(0.0, frequency);
    let point = |(member, plant): (usize, &Plant)| TemplatePoint {
        member: Some(member),
        values: vec![],
        response: plant(s),
        load_motion: Complex64::new(0.0, 0.0),
        sensor: Complex64::new(1.0, 0.0),
    };
    let points: Vec<TemplatePoint> = plants.iter().enumerate().map(point).collect();
    let outline = points.iter().map(|point| point.response).collect();
    Template {
        frequency_rad_per_s: frequency,
        nominal: plants[0](s),
        points,
        outlines: if is_filled { vec![outline] } else { vec![] },
        resolution: Resolution::Members,
    }
}

const SERVO_FREQUENCIES: [f64; 7] = [0.1, 0.5, 1.0, 2.0, 10.0, 15.0, 100.0];

fn stability_bounds() -> Figure {
    let plants = servo();
    let bounds: Vec<Bound> =
        SERVO_FREQUENCIES.iter().map(|w| bound(&plants, Limited::Complementary, |_| 1.2, *w)).collect();
    let templates: Vec<Template> = [1.0, 10.0, 100.0].iter().map(|w| template(&plants, *w, true)).collect();
    let w = frequencies(0.05, 3000.0, 400);
    let input = NicholsInput {
        loops: vec![FrequencySeries {
            name: "nominal loop L_0".to_string(),
            response: response(|s| plants[0](s) * servo_controller(s), &w),
            frequencies_rad_per_s: w,
        }],
        design_frequencies_rad_per_s: SERVO_FREQUENCIES.to_vec(),
        bounds: vec![BoundGroup { name: "bounds |T| ≤ 1.2".to_string(), bounds: &bounds }],
        templates: &templates,
        contours_db: nichols::USUAL_CONTOURS_DB.to_vec(),
        ..NicholsInput::default()
    };
    let caption =
        "The nominal loop of a servo stays outside the bounds of robust stability at every design frequency.";
    nichols(Words::new("nichols-stability", "Robust stability on the Nichols chart", caption), &input)
}

fn sensitivity_limit(s: Complex64) -> f64 {
    0.02 * magnitude(((s + 64.0) * s + 748.0) * s + 2400.0) / magnitude((s + 14.4) * s + 169.0)
}

fn bounds_of_double_lag() -> [Vec<Bound>; 3] {
    let plants = double_lag();
    [
        [0.1, 5.0, 10.0, 100.0].map(|w| bound(&plants, Limited::Complementary, |_| 1.2, w)).to_vec(),
        [0.1, 5.0, 10.0].map(|w| bound(&plants, Limited::Sensitivity, sensitivity_limit, w)).to_vec(),
        [0.1, 5.0, 10.0].map(|w| bound(&plants, Limited::PlantInput, |_| 0.01, w)).to_vec(),
    ]
}

fn specifications() -> Figure {
    let bounds = bounds_of_double_lag();
    let names = ["|T| ≤ 1.2", "|S|", "|P S| ≤ 0.01"];
    let groups = names.iter().zip(&bounds);
    let input = NicholsInput {
        bounds: groups.map(|(name, bounds)| BoundGroup { name: (*name).to_string(), bounds }).collect(),
        ..NicholsInput::default()
    };
    let caption = "Bounds of stability, sensitivity and disturbances, each with its forbidden side.";
    nichols(Words::new("bounds-specifications", "Bounds of three specifications", caption), &input)
}

fn worst_case() -> Figure {
    let plants = double_lag();
    let [mut bounds, others @ ..] = bounds_of_double_lag();
    for bound in &mut bounds {
        for other in others.iter().flatten().filter(|o| o.frequency_rad_per_s == bound.frequency_rad_per_s) {
            let pairs = bound.forbidden.iter().zip(&other.forbidden);
            bound.forbidden = pairs.map(|(a, b)| a.union(b)).collect();
        }
    }
    let w = frequencies(0.05, 3000.0, 400);
    let at = Complex64::new(0.0, 67.0);
    let input = NicholsInput {
        loops: vec![FrequencySeries {
            name: "nominal loop L_0".to_string(),
            response: response(|s| plants[0](s) * lag_controller(s), &w),
            frequencies_rad_per_s: w,
        }],
        design_frequencies_rad_per_s: vec![0.1, 5.0, 10.0, 100.0],
        bounds: vec![BoundGroup { name: "worst-case bounds".to_string(), bounds: &bounds }],
        violations: vec![OpenLoopViolation {
            frequency_rad_per_s: 67.0,
            open_loop: lag_controller(at) * 10.0 / ((at + 1.0) * (at + 20.0)),
            text: "|T| 0.25 dB over at 67 rad/s".to_string(),
        }],
        contours_db: nichols::USUAL_CONTOURS_DB.to_vec(),
        ..NicholsInput::default()
    };
    let caption = "Every design frequency keeps to its bound, and the loop fails between two of them.";
    nichols(Words::new("nichols-worst-case", "Worst-case bounds and the loop", caption), &input)
}

fn templates_of_servo() -> Figure {
    let plants = servo();
    let all: Vec<Template> = SERVO_FREQUENCIES.iter().map(|w| template(&plants, *w, true)).collect();
    let caption = "Where the plants of the servo lie at each design frequency.";
    templates(Words::new("templates", "Templates of the servo", caption), &all)
}
