use phea_dynamics::scalar::Scalar;

use super::super::chambers::{AeratedChambers, AeratedSide};
use super::Account;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

/// Oil at one pressure in its enclosure.
///
/// ```text
/// C dp/dt = q - dV/dt         C = V rho'/rho + W
/// oil       V rho + W integral of rho dp              enters as q rho
/// energy    V w + W integral of (p + w) dp            enters as q (p + w), leaves as work p dV/dt
/// rho' = rho/beta(p),  (p + w)' = 1 + (p + w)/beta(p),  rho(0) = 1,  w(0) = 0,       p + w = rho integral of dp/rho
/// ```
///
/// All integrals are from zero gauge pressure. V is the volume of fluid, W the compliance of all
/// other parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Volume<T> {
    /// Volume V, m3.
    pub(super) fluid: T,
    /// Compliance W, m3/Pa.
    pub(super) beside: T,
    /// Pressure p, Pa gauge.
    pub(super) pressure: T,
    /// Law beta(p).
    pub(super) law: DensityLaw<T>,
}

/// Dependence of the density on the pressure.
#[derive(Clone, Copy, Debug)]
pub(super) enum DensityLaw<T> {
    /// Constant modulus in Pa: rho = exp(p/beta), w = beta (exp(p/beta) - 1 - p/beta).
    Constant(T),
    /// Fluid with air.
    Mixture(Mixture<T>),
}

/// Fluid with air, and the part of the wall's compliance that grows with the fluid.
///
/// ```text
/// 1/beta(p) = s/beta_mixture(P) + k        1/rho = v(P)^s exp(-k p)        v = (1 - a) exp(-p/beta_0) + a (p_atm/P)^(1/n)
/// ```
///
/// v is the volume of the mixture over that at atmospheric pressure, whose tangent modulus is
/// beta_mixture (so it is valid down to 1 Pa absolute, below which the modulus of the chambers is
/// constant); s is 1 if the chamber contains the mixture and 0 if its modulus is stated. Neither
/// the integral of rho nor, with k, that of 1/rho is elementary; all are taken by Gauss and
/// Legendre's rule of twelve points over ln P, exact to 1e-13 up to 70 bar and 1e-9 up to 700 bar.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture<T> {
    bulk_modulus: T,
    volume_fraction: T,
    polytropic_exponent: T,
    /// Factor s.
    fraction: T,
    /// Wall compliance k, 1/Pa.
    wall: T,
}

/// Nodes and weights of the Gauss-Legendre rule for 12 points from -1 to 1, the positive half.
// ORIGIN: analytic
const GAUSS_LEGENDRE: [(f64, f64); 6] = [
    (0.1252334085114689, 0.2491470458134028),
    (0.3678314989981802, 0.2334925365383548),
    (0.5873179542866175, 0.2031674267230659),
    (0.7699026741943047, 0.1600783285433462),
    (0.9041172563704749, 0.1069393259953184),
    (0.9815606342467192, 0.0471753363865118),
];

impl<T: Scalar> Volume<T> {
    /// Side of a cylinder of this piston area in m2 whose fluid contains air, with the piston at a
    /// distance `travel` in m from the end.
    ///
    /// Within the constant compliance V/beta_mixture + W, the part k V that grows with V like the
    /// chamber belongs to its modulus.
    pub(super) fn aerated(
        chambers: &AeratedChambers<T>,
        side: &AeratedSide<T>,
        area: T,
        travel: T,
        pressure: T,
    ) -> Volume<T> {
        let wall = side.wall_slope / area;
        let law = DensityLaw::Mixture(Mixture {
            bulk_modulus: chambers.bulk_modulus,
            volume_fraction: chambers.volume_fraction,
            polytropic_exponent: chambers.polytropic_exponent,
            fraction: side.fluid_slope / area,
            wall,
        });
        Volume {
            fluid: side.fluid_constant + area * travel,
            beside: side.wall_constant - wall * side.fluid_constant,
            pressure,
            law,
        }
    }

    /// Ratio of the density to that at zero gauge pressure.
    pub(super) fn density(&self) -> T {
        self.law.density(self.pressure)
    }

    /// Energy of compression per volume, w, Pa.
    pub(super) fn compression(&self) -> T {
        self.law.port_energy(self.pressure) - self.pressure
    }

    pub(super) fn oil(&self, flow: T) -> Account<T> {
        let density = self.density();
        let beside = self.beside * self.law.density_integral(self.pressure);
        Account { stored: self.fluid * density + beside, inflow: density * flow, lost: T::from(0.0) }
    }

    pub(super) fn energy(&self, flow: T, growth: T) -> Account<T> {
        let compression = self.compression();
        let beside = self.beside * self.law.port_energy_integral(self.pressure);
        Account {
            stored: self.fluid * compression + beside,
            inflow: flow * (self.pressure + compression) - self.pressure * growth,
            lost: T::from(0.0),
        }
    }
}

impl<T: Scalar> DensityLaw<T> {
    /// Density rho.
    pub(super) fn density(&self, pressure: T) -> T {
        match self {
            DensityLaw::Constant(modulus) => (pressure / *modulus).exp(),
            DensityLaw::Mixture(mixture) => T::from(1.0) / mixture.specific_volume(pressure),
        }
    }

