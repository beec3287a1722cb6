//! Table `[cylinder.end_stops]`, and that of a motor.

use phea_quantity::{INVERSE_VELOCITY, STIFFNESS};
use phea_table::{TableNumber, Visitor, key};

use super::Contact;

impl<S: TableNumber> Contact<S> {
    /// Visits the table of the end stops at both ends of the stroke.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(key("stiffness", &STIFFNESS, "Of each stop.").of_motion().positive(), &mut self.stiffness);
        let k =
            key("relative_damping", &INVERSE_VELOCITY, "Damping relative to the elastic force.").of_motion();
        v.quantity(k.not_negative().or(0.0), &mut self.relative_damping);
    }
}
