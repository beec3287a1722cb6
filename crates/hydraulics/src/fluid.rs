//! Hydraulic fluid and the air entrained in it.

mod component;
mod keys;

pub use keys::DeclaredFluid;

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Atmospheric pressure in Pa absolute (ISO 2533 standard atmosphere at sea level): the pressure at
/// which the volume fraction of entrained air is stated, and the difference between gauge and
/// absolute pressures.
pub const ATMOSPHERIC_PRESSURE_ABSOLUTE: f64 = 101_325.0;

/// Polytropic exponent of a monatomic gas, the greatest of all.
pub(crate) const MONATOMIC_EXPONENT: f64 = 5.0 / 3.0;

/// Hydraulic fluid. Units: Pa, kg/m3, m2/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid<S = f64> {
    /// Bulk modulus beta_0 of the fluid free of air, Pa.
    pub bulk_modulus: S,
    /// Density, kg/m3.
    pub density: S,
    /// Kinematic viscosity, m2/s.
    pub kinematic_viscosity: S,
    /// Air bubbles, absent by default.
    pub entrained_air: Option<EntrainedAir<S>>,
    /// Pressure in Pa absolute below which a chamber is reported to cavitate: a few pascals for
    /// mineral oil at working temperatures. Fluid with entrained air expands before it boils and
    /// never reaches vacuum: for it, state the pressure at which dissolved air is released.
    pub vapour_pressure_absolute: S,
}

/// Free air carried as bubbles (dissolved air does not soften the fluid and does not count).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EntrainedAir<S = f64> {
    /// Volume of air over volume of the mixture at atmospheric pressure, in [0, 1).
    pub volume_fraction: S,
    /// Polytropic index of its compression: 1 isothermal, 1.4 adiabatic.
    pub polytropic_exponent: S,
}

impl Fluid {
    /// Invalid parameters of this fluid; empty if all are valid.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(keys::BULK_MODULUS_KEY, self.bulk_modulus);
        problems.key(keys::DENSITY_KEY, self.density);
        problems.key(keys::KINEMATIC_VISCOSITY_KEY, self.kinematic_viscosity);
        problems.key_as("vapour_pressure_absolute", keys::VAPOUR_PRESSURE_KEY, self.vapour_pressure_absolute);
        if let Some(EntrainedAir { volume_fraction, polytropic_exponent }) = self.entrained_air {
            problems.key_as("entrained_air.volume_fraction", keys::ENTRAINED_AIR_KEY, volume_fraction);
            let exponent = keys::POLYTROPIC_EXPONENT_KEY;
            problems.key_as("entrained_air.polytropic_exponent", exponent, polytropic_exponent);
        }
        problems.into_vec()
    }
}

impl<S: Scalar> Fluid<S> {
    /// Bulk modulus at a gauge pressure in Pa: that of the fluid without air,
    /// [`bulk_modulus_with_air`] with air.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::fluid::{EntrainedAir, Fluid};
    /// let clean = Fluid {
    ///     bulk_modulus: 1.45e9, density: 870.0, kinematic_viscosity: 46e-6, entrained_air: None,
    ///     vapour_pressure_absolute: 0.0,
    /// };
    /// assert_eq!(clean.modulus_at(35e5), 1.45e9);
    /// let air = EntrainedAir { volume_fraction: 0.01, polytropic_exponent: 1.4 };
    /// let foamy = Fluid { entrained_air: Some(air), ..clean };
    /// assert!(foamy.modulus_at(35e5) < 1.3e9 && foamy.modulus_at(5e5) < 0.3e9);
    /// ```
    pub fn modulus_at(&self, pressure: S) -> S {
        match self.entrained_air {
            None => self.bulk_modulus,
            Some(air) => bulk_modulus_with_air(
                self.bulk_modulus,
                air.volume_fraction,
                air.polytropic_exponent,
                pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE),
            ),
        }
    }
}

/// Tangent bulk modulus of a fluid with entrained air, in Pa, at a pressure in Pa absolute.
///
/// ```text
/// V_liquid = (1 - a) exp(-(p - p0)/beta)        V_gas = a (p0/p)^(1/n)
/// beta_mixture = -V dp/dV = (V_liquid + V_gas) / (V_liquid/beta + V_gas/(n p))
/// ```
///
/// The volumes of a compressible liquid and of a gas compressed polytropically from atmospheric
/// pressure p0 add up; no air dissolves. Source: the family of models reviewed by Gholizadeh,
/// Burton and Schoenau (2011), "Fluid bulk modulus: a literature survey", International Journal of
/// Fluid Power 12(3). `pressure_absolute` must be positive.
///
/// # Example
/// At atmospheric pressure the moduli combine like springs in series, by volume:
/// ```
/// use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE as P0, bulk_modulus_with_air};
/// let mixture = bulk_modulus_with_air(1.45e9, 0.02, 1.4, P0);
/// let series = 1.0 / (0.98 / 1.45e9 + 0.02 / (1.4 * P0));
/// assert!((mixture / series - 1.0).abs() < 1e-12);
/// ```
pub fn bulk_modulus_with_air<S: Scalar>(
    bulk_modulus: S,
    volume_fraction: S,
    polytropic_exponent: S,
    pressure_absolute: S,
) -> S {
    let reference = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
    let liquid = (S::from(1.0) - volume_fraction) * ((reference - pressure_absolute) / bulk_modulus).exp();
    let gas = volume_fraction * ((reference / pressure_absolute).ln() / polytropic_exponent).exp();
    (liquid + gas) / (liquid / bulk_modulus + gas / (polytropic_exponent * pressure_absolute))
}
