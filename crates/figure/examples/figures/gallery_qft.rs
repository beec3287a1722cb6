//! Figures of two published examples: k/((s + a)(s + b)) with a controller that fails between its
//! design frequencies, and k a/(s (s + a)) with a prefilter.

#![allow(clippy::unwrap_used, reason = "published examples are what they are")]

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{cos, magnitude, pow, sin};
use phea_dynamics::time_response::{step_response, uniform_times};
use phea_figure::*;
use phea_qft::bound::{Bound, BoundFunction, TemplateFill};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::template::{Resolution, Template, TemplatePoint};

/// Every figure once.
pub(crate) fn all() -> Vec<Figure> {
    vec![
        stability_bounds(),
        specifications(),
        worst_case(),
        with_dead_time(),
        templates_of_servo(),
        complementary_sensitivity(),
        tracking(),
        steps(),
    ]
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

/// k and a around the box of k a/(s (s + a)), from 1 to 10 each, beginning with the nominal plant
/// (1, 1).
fn servo_parameters() -> Vec<(f64, f64)> {
    let steps = frequencies(1.0, 10.0, 7);
    let (up, down): (Vec<f64>, Vec<f64>) = (steps.clone(), steps.into_iter().rev().collect());
    let sides = [(&up, 1.0, true), (&up, 10.0, false), (&down, 10.0, true), (&down, 1.0, false)];
    let mut around = Vec::new();
    for (values, other, moves_gain) in sides {
        for &value in values.iter().take(values.len() - 1) {
            around.push(if moves_gain { (value, other) } else { (other, value) });
        }
    }
    around
}

fn servo() -> Vec<Plant> {
    let plant = |(k, a): (f64, f64)| -> Plant { Box::new(move |s| k * a / (s * (s + a))) };
    servo_parameters().into_iter().map(plant).collect()
}

fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients.to_vec())
}

fn ratio(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

// ORIGIN: paper, controller and prefilter published for this servo.
const SERVO_CONTROLLER: ([f64; 3], [f64; 4]) =
    ([3.0787e6, 3.5365e8, 3.8529e8], [1.0, 1528.8, 1.0636e6, 4.281e7]);

fn servo_controller(s: Complex64) -> Complex64 {
    let (numerator, denominator) = SERVO_CONTROLLER;
    polynomial(&numerator).evaluate(s) / polynomial(&denominator).evaluate(s)
}

/// F L/(1 + L) of the servo, F = 1/(s^2/16 + 0.35 s + 1).
fn servo_tracking((k, a): (f64, f64)) -> TransferFunction {
    let (numerator, denominator) = SERVO_CONTROLLER;
    let forward = polynomial(&numerator).scaled(k * a);
    let characteristic = polynomial(&denominator).product(&polynomial(&[1.0, a, 0.0])).sum(&forward);
    let loop_closed = TransferFunction::from_polynomials(&forward, &characteristic).unwrap();
    loop_closed.series(&ratio(&[1.0], &[1.0 / 16.0, 0.35, 1.0])).unwrap()
}

/// Upper and lower limit of tracking.
fn tracking_limits() -> [TransferFunction; 2] {
    [ratio(&[0.6584, 0.6584 * 30.0], &[1.0, 4.0, 19.752]), ratio(&[120.0], &[1.0, 17.0, 82.0, 120.0])]
}

/// The controller of the first example that fails at 67 rad/s.
fn lag_controller(s: Complex64) -> Complex64 {
    379.0 * (s / 42.0 + 1.0) / (s / 165.0 + 1.0)
}

fn response(of: impl Fn(Complex64) -> Complex64, frequencies: &[f64]) -> Vec<Complex64> {
    frequencies.iter().map(|w| of(Complex64::new(0.0, *w))).collect()
}

/// Over phases two degrees apart, of the listed plants only.
fn bound(plants: &[Plant], requirement: &Requirement, frequency: f64) -> Bound {
    let function =
        BoundFunction::new(&template(plants, frequency, false), requirement, TemplateFill::Points).unwrap();
    let phases_rad: Vec<f64> = evenly(-360.0, 0.0, 181).into_iter().map(f64::to_radians).collect();
    let forbidden = phases_rad.iter().map(|phase| function.forbidden(*phase)).collect();
    Bound { frequency_rad_per_s: frequency, phases_rad, forbidden }
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
    let bounds: Vec<Bound> = SERVO_FREQUENCIES
        .iter()
        .map(|w| bound(&plants, &Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)), *w))
        .collect();
    let templates: Vec<Template> = [1.0, 10.0, 100.0].iter().map(|w| template(&plants, *w, true)).collect();
    let w = frequencies(0.05, 3000.0, 400);
    let chart = NicholsChart {
        loops: vec![FrequencySeries {
            name: "nominal loop L_0".to_string(),
            response: response(|s| plants[0](s) * servo_controller(s), &w),
            frequencies_rad_per_s: w,
        }],
        design_frequencies_rad_per_s: SERVO_FREQUENCIES.to_vec(),
        bounds: vec![BoundGroup { name: "bounds |T| ≤ 1.2".to_string(), bounds: &bounds }],
        templates: &templates,
        contours_db: nichols::USUAL_CONTOURS_DB.to_vec(),
        ..NicholsChart::default()
    };
    let caption =
        "The nominal loop of a servo stays outside the bounds of robust stability at every design frequency.";
    chart.draw(&Words::new("nichols-stability", "Robust stability on the Nichols chart", caption))
}

