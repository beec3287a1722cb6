//! The shaping of a loop as a search sees it.

use num_complex::Complex64;
use phea_dynamics::controller::Controller;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;

use super::margins::{ColumnLoop, DelayMargins, bandwidth, candidates, delay_margins};
use super::samples::{Samples, SamplesError};
use super::structure::{DECIBELS_PER_NEPER, Structure, StructureResponse};
use super::{Judgement, MarginRow, SearchProblem, Slopes};
use crate::closed_loop::Compensation;
use crate::design::Objective;
use crate::stability::{StabilityStatus, member_stability};
use crate::verification::PlantPoint;

/// Rows of one linearisation.
const ROWS_MAXIMUM: usize = 400;
/// Columns whose worst margin is further above the worst of all give no rows, dB.
const WINDOW_DB: f64 = 40.0;

/// A structure, the samples its margins are taken at, and an objective.
///
/// ```text
/// minimise objective(x)   subject to   margin(x; plant, frequency, specification) + rate relaxation >= 0
/// ```
#[derive(Clone, Debug)]
pub struct Shaping {
    structure: Structure,
    objective: Objective,
    samples: Samples,
    relaxation_db: f64,
    response: StructureResponse,
    bounds: Vec<[f64; 2]>,
    /// The plant that was found unstable last is looked at first.
    suspect: usize,
    around: ColumnLoop,
}

/// The least margin at one frequency to one specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledMargin {
    /// Index of the specification.
    pub specification: usize,
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// dB, to the limit as it was asked for.
    pub margin_db: f64,
    /// The plant.
    pub plant: PlantPoint,
    /// The second plant of a spread, with the least magnitude.
    pub other: Option<PlantPoint>,
}

/// The worst of the samples at one G.
struct Looked {
    /// (column, demand, excess squared for a rate of 1)
    excesses: Vec<(usize, usize, f64)>,
    delays: DelayMargins,
    worst_db: f64,
}

impl Shaping {
    /// The problem without relaxation.
    ///
    /// # Errors
    /// A fixed element that is no continuous transfer function, a structure that cannot be sampled.
    pub fn new(structure: Structure, objective: Objective, samples: Samples) -> Result<Shaping, LinearError> {
        structure.high_frequency_gain_db(&[])?;
        Ok(Shaping {
            response: structure.response(&samples.problem().timing, &samples.frequencies_rad_per_s())?,
            bounds: structure.bounds(),
            structure,
            objective,
            samples,
            relaxation_db: 0.0,
            suspect: 0,
            around: ColumnLoop::default(),
        })
    }

