//! Table `[sensor]`: the dynamics between the controlled output and the input of the controller.

use super::plant::Rational;
use phea_quantity::TIME;
use phea_table::Visitor;
use phea_table::key;

/// Dynamics H of the sensor; if absent, 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensor {
    /// Numerator and denominator in s.
    pub transfer: Rational,
    /// Dead time, s.
    pub delay: f64,
}

impl Sensor {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        self.transfer.visit(v);
        v.quantity(key("delay", &TIME, "Dead time of the sensor.").not_negative().or(0.0), &mut self.delay);
    }
}
