//! Table `[fluid]`.

use phea_quantity::{DENSITY, KINEMATIC_VISCOSITY, PRESSURE, RATIO};
use phea_table::{Key, TableNumber, Visitor, key};

use super::MONATOMIC_EXPONENT;

pub(super) const BULK_MODULUS_KEY: Key =
    key("bulk_modulus", &PRESSURE, "Bulk modulus of the liquid without air.").positive().usual(
        1e9,
        2.5e9,
        "fluids of hydraulics",
    );
pub(super) const DENSITY_KEY: Key = key("density", &DENSITY, "Density of the liquid.").positive().usual(
    700.0,
    1300.0,
    "fluids of hydraulics",
);
pub(super) const KINEMATIC_VISCOSITY_KEY: Key =
    key("kinematic_viscosity", &KINEMATIC_VISCOSITY, "Kinematic viscosity.").positive().usual(
        5e-6,
        5e-4,
        "fluids of hydraulics",
    );
pub(super) const ENTRAINED_AIR_KEY: Key =
    key("entrained_air", &RATIO, "Share of free air in the volume at atmospheric pressure.")
        .not_negative()
        .below(1.0)
        .usual(0.0, 0.02, "fluids of hydraulics");
pub(super) const POLYTROPIC_EXPONENT_KEY: Key =
    key("polytropic_exponent", &RATIO, "Of the entrained air: 1 is isothermal, 1.4 adiabatic.")
        .at_least(1.0)
        .at_most(MONATOMIC_EXPONENT)
        .or(1.4);
pub(super) const VAPOUR_PRESSURE_KEY: Key =
    key("vapour_pressure", &PRESSURE, "Absolute; below it a chamber is reported to cavitate.")
        .not_negative()
        .or(0.0);

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
        v.quantity(BULK_MODULUS_KEY, &mut self.bulk_modulus);
        v.quantity(DENSITY_KEY, &mut self.density);
        v.optional(KINEMATIC_VISCOSITY_KEY, &mut self.kinematic_viscosity);
        v.optional(ENTRAINED_AIR_KEY, &mut self.entrained_air);
        v.quantity(POLYTROPIC_EXPONENT_KEY, &mut self.polytropic_exponent);
        v.quantity(VAPOUR_PRESSURE_KEY, &mut self.vapour_pressure);
    }
}
