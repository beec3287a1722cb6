//! Table `[cylinder.end_stops]`, and that of a motor.

use phea_quantity::{INVERSE_VELOCITY, STIFFNESS};
use phea_table::{Key, TableNumber, Visitor, key};

use super::Contact;

pub(super) const STIFFNESS_KEY: Key = key("stiffness", &STIFFNESS, "Of each stop.").of_motion().positive();
pub(super) const RELATIVE_DAMPING_KEY: Key =
    key("relative_damping", &INVERSE_VELOCITY, "Damping relative to the elastic force.")
        .of_motion()
        .not_negative()
        .or(0.0);

impl<S: TableNumber> Contact<S> {
    /// Visits the table of the end stops at both ends of the stroke.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(STIFFNESS_KEY, &mut self.stiffness);
        v.quantity(RELATIVE_DAMPING_KEY, &mut self.relative_damping);
    }
}
