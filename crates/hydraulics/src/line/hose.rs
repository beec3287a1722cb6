use std::f64::consts::FRAC_PI_4;

use phea_dynamics::scalar::Scalar;

use super::StiffeningMember;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Hose described by its catalogue's volumetric expansion. Units: m, m3/m, m3/(m Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hose<S = f64> {
    /// Bore D_ho, m.
    pub bore: S,
    /// Volumetric expansion per length at the working pressure, E, m3/m (ISO 6801), to which the
    /// thesis' modulus refers.
    pub volumetric_expansion: S,
    /// Volumetric expansion at the operating pressure, m3/m: the oil in a metre in excess of its
    /// bore. Negative only if the straight line through a measured point of the catalogue misses
    /// the origin.
    pub operating_expansion: S,
    /// Slope of the volumetric expansion over pressure, epsilon = dE/dp, m3/(m Pa).
    pub expansion_slope: S,
    /// Ratio of dynamic to static wall modulus, r_beta.
    pub dynamic_stiffening: Stiffening<S>,
}

/// Ratio r_beta of dynamic to static wall modulus as an interval: nylon braid 4 to 5 (Johnston et
/// al. 2010), measured far above the frequencies of force control, so uncertain there. One at zero
/// frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffening<S = f64> {
    /// Value for a nominal calculation.
    pub nominal: S,
    /// Softest wall.
    pub minimum: S,
    /// Stiffest wall.
    pub maximum: S,
}

impl<S: Copy> Stiffening<S> {
    /// Ratio without uncertainty.
    pub fn certain(ratio: S) -> Stiffening<S> {
        Stiffening { nominal: ratio, minimum: ratio, maximum: ratio }
    }

    /// Ratio for one member of the interval.
    pub fn member(&self, member: StiffeningMember) -> S {
        match member {
            StiffeningMember::Minimum => self.minimum,
            StiffeningMember::Nominal => self.nominal,
            StiffeningMember::Maximum => self.maximum,
        }
    }
}

impl Hose {
    /// Impossible parameters of this hose; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::HOSE_BORE, self.bore);
        problems.not_negative("volumetric_expansion", self.volumetric_expansion);
        let oil = FRAC_PI_4 * self.bore * self.bore + self.operating_expansion;
        problems.require(
            "operating_expansion",
            self.operating_expansion,
            oil > 0.0,
            ParameterRequirement::HoseHoldsOil,
        );
        problems.key_as("expansion_slope", super::keys::EXPANSION_SLOPE_KEY, self.expansion_slope);
        let Stiffening { nominal, minimum, maximum } = self.dynamic_stiffening;
        let at_least_one = ParameterRequirement::AtLeastOneOfHose;
        problems.require("dynamic_stiffening.minimum", minimum, minimum >= 1.0, at_least_one);
        problems.require(
            "dynamic_stiffening.nominal",
            nominal,
            nominal >= minimum,
            ParameterRequirement::AtLeastMinimum,
        );
        problems.require(
            "dynamic_stiffening.maximum",
            maximum,
            maximum >= nominal,
            ParameterRequirement::AtLeastNominal,
        );
        problems.into_vec()
    }
}

impl<S: Scalar> Hose<S> {
    /// Compliance of a metre by its data sheet, m2/Pa: the expansion of the wall, and the oil in
    /// the bore at the operating pressure p.
    ///
    /// ```text
    /// dV/dp / L = epsilon/r_beta + (A_ho + E(p))/beta_0
    /// ```
    ///
    /// The thesis refers beta_hoSS to the bore expanded at the working pressure (6.24) but
    /// multiplies it by the unexpanded volume (6.25): this reduces the expansion of the wall to
    /// A_ho/(A_ho + E) of it.
    ///
    /// # Example
    /// Eaton Synflex 3130-08 at 35 bar:
    /// ```
    /// # use phea_hydraulics::{line::StiffeningMember, reference_rig::hose};
    /// let compliance = hose().compliance_per_length(1.45e9, StiffeningMember::Nominal);
    /// assert!((compliance - 5.3992e-13).abs() < 0.5e-17); // ORIGIN: recomputed by comparisons/recompute_rig.py
    /// ```
    pub fn compliance_per_length(&self, fluid_modulus: S, member: StiffeningMember) -> S {
        let area = S::from(FRAC_PI_4) * self.bore.squared() + self.operating_expansion;
        self.expansion_slope / self.dynamic_stiffening.member(member) + area / fluid_modulus
    }

    /// Hose with its bore at the operating pressure, and its expansion counted from there: its
    /// moduli refer to the oil that it contains.
    ///
    /// # Example
    /// ```
    /// # use phea_hydraulics::{line::StiffeningMember, reference_rig::hose};
    /// let filled = hose().filled();
    /// assert!((filled.bore - 13.084e-3).abs() < 0.5e-6); // ORIGIN: analytic, sqrt(D^2 + 4 E/pi)
    /// let wall = filled.bore * filled.bore * std::f64::consts::FRAC_PI_4 / filled.wall_modulus(StiffeningMember::Nominal);
    /// assert!((wall * 5.0 / hose().expansion_slope - 1.0).abs() < 1e-12);
    /// ```
    pub fn filled(&self) -> Hose<S> {
        let squared_bore = self.bore.squared() + S::from(1.0 / FRAC_PI_4) * self.operating_expansion;
        let zero = S::from(0.0);
        Hose {
            bore: squared_bore.sqrt(),
            volumetric_expansion: zero,
            operating_expansion: zero,
            expansion_slope: self.expansion_slope,
            dynamic_stiffening: self.dynamic_stiffening,
        }
    }

    /// Static wall modulus beta_hoSS, Pa: [`static_hose_modulus`].
    pub fn static_modulus(&self) -> S {
        static_hose_modulus(self.bore, self.volumetric_expansion, self.expansion_slope)
    }

    /// Dynamic wall modulus beta_ho = r_beta beta_hoSS, Pa.
    pub fn wall_modulus(&self, member: StiffeningMember) -> S {
        self.dynamic_stiffening.member(member) * self.static_modulus()
    }
}

/// Static modulus of a hose wall from its volumetric expansion, Pa.
///
/// ```text
/// beta_hoSS = (A_ho + E)/epsilon = (pi D_ho^2 + 4 E)/(4 epsilon)                  thesis (6.21) to (6.24)
/// ```
///
/// # Example
/// Eaton Synflex 3130-08 at 70 bar:
/// ```
/// use phea_hydraulics::line::static_hose_modulus;
/// assert!((static_hose_modulus(12.7e-3, 1.56e-5, 2.236e-12) - 6.363e7_f64).abs() < 0.5e4);
/// ```
pub fn static_hose_modulus<S: Scalar>(bore: S, volumetric_expansion: S, expansion_slope: S) -> S {
    (S::from(FRAC_PI_4) * bore.squared() + volumetric_expansion) / expansion_slope
}
