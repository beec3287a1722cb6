use std::f64::consts::FRAC_PI_4;

use phea_dynamics::scalar::Scalar;

use super::{Line, StiffeningMember};
use crate::fluid::Fluid;
use crate::parameter::{ParameterError, Problems};

/// Fluid column of a line: round, straight, of constant bore and modulus. Units: m, kg/m3, m2/s,
/// Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conduit<S = f64> {
    /// Length L, m.
    pub length: S,
    /// Bore D = 2 R, m.
    pub bore: S,
    /// Density of the fluid rho, kg/m3.
    pub density: S,
    /// Kinematic viscosity of the fluid nu, m2/s.
    pub kinematic_viscosity: S,
    /// Bulk modulus of fluid and wall together beta_e, Pa.
    pub effective_bulk_modulus: S,
}

/// Error for a line that has no such dynamic model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineError {
    /// Impossible parameters.
    #[error("{}", problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Impossible {
        /// All impossible parameters.
        problems: Vec<ParameterError>,
    },
    /// A line with a known volume only: it has no length and no bore from which inertia, friction
    /// or delay follow.
    #[error("a plain volume has neither length nor bore: only the lumped model fits it")]
    NoBore,
    /// A line without length, along which no wave travels.
    #[error("a line without length carries no waves: use the lumped model")]
    NoLength,
    /// Friction between the fluid and a light wall, which mixes the waves so much that the model in
    /// time would supply energy at low frequency: the resistance that compensates for the lags of
    /// its waves exceeds that of steady flow.
    #[error(
        "friction mixes the waves: their lags take {needed} Pa s/m3 at each end, steady flow gives {half_resistance}"
    )]
    MixedByFriction {
        /// Resistance that the lags of the waves need, Pa s/m3.
        needed: f64,
        /// Half of the steady resistance, Pa s/m3.
        half_resistance: f64,
    },
    /// A wall that creeps or moves along its axis, but is not a hose.
    #[error("this model of the wall is for hoses")]
    NotAHose,
    /// A line with zero segments.
    #[error("a line in segments has at least one; without any it is lumped")]
    NoSegments,
    /// A dissipation number beyond the range of the attenuation's fit: friction damps all waves
    /// before they arrive.
    #[error(
        "the dissipation number nu L/(c R^2) is {dissipation}, above {limit}: use the lumped model in segments"
    )]
    Overdamped {
        /// Dissipation number of the line.
        dissipation: f64,
        /// Greatest dissipation number of the fit.
        limit: f64,
    },
}

impl Conduit {
    /// Fluid column of a hose or pipe, with the fluid's modulus at a mean gauge pressure in Pa.
    ///
    /// # Errors
    /// [`LineError::NoBore`] for a plain volume, [`LineError::NoLength`], and impossible
    /// parameters.
    ///
    /// # Example
    /// Pressure takes 2.80 ms along 1.5 m of the thesis' hose at 35 bar, and the compliance equals
    /// that of the lumped line.
    /// ```
    /// use phea_hydraulics::line::{Conduit, StiffeningMember};
    /// use phea_hydraulics::reference_rig::{components, hose_line};
    /// use phea_hydraulics::stiffness::StiffnessModel;
    /// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
    /// let conduit = Conduit::of_line(&hose_line(), &fluid, 35e5, StiffeningMember::Nominal)?;
    /// assert!((conduit.speed() - 535.0_f64).abs() < 0.5 && (conduit.delay() - 2.80e-3).abs() < 5e-6);
    /// let lumped = hose_line().compliance(1.45e9, StiffeningMember::Nominal);
    /// assert!((conduit.compliance() / lumped - 1.0).abs() < 1e-14);
    /// # Ok::<(), phea_hydraulics::line::LineError>(())
    /// ```
    pub fn of_line(
        line: &Line,
        fluid: &Fluid,
        pressure: f64,
        member: StiffeningMember,
    ) -> Result<Conduit, LineError> {
        let mut problems = line.problems();
        problems.extend(fluid.problems().into_iter().map(|problem| problem.within("fluid")));
        if !problems.is_empty() {
            return Err(LineError::Impossible { problems });
        }
        if matches!(line, Line::Volume { .. }) {
            return Err(LineError::NoBore);
        }
        let conduit = Conduit::filled(line, fluid, pressure, member);
        conduit.check().map(|()| conduit)
    }