fn bounds_of_double_lag() -> [Vec<Bound>; 3] {
    let plants = double_lag();
    let sensitivity = ratio(&[0.02, 1.28, 14.96, 48.0], &[1.0, 14.4, 169.0]);
    let low = [0.1, 5.0, 10.0];
    let at = |frequencies: &[f64], requirement: Requirement| -> Vec<Bound> {
        frequencies.iter().map(|w| bound(&plants, &requirement, *w)).collect()
    };
    [
        at(&[0.1, 5.0, 10.0, 100.0], Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2))),
        at(&low, Requirement::at_most(ClosedLoop::Sensitivity, Limit::Rational(sensitivity))),
        at(&low, Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(0.01))),
    ]
}

fn specifications() -> Figure {
    let bounds = bounds_of_double_lag();
    let names = ["|T| ≤ 1.2", "|S|", "|P S| ≤ 0.01"];
    let groups = names.iter().zip(&bounds);
    let chart = NicholsChart {
        bounds: groups.map(|(name, bounds)| BoundGroup { name: (*name).to_string(), bounds }).collect(),
        ..NicholsChart::default()
    };
    let caption = "Bounds of stability, sensitivity and disturbances, each with its forbidden side.";
    chart.draw(&Words::new("bounds-specifications", "Bounds of three specifications", caption))
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
    let chart = NicholsChart {
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
        ..NicholsChart::default()
    };
    let caption = "Every design frequency keeps to its bound, and the loop fails between two of them.";
    chart.draw(&Words::new("nichols-worst-case", "Worst-case bounds and the loop", caption))
}

/// e^(-0.1 s) k/(s + 1) under 4(s + 1)/s, k from 1 to 2: the phase falls without end.
fn with_dead_time() -> Figure {
    let plant = |k: f64| -> Plant {
        Box::new(move |s| Complex64::new(cos(-0.1 * s.im), sin(-0.1 * s.im)) * k / (s + 1.0))
    };
    let plants = evenly(1.0, 2.0, 9).into_iter().map(plant).collect::<Vec<_>>();
    let design = [1.0, 5.0, 10.0, 30.0, 60.0];
    let bounds: Vec<Bound> = design
        .iter()
        .map(|w| bound(&plants, &Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.5)), *w))
        .collect();
    let w = frequencies(0.1, 200.0, 600);
    let chart = NicholsChart {
        loops: vec![FrequencySeries {
            name: "nominal loop L_0".to_string(),
            response: response(|s| plants[0](s) * 4.0 * (s + 1.0) / s, &w),
            frequencies_rad_per_s: w,
        }],
        design_frequencies_rad_per_s: design.to_vec(),
        bounds: vec![BoundGroup { name: "bounds |T| ≤ 1.5".to_string(), bounds: &bounds }],
        contours_db: vec![3.5, 0.0, -6.0, -20.0],
        ..NicholsChart::default()
    };
    let caption = "Dead time turns the loop on and on; chart and bounds go along.";
    chart.draw(&Words::new("nichols-dead-time", "A loop with dead time", caption))
}

fn templates_of_servo() -> Figure {
    let plants = servo();
    let all: Vec<Template> = SERVO_FREQUENCIES.iter().map(|w| template(&plants, *w, true)).collect();
    let caption = "Where the plants of the servo lie at each design frequency.";
    templates(&Words::new("templates", "Templates of the servo", caption), &all)
}

