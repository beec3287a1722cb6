//! The shaping of a loop as a problem of a search.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use super::margins::{
    ColumnDependence, ColumnLoop, DelayMargins, Demand, MarginCandidate, bandwidth, candidates, delay_margins,
};
use super::sample_stability::SampleStability;
use super::samples::{FrequencyColumn, Samples, SamplesError};
use super::structure::{DECIBELS_PER_NEPER, Structure, StructureResponse};
use super::{Judgement, MarginRow, SearchProblem, Slopes};
use crate::closed_loop::Compensation;
use crate::design::Objective;
use crate::verification::{PlantPoint, TrackingJudgement};

/// Rows of one linearisation.
const ROWS_MAXIMUM: usize = 240;
/// The measure of instability for a loop for which it is too expensive to compute.
const UNSTABLE: f64 = 1.0;
/// Columns whose worst margin is further above the worst of all give no rows, dB.
const WINDOW_DB: f64 = 20.0;
/// Relative difference of two squares, and difference of two margins in dB, that is rounding.
const ROUNDING: f64 = 1e-9;
const ROUNDING_DB: f64 = 1e-6;

/// A structure, the samples its margins are taken at, and an objective.
///
/// ```text
/// minimise objective(x)   subject to   margin(x; plant, frequency, specification) + rate relaxation >= 0
/// ```
///
/// With a prefilter, of a structure of its own, tracking is judged by magnitude and x holds the
/// free numbers of the controller, then those of the prefilter; without one, tracking is judged by
/// the spread of the plants.
///
/// A required delay is a margin too: 20 log10 of the least delay that a plant tolerates over the
/// required delay, the gain crossovers and their phases interpolated between the frequencies of the
/// samples.
///
/// # Example
/// |1/(1+L)| <= 2 at 1 rad/s for 1/s and 4/s under a gain k: the worst plant is 1/s, for which it is w/|j w + k|.
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// # use phea_qft::verification::PlantPoint;
/// use phea_qft::design::{DesignProblem, Objective};
/// use phea_qft::loop_shaping::{Samples, SearchProblem, Shaping, Structure};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let problem = DesignProblem {
/// #     family: Family::Uncertain(UncertainFamily::new(plant, vec![], vec![], Extent::Box)?),
/// #     beside: vec![],
/// #     sensor: TransferFunction::gain_only(1.0),
/// #     timing: Timing::default(),
/// #     specifications: vec![Specification {
/// #         requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0)),
/// #         frequencies_rad_per_s: vec![1.0],
/// #         band_rad_per_s: [0.0, f64::INFINITY],
/// #     }],
/// #     minimum_delay_margin_s: 0.0,
/// # };
/// let plants = [1.0, 4.0].map(|gain| PlantPoint::Parameters(vec![gain]));
/// let samples = Samples::new(&problem, &plants, &[1.0])?;
/// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts: vec![] };
/// let mut shaping = Shaping::new(structure, None, Objective::LeastHighFrequencyGain, samples)?;
/// let judged = shaping.judge(&[0.0]); // k = 1, so that |1/(1+L)| = 1/sqrt(2)
/// assert!(judged.stable && judged.objective_db == 0.0);
/// assert!((judged.worst_margin_db - 9.0309).abs() < 1e-4);
/// let row = &shaping.slopes(&[0.0]).margins[0]; // and half a dB more for each dB of k
/// assert!((row.slopes[0] - 0.5 * 8.6859).abs() < 1e-4);
/// assert_eq!(shaping.margins(&[0.0])[0].plant, plants[0]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Shaping {
    structure: Structure,
    prefilter: Option<Structure>,
    objective: Objective,
    samples: Samples,
    response: StructureResponse,
    prefilter_response: Option<StructureResponse>,
    bounds: Vec<[f64; 2]>,
    stability: SampleStability,
    around: ColumnLoop,
}

/// The least margin to one specification at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledMargin {
    /// Index of the specification.
    pub specification: usize,
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// dB, to the original limit.
    pub margin_db: f64,
    /// The plant.
    pub plant: PlantPoint,
    /// The second plant of a spread, with the least magnitude.
    pub other: Option<PlantPoint>,
}

