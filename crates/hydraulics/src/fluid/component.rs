//! Fluid from its table.

use phea_dynamics::scalar::Scalar;
use phea_table::once_read;

use super::keys::DeclaredFluid;
use super::{EntrainedAir, Fluid};

/// Kinematic viscosity of ISO VG 46 oil at 40 degrees Celsius, m2/s: used where none is stated.
const KINEMATIC_VISCOSITY: f64 = 46e-6;

impl<S: Scalar> DeclaredFluid<S> {
    /// Fluid with the viscosity of a common oil where none is stated.
    pub fn component(&self) -> Fluid<S> {
        Fluid {
            bulk_modulus: self.bulk_modulus,
            density: self.density,
            kinematic_viscosity: self.kinematic_viscosity.unwrap_or(S::from(KINEMATIC_VISCOSITY)),
            entrained_air: self.entrained_air.and_then(once_read).map(|volume_fraction| EntrainedAir {
                volume_fraction,
                polytropic_exponent: self.polytropic_exponent,
            }),
            vapour_pressure_absolute: self.vapour_pressure,
        }
    }
}
