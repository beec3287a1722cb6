//! Table `[fluid]`.

use phea_quantity::{DENSITY, KINEMATIC_VISCOSITY, PRESSURE, RATIO};
use phea_table::{TableNumber, Visitor, key};

/// Oil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredFluid<S = f64> {
    /// Bulk modulus of the liquid without air, Pa.
    pub bulk_modulus: S,
    /// Density, kg/m³.
    pub density: S,
    /// Kinematic viscosity, m²/s.
    pub kinematic_viscosity: Option<S>,
    /// Volume of free air over total volume at atmospheric pressure; `None` and zero mean none.
    pub entrained_air: Option<S>,
    /// Polytropic exponent of the entrained air.
    pub polytropic_exponent: S,
    /// Absolute pressure below which a chamber is reported to cavitate, Pa.
    pub vapour_pressure: S,
}

impl<S: TableNumber> DeclaredFluid<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("bulk_modulus", &PRESSURE, "Bulk modulus of the liquid without air.").positive();
        v.quantity(k, &mut self.bulk_modulus);
        let k = key("density", &DENSITY, "Density of the liquid.").positive();
        v.quantity(k, &mut self.density);
        let k = key("kinematic_viscosity", &KINEMATIC_VISCOSITY, "Kinematic viscosity.").positive();
        v.optional(k, &mut self.kinematic_viscosity);
        let k = key("entrained_air", &RATIO, "Share of free air in the volume at atmospheric pressure.");
        v.optional(k.not_negative().below(1.0), &mut self.entrained_air);
        let k = key("polytropic_exponent", &RATIO, "Of the entrained air: 1 is isothermal, 1.4 adiabatic.");
        v.quantity(k.at_least(1.0).at_most(1.7).or(1.4), &mut self.polytropic_exponent);
        let k = key("vapour_pressure", &PRESSURE, "Absolute; below it a chamber is reported to cavitate.");
        v.quantity(k.not_negative().or(0.0), &mut self.vapour_pressure);
    }
}
