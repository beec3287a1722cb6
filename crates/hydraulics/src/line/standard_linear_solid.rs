use num_complex::Complex64;
use phea_dynamics::scalar::Scalar;

use super::{Hose, StiffeningMember};
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Creeping wall: a spring in parallel with a spring and damper in series (Zener). Units: Pa, s.
///
/// ```text
/// beta(s) = beta_static + (beta_dynamic - beta_static) tau s/(1 + tau s)
/// ```
///
/// At rest the wall is as soft as stated in the catalogue, in fast motion as stiff as measured at
/// high frequency; between these limits it dissipates. A single relaxation time is the simplest
/// model with these limits; relaxation times of measured hoses extend over decades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardLinearSolid<S = f64> {
    /// Modulus at rest, Pa.
    pub static_modulus: S,
    /// Modulus at high frequency, Pa, not below the static one.
    pub dynamic_modulus: S,
    /// Time constant tau in which pressure relaxes at constant volume, s.
    pub relaxation_time: S,
}

impl StandardLinearSolid {
    /// Wall of a hose: its modulus at rest, with the bore at the operating pressure, and r_beta
    /// times that modulus at high frequency.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_hydraulics::line::{StiffeningMember, StandardLinearSolid};
    /// let hose = phea_hydraulics::reference_rig::hose().filled();
    /// let wall = StandardLinearSolid::of_hose(&hose, StiffeningMember::Nominal, 0.1);
    /// let compliance = |frequency| wall.compliance(Complex64::new(0.0, frequency));
    /// assert!((compliance(1e-6).re * hose.static_modulus() - 1.0).abs() < 1e-9);
    /// assert!((compliance(1e6).re * hose.wall_modulus(StiffeningMember::Nominal) - 1.0).abs() < 1e-9);
    /// ```
    pub fn of_hose(hose: &Hose, member: StiffeningMember, relaxation_time: f64) -> StandardLinearSolid {
        let hose = hose.filled();
        StandardLinearSolid {
            static_modulus: hose.static_modulus(),
            dynamic_modulus: hose.wall_modulus(member),
            relaxation_time,
        }
    }

    /// Impossible parameters of this wall; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("static_modulus", self.static_modulus);
        let stiffens = self.dynamic_modulus >= self.static_modulus;
        problems.require(
            "dynamic_modulus",
            self.dynamic_modulus,
            stiffens,
            ParameterRequirement::AtLeastStaticModulus,
        );
        problems.key(super::motion_keys::RELAXATION, self.relaxation_time);
        problems.into_vec()
    }

    /// Compliance 1/beta(s) per volume: the immediate and the delayed part, 1/Pa.
    ///
    /// ```text
    /// 1/beta(s) = 1/beta_dynamic + (1/beta_static - 1/beta_dynamic)/(1 + theta s)
    /// ```
    pub fn compliance(&self, s: Complex64) -> Complex64 {
        1.0 / self.dynamic_modulus + self.retarded_compliance() / (1.0 + self.retardation_time() * s)
    }
}

impl<S: Scalar> StandardLinearSolid<S> {
    /// Delayed part of the compliance per volume, 1/Pa.
    ///
    /// ```text
    /// 1/beta_static - 1/beta_dynamic
    /// ```
    pub fn retarded_compliance(&self) -> S {
        let one = S::from(1.0);
        one / self.static_modulus - one / self.dynamic_modulus
    }

    /// Time constant in which the volume follows at constant pressure, s.
    ///
    /// ```text
    /// theta = tau beta_dynamic/beta_static
    /// ```
    pub(crate) fn retardation_time(&self) -> S {
        self.relaxation_time * self.dynamic_modulus / self.static_modulus
    }
}
