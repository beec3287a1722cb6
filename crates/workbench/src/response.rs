//! Output on frequency responses from recorded signals: text, JSON, figures, and the files of
//! a measured family.

mod answer;
mod document;
mod figures;
mod files;
mod levels;

pub(crate) use answer::IdentifiedResponsesAnswer;
pub use answer::json;
pub(crate) use document::document;
pub(crate) use figures::pictures;
pub use files::files;
use phea_engineering::response::{ResponseMember, Unusable};
use phea_engineering::rig::Rig;

use num_complex::Complex64;
use phea_dynamics::portable::argument;
use phea_dynamics::spectrum::Distortion;

use crate::answer::significant;
use crate::quantity::DisplayUnit;

/// Points, the lowest frequencies first, that show the sign of a response.
const LOWEST: usize = 3;
/// Cosine of the angle between a response and its plant, below which they are opposite.
const OPPOSITE: f64 = -0.5;
/// Degrees by which a reversed force lags the opposite of its command.
const REVERSED_LAG: [f64; 2] = [-15.0, 105.0];

/// Ratio of the output at lines that are not excited to that at the excited ones, above which it is
/// reported.
const DISTORTED: f64 = 0.01;

/// A member, and the linear plant of a project at its frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The member estimated from the record.
    pub member: ResponseMember,
    /// Response of the project's plant; absent without a project, and for signals other than
    /// command and force.
    pub plant: Option<Vec<Complex64>>,
}

impl Compared {
    /// Compares a member with the plant of a rig.
    pub(crate) fn with(member: ResponseMember, rig: Option<&Rig>) -> Compared {
        let is_plant = member.units == ["V", "N"];
        let plant = rig.filter(|_| is_plant);
        let plant =
            plant.map(|rig| member.points.iter().map(|point| rig.response(point.frequency)).collect());
        Compared { member, plant }
    }

    /// True if the output is opposite to the input at the lowest frequencies. With a plant, the two
    /// are compared. Without one: a valve that fills a chamber leads to a force that lags its
    /// command by 0 to 90 degrees, and a reversed valve to one that lags by 180 degrees more.
    pub(crate) fn is_reversed(&self) -> bool {
        let lowest = self.member.points.iter().take(LOWEST);
        let is_opposite = |(index, point): (usize, &phea_dynamics::spectrum::SpectralPoint)| {
            let plant = self.plant.as_ref().and_then(|plant| plant.get(index));
            match plant {
                Some(plant) => {
                    let along = (point.response * plant.conj()).re;
                    along < OPPOSITE * (point.response.norm_sqr() * plant.norm_sqr()).sqrt()
                }
                None => {
                    let lag = -argument(-point.response).to_degrees();
                    (REVERSED_LAG[0]..=REVERSED_LAG[1]).contains(&lag)
                }
            }
        };
        let is_of_force = self.member.units == ["V", "N"];
        is_of_force && !self.member.points.is_empty() && lowest.enumerate().all(is_opposite)
    }

    /// Warnings on the record, in sentences without a full stop.
    pub(crate) fn warnings(&self) -> Vec<String> {
        [self.reversal(), self.distortion(), resampling(&self.member)].into_iter().flatten().collect()
    }

    /// The output at lines that the input does not excite.
    fn distortion(&self) -> Option<String> {
        let Distortion { even, odd } = self.member.distortion;
        let [input, output] = self.member.signals;
        let percent = |level: f64| significant(100.0 * level, 2);
        (even.max(odd) > DISTORTED).then(|| {
            format!(
                "{}: `{output}` does not follow `{input}` linearly, or drifts: where `{input}` has no lines, `{output}` has {} % of its size at even multiples of the lowest frequency and {} % at odd ones, in each period alike; the discs of 95 % count noise alone, and what is not linear displaces the response itself: compare records of different amplitude",
                self.member.file,
                percent(even),
                percent(odd),
            )
        })
    }

    /// An output against its input.
    fn reversal(&self) -> Option<String> {
        let lowest = self.member.points.first().filter(|_| self.is_reversed())?;
        let [input, output] = self.member.signals;
        Some(format!(
            "{}: `{output}` goes against `{input}`: at {} Hz its phase is {} degrees, and a positive command extends the rod; state `{output} = {{ reversed = true }}` in its [[identify.response]], or `{input} = {{ reversed = true }}`",
            self.member.file,
            significant(DisplayUnit::HERTZ.of(lowest.frequency), 3),
            significant(argument(lowest.response).to_degrees(), 3),
        ))
    }

    /// Number of discs that contain the plant, and its largest distance from the estimate, dB.
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

/// Rows that were resampled to even ones.
pub(crate) fn resampling(member: &ResponseMember) -> Option<String> {
    let resampled = member.resampled?;
    let milliseconds = |seconds: f64| DisplayUnit::MILLISECOND.number(seconds, 3);
    Some(format!(
        "{}: the rows are not even ({} ms between the earliest and the latest, at most {} ms apart): the signals are taken on lines between them, which follow a sine within 5 % up to {} Hz, and higher frequencies are left out",
        member.file,
        milliseconds(resampled.scatter),
        milliseconds(resampled.longest),
        significant(DisplayUnit::HERTZ.of(resampled.highest()), 3),
    ))
}

/// Reason why a frequency is left out, in words.
pub(crate) fn because(reason: Unusable) -> &'static str {
    match reason {
        Unusable::NotExcited => "the input does not excite this frequency",
        Unusable::Incoherent => "the coherence is below the threshold",
    }
}
