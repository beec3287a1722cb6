//! Table `[line.wall]`.

use phea_quantity::{MASS_PER_LENGTH, STRAIN_PER_FORCE, STRAIN_PER_PRESSURE};
use phea_table::{TableNumber, Visitor, key};

use super::LineWall;

impl<S: TableNumber> LineWall<S> {
    /// Visits the table of the wall.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("mass_per_length", &MASS_PER_LENGTH, "Mass of a metre of wall.").positive();
        v.optional(k, &mut self.mass_per_length);
        let k = key("pressure_compliance", &STRAIN_PER_PRESSURE, "Area strain per pressure, no tension.");
        v.optional(k.not_negative(), &mut self.pressure_compliance);
        let k = key("coupling_compliance", &STRAIN_PER_FORCE, "Area strain per tension; negative: a braid.");
        v.optional(k, &mut self.coupling_compliance);
        let k = key("axial_compliance", &STRAIN_PER_FORCE, "Axial strain per tension.").positive();
        v.optional(k, &mut self.axial_compliance);
    }
}