    /// Impossible parameters of this conduit; empty if there are none. A length of zero is possible
    /// here.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.not_negative("length", self.length);
        problems.positive("bore", self.bore);
        problems.positive("density", self.density);
        problems.positive("kinematic_viscosity", self.kinematic_viscosity);
        problems.positive("effective_bulk_modulus", self.effective_bulk_modulus);
        problems.into_vec()
    }

    pub(super) fn check(&self) -> Result<(), LineError> {
        let problems = self.problems();
        match (problems.is_empty(), self.length > 0.0) {
            (false, _) => Err(LineError::Impossible { problems }),
            (true, false) => Err(LineError::NoLength),
            (true, true) => Ok(()),
        }
    }
}

impl<S: Scalar> Conduit<S> {
    /// Fluid column of a hose or pipe over any scalar, unchecked; length and bore of a plain volume
    /// are NaN.
    pub(crate) fn filled(
        line: &Line<S>,
        fluid: &Fluid<S>,
        pressure: S,
        member: StiffeningMember,
    ) -> Conduit<S> {
        let (length, bore) = match *line {
            Line::Hose { hose, length } => (length, hose.filled().bore),
            Line::Pipe { pipe, length } => (length, pipe.bore),
            Line::Volume { .. } => (S::from(f64::NAN), S::from(f64::NAN)),
        };
        Conduit {
            length,
            bore,
            density: fluid.density,
            kinematic_viscosity: fluid.kinematic_viscosity,
            effective_bulk_modulus: line.filled().effective_modulus(fluid.modulus_at(pressure), member),
        }
    }

    /// Area of the bore, m2.
    pub fn area(&self) -> S {
        S::from(FRAC_PI_4) * self.bore.squared()
    }

    /// Compliance, m3/Pa.
    ///
    /// ```text
    /// C = A L/beta_e
    /// ```
    pub fn compliance(&self) -> S {
        self.area() * self.length / self.effective_bulk_modulus
    }

    /// Inertance, Pa s2/m3.
    ///
    /// ```text
    /// I = rho L/A
    /// ```
    pub fn inertance(&self) -> S {
        self.density * self.length / self.area()
    }

    /// Resistance of steady laminar flow (Hagen and Poiseuille), Pa s/m3.
    ///
    /// ```text
    /// R_0 = 8 nu/R^2 rho L/A
    /// ```
    pub fn steady_resistance(&self) -> S {
        S::from(8.0) * self.viscous_rate() * self.inertance()
    }

    /// Rate at which friction spreads from the wall into the flow, 1/s.
    ///
    /// ```text
    /// nu/R^2
    /// ```
    pub fn viscous_rate(&self) -> S {
        S::from(4.0) * self.kinematic_viscosity / self.bore.squared()
    }

    /// Speed of a pressure wave, m/s.
    ///
    /// ```text
    /// c = sqrt(beta_e/rho)
    /// ```
    pub fn speed(&self) -> S {
        (self.effective_bulk_modulus / self.density).sqrt()
    }

    /// Travel time of a wave along the line, s.
    ///
    /// ```text
    /// T = L/c
    /// ```
    pub fn delay(&self) -> S {
        self.length / self.speed()
    }

    /// Characteristic impedance, Pa s/m3.
    ///
    /// ```text
    /// Z_c = rho c/A                                                        thesis (4.38), over the area
    /// ```
    pub fn characteristic_impedance(&self) -> S {
        self.density * self.speed() / self.area()
    }

    /// Dissipation number, dimensionless: friction that acts on a wave along the line.
    ///
    /// ```text
    /// nu T/R^2
    /// ```
    pub fn dissipation_number(&self) -> S {
        self.viscous_rate() * self.delay()
    }
}
