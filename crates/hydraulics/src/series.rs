//! Optional element between force sensor and load: a spring, or a hydraulic transmission.
//!
//! ```text
//! rod - force sensor K_S - mass m - spring k, damper c, ends - load                      SeriesSpring
//! rod - force sensor K_S - piston - oil - line - oil - piston - load                     Transmission
//! ```
//!
//! The sensor sits on the rod, as on a rig, and the series element is screwed to it; the load is at
//! the other end. With a mass the sensor also measures the force that accelerates this mass; the
//! deflection of the spring does not include it. With a transmission it also measures the forces of
//! the oil's acceleration and of line friction, which the line's fixings hold and not the load.

mod checks;
mod coil;
mod component;
mod keys;
mod oil_column;
mod spring;
mod transmission;

pub use coil::{CoilPair, CoilWire, LEAST_ACTIVE_COILS, coil_pair};
pub use keys::{DeclaredSeries, DeclaredSpring, DeclaredTransmission, SpringCoil};
pub use oil_column::OilColumn;
pub use spring::{SeriesSpring, SeriesTravel};
pub use transmission::{MOST_SEGMENTS, Transmission};

use phea_dynamics::scalar::Scalar;

use crate::fluid::Fluid;
use crate::line::StiffeningMember;
use crate::parameter::ParameterError;

/// Element between force sensor and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeriesElement<S = f64> {
    /// Spring with its damper and the mass before it.
    Spring(SeriesSpring<S>),
    /// Two pistons with oil and a line between them.
    Transmission(Transmission<S>),
}

/// Series element in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MovingSeries<S = f64> {
    /// Spring with its damper and the mass before it.
    Spring(SeriesSpring<S>),
    /// Oil between two pistons.
    Oil(OilColumn<S>),
}

/// Source of the measured force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ForceFrom {
    /// Force sensor between rod and spring.
    #[default]
    Sensor,
    /// Deflection of the spring, through its own characteristic: without damper and ends.
    Deflection,
}

impl SeriesElement {
    /// Impossible parameters of this element; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        match self {
            SeriesElement::Spring(spring) => spring.problems(),
            SeriesElement::Transmission(transmission) => transmission.problems(),
        }
    }
}

impl<S: Scalar> SeriesElement<S> {
    /// Element in motion, a transmission being filled with this fluid.
    pub fn in_motion(&self, fluid: &Fluid<S>, member: StiffeningMember) -> MovingSeries<S> {
        match self {
            SeriesElement::Spring(spring) => MovingSeries::Spring(*spring),
            SeriesElement::Transmission(transmission) => {
                MovingSeries::Oil(transmission.column(fluid, member))
            }
        }
    }

    /// Compression in m at which it holds a force in N at rest, within its travel, and the slope in
    /// m/N.
    pub fn held_deflection(&self, force: S, fluid: &Fluid<S>) -> [S; 2] {
        let one = S::from(1.0);
        match self {
            SeriesElement::Spring(spring) => {
                [spring.held_deflection(force), one / spring.stiffness_under(force)]
            }
            SeriesElement::Transmission(transmission) => {
                let stiffness = transmission.column(fluid, StiffeningMember::Nominal).stiffness();
                [force / stiffness, one / stiffness]
            }
        }
    }

    /// Source of the measured force.
    pub fn force_from(&self) -> ForceFrom {
        match self {
            SeriesElement::Spring(spring) => spring.force_from,
            SeriesElement::Transmission(_) => ForceFrom::Sensor,
        }
    }
}

phea_dynamics::parameters! {
    MovingSeries = MovingSeries::Spring(spring) | MovingSeries::Oil(column)
}
