//! Table `[force_sensor]`.

use phea_quantity::{FORCE, STIFFNESS};
use phea_table::{Key, TableNumber, Visitor, key};

pub(super) const STIFFNESS_KEY: Key =
    key("stiffness", &STIFFNESS, "K_S: with a prescribed load motion, of cell and environment.")
        .of_motion()
        .positive()
        .usual(1e6, 1e10, "load cells");

/// Load cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredForceSensor<S = f64> {
    /// Stiffness K_S, N/m: of the cell in series with its environment if the load is a prescribed
    /// motion.
    pub stiffness: S,
    /// Root mean square of the white noise at a sampled controller, N.
    pub noise: S,
    /// Largest permitted force in both directions, N.
    pub capacity: Option<S>,
}

impl<S: TableNumber> DeclaredForceSensor<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(STIFFNESS_KEY, &mut self.stiffness);
        let k =
            key("noise", &FORCE, "Root mean square of the white noise in what a sampled controller sees.")
                .of_motion();
        v.quantity(k.not_negative().or(0.0), &mut self.noise);
        let k =
            key("capacity", &FORCE, "The force that it survives, in both directions.").of_motion().positive();
        v.optional(k, &mut self.capacity);
    }
}
