//! Table `[line.wall]`, and the ratio of dynamic to static modulus, which is a number, or a table
//! `{ nominal = 5, minimum = 4, maximum = 5 }`.

use phea_quantity::{MASS_PER_LENGTH, RATIO, STRAIN_PER_FORCE, STRAIN_PER_PRESSURE};
use phea_table::{Key, TableNumber, ValueForm, Visitor, key};

use super::{LineWall, Stiffening};

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

impl<S: TableNumber> Stiffening<S> {
    fn is_certain(&self) -> bool {
        self.minimum == self.nominal && self.nominal == self.maximum
    }

    /// Visits the key of the ratio.
    pub fn visit<V: Visitor<S>>(field: &mut Option<Stiffening<S>>, v: &mut V) {
        let k = key("dynamic_stiffening", &RATIO, "r_β, the hose's dynamic over its static modulus.");
        let k = k.at_least(1.0);
        let spread = field.is_some_and(|ratio| !ratio.is_certain());
        if v.form(k, if spread { ValueForm::Table } else { ValueForm::Number }) != ValueForm::Table {
            let mut number = field.map(|ratio| ratio.nominal);
            v.optional(k, &mut number);
            *field = number.map(Stiffening::certain);
            return;
        }
        let part = |name, doc| Key { name, doc, default: None, ..k };
        v.table(k, field, |ratio: &mut Stiffening<S>, v: &mut V| {
            v.quantity(part("nominal", "The value to design with."), &mut ratio.nominal);
            v.quantity(part("minimum", "The least it may be."), &mut ratio.minimum);
            v.quantity(part("maximum", "The most it may be."), &mut ratio.maximum);
        });
    }
}
