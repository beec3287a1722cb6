//! Reproducible random templates and requirements.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::template::{Resolution, Template, TemplatePoint};

/// Reproducible numbers in [0, 1) (Marsaglia 2003, xorshift).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A number between these two, uniform in its logarithm.
    pub(crate) fn factor(&mut self, low: f64, high: f64) -> f64 {
        portable::exp(self.between(portable::ln(low), portable::ln(high)))
    }

    pub(crate) fn polar(&mut self, magnitudes: [f64; 2], angles: [f64; 2]) -> Complex64 {
        let (magnitude, angle) =
            (self.factor(magnitudes[0], magnitudes[1]), self.between(angles[0], angles[1]));
        Complex64::new(magnitude * portable::cos(angle), magnitude * portable::sin(angle))
    }
}

/// A family with random spread, whose sensor is one, common to all plants, or different from plant
/// to plant.
pub(crate) fn random_template(numbers: &mut Numbers) -> Template {
    let count = numbers.factor(1.0, 120.0) as usize;
    template_of(numbers, count)
}

/// A random family with this number of plants.
pub(crate) fn template_of(numbers: &mut Numbers, count: usize) -> Template {
    let spread = [1.0, numbers.factor(1.01, 30.0)];
    let angles = [0.0, numbers.factor(0.01, 6.0)];
    let sensors = (numbers.next() * 3.0) as u32;
    let common = numbers.polar([0.2, 3.0], [-2.0, 0.0]);
    let unit = numbers.factor(1e-6, 1e6);
    let point = |member| {
        let sensor = match sensors {
            0 => Complex64::new(1.0, 0.0),
            1 => common,
            _ => common * numbers.polar([0.7, 1.4], [-0.2, 0.2]),
        };
        let response = numbers.polar(spread, angles) * unit * sensor;
        let load_motion = numbers.polar([0.01, 100.0], [-3.0, 3.0]);
        TemplatePoint { member: Some(member), values: vec![], response, load_motion, sensor }
    };
    let points: Vec<TemplatePoint> = (0..count.max(1)).map(point).collect();
    Template {
        frequency_rad_per_s: 1.0,
        nominal: points[0].response,
        points,
        outlines: vec![],
        resolution: Resolution::Members,
    }
}

/// Requirements of every kind, with limits on both sides of one and, if the textbook formula allows
/// it, sometimes one itself, relative to the limited quantity.
pub(crate) fn random_requirements(numbers: &mut Numbers, template: &Template) -> Vec<Requirement> {
    let mut limit = |unit: f64| {
        let one = unit == 1.0 && numbers.next() < 0.2;
        let factor = if one { 1.0 } else { numbers.factor(0.05, 20.0) };
        Limit::Constant(factor * unit)
    };
    let response = portable::magnitude(template.nominal);
    let sensor = portable::magnitude(template.points[0].sensor);
    let load_motion = portable::magnitude(template.points[0].load_motion);
    vec![
        Requirement::at_most(ClosedLoop::RobustStability, limit(1.0)),
        Requirement::at_most(ClosedLoop::Sensitivity, limit(1.0)),
        Requirement::at_most(ClosedLoop::PlantInputDisturbance, limit(response / sensor)),
        Requirement::at_most(ClosedLoop::ControlEffort, limit(1.0 / response)),
        Requirement::at_most(ClosedLoop::LoadMotion, limit(load_motion)),
        Requirement::tracking(Limit::Constant(1.0), limit(1.0)),
    ]
}
