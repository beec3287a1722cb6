//! Table `[[specification]]`: a requirement on the closed loop.

use super::limit::DeclaredLimit;
use phea_dynamics::closed_loop::ClosedLoop;
use phea_quantity::{ANGULAR_FREQUENCY, FORCE, PERCENT, TIME};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Subject of a specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpecificationKind {
    /// Magnitude of a closed loop over frequency.
    ClosedLoop(ClosedLoop),
    /// Response to a step of the reference over time.
    Step,
}

impl Default for SpecificationKind {
    fn default() -> Self {
        SpecificationKind::ClosedLoop(ClosedLoop::default())
    }
}

/// Requirement as declared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSpecification {
    /// Limited quantity.
    pub kind: SpecificationKind,
    /// Upper limit; for every kind except tracking.
    pub limit: Option<DeclaredLimit>,
    /// Upper limit of tracking.
    pub upper: Option<DeclaredLimit>,
    /// Lower limit of tracking.
    pub lower: Option<DeclaredLimit>,
    /// Frequencies of the bounds, rad/s.
    pub frequencies: Vec<f64>,
    /// Band in which it must hold, rad/s; if absent, the span of `frequencies`.
    pub band: Option<[f64; 2]>,
    /// Requirements on a step; for the kind `step`.
    pub step: RequiredStep,
}

/// Requirements on the response to a reference step, for every plant and every run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RequiredStep {
    /// Largest overshoot, percent of the step.
    pub overshoot_percent: Option<f64>,
    /// Latest settling time, s.
    pub settling_time: Option<f64>,
    /// Band of the settling time, percent of the step; if absent, [`SETTLING_BAND_PERCENT`].
    pub settling_band_percent: Option<f64>,
    /// Longest time from 10 to 90 percent of the step, s.
    pub rise_time: Option<f64>,
    /// Size of the step on the nonlinear rig, N, with the sign of its direction; if absent, a tenth
    /// of the force that the supply can produce.
    pub amplitude: Option<f64>,
    /// Initial force of the step on the nonlinear rig, N; if absent, that of the operating point.
    pub initial_force: Option<f64>,
}

/// Default settling band, percent of a step.
pub const SETTLING_BAND_PERCENT: f64 = 2.0;

/// Words of `kind`, which results and certificates also use for a closed loop.
pub static SPECIFICATION_KINDS: [(&str, SpecificationKind); 7] = [
    ("robust_stability", SpecificationKind::ClosedLoop(ClosedLoop::RobustStability)),
    ("sensitivity", SpecificationKind::ClosedLoop(ClosedLoop::Sensitivity)),
    ("plant_input_disturbance", SpecificationKind::ClosedLoop(ClosedLoop::PlantInputDisturbance)),
    ("control_effort", SpecificationKind::ClosedLoop(ClosedLoop::ControlEffort)),
    ("load_motion", SpecificationKind::ClosedLoop(ClosedLoop::LoadMotion)),
    ("tracking", SpecificationKind::ClosedLoop(ClosedLoop::Tracking)),
    ("step", SpecificationKind::Step),
];

impl DeclaredSpecification {
    /// Closed loop whose magnitude is limited; `None` for a requirement in time.
    pub fn closed_loop(&self) -> Option<ClosedLoop> {
        match self.kind {
            SpecificationKind::ClosedLoop(closed_loop) => Some(closed_loop),
            SpecificationKind::Step => None,
        }
    }

    /// Band in which it must hold, rad/s: the declared band, or the span of the frequencies.
    pub fn band_rad_per_s(&self) -> [f64; 2] {
        let first = self.frequencies.first().copied().unwrap_or(0.0);
        let last = self.frequencies.last().copied().unwrap_or(0.0);
        self.band.unwrap_or([first, last])
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("kind", "Which closed loop is limited, or \"step\": what is required in time.");
        v.choice(k, &SPECIFICATION_KINDS, &mut self.kind, true);
        DeclaredLimit::visit("limit", "Upper limit, of a closed loop but tracking.", &mut self.limit, v);
        DeclaredLimit::visit("upper", "Upper limit of tracking.", &mut self.upper, v);
        DeclaredLimit::visit("lower", "Lower limit of tracking.", &mut self.lower, v);
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Where bounds are drawn, increasing.").positive();
        v.quantities(k, &mut self.frequencies, false);
        let k = key("band", &ANGULAR_FREQUENCY, "Where it must hold; absent: the span of `frequencies`.");
        v.pair(k.not_negative().or_infinite(), &mut self.band);
        self.step.visit(v);
    }
}

impl RequiredStep {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("overshoot_percent", &PERCENT, "Largest overshoot, in percent of the step; of \"step\".");
        v.optional(k.not_negative().below(100.0), &mut self.overshoot_percent);
        let k = key("settling_time", &TIME, "Largest settling time; of \"step\".").positive();
        v.optional(k, &mut self.settling_time);
        let k =
            key("settling_band_percent", &PERCENT, "Band of the settling time; absent: 2 %; of \"step\".");
        v.optional(k.positive().below(100.0), &mut self.settling_band_percent);
        let k = key("rise_time", &TIME, "Longest rise from 10 to 90 %; of \"step\".").positive();
        v.optional(k, &mut self.rise_time);
        let k = key("amplitude", &FORCE, "Size of the step on the nonlinear rig, signed; of \"step\".");
        v.optional(k.of_motion(), &mut self.amplitude);
        let k = key("initial_force", &FORCE, "Force before the step on the nonlinear rig; of \"step\".");
        v.optional(k.of_motion(), &mut self.initial_force);
    }
}
