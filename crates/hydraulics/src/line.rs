//! Line between a valve port and a cylinder chamber: hose, pipe or plain volume, and its dynamics.
//!
//! [`Line`] describes it, [`LineModel`] and [`DynamicLine`] are the models that a machine computes:
//! capacities with or without inertances ([`Segments`]), a wall that creeps
//! ([`StandardLinearSolid`]), one wave ([`TransmissionLine`]) or two ([`TwoWaveHose`]).

mod attenuation;
mod blocked;
mod braided_wall;
mod checks;
mod component;
mod conduit;
mod dynamic_line;
mod hose;
mod hose_keys;
mod keys;
mod laminar_friction;
mod line_model;
mod line_response;
mod motion_keys;
mod pipe;
mod segments;
mod standard_linear_solid;
mod transfer_matrix;
mod transmission_line;
mod travelling_waves;
mod two_wave;

pub use blocked::BlockedLine;
pub use braided_wall::{BraidedWall, LineWall};
pub use component::ExpansionPressures;
pub use conduit::{Conduit, LineError};
pub use dynamic_line::DynamicLine;
pub use hose::{Hose, Stiffening, static_hose_modulus};
pub use keys::{
    Component, DeclaredLine, DeclaredLines, DeclaredPipe, ElasticWall, HoseExpansion, HoseProperties,
    LineVolume, StiffnessModel,
};
pub use laminar_friction::friction_factor;
pub use line_model::LineModel;
pub use line_response::LineResponse;
pub use motion_keys::{LineMotion, LineSegments};
pub use pipe::{Anchoring, Pipe, PipeWall, pipe_wall_compliance};
pub(crate) use segments::LineContent;
pub use segments::{LaminarFriction, Segments};
pub use standard_linear_solid::StandardLinearSolid;
pub use transfer_matrix::TransferMatrix;
pub use transmission_line::{END_SHARE, TransmissionLine};
pub use travelling_waves::TravellingWaves;
pub use two_wave::{HoseWave, TwoWaveHose, TwoWaveLine};

use std::f64::consts::FRAC_PI_4;

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Line between one valve port and its chamber. Units: m, m3, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line<S = f64> {
    /// Hose of a given length.
    Hose {
        /// Hose.
        hose: Hose<S>,
        /// Length L_ho, m.
        length: S,
    },
    /// Pipe of a given length.
    Pipe {
        /// Pipe.
        pipe: Pipe<S>,
        /// Length, m.
        length: S,
    },
    /// Capacity with a known effective modulus (fluid and wall together).
    Volume {
        /// Volume, m3.
        volume: S,
        /// Effective bulk modulus, Pa.
        effective_bulk_modulus: S,
    },
}

/// Member of a hose's stiffening interval used in a calculation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StiffeningMember {
    /// Softest member: smallest r_beta.
    Minimum,
    /// Nominal r_beta.
    Nominal,
    /// Stiffest member: largest r_beta.
    Maximum,
}

impl Line {
    /// Line whose hose has a single ratio of stiffening, the nominal one: that of a member of a
    /// family need not be in the declared interval.
    pub fn stiffened_alike(self) -> Line {
        match self {
            Line::Hose { mut hose, length } => {
                hose.dynamic_stiffening = Stiffening::certain(hose.dynamic_stiffening.nominal);
                Line::Hose { hose, length }
            }
            Line::Pipe { .. } | Line::Volume { .. } => self,
        }
    }

    /// Line that holds nothing.
    pub fn without_volume(mut self) -> Line {
        match &mut self {
            Line::Hose { length, .. } | Line::Pipe { length, .. } => *length = 0.0,
            Line::Volume { volume, .. } => *volume = 0.0,
        }
        self
    }

    /// Impossible parameters of this line; empty if there are none. A length or volume of zero is
    /// possible: no line.
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
                problems.key(keys::VOLUME_KEY, volume);
                problems.key(keys::EFFECTIVE_BULK_MODULUS_KEY, effective_bulk_modulus);
            }
        }
        problems.into_vec()
    }
}

impl<S: Scalar> Line<S> {
    /// Line at the operating pressure: a hose with its bore there, [`Hose::filled`]. Pipes and
    /// plain volumes are unchanged.
    pub fn filled(&self) -> Line<S> {
        match *self {
            Line::Hose { hose, length } => Line::Hose { hose: hose.filled(), length },
            Line::Pipe { .. } | Line::Volume { .. } => *self,
        }
    }

    /// Volume V_ho of the fluid in the unexpanded line, m3.
    pub fn volume(&self) -> S {
        match *self {
            Line::Hose { hose, length } => S::from(FRAC_PI_4) * hose.bore * hose.bore * length,
            Line::Pipe { pipe, length } => S::from(FRAC_PI_4) * pipe.bore * pipe.bore * length,
            Line::Volume { volume, .. } => volume,
        }
    }

    /// Effective bulk modulus beta_e in Pa of fluid and wall together, for a fluid of this modulus:
    /// thesis (6.20), a hose's wall with the modulus of thesis (6.24). The modulus referred to the
    /// oil in a hose is `filled().effective_modulus(..)`.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::line::{Hose, Line, StiffeningMember, Stiffening};
    /// let hose = Hose {
    ///     bore: 12.7e-3,
    ///     volumetric_expansion: 1.56e-5,
    ///     operating_expansion: 7.774e-6,
    ///     expansion_slope: 2.236e-12,
    ///     dynamic_stiffening: Stiffening { nominal: 5.0, minimum: 4.0, maximum: 5.0 },
    /// };
    /// let line = Line::Hose { hose, length: 1.5 };
    /// assert!((line.effective_modulus(1.45e9, StiffeningMember::Nominal) - 2.609e8).abs() < 0.5e5);
    /// ```
    pub fn effective_modulus(&self, fluid_modulus: S, member: StiffeningMember) -> S {
        match *self {
            Line::Hose { hose, .. } => series_modulus(fluid_modulus, hose.wall_modulus(member)),
            Line::Pipe { pipe, .. } => {
                let one = S::from(1.0);
                one / (one / fluid_modulus + pipe.wall_compliance())
            }
            Line::Volume { effective_bulk_modulus, .. } => effective_bulk_modulus,
        }
    }

    /// Compliance dV/dp: the volume that the line takes up per pascal; for a hose by its data
    /// sheet, m3/Pa.
    ///
    /// ```text
    /// dV/dp = V/beta_e          hose: epsilon L/r_beta + (A_ho + E(p)) L/beta_0         p the operating pressure
    /// ```
    pub fn compliance(&self, fluid_modulus: S, member: StiffeningMember) -> S {
        match *self {
            Line::Hose { hose, length } => length * hose.compliance_per_length(fluid_modulus, member),
            Line::Pipe { .. } | Line::Volume { .. } => {
                self.volume() / self.effective_modulus(fluid_modulus, member)
            }
        }
    }

    /// Compliance of the line in the thesis' model, V_ho/beta_e: the unexpanded volume over the
    /// modulus of 6.20, m3/Pa.
    pub fn compliance_of_unexpanded(&self, fluid_modulus: S, member: StiffeningMember) -> S {
        self.volume() / self.effective_modulus(fluid_modulus, member)
    }
}

/// Modulus of two compliances with a common volume, Pa.
///
/// ```text
/// beta_e = beta_0 beta_ho / (beta_0 + beta_ho)                         thesis (6.20), Merritt (1967)
/// ```
pub fn series_modulus<S: Scalar>(fluid_modulus: S, wall_modulus: S) -> S {
    fluid_modulus * wall_modulus / (fluid_modulus + wall_modulus)
}
