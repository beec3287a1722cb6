//! Limit and weight that a requirement imposes on one plant, in the q-plane.

use num_complex::Complex64;
use phea_dynamics::closed_loop::PlantPath;
use phea_dynamics::portable;

use super::BoundError;
use super::ceiling::CeilingPlant;
use super::fill::Edge;
use super::inequality::{InequalityForm, WeightedPlant};
use super::power_of_two::power_of_two;
use crate::specification::{ClosedLoop, Limit, Requirement};
use crate::template::{Template, TemplatePoint};

/// A requirement at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rule {
    closed_loop: ClosedLoop,
    /// Limit W; upper/lower for tracking.
    limit: f64,
    /// Nominal response P0 H0.
    nominal: Complex64,
}

impl Rule {
    pub(super) fn new(requirement: &Requirement, template: &Template) -> Result<Rule, BoundError> {
        let frequency_rad_per_s = template.frequency_rad_per_s;
        let at = |limit: &Limit| {
            limit.magnitude(frequency_rad_per_s).ok_or(BoundError::NoLimit { frequency_rad_per_s })
        };
        let limit = match requirement.limits() {
            (None, upper) => at(upper)?,
            (Some(lower), upper) => at(upper)? / at(lower)?,
        };
        if limit.is_nan() || limit < 0.0 {
            return Err(BoundError::Limit { frequency_rad_per_s, limit });
        }
        if !is_response(template.nominal) {
            return Err(BoundError::Nominal { frequency_rad_per_s });
        }
        Ok(Rule { closed_loop: requirement.closed_loop(), limit, nominal: template.nominal })
    }

    /// True if no limit applies.
    pub(super) fn is_idle(&self) -> bool {
        self.limit == f64::INFINITY
    }

    pub(super) fn form(&self) -> InequalityForm {
        match self.closed_loop {
            ClosedLoop::Tracking => InequalityForm::Spread,
            closed_loop if closed_loop.has_feedback() => InequalityForm::Complementary,
            _ => InequalityForm::Sensitivity,
        }
    }

    /// True if more than P H of a plant is needed.
    pub(super) fn needs_paths(&self) -> bool {
        matches!(self.closed_loop.plant_path(), PlantPath::Plant | PlantPath::LoadMotion)
    }

    /// A plant with its limit and weight.
    ///
    /// ```text
    /// |T| <= W: (W, 1)    |S| <= W: (W, 1)    |P S| <= W: (W, |P|)    |Pd S| <= W: (W, |Pd|)
    /// |G S| = |T|/|P H| <= W: (W |P H|, 1)    |T_i| <= d |T_k|: (d |H_i|, 1), and |H_k| goes with |q_k + L0|
    /// ```
    ///
    /// `None` for a response that is zero or not finite.
    pub(super) fn plant(&self, point: &TemplatePoint) -> Option<WeightedPlant> {
        let inverse = self.nominal / point.response;
        let response = || portable::magnitude(point.response);
        let sensor = || portable::magnitude(point.sensor);
        let (limit, weight) = match self.closed_loop {
            ClosedLoop::RobustStability | ClosedLoop::Sensitivity => scaled(self.limit, 1.0),
            ClosedLoop::PlantInputDisturbance => scaled(self.limit, response() / sensor()),
            ClosedLoop::LoadMotion => scaled(self.limit, portable::magnitude(point.load_motion)),
            ClosedLoop::ControlEffort => scaled(self.limit * response(), 1.0),
            ClosedLoop::Tracking => (self.limit / self.tracking_scale() * sensor(), 1.0),
        };
        let sound =
            is_response(point.response) && is_response(inverse) && limit.is_finite() && weight.is_finite();
        sound.then(|| WeightedPlant { inverse, modulus: modulus(inverse), limit, weight })
    }

    /// The reference for the plants: for tracking every plant with its |H|, otherwise |L0| itself.
    pub(super) fn candidate(&self, plant: &WeightedPlant, point: &TemplatePoint) -> CeilingPlant {
        let weight = portable::magnitude(point.sensor) / self.tracking_scale();
        CeilingPlant { inverse: plant.inverse, modulus: plant.modulus, weight }
    }

    /// The contour between two plants.
    pub(super) fn edge(&self, ends: [&WeightedPlant; 2], points: [&TemplatePoint; 2]) -> Edge {
        let [from, to] = points;
        match self.closed_loop {
            ClosedLoop::RobustStability | ClosedLoop::Tracking => Edge::of_complementary(ends),
            ClosedLoop::ControlEffort => {
                Edge::of_control_effort(ends, self.limit * portable::magnitude(self.nominal))
            }
            ClosedLoop::Sensitivity => {
                Edge::of_sensitivity(ends, ends.map(|plant| plant.inverse), self.limit)
            }
            ClosedLoop::PlantInputDisturbance => {
                Edge::of_sensitivity(ends, [from, to].map(|point| self.nominal / point.sensor), self.limit)
            }
            ClosedLoop::LoadMotion => Edge::of_sensitivity(
                ends,
                [from, to].map(|point| point.load_motion * self.nominal / point.response),
                self.limit,
            ),
        }
    }

    /// Scale common to all plants, since they are compared with each other.
    fn tracking_scale(&self) -> f64 {
        power_of_two(self.limit.max(1.0))
    }
}

/// True if a plant can have this response: neither zero nor infinite.
fn is_response(value: Complex64) -> bool {
    value.is_finite() && value != Complex64::new(0.0, 0.0)
}

/// Magnitude |z|, by the fast formula unless it might overflow or lose digits.
fn modulus(value: Complex64) -> f64 {
    let square = value.norm_sqr();
    if square > 1e-280 && square < 1e280 { square.sqrt() } else { portable::magnitude(value) }
}

/// Limit and weight over a power of two common to both, so that neither square overflows. If both
/// underflow to zero, nothing can be violated.
fn scaled(limit: f64, weight: f64) -> (f64, f64) {
    let scale = power_of_two(limit.max(weight));
    if limit == 0.0 && weight == 0.0 { (1.0, 0.0) } else { (limit / scale, weight / scale) }
}