/// Curve over frequencies.
fn curve(frequencies: &[f64], magnitudes: Vec<f64>) -> MagnitudeCurve {
    MagnitudeCurve { frequencies_rad_per_s: frequencies.to_vec(), magnitudes }
}

fn envelope(members: &[MagnitudeCurve], choose: fn(f64, f64) -> f64) -> MagnitudeCurve {
    let mut chosen = members[0].clone();
    for member in members {
        for (value, other) in chosen.magnitudes.iter_mut().zip(&member.magnitudes) {
            *value = choose(*value, *other);
        }
    }
    chosen
}

fn complementary_sensitivity() -> Figure {
    let w = frequencies(0.1, 2000.0, 300);
    let plants = double_lag();
    let closed = |plant: &Plant, s: Complex64| {
        let open = plant(s) * lag_controller(s);
        magnitude(open / (1.0 + open))
    };
    let members: Vec<MagnitudeCurve> = plants
        .iter()
        .map(|plant| curve(&w, w.iter().map(|w| closed(plant, Complex64::new(0.0, *w))).collect()))
        .collect();
    let greatest = envelope(&members, f64::max);
    let peaks = greatest.magnitudes.iter().zip(&w);
    let (peak, at) = peaks.max_by(|a, b| a.0.total_cmp(b.0)).unwrap();
    let chart = FamilyMagnitude {
        quantity: "|T| = |L/(1+L)|".to_string(),
        upper_limit: Some(curve(&[0.1, 2000.0], vec![1.2, 1.2])),
        marks: vec![MagnitudeMark {
            frequency_rad_per_s: *at,
            magnitude: *peak,
            text: "0.25 dB over at 67 rad/s".to_string(),
            is_violation: true,
        }],
        envelopes: vec![FamilyEnvelope { greatest, ..FamilyEnvelope::default() }],
        members,
        design_frequencies_rad_per_s: vec![0.1, 5.0, 10.0, 100.0],
        ..FamilyMagnitude::default()
    };
    let caption =
        "The family meets the limit at every design frequency and exceeds it between 10 and 100 rad/s.";
    chart.draw(&Words::new("family-stability", "Robust stability over frequency", caption))
}

fn tracking() -> Figure {
    let w = frequencies(0.05, 50.0, 200);
    let of = |system: &TransferFunction, w: &[f64]| {
        curve(w, w.iter().map(|w| magnitude(system.at_frequency(*w))).collect())
    };
    let band = frequencies(0.05, 10.0, 120);
    let [upper, lower] = tracking_limits().map(|limit| of(&limit, &band));
    let members: Vec<MagnitudeCurve> =
        servo_parameters().into_iter().map(|parameters| of(&servo_tracking(parameters), &w)).collect();
    let chart = FamilyMagnitude {
        quantity: "|F L/(1+L)|".to_string(),
        upper_limit: Some(upper),
        lower_limit: Some(lower),
        envelopes: vec![FamilyEnvelope {
            name: String::new(),
            greatest: envelope(&members, f64::max),
            least: Some(envelope(&members, f64::min)),
        }],
        marks: vec![MagnitudeMark {
            frequency_rad_per_s: 10.0,
            magnitude: magnitude(servo_tracking((1.0, 1.0)).at_frequency(10.0)),
            text: "nominal at 10 rad/s".to_string(),
            is_violation: false,
        }],
        members,
        design_frequencies_rad_per_s: vec![0.1, 0.5, 1.0, 2.0, 10.0],
        ..FamilyMagnitude::default()
    };
    let caption = "The family follows its reference between the two limits.";
    chart.draw(&Words::new("family-tracking", "Tracking over frequency", caption))
}

fn steps() -> Figure {
    let times = uniform_times(4.0, 300).unwrap();
    let series = |name: &str, system: &TransferFunction| TimeSeries {
        name: name.to_string(),
        times_s: times.clone(),
        values: step_response(system, &times).unwrap(),
    };
    let [upper, lower] = tracking_limits();
    let chart = FamilySteps {
        quantity: "Position, part of the step".to_string(),
        band: Some(TimeBand {
            name: "band of the limits".to_string(),
            upper: series("upper", &upper),
            lower: series("lower", &lower),
        }),
        members: servo_parameters().into_iter().map(|p| series("", &servo_tracking(p))).collect(),
        nominal: Some(series("nominal plant", &servo_tracking((1.0, 1.0)))),
        named: vec![],
    };
    let caption = "Step responses of the servo inside the band of the responses of the limits.";
    chart.draw(&Words::new("family-steps", "Step responses of the family", caption))
}
