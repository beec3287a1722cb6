//! The plants evaluated for a template, their places, and lines of neighbours between them.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, report_progress};

use super::{TemplateError, TemplateOptions};
use crate::closed_loop::{Compensation, MemberResponse};
use crate::family::UncertainFamily;

/// Position of a plant: phase and magnitude of P H, with the phase continued from neighbour to
/// neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlantPosition {
    pub(super) phase_deg: f64,
    pub(super) magnitude_db: f64,
}

impl PlantPosition {
    pub(super) fn of(response: Complex64) -> PlantPosition {
        PlantPosition {
            phase_deg: portable::argument(response) * 180.0 / std::f64::consts::PI,
            magnitude_db: 20.0 * portable::log10(portable::magnitude(response)),
        }
    }

    pub(super) fn response(self) -> Complex64 {
        let magnitude = portable::pow(10.0, self.magnitude_db / 20.0);
        let phase = self.phase_deg * std::f64::consts::PI / 180.0;
        Complex64::new(magnitude * portable::cos(phase), magnitude * portable::sin(phase))
    }

    pub(super) fn is_finite(self) -> bool {
        self.phase_deg.is_finite() && self.magnitude_db.is_finite()
    }

    /// Response with the phase nearest to that of another position.
    pub(super) fn beside(self, other: PlantPosition) -> PlantPosition {
        PlantPosition { phase_deg: other.phase_deg + turned_deg(self.phase_deg - other.phase_deg), ..self }
    }
}

/// An angle reduced to within half a turn.
fn turned_deg(angle_deg: f64) -> f64 {
    angle_deg - 360.0 * (angle_deg / 360.0).round()
}

/// One point of the box.
#[derive(Clone, Debug)]
pub(super) struct TemplatePlant {
    pub(super) fractions: Vec<f64>,
    pub(super) response: MemberResponse,
    pub(super) place: PlantPosition,
    /// True if the phase is continued from another plant.
    anchored: bool,
}

/// Two neighbours without a closer plant between them.
#[derive(Clone, Debug)]
pub(super) struct Gap {
    pub(super) phase_deg: f64,
    pub(super) magnitude_db: f64,
    pub(super) plant: usize,
    apart: f64,
}

/// Reason why refinement stopped.
pub(super) enum Stop {
    /// The allowed plants or rounds are used up.
    Exhausted,
    /// A plant cannot be evaluated, or the watch stops it.
    Failed(TemplateError),
}

impl From<Stopped> for Stop {
    fn from(stopped: Stopped) -> Stop {
        Stop::Failed(stopped.into())
    }
}

/// Neighbours on a straight line of the box, with their fraction of its length.
#[derive(Clone, Debug)]
pub(super) struct BoxLine {
    pub(super) plants: Vec<usize>,
    pub(super) positions: Vec<f64>,
}

impl BoxLine {
    pub(super) fn reversed(&self) -> BoxLine {
        BoxLine {
            plants: self.plants.iter().rev().copied().collect(),
            positions: self.positions.iter().rev().map(|position| 1.0 - position).collect(),
        }
    }
}

/// Name of the stage in progress reports.
const STAGE: &str = "template";

/// Smallest part of a line that is divided further: a remaining gap does not close.
const PART_MINIMUM: f64 = 1.0 / (1 << 20) as f64;

/// All plants evaluated at one frequency.
pub(super) struct Plants<'a> {
    pub(super) family: &'a UncertainFamily,
    compensation: &'a Compensation,
    frequency_rad_per_s: f64,
    pub(super) options: TemplateOptions,
    pub(super) list: Vec<TemplatePlant>,
    pub(super) evaluations: usize,
    /// Number of evaluations at which refinement stops.
    pub(super) evaluations_maximum: usize,
    pub(super) gap: Option<Gap>,
    watch: Watch<'a>,
}

