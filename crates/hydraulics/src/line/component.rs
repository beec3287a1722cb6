//! Line from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{Component, DeclaredLine, DeclaredPipe, HoseExpansion, HoseProperties, LineVolume};
use super::motion_keys::{LineMotion, LineSegments};
use super::{Anchoring, END_SHARE, Hose, LaminarFriction, Line, LineModel, Pipe, PipeWall, Stiffening};

impl<S: Scalar> DeclaredLine<S> {
    /// Hose, pipe or volume; the expansion of a hose is that at these pressures.
    pub fn component(&self, pressures: ExpansionPressures<S>) -> Line<S> {
        match &self.component {
            Component::Volume(LineVolume { volume, effective_bulk_modulus }) => {
                Line::Volume { volume: *volume, effective_bulk_modulus: *effective_bulk_modulus }
            }
            Component::Pipe { pipe, length } => Line::Pipe { pipe: pipe.component(), length: *length },
            Component::Hose { properties, length, .. } => {
                Line::Hose { hose: properties.component(pressures, self.dynamic_stiffening), length: *length }
            }
        }
    }
}

impl<S: Scalar> HoseProperties<S> {
    /// Hose with its expansion at these pressures. A ratio of stiffening without a spread is one
    /// uncertain number, one with a spread has three.
    pub fn component(&self, pressures: ExpansionPressures<S>, stiffening: Option<Stiffening<S>>) -> Hose<S> {
        let ExpansionPressures { working, operating } = pressures;
        let slope = self.expansion.slope();
        Hose {
            bore: self.bore,
            volumetric_expansion: self.expansion.at(working, working, slope),
            operating_expansion: self.expansion.at(operating, working, slope),
            expansion_slope: slope,
            dynamic_stiffening: stiffening.unwrap_or(Stiffening::certain(S::from(1.0))),
        }
    }
}

/// Pressures in Pa at which the expansion of a hose is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpansionPressures<S = f64> {
    /// The supply's: the thesis refers the wall's modulus to it.
    working: S,
    /// Midway between supply and tank, the pressure in the chambers of an idle actuator.
    operating: S,
}

impl<S: Scalar> ExpansionPressures<S> {
    /// Pressures of a hose between a supply and its tank, Pa.
    pub fn of(supply: S, tank: S) -> ExpansionPressures<S> {
        ExpansionPressures { working: supply, operating: S::from(0.5) * (supply + tank) }
    }

    /// Pressures of a hose that is used at a single one, Pa.
    pub fn at(pressure: S) -> ExpansionPressures<S> {
        ExpansionPressures { working: pressure, operating: pressure }
    }
}

impl<S: Scalar> HoseExpansion<S> {
    /// Declared slope, or the expansion over the pressure of its measurement, m3/(m Pa).
    pub fn slope(&self) -> S {
        match *self {
            HoseExpansion::Slope { slope, .. } => slope,
            HoseExpansion::Measured { measured, pressure } => measured / pressure,
        }
    }

    /// Measured value with the slope from there, or the slope from zero, m3/m; a value without a
    /// pressure is assumed to be at the working pressure.
    fn at(&self, pressure: S, working_pressure: S, slope: S) -> S {
        match self.measured() {
            Some(measured) => measured + slope * (pressure - self.pressure().unwrap_or(working_pressure)),
            None => slope * pressure,
        }
    }
}

impl<S: Scalar> DeclaredPipe<S> {
    fn component(&self) -> Pipe<S> {
        let wall = self.wall.map_or(PipeWall::Rigid, |wall| PipeWall::Elastic {
            thickness: wall.thickness,
            youngs_modulus: wall.youngs_modulus,
            poisson_ratio: self.poisson_ratio,
            anchoring: Anchoring::Throughout,
            thick: true,
        });
        Pipe { bore: self.bore, wall }
    }
}

impl LineMotion {
    /// Model of the line in motion; lumped until it is chosen.
    pub fn component(&self) -> LineModel {
        let fraction = |stated: &Option<f64>| stated.unwrap_or(END_SHARE);
        match self {
            LineMotion::Automatic | LineMotion::Lumped => LineModel::Lumped,
            LineMotion::Creeping { relaxation_time } => {
                LineModel::Creeping { relaxation_time: *relaxation_time }
            }
            LineMotion::Segments(segments) => segments.component(),
            LineMotion::TransmissionLine { end_share } => {
                LineModel::TransmissionLine { end_share: fraction(end_share) }
            }
            LineMotion::TwoWave { end_share, wall } => {
                LineModel::TwoWave { end_share: fraction(end_share), wall: wall.unwrap_or_default() }
            }
        }
    }
}

impl LineSegments {
    fn component(&self) -> LineModel {
        LineModel::Segments {
            count: self.count() as usize,
            friction: self.friction.unwrap_or(LaminarFriction::FrequencyDependent),
            relaxation_time: self.relaxation_time,
        }
    }
}
