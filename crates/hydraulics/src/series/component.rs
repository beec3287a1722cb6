//! Element between force sensor and load from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredSeries, DeclaredSpring, DeclaredTransmission};
use super::{SeriesElement, SeriesSpring, SeriesTravel, Transmission};
use crate::contact::Contact;
use crate::line::ExpansionPressures;

impl<S: Scalar> DeclaredSeries<S> {
    /// The spring or the transmission.
    pub fn component(&self) -> SeriesElement<S> {
        match self {
            DeclaredSeries::Spring(declared) => SeriesElement::Spring(declared.component()),
            DeclaredSeries::Transmission(declared) => SeriesElement::Transmission(declared.component()),
        }
    }
}

impl<S: Scalar> DeclaredTransmission<S> {
    /// Transmission whose hose has the expansion at the filling pressure.
    fn component(&self) -> Transmission<S> {
        let filling_pressure = self.filling_pressure;
        Transmission {
            piston_area: self.piston_area,
            line: self.line.component(ExpansionPressures::at(filling_pressure)),
            end_volume: self.end_volume,
            filling_pressure,
            segments: self.segments as usize,
        }
    }
}

impl<S: Scalar> DeclaredSpring<S> {
    /// Spring without a damper, a mass or a progression of zero.
    fn component(&self) -> SeriesSpring<S> {
        SeriesSpring {
            stiffness: self.stiffness,
            damping: self.damping,
            mass: self.mass,
            travel: self.travel.map(|travel| SeriesTravel {
                travel,
                progression: self.progression,
                ends: self
                    .stop_stiffness
                    .map(|stiffness| Contact { stiffness, relative_damping: self.stop_damping }),
            }),
            force_from: self.force_from,
        }
    }
}
