use std::f64::consts::FRAC_PI_4;

use phea_dynamics::scalar::Scalar;

use super::Member;
use crate::parameter::{ParameterError, Problems};

/// A hose described by its catalogue's volumetric expansion. Units: m, m3/m, m3/(m Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hose<S = f64> {
    /// Bore D_ho in m.
    pub bore: S,
    /// Volumetric expansion per length at the working pressure, E, in m3/m (ISO 6801).
    pub volumetric_expansion: S,
    /// Slope of the volumetric expansion over pressure, epsilon = dE/dp, in m3/(m Pa).
    pub expansion_slope: S,
    /// Dynamic over static wall modulus, r_beta.
    pub dynamic_stiffening: Stiffening<S>,
}

/// Ratio r_beta of dynamic to static wall modulus as an interval: nylon braid 4 to 5 (Johnston et al. 2010), measured
/// far above the frequencies of force control, so uncertain there. One at zero frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffening<S = f64> {
    /// What a nominal calculation uses.
    pub nominal: S,
    /// The softest the wall may be.
    pub minimum: S,
    /// The stiffest the wall may be.
    pub maximum: S,
}

impl Stiffening {
    /// No uncertainty.
    pub fn certain(ratio: f64) -> Stiffening {
        Stiffening { nominal: ratio, minimum: ratio, maximum: ratio }
    }

    fn map<S: Scalar>(&self) -> Stiffening<S> {
        Stiffening {
            nominal: S::from(self.nominal),
            minimum: S::from(self.minimum),
            maximum: S::from(self.maximum),
        }
    }
}

impl<S: Copy> Stiffening<S> {
    /// The ratio of one member of the interval.
    pub fn member(&self, member: Member) -> S {
        match member {
            Member::Minimum => self.minimum,
            Member::Nominal => self.nominal,
            Member::Maximum => self.maximum,
        }
    }
}

impl Hose {
    /// What about this hose is impossible; empty if nothing is.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("bore", self.bore);
        problems.not_negative("volumetric_expansion", self.volumetric_expansion);
        problems.positive("expansion_slope", self.expansion_slope);
        let Stiffening { nominal, minimum, maximum } = self.dynamic_stiffening;
        let at_least_one = "at least 1: a hose is softest when it is slow";
        problems.require("dynamic_stiffening.minimum", minimum, minimum >= 1.0, at_least_one);
        problems.require("dynamic_stiffening.nominal", nominal, nominal >= minimum, "at least the minimum");
        problems.require("dynamic_stiffening.maximum", maximum, maximum >= nominal, "at least the nominal");
        problems.into_vec()
    }

    /// Compliance per length counted in the expanded bore throughout, in m2/Pa: epsilon/r_beta + (A_ho + E)/beta_0.
    ///
    /// The thesis refers beta_hoSS to the expanded bore (6.24) but multiplies it with the unexpanded volume (6.25),
    /// which understates this by the factor A_ho/(A_ho + E).
    pub fn expanded_compliance_per_length(&self, fluid_modulus: f64, member: Member) -> f64 {
        let area = FRAC_PI_4 * self.bore * self.bore + self.volumetric_expansion;
        self.expansion_slope / self.dynamic_stiffening.member(member) + area / fluid_modulus
    }

    /// The same numbers as constants of another scalar.
    pub fn map<S: Scalar>(&self) -> Hose<S> {
        Hose {
            bore: S::from(self.bore),
            volumetric_expansion: S::from(self.volumetric_expansion),
            expansion_slope: S::from(self.expansion_slope),
            dynamic_stiffening: self.dynamic_stiffening.map(),
        }
    }
}

impl<S: Scalar> Hose<S> {
    /// Static wall modulus beta_hoSS in Pa: [`static_hose_modulus`].
    pub fn static_modulus(&self) -> S {
        static_hose_modulus(self.bore, self.volumetric_expansion, self.expansion_slope)
    }

    /// Dynamic wall modulus beta_ho = r_beta beta_hoSS in Pa.
    pub fn wall_modulus(&self, member: Member) -> S {
        self.dynamic_stiffening.member(member) * self.static_modulus()
    }
}

/// Static modulus of a hose wall from its volumetric expansion, in Pa.
///
/// ```text
/// beta_hoSS = (A_ho + E)/epsilon = (pi D_ho^2 + 4 E)/(4 epsilon)                  thesis (6.21) to (6.24)
/// ```
///
/// # Example
/// Eaton Synflex 3130-08 at 70 bar
/// ```
/// use phea_hydraulics::line::static_hose_modulus;
/// assert!((static_hose_modulus(12.7e-3, 1.56e-5, 2.236e-12) - 6.363e7_f64).abs() < 0.5e4);
/// ```
pub fn static_hose_modulus<S: Scalar>(bore: S, volumetric_expansion: S, expansion_slope: S) -> S {
    (S::from(FRAC_PI_4) * bore.squared() + volumetric_expansion) / expansion_slope
}
