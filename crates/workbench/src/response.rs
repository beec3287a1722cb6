//! Output on frequency responses from recorded signals: text, JSON, figures, and the files of
//! a measured family.

mod answer;
mod document;
mod figures;
mod files;

pub use phea_engineering::response::*;

pub use answer::json;
pub(crate) use document::document;
pub(crate) use figures::pictures;
pub use files::files;

use num_complex::Complex64;

use crate::rig::Rig;

/// A member, and the linear plant of a project at its frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// From the record.
    pub member: ResponseMember,
    /// By the project; absent without one, and for signals other than command and force.
    pub plant: Option<Vec<Complex64>>,
}

impl Compared {
    /// Beside the plant of a rig.
    pub(crate) fn with(member: ResponseMember, rig: Option<&Rig>) -> Compared {
        let is_plant = member.units == ["V", "N"];
        let plant = rig.filter(|_| is_plant);
        let plant =
            plant.map(|rig| member.points.iter().map(|point| rig.response(point.frequency)).collect());
        Compared { member, plant }
    }

    /// Discs that hold the plant, and how far it is away at most, in dB.
    pub(crate) fn agreement(&self) -> Option<(usize, f64)> {
        let both = || self.member.points.iter().zip(self.plant.iter().flatten());
        let apart = |(point, plant): (&phea_dynamics::spectrum::SpectralPoint, &Complex64)| {
            20.0 * phea_dynamics::portable::log10((point.response / plant).norm_sqr().sqrt()).abs()
        };
        let held = both()
            .filter(|(point, plant)| (point.response - *plant).norm_sqr() <= point.radius * point.radius);
        self.plant.as_ref().map(|_| (held.count(), both().map(apart).fold(0.0, f64::max)))
    }
}

/// Why a frequency is left out, in words.
pub(crate) fn because(reason: Unusable) -> &'static str {
    match reason {
        Unusable::NotExcited => "the input does not excite this frequency",
        Unusable::Incoherent => "the coherence is below the threshold",
    }
}
