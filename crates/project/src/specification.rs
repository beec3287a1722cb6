//! `[[specification]]`: a requirement on the closed loop.

use super::key::{key, plain};
use super::limit::DeclaredLimit;
use super::visitor::Visitor;
use phea_dynamics::closed_loop::ClosedLoop;
use phea_quantity::ANGULAR_FREQUENCY;

/// One specification.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSpecification {
    /// Which closed loop is limited.
    pub kind: ClosedLoop,
    /// Upper limit; for every kind except tracking.
    pub limit: Option<DeclaredLimit>,
    /// Upper limit of tracking.
    pub upper: Option<DeclaredLimit>,
    /// Lower limit of tracking.
    pub lower: Option<DeclaredLimit>,
    /// rad/s, where bounds are drawn.
    pub frequencies: Vec<f64>,
    /// rad/s, where it must hold; absent: the span of `frequencies`.
    pub band: Option<[f64; 2]>,
}

/// The words of `kind`, by which answers and certificates call a closed loop too.
pub static SPECIFICATION_KINDS: [(&str, ClosedLoop); 6] = [
    ("robust_stability", ClosedLoop::RobustStability),
    ("sensitivity", ClosedLoop::Sensitivity),
    ("plant_input_disturbance", ClosedLoop::PlantInputDisturbance),
    ("control_effort", ClosedLoop::ControlEffort),
    ("load_motion", ClosedLoop::LoadMotion),
    ("tracking", ClosedLoop::Tracking),
];

impl DeclaredSpecification {
    /// Where it must hold, rad/s: the declared band, or the span of the frequencies.
    pub fn band_rad_per_s(&self) -> [f64; 2] {
        let first = self.frequencies.first().copied().unwrap_or(0.0);
        let last = self.frequencies.last().copied().unwrap_or(0.0);
        self.band.unwrap_or([first, last])
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.choice(plain("kind", "Which closed loop is limited."), &SPECIFICATION_KINDS, &mut self.kind, true);
        DeclaredLimit::visit("limit", "Upper limit, of every kind but tracking.", &mut self.limit, v);
        DeclaredLimit::visit("upper", "Upper limit of tracking.", &mut self.upper, v);
        DeclaredLimit::visit("lower", "Lower limit of tracking.", &mut self.lower, v);
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Where bounds are drawn, increasing.").positive();
        v.quantities(k, &mut self.frequencies, false);
        let k = key("band", &ANGULAR_FREQUENCY, "Where it must hold; absent: the span of `frequencies`.");
        v.pair(k.not_negative().or_infinite(), &mut self.band);
    }
}
