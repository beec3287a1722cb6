//! Published values for a simulated step.

use phea_quantity::{PERCENT, TIME};
use phea_table::Visitor;
use phea_table::{key, plain};

/// Published metrics of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Published {
    /// Overshoot in percent of the step.
    pub overshoot_percent: Option<f64>,
    /// Settling time in s.
    pub settling_time: Option<f64>,
    /// Source of the publication.
    pub source: Option<String>,
    /// Remark for the reader.
    pub remark: Option<String>,
}

impl Published {
    pub(super) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("overshoot_percent", &PERCENT, "Overshoot, in percent of the step.").not_negative();
        v.optional(k, &mut self.overshoot_percent);
        let k = key("settling_time", &TIME, "Settling time.").positive();
        v.optional(k, &mut self.settling_time);
        v.text(plain("source", "Where it is published."), &mut self.source, true);
        v.text(plain("remark", "A remark for the reader."), &mut self.remark, false);
    }
}
