//! The line between a valve port and a cylinder chamber: hose, pipe or plain volume.

mod hose;
mod pipe;

pub use hose::{Hose, Stiffening, static_hose_modulus};
pub use pipe::{Anchoring, Pipe, PipeWall, pipe_wall_compliance};

use std::f64::consts::FRAC_PI_4;

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// A line between one valve port and its chamber. Units: m, m3, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// A hose of this length.
    Hose {
        /// The hose.
        hose: Hose,
        /// Length L_ho in m.
        length: f64,
    },
    /// A pipe of this length.
    Pipe {
        /// The pipe.
        pipe: Pipe,
        /// Length in m.
        length: f64,
    },
    /// Any capacity whose effective modulus (fluid and wall together) is known.
    Volume {
        /// Volume in m3.
        volume: f64,
        /// Effective bulk modulus in Pa.
        effective_bulk_modulus: f64,
    },
}

/// Which member of a hose's stiffening interval to calculate with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// The softest: smallest r_beta.
    Minimum,
    /// The nominal r_beta.
    Nominal,
    /// The stiffest: largest r_beta.
    Maximum,
}

impl Line {
    /// What about this line is impossible; empty if nothing is. A length or volume of zero is possible: no line.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        match *self {
            Line::Hose { hose, length } => {
                problems.component("hose", hose.problems());
                problems.not_negative("length", length);
            }
            Line::Pipe { pipe, length } => {
                problems.component("pipe", pipe.problems());
                problems.not_negative("length", length);
            }
            Line::Volume { volume, effective_bulk_modulus } => {
                problems.not_negative("volume", volume);
                problems.positive("effective_bulk_modulus", effective_bulk_modulus);
            }
        }
        problems.into_vec()
    }

    /// Volume of the fluid in the unexpanded line, V_ho, in m3.
    pub fn volume(&self) -> f64 {
        match *self {
            Line::Hose { hose, length } => FRAC_PI_4 * hose.bore * hose.bore * length,
            Line::Pipe { pipe, length } => FRAC_PI_4 * pipe.bore * pipe.bore * length,
            Line::Volume { volume, .. } => volume,
        }
    }

    /// Effective bulk modulus beta_e of fluid and wall together, in Pa, for a fluid of this modulus: thesis (6.20).
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::line::{Hose, Line, Member, Stiffening};
    /// let hose = Hose {
    ///     bore: 12.7e-3,
    ///     volumetric_expansion: 1.56e-5,
    ///     expansion_slope: 2.236e-12,
    ///     dynamic_stiffening: Stiffening { nominal: 5.0, minimum: 4.0, maximum: 5.0 },
    /// };
    /// let line = Line::Hose { hose, length: 1.5 };
    /// assert!((line.effective_modulus(1.45e9, Member::Nominal) - 2.609e8).abs() < 0.5e5);
    /// ```
    pub fn effective_modulus(&self, fluid_modulus: f64, member: Member) -> f64 {
        match *self {
            Line::Hose { hose, .. } => series_modulus(fluid_modulus, hose.wall_modulus(member)),
            Line::Pipe { pipe, .. } => 1.0 / (1.0 / fluid_modulus + pipe.wall_compliance()),
            Line::Volume { effective_bulk_modulus, .. } => effective_bulk_modulus,
        }
    }

    /// Compliance dV/dp = V_ho/beta_e in m3/Pa: what the line takes up per pascal.
    pub fn compliance(&self, fluid_modulus: f64, member: Member) -> f64 {
        self.volume() / self.effective_modulus(fluid_modulus, member)
    }
}

/// Modulus of two compliances that share a volume, in Pa.
///
/// ```text
/// beta_e = beta_0 beta_ho / (beta_0 + beta_ho)                         thesis (6.20), Merritt (1967)
/// ```
pub fn series_modulus<S: Scalar>(fluid_modulus: S, wall_modulus: S) -> S {
    fluid_modulus * wall_modulus / (fluid_modulus + wall_modulus)
}