    /// Sum p + w, Pa.
    fn port_energy(&self, pressure: T) -> T {
        match self {
            DensityLaw::Constant(modulus) => *modulus * (self.density(pressure) - T::from(1.0)),
            DensityLaw::Mixture(mixture) => {
                let thinned = integral(pressure, |pressure| mixture.specific_volume(pressure));
                thinned / mixture.specific_volume(pressure)
            }
        }
    }

    /// Integral of rho over the pressure, Pa.
    fn density_integral(&self, pressure: T) -> T {
        match self {
            DensityLaw::Constant(_) => self.port_energy(pressure),
            DensityLaw::Mixture(_) => integral(pressure, |pressure| self.density(pressure)),
        }
    }

    /// Integral of p + w over the pressure, Pa2.
    fn port_energy_integral(&self, pressure: T) -> T {
        match self {
            DensityLaw::Constant(modulus) => *modulus * (self.port_energy(pressure) - pressure),
            DensityLaw::Mixture(_) => integral(pressure, |pressure| self.port_energy(pressure)),
        }
    }
}

impl<T: Scalar> Mixture<T> {
    /// Specific volume 1/rho.
    fn specific_volume(&self, pressure: T) -> T {
        let atmosphere = T::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let liquid = (T::from(1.0) - self.volume_fraction) * (-pressure / self.bulk_modulus).exp();
        let squeeze = (atmosphere / (pressure + atmosphere)).ln() / self.polytropic_exponent;
        let volume = liquid + self.volume_fraction * squeeze.exp();
        (self.fraction * volume.ln() - self.wall * pressure).exp()
    }
}

/// Integral from zero gauge pressure to `pressure`, with equal steps in the logarithm of the
/// absolute pressure.
fn integral<T: Scalar>(pressure: T, of: impl Fn(T) -> T) -> T {
    let atmosphere = T::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
    let half = T::from(0.5) * ((pressure + atmosphere) / atmosphere).ln();
    let at = |node: f64| {
        let absolute = atmosphere * (half * T::from(1.0 + node)).exp();
        absolute * of(absolute - atmosphere)
    };
    let sum = GAUSS_LEGENDRE
        .iter()
        .fold(T::from(0.0), |sum, (node, weight)| sum + T::from(*weight) * (at(-node) + at(*node)));
    half * sum
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable::{exp, ln};

    use super::*;

    const MODULUS: f64 = 1.45e9;

    fn mixture(volume_fraction: f64, polytropic_exponent: f64, wall: f64) -> DensityLaw<f64> {
        DensityLaw::Mixture(Mixture {
            bulk_modulus: MODULUS,
            volume_fraction,
            polytropic_exponent,
            fraction: 1.0,
            wall,
        })
    }

    /// Rigid wall: the integral of the volumes of liquid and gas is elementary.
    #[test]
    fn energy_of_the_mixture_is_that_of_its_liquid_and_its_gas() {
        let atmosphere = ATMOSPHERIC_PRESSURE_ABSOLUTE;
        for (air, index) in [(0.001, 1.4), (0.02, 1.0), (0.3, 1.2)] {
            for pressure in [-0.9 * atmosphere, 3e4, 35e5, 7e6] {
                let ratio = ln((pressure + atmosphere) / atmosphere);
                let liquid = (1.0 - air) * exp(-pressure / MODULUS);
                let gas = air * exp(-ratio / index);
                let gained = (1.0 - air) * MODULUS * (1.0 - exp(-pressure / MODULUS));
                let exponent = 1.0 - 1.0 / index;
                let squeezed = if index > 1.0 { (exp(exponent * ratio) - 1.0) / exponent } else { ratio };
                let energy = (gained + air * atmosphere * squeezed) / (liquid + gas);
                let law = mixture(air, index, 0.0);
                assert!((law.density(pressure) * (liquid + gas) - 1.0).abs() < 1e-13);
                assert!((law.port_energy(pressure) / energy - 1.0).abs() < 1e-11, "{air} {index} {pressure}");
            }
        }
    }

    /// Mixture without air: it has the constant modulus of liquid and wall in series.
    #[test]
    fn a_mixture_without_air_has_a_constant_modulus() {
        let wall = 1.0 / 3e8;
        let (law, constant) = (mixture(0.0, 1.4, wall), DensityLaw::Constant(1.0 / (1.0 / MODULUS + wall)));
        for pressure in [-5e4, 35e5, 7e6] {
            let close = |of: fn(&DensityLaw<f64>, f64) -> f64, tolerance: f64| {
                (of(&law, pressure) / of(&constant, pressure) - 1.0).abs() < tolerance
            };
            assert!(close(DensityLaw::density, 1e-13) && close(DensityLaw::port_energy, 1e-10));
            // the closed form is a difference of nearly equal numbers
            assert!(
                close(DensityLaw::density_integral, 1e-10) && close(DensityLaw::port_energy_integral, 1e-6),
                "{pressure}"
            );
        }
    }
}