/// The worst of the samples at one G.
struct Looked {
    /// Of each column and demand.
    excesses: Vec<ColumnExcess>,
    delays: DelayMargins,
    worst_db: f64,
}

/// How far the worst plant of a column goes beyond a limit.
#[derive(Clone, Copy, Debug)]
struct ColumnExcess {
    column: usize,
    /// Index of the demand in the column.
    number: usize,
    /// The square of the excess.
    squared: f64,
    rate: f64,
}

impl ColumnExcess {
    /// The margin over its rate, dB.
    fn margin_db(&self) -> f64 {
        -10.0 * portable::log10(self.squared) / self.rate
    }
}

impl Shaping {
    /// The problem without relaxation.
    ///
    /// # Errors
    /// A fixed element that is not a continuous transfer function; a structure that cannot be
    /// sampled.
    pub fn new(
        structure: Structure,
        prefilter: Option<Structure>,
        objective: Objective,
        mut samples: Samples,
    ) -> Result<Shaping, LinearError> {
        structure.high_frequency_gain_db(&[])?;
        samples.judge_tracking_by(match prefilter {
            Some(_) => TrackingJudgement::Magnitude,
            None => TrackingJudgement::Spread,
        });
        let timing = samples.problem().timing;
        let frequencies = samples.frequencies_rad_per_s();
        let behind = timing.of_prefilter();
        let behind = prefilter.as_ref().map(|prefilter| prefilter.response(&behind, &frequencies));
        Ok(Shaping {
            response: structure.response(&timing, &frequencies)?,
            prefilter_response: behind.transpose()?,
            bounds: [structure.bounds(), prefilter.as_ref().map_or(vec![], Structure::bounds)].concat(),
            stability: SampleStability::new(samples.around(), samples.members().to_vec()),
            structure,
            prefilter,
            objective,
            samples,
            around: ColumnLoop::default(),
        })
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// How tracking is judged.
    pub fn tracking(&self) -> TrackingJudgement {
        self.samples.tracking()
    }

    /// The samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Adds these plants at this frequency, and at every frequency of the grid if they are new;
    /// returns whether one of them is new there.
    ///
    /// # Errors
    /// Those of [`Samples::add`].
    pub fn add(&mut self, plants: &[PlantPoint], frequency_rad_per_s: f64) -> Result<bool, SamplesError> {
        let known = self.samples.members().len();
        let new = self.samples.add(plants, frequency_rad_per_s)?;
        for plant in plants {
            self.samples.add_plant(plant)?;
        }
        for member in self.samples.members().iter().skip(known) {
            self.stability.add(member.clone());
        }
        let timing = &self.samples.problem().timing;
        let behind = timing.of_prefilter();
        let frequencies = self.samples.frequencies_rad_per_s();
        self.response = self.structure.response(timing, &frequencies)?;
        let prefilter = self.prefilter.as_ref();
        self.prefilter_response =
            prefilter.map(|prefilter| prefilter.response(&behind, &frequencies)).transpose()?;
        Ok(new)
    }

    /// Counts margins by their share of the room between two limits; see
    /// [`Samples::count_shares_of_room`].
    pub(crate) fn count_shares_of_room(&mut self) {
        self.samples.count_shares_of_room(true);
    }

    /// Tightens every limit by this much from now on; see [`Samples::keep_in_reserve`].
    pub(crate) fn keep_in_reserve(&mut self, reserve_db: f64) {
        self.samples.keep_in_reserve(reserve_db);
    }

    /// Judges the controller of this loop in place of the one at x, but with the objective at x:
    /// the effect of rounded coefficients.
    pub(crate) fn judge_deployed(&mut self, x: &[f64], law: &Compensation) -> Judgement {
        let response = |column: &FrequencyColumn| {
            let found = law.response(column.frequency);
            [found.feedback, found.prefilter]
        };
        let forward: Vec<[Complex64; 2]> = self.samples.columns().iter().map(response).collect();
        if !forward.iter().flatten().all(|one| one.is_finite()) {
            return Judgement::UNUSABLE;
        }
        let (stable, instability) = self.stability_of(law.feedback());
        self.judgement(x, &forward, stable, instability)
    }

    /// Controller and prefilter at x; without a prefilter, the gain 1.
    pub fn controller(&self, x: &[f64]) -> Controller {
        let (own, behind) = self.split(x);
        Controller {
            feedback: self.structure.compensator(own),
            prefilter: self
                .prefilter
                .as_ref()
                .map_or_else(Compensator::default, |prefilter| prefilter.compensator(behind)),
            timing: self.samples.problem().timing,
            ..Controller::default()
        }
    }

    /// The least margin to each specification at each frequency, by frequency; empty for a
    /// controller without a response.
    pub fn margins(&self, x: &[f64]) -> Vec<SampledMargin> {
        let Some(forward) = self.forward(x) else { return vec![] };
        let mut around = ColumnLoop::default();
        let mut margins = Vec::new();
        let plant = |index: usize| self.samples.plants()[index].clone();
        for (column, &[feedback, prefilter]) in self.samples.columns().iter().zip(&forward) {
            around.close(column, feedback, prefilter);
            for demand in column.demands.iter().filter(|demand| !demand.is_reserve()) {
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

    /// The numbers of the controller, and those of the prefilter.
    fn split<'x>(&self, x: &'x [f64]) -> (&'x [f64], &'x [f64]) {
        x.split_at(self.structure.dimension().min(x.len()))
    }

    /// G and F at the frequencies of the samples; `None` where they cannot be sampled or are not
    /// finite.
    fn forward(&self, x: &[f64]) -> Option<Vec<[Complex64; 2]>> {
        let (own, behind) = self.split(x);
        let feedback = self.response.values(own).ok()?;
        let prefilter = match &self.prefilter_response {
            Some(response) => response.values(behind).ok()?,
            None => vec![Complex64::new(1.0, 0.0); feedback.len()],
        };
        let both: Vec<[Complex64; 2]> = feedback.into_iter().zip(prefilter).map(|(g, f)| [g, f]).collect();
        both.iter().flatten().all(|one| one.is_finite()).then_some(both)
    }

    /// The slopes of ln G and of ln F at the frequencies of the samples, each among zeros for the
    /// numbers of the other.
    fn forward_slopes(&self, x: &[f64]) -> Option<[Vec<Vec<Complex64>>; 2]> {
        let (own, behind) = self.split(x);
        let zeros = |count: usize| vec![Complex64::new(0.0, 0.0); count];
        let feedback = self.response.slopes(own).ok()?;
        let feedback = feedback.into_iter().map(|slopes| [slopes, zeros(behind.len())].concat()).collect();
        let prefilter = match &self.prefilter_response {
            Some(response) => response.slopes(behind).ok()?,
            None => vec![],
        };
        let prefilter = prefilter.into_iter().map(|slopes| [zeros(own.len()), slopes].concat()).collect();
        Some([feedback, prefilter])
    }

    fn look(&mut self, forward: &[[Complex64; 2]]) -> Looked {
        let mut excesses = Vec::new();
        let mut worst_db = f64::INFINITY;
        // of those whose rate is 1: most logarithms need not be taken
        let mut greatest = 0.0;
        for (index, (column, &[feedback, prefilter])) in
            self.samples.columns().iter().zip(forward).enumerate()
        {
            self.around.close(column, feedback, prefilter);
            for (number, demand) in column.demands.iter().enumerate() {
                let squared = demand.worst_excess(column, &self.around);
                let excess = ColumnExcess { column: index, number, squared, rate: demand.rate() };
                excesses.push(excess);
                if excess.rate == 1.0 {
                    if squared <= greatest * (1.0 - ROUNDING) {
                        continue;
                    }
                    greatest = squared.max(greatest);
                }
                let margin_db = excess.margin_db();
                worst_db = if margin_db < worst_db { margin_db } else { worst_db };
            }
        }
        let feedback: Vec<Complex64> = forward.iter().map(|[feedback, _]| *feedback).collect();
        let columns = self.samples.columns();
        let delay_s = self.samples.problem().minimum_delay_margin_s;
        let delays = delay_margins(columns, &feedback, self.samples.plants().len(), delay_s);
        let worst_db = delays.crossovers.iter().map(|margin| margin.value_db).fold(worst_db, f64::min);
        Looked { excesses, delays, worst_db }
    }

    /// The objective and its slopes, given those of ln G at the columns.
    fn objective(&self, x: &[f64], forward: &[[Complex64; 2]], slopes: &[Vec<Complex64>]) -> (f64, Vec<f64>) {
        let own = self.split(x).0;
        match self.objective {
            Objective::LeastHighFrequencyGain => {
                let value = self.structure.high_frequency_gain_db(own).unwrap_or(f64::INFINITY);
                let mut along = self.structure.high_frequency_slopes_db();
                along.resize(x.len(), 0.0);
                (value, along)
            }
            Objective::LeastBandwidth => {
                let feedback: Vec<Complex64> = forward.iter().map(|[feedback, _]| *feedback).collect();
                match bandwidth(self.samples.columns(), &feedback) {
                    Some(found) => (found.value_db, along(&found.terms, slopes, x.len())),
                    None => (0.0, vec![0.0; x.len()]),
                }
            }
            Objective::BestWorstMargin => (0.0, vec![0.0; x.len()]),
        }
    }

    fn judgement(
        &mut self,
        x: &[f64],
        forward: &[[Complex64; 2]],
        stable: bool,
        instability: f64,
    ) -> Judgement {
        let worst_margin_db = self.look(forward).worst_db;
        let (objective_db, _) = self.objective(x, forward, &[]);
        Judgement { objective_db, worst_margin_db, stable, instability }
    }

    /// Whether every plant is stable, and how far from it the worst one is.
    fn stability(&mut self, x: &[f64]) -> (bool, f64) {
        let timing = &self.samples.problem().timing;
        let continuous = self.structure.compensator(self.split(x).0).transfer_function();
        let feedback = continuous.and_then(|continuous| match timing.sample_time_s {
            None => Ok(continuous),
            Some(sample_time_s) => continuous.discretized(sample_time_s, timing.discretization),
        });
        feedback.map_or((false, f64::INFINITY), |feedback| self.stability_of(&feedback))
    }

    /// The same with this G.
    fn stability_of(&mut self, feedback: &TransferFunction) -> (bool, f64) {
        if self.stability.is_stable(feedback) == Ok(true) {
            return (true, 0.0);
        }
        if !self.stability.is_rational() {
            let ranked = self.stability.approximate_real_part(feedback);
            return (false, ranked.map_or(f64::INFINITY, |real_part| real_part.unwrap_or(UNSTABLE)));
        }
        let judgement = self.stability.judge(feedback);
        (false, judgement.map_or(f64::INFINITY, |judgement| judgement.largest_real_part))
    }

    /// The rows of the columns and demands that matter, the least margin first.
    fn rows(
        &mut self,
        looked: &Looked,
        forward: &[[Complex64; 2]],
        [own, behind]: &[Vec<Vec<Complex64>>; 2],
    ) -> Vec<MarginRow> {
        let dimension = self.bounds.len();
        let plants = self.samples.plants().len();
        let mut found = self.least(looked, forward);
        let delays = looked.delays.crossovers.iter().chain(&looked.delays.peaks);
        let delays = delays.filter(|margin| margin.value_db.is_finite()).enumerate();
        found.extend(delays.map(|(number, margin)| (margin.value_db, RowOf::Delay(number, margin))));
        sort_by_number(&mut found, |(margin, _)| *margin);
        let columns = self.samples.columns();
        let row = |(_, row_of): (f64, RowOf<'_>)| match row_of {
            RowOf::Plant { column, number, found } => {
                let demand = columns[column].demands.get(number)?;
                let mut slopes = along(&[(column, -DECIBELS_PER_NEPER * found.sensitivity)], own, dimension);
                let through = Complex64::new(-DECIBELS_PER_NEPER * demand.prefilter_power(), 0.0);
                let of_prefilter = along(&[(column, through)], behind, dimension);
                slopes.iter_mut().zip(of_prefilter).for_each(|(slope, more)| *slope += more);
                let sample = sample_number(column, number, plants, &found);
                Some(MarginRow { sample, margin_db: found.margin_db, rate: demand.rate(), slopes })
            }
            RowOf::Delay(number, margin) => Some(MarginRow {
                sample: usize::MAX - number,
                margin_db: margin.value_db,
                rate: 1.0,
                slopes: along(&margin.terms, own, dimension),
            }),
        };
        let rows = found.into_iter().filter_map(row);
        let finite = rows.filter(|row| row.slopes.iter().all(|slope| slope.is_finite()));
        finite.take(ROWS_MAXIMUM).collect()
    }

    /// The least margins over their rates, with their plants, by column and demand: at least as
    /// many as there are rows.
    fn least(&mut self, looked: &Looked, forward: &[[Complex64; 2]]) -> Vec<(f64, RowOf<'static>)> {
        let mut found = Vec::new();
        // of those that were found, the least in order
        let mut least: Vec<f64> = Vec::with_capacity(ROWS_MAXIMUM + 1);
        for (worst, index, number) in near(looked) {
            if least.get(ROWS_MAXIMUM - 1).is_some_and(|last| *last < worst - ROUNDING_DB) {
                break;
            }
            let (column, [feedback, prefilter]) = (&self.samples.columns()[index], forward[index]);
            self.around.close(column, feedback, prefilter);
            let Some(demand) = column.demands.get(number) else { continue };
            for one in candidates(demand, column, &self.around, feedback) {
                let margin = one.margin_db / demand.rate();
                let place = least.partition_point(|known| *known <= margin);
                if place < ROWS_MAXIMUM {
                    least.insert(place, margin);
                    least.truncate(ROWS_MAXIMUM);
                }
                found.push((margin, RowOf::Plant { column: index, number, found: one }));
            }
        }
        found.sort_by_key(|(_, row_of)| row_of.place());
        found
    }
}

/// What a row is of.
#[derive(Clone, Copy, Debug)]
enum RowOf<'a> {
    Plant { column: usize, number: usize, found: MarginCandidate },
    Delay(usize, &'a ColumnDependence),
}

impl RowOf<'_> {
    /// Column and number of the demand, of a plant.
    fn place(&self) -> (usize, usize) {
        match *self {
            RowOf::Plant { column, number, .. } => (column, number),
            RowOf::Delay(..) => (usize::MAX, usize::MAX),
        }
    }
}

/// The least margins over their rates in dB, with column and demand, in order.
fn near(looked: &Looked) -> Vec<(f64, usize, usize)> {
    let farthest_db = looked.worst_db + WINDOW_DB;
    // the square of an excess with a rate of 1 that is certainly beyond
    let beyond = portable::pow(10.0, -0.1 * farthest_db) * (1.0 - ROUNDING);
    let may_be = |excess: &&ColumnExcess| excess.rate != 1.0 || excess.squared >= beyond;
    let margins = looked.excesses.iter().filter(may_be);
    let margins = margins.map(|excess| (excess.margin_db(), excess.column, excess.number));
    let mut near: Vec<(f64, usize, usize)> =
        margins.filter(|(margin_db, ..)| *margin_db <= farthest_db).collect();
    let in_order = |one: &(f64, usize, usize), other: &(f64, usize, usize)| {
        one.0.total_cmp(&other.0).then((one.1, one.2).cmp(&(other.1, other.2)))
    };
    if near.len() > ROWS_MAXIMUM {
        near.select_nth_unstable_by(ROWS_MAXIMUM, in_order);
        near.truncate(ROWS_MAXIMUM);
    }
    near.sort_unstable_by(in_order);
    near
}

/// A number for the margin of this plant, or pair, to this demand at this column.
fn sample_number(column: usize, demand: usize, plants: usize, found: &MarginCandidate) -> usize {
    let pair = found.plant * (plants + 1) + found.other.map_or(plants, |other| other);
    (column * Demand::PER_COLUMN + demand) * (plants + 1) * (plants + 1) + pair
}

impl SearchProblem for Shaping {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let Some(forward) = self.forward(x) else { return Judgement::UNUSABLE };
        let (stable, instability) = self.stability(x);
        self.judgement(x, &forward, stable, instability)
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let none =
            || Slopes { objective_db: f64::INFINITY, objective_slopes: vec![0.0; x.len()], margins: vec![] };
        let (Some(forward), Some(slopes)) = (self.forward(x), self.forward_slopes(x)) else { return none() };
        let looked = self.look(&forward);
        let (objective_db, objective_slopes) = self.objective(x, &forward, &slopes[0]);
        Slopes { objective_db, objective_slopes, margins: self.rows(&looked, &forward, &slopes) }
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
