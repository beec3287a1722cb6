//! Table `[sensor]`: the dynamics between the controlled output and the input of the controller.

use super::key::key;
use super::plant::Rational;
use super::visitor::Visitor;
use phea_quantity::TIME;

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