    /// Raises every upper limit by this much and lowers every lower one; a demanded delay falls by as many dB.
    pub fn relax(&mut self, relaxation_db: f64) {
        self.relaxation_db = relaxation_db;
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// The samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The samples, for another structure.
    pub fn into_samples(self) -> Samples {
        self.samples
    }

    /// Adds a counterexample, as [`Samples::add`] does, and its plants at every frequency of the grid.
    ///
    /// # Errors
    /// Those of [`Samples::add`].
    pub fn add(&mut self, plants: &[PlantPoint], frequency_rad_per_s: f64) -> Result<bool, SamplesError> {
        let new = self.samples.add(plants, frequency_rad_per_s)?;
        for plant in plants {
            self.samples.add_plant(plant)?;
        }
        let timing = &self.samples.problem().timing;
        self.response = self.structure.response(timing, &self.samples.frequencies_rad_per_s())?;
        Ok(new)
    }

    /// The least margin to each specification at each frequency, by frequency; empty for a controller without a response.
    pub fn margins(&self, x: &[f64]) -> Vec<SampledMargin> {
        let Some(feedback) = self.feedback(x) else { return vec![] };
        let mut around = ColumnLoop::default();
        let mut margins = Vec::new();
        let plant = |index: usize| self.samples.plants()[index].clone();
        for (column, feedback) in self.samples.columns().iter().zip(feedback) {
            around.close(column, feedback);
            for demand in &column.demands {
                let worst = candidates(demand, column, &around, feedback).into_iter().next();
                margins.extend(worst.map(|worst| SampledMargin {
                    specification: demand.specification,
                    frequency_rad_per_s: column.frequency,
                    margin_db: worst.margin_db,
                    plant: plant(worst.plant),
                    other: worst.other.map(plant),
                }));
            }
        }
        margins
    }

    /// G at the frequencies of the samples; `None` where it cannot be sampled or is no number.
    fn feedback(&self, x: &[f64]) -> Option<Vec<Complex64>> {
        let feedback = self.response.values(x).ok()?;
        feedback.iter().all(|feedback| feedback.is_finite()).then_some(feedback)
    }

    fn look(&mut self, feedback: &[Complex64]) -> Looked {
        let mut excesses = Vec::new();
        let mut worst = 0.0;
        for (index, (column, &feedback)) in self.samples.columns().iter().zip(feedback).enumerate() {
            self.around.close(column, feedback);
            for (number, demand) in column.demands.iter().enumerate() {
                let excess = demand.worst_excess(column, &self.around);
                // a margin over its rate of 2 is the margin of the square root
                let excess = if demand.rate() > 1.0 { excess.sqrt() } else { excess };
                worst = if excess > worst { excess } else { worst };
                excesses.push((index, number, excess));
            }
        }
        let columns = self.samples.columns();
        let delay_s = self.samples.problem().minimum_delay_margin_s;
        let delays = delay_margins(columns, feedback, self.samples.plants().len(), delay_s);
        let worst_db = delays.crossovers.iter().map(|margin| margin.value_db).fold(decibels(worst), f64::min);
        Looked { excesses, delays, worst_db }
    }

    /// The objective and its slopes, given those of ln G at the columns.
    fn objective(&self, x: &[f64], feedback: &[Complex64], slopes: &[Vec<Complex64>]) -> (f64, Vec<f64>) {
        match self.objective {
            Objective::LeastHighFrequencyGain => {
                let value = self.structure.high_frequency_gain_db(x).unwrap_or(f64::INFINITY);
                (value, self.structure.high_frequency_slopes_db())
            }
            Objective::LeastBandwidth => match bandwidth(self.samples.columns(), feedback) {
                Some(found) => (found.value_db, along(&found.terms, slopes, x.len())),
                None => (0.0, vec![0.0; x.len()]),
            },
            Objective::BestWorstMargin => (0.0, vec![0.0; x.len()]),
        }
    }

    /// Whether no plant is found unstable.
    fn is_stable(&mut self, x: &[f64]) -> bool {
        let problem = self.samples.problem();
        let controller = Controller {
            feedback: self.structure.compensator(x),
            timing: problem.timing,
            ..Controller::default()
        };
        let Ok(compensation) = Compensation::new(&controller, problem.sensor.clone()) else { return false };
        let members = self.samples.members();
        let others = (0..members.len()).filter(|&index| index != self.suspect);
        let unstable = std::iter::once(self.suspect).chain(others).find(|&index| {
            members.get(index).is_some_and(|member| {
                let status = member_stability(member, &compensation).status;
                matches!(status, StabilityStatus::Unstable(_))
            })
        });
        self.suspect = unstable.unwrap_or(self.suspect);
        unstable.is_none()
    }

    /// The rows of the columns and demands that matter, the least margin first.
    fn rows(&mut self, looked: &Looked, feedback: &[Complex64], slopes: &[Vec<Complex64>]) -> Vec<MarginRow> {
        let dimension = self.bounds.len();
        let mut near: Vec<(f64, usize, usize)> = looked
            .excesses
            .iter()
            .map(|&(column, demand, excess)| (decibels(excess), column, demand))
            .filter(|(margin_db, ..)| *margin_db <= looked.worst_db + WINDOW_DB)
            .collect();
        near.sort_by(|one, other| one.0.total_cmp(&other.0));
        near.truncate(ROWS_MAXIMUM);
        near.sort_by_key(|&(_, column, demand)| (column, demand));
        let mut rows = Vec::new();
        for (index, number) in near.iter().map(|&(_, column, demand)| (column, demand)) {
            let (column, feedback) = (&self.samples.columns()[index], feedback[index]);
            self.around.close(column, feedback);
            let demand = &column.demands[number];
            for found in candidates(demand, column, &self.around, feedback) {
                let factor = -DECIBELS_PER_NEPER * found.sensitivity;
                rows.push(MarginRow {
                    margin_db: found.margin_db + demand.rate() * self.relaxation_db,
                    rate: demand.rate(),
                    slopes: along(&[(index, factor)], slopes, dimension),
                });
            }
        }
        let delays = looked.delays.crossovers.iter().chain(&looked.delays.peaks);
        rows.extend(delays.filter(|margin| margin.value_db.is_finite()).map(|margin| MarginRow {
            margin_db: margin.value_db + self.relaxation_db,
            rate: 1.0,
            slopes: along(&margin.terms, slopes, dimension),
        }));
        rows.retain(|row| row.slopes.iter().all(|slope| slope.is_finite()));
        rows.sort_by(|one, other| (one.margin_db / one.rate).total_cmp(&(other.margin_db / other.rate)));
        rows.truncate(ROWS_MAXIMUM);
        rows
    }
}

impl SearchProblem for Shaping {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let Some(feedback) = self.feedback(x) else {
            let none = f64::NEG_INFINITY;
            return Judgement { objective_db: f64::INFINITY, worst_margin_db: none, stable: false };
        };
        let worst_margin_db = self.look(&feedback).worst_db + self.relaxation_db;
        let (objective_db, _) = self.objective(x, &feedback, &[]);
        Judgement { objective_db, worst_margin_db, stable: self.is_stable(x) }
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let none =
            || Slopes { objective_db: f64::INFINITY, objective_slopes: vec![0.0; x.len()], margins: vec![] };
        let (Some(feedback), Ok(slopes)) = (self.feedback(x), self.response.slopes(x)) else { return none() };
        let looked = self.look(&feedback);
        let (objective_db, objective_slopes) = self.objective(x, &feedback, &slopes);
        Slopes { objective_db, objective_slopes, margins: self.rows(&looked, &feedback, &slopes) }
    }
}

/// The sum of Re(factor d ln G/dx) over columns.
fn along(terms: &[(usize, Complex64)], slopes: &[Vec<Complex64>], dimension: usize) -> Vec<f64> {
    let mut sum = vec![0.0; dimension];
    for (column, factor) in terms {
        for (sum, slope) in sum.iter_mut().zip(slopes.get(*column).into_iter().flatten()) {
            *sum += (factor * slope).re;
        }
    }
    sum
}

/// The margin in dB that belongs to a squared excess.
fn decibels(excess: f64) -> f64 {
    -10.0 * portable::log10(excess)
}