impl<'a> Plants<'a> {
    pub(super) fn new(
        family: &'a UncertainFamily,
        compensation: &'a Compensation,
        frequency_rad_per_s: f64,
        options: TemplateOptions,
        watch: Watch<'a>,
    ) -> Plants<'a> {
        let evaluations_maximum = family.members().len().saturating_add(options.evaluations_maximum);
        Plants {
            family,
            compensation,
            frequency_rad_per_s,
            options,
            list: vec![],
            evaluations: 0,
            evaluations_maximum,
            gap: None,
            watch,
        }
    }

    /// Reports the fraction of the allowed plants that were evaluated to the watch.
    pub(super) fn ask(&mut self) -> Result<(), Stopped> {
        report_progress(self.watch, STAGE, self.evaluations, self.evaluations_maximum)
    }

    /// Responses P, Pd and H at these parameter values.
    pub(super) fn response(&mut self, values: &[f64]) -> Result<MemberResponse, TemplateError> {
        self.evaluations += 1;
        self.ask()?;
        let plant = self.family.plant();
        let response = self.compensation.response_of(plant, values, self.frequency_rad_per_s);
        response.map_err(|reason| TemplateError::Plant { values: values.to_vec(), reason })
    }

    /// Adds a plant whose response is known.
    pub(super) fn keep(&mut self, fractions: Vec<f64>, response: MemberResponse) -> usize {
        let place = PlantPosition::of(response.plant * response.sensor);
        self.list.push(TemplatePlant { fractions, response, place, anchored: self.list.is_empty() });
        self.list.len() - 1
    }

    /// Adds the plant at a point of the box.
    pub(super) fn at(&mut self, fractions: Vec<f64>) -> Result<usize, Stop> {
        if self.evaluations >= self.evaluations_maximum {
            return Err(Stop::Exhausted);
        }
        let response = self.response(&self.family.values(&fractions)).map_err(Stop::Failed)?;
        Ok(self.keep(fractions, response))
    }

    pub(super) fn between(&mut self, from: usize, to: usize, position: f64) -> Result<usize, Stop> {
        let (start, end) = (&self.list[from].fractions, &self.list[to].fractions);
        let fractions =
            start.iter().zip(end).map(|(&start, &end)| start + position * (end - start)).collect();
        self.at(fractions)
    }

    pub(super) fn place(&self, plant: usize) -> PlantPosition {
        self.list[plant].place
    }

    /// Difference between two plants, in tolerances of phase and magnitude.
    pub(super) fn step(&self, from: usize, to: usize) -> [f64; 2] {
        let (from, to) = (self.place(from), self.place(to));
        self.steps(from, to.beside(from))
    }

    /// Difference between two positions, in tolerances of phase and magnitude.
    pub(super) fn steps(&self, from: PlantPosition, to: PlantPosition) -> [f64; 2] {
        [
            (to.phase_deg - from.phase_deg) / self.options.phase_deg,
            (to.magnitude_db - from.magnitude_db) / self.options.magnitude_db,
        ]
    }

    /// Distance of two plants in tolerances: neighbours are at most 1 apart.
    pub(super) fn apart(&self, from: usize, to: usize) -> f64 {
        let [phase, magnitude] = self.step(from, to);
        let apart = phase.abs().max(magnitude.abs());
        if apart.is_finite() { apart } else { f64::INFINITY }
    }

    pub(super) fn is_finite(&self, plant: usize) -> bool {
        self.place(plant).is_finite()
    }

    /// Records a gap if it is the widest.
    pub(super) fn remember_gap(&mut self, from: usize, to: usize) {
        let apart = self.apart(from, to);
        if self.gap.as_ref().is_some_and(|gap| gap.apart >= apart) {
            return;
        }
        let (from_place, to_place) = (self.place(from), self.place(to));
        let side = if self.is_finite(from) { to } else { from };
        let plant = if from_place.magnitude_db > to_place.magnitude_db { from } else { side };
        let [phase_deg, magnitude_db] = match self.step(from, to) {
            [phase, magnitude] if phase.is_finite() && magnitude.is_finite() => {
                [phase.abs() * self.options.phase_deg, magnitude.abs() * self.options.magnitude_db]
            }
            _ => [180.0, f64::INFINITY],
        };
        self.gap = Some(Gap { phase_deg, magnitude_db, plant, apart });
    }

    /// Records that a pole or a zero is near; of several plants the one with the largest magnitude.
    pub(super) fn remember_pole(&mut self, plant: usize) {
        let magnitude_db = self.place(plant).magnitude_db;
        let cache = self.gap.as_ref().is_some_and(|gap| {
            gap.apart == f64::INFINITY && self.place(gap.plant).magnitude_db >= magnitude_db
        });
        if !cache {
            let (phase_deg, apart) = (180.0, f64::INFINITY);
            self.gap = Some(Gap { phase_deg, magnitude_db: f64::INFINITY, plant, apart });
        }
    }

    /// The straight line between two plants, halved until neighbours are at most a tolerance apart,
    /// or no longer divisible.
    pub(super) fn line(&mut self, from: usize, to: usize, pieces: usize) -> Result<BoxLine, Stop> {
        let mut line = BoxLine { plants: vec![from], positions: vec![0.0] };
        let mut pending = vec![(1.0, to)];
        for piece in (1..pieces).rev() {
            let position = piece as f64 / pieces as f64;
            pending.push((position, self.between(from, to, position)?));
        }
        let (mut left, mut last) = (0.0, from);
        while let Some(&(right, next)) = pending.last() {
            let close = self.apart(last, next) <= 1.0;
            let divisible = right - left > PART_MINIMUM && (self.is_finite(last) || self.is_finite(next));
            if !close && divisible {
                let position = left + (right - left) / 2.0;
                match self.between(from, to, position) {
                    Ok(middle) => pending.push((position, middle)),
                    Err(stop) => {
                        self.remember_gap(last, next);
                        return Err(stop);
                    }
                }
                continue;
            }
            if close {
                self.anchor(last, next);
            } else {
                self.remember_gap(last, next);
            }
            line.plants.push(next);
            line.positions.push(right);
            pending.pop();
            (left, last) = (right, next);
        }
        Ok(line)
    }

    fn anchor(&mut self, from: usize, to: usize) {
        let from = self.place(from);
        if !self.list[to].anchored && from.is_finite() {
            self.list[to].place = self.list[to].place.beside(from);
            self.list[to].anchored = true;
        }
    }

    /// Halves of a line.
    pub(super) fn halves(&mut self, line: &BoxLine) -> Result<[BoxLine; 2], Stop> {
        let after = line.positions.partition_point(|&position| position < 0.5);
        let mut whole = line.clone();
        if whole.positions[after] > 0.5 {
            let (first, last) = (line.plants[0], line.plants[line.plants.len() - 1]);
            let middle = self.between(first, last, 0.5)?;
            self.anchor(line.plants[after - 1], middle);
            whole.plants.insert(after, middle);
            whole.positions.insert(after, 0.5);
        }
        let first = BoxLine {
            plants: whole.plants[..=after].to_vec(),
            positions: whole.positions[..=after].iter().map(|position| 2.0 * position).collect(),
        };
        let second = BoxLine {
            plants: whole.plants[after..].to_vec(),
            positions: whole.positions[after..].iter().map(|position| 2.0 * position - 1.0).collect(),
        };
        Ok([first, second])
    }

    /// The places along a closed walk of neighbours (the last repeats the first, and is omitted);
    /// `None` if it has a gap, or encircles a pole or a zero of the family.
    pub(super) fn closed_walk(&self, walk: &[usize]) -> Option<Vec<(PlantPosition, usize)>> {
        let first = *walk.first()?;
        let mut places = vec![(self.place(first), first)];
        let mut place = self.place(first);
        for pair in walk.windows(2) {
            if self.apart(pair[0], pair[1]) > 1.0 {
                return None;
            }
            place = self.place(pair[1]).beside(place);
            places.push((place, pair[1]));
        }
        let (end, _) = places.pop()?;
        ((end.phase_deg - self.place(first).phase_deg).abs() < 180.0).then_some(places)
    }

    /// The parts of a walk without a gap.
    pub(super) fn unbroken(&self, walk: &[usize]) -> Vec<Vec<usize>> {
        walk.chunk_by(|&from, &to| self.apart(from, to) <= 1.0).map(<[usize]>::to_vec).collect()
    }
}
