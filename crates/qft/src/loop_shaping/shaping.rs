//! The shaping of a loop as a search problem.

mod least_margins;

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Objective};
use phea_dynamics::linear::{LinearError, TransferFunction};

use super::margins::{ColumnLoop, bandwidth, candidates};
use super::sample_stability::SampleStability;
use super::samples::{FrequencyColumn, Samples, SamplesError};
use super::structure::{Structure, StructureResponse};
use super::{Judgement, SearchProblem, Slopes};
use crate::closed_loop::Compensation;
use crate::specification::Specification;
use crate::verification::{PlantPoint, SpecificationMargin, TrackingJudgement};
use least_margins::LeastMargins;

/// The measure of instability of a loop for which it is too expensive to compute.
const UNSTABLE: f64 = 1.0;

/// A structure, the samples of its margins, and an objective.
///
/// ```text
/// minimise objective(x)   subject to   margin(x; plant, frequency, specification) + rate relaxation >= 0
/// ```
///
/// With a prefilter, which has a separate structure, tracking is assessed by magnitude, and x holds
/// the free numbers of the controller, then those of the prefilter; without one, tracking is
/// assessed by the spread of the plants.
///
/// A required delay is also a margin: 20 log10 of the least delay that a plant tolerates over the
/// required delay, with the gain crossovers and their phases interpolated between the frequencies
/// of the samples.
///
/// # Example
/// Limit |1/(1+L)| <= 2 at 1 rad/s for 1/s and 4/s with a gain k: the worst plant is 1/s, for which
/// it is w/|j w + k|.
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
/// #     additional_plants: vec![],
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
    /// The last loop evaluated: slopes are mostly computed there.
    judged: Option<JudgedLoop>,
}

/// The loop at the evaluated x, with its margins.
#[derive(Clone, Debug)]
struct JudgedLoop {
    x: Vec<f64>,
    forward: Vec<[Complex64; 2]>,
    looked: LeastMargins,
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
            judged: None,
        })
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// The structure of the prefilter; `None` without one.
    pub fn prefilter(&self) -> Option<&Structure> {
        self.prefilter.as_ref()
    }

    /// Evaluation of tracking.
    pub fn tracking(&self) -> TrackingJudgement {
        self.samples.tracking()
    }

    /// The samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Adds these plants at this frequency, and at every frequency of the grid if they are new;
    /// returns true if one of them is new there.
    ///
    /// # Errors
    /// Errors of [`Samples::add`].
    pub fn add(&mut self, plants: &[PlantPoint], frequency_rad_per_s: f64) -> Result<bool, SamplesError> {
        self.judged = None;
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

    /// Shaping of these plants and frequencies with other limits, and with free numbers in the
    /// ranges of another structure with equal factors.
    #[must_use]
    pub fn with_limits(
        &self,
        structure: Structure,
        (specifications, minimum_delay_margin_s): (Vec<Specification>, f64),
    ) -> Shaping {
        let mut wider = self.clone();
        wider.samples.judge_by(specifications, minimum_delay_margin_s);
        let of_prefilter = self.prefilter.as_ref().map_or(vec![], Structure::bounds);
        wider.bounds = [structure.bounds(), of_prefilter].concat();
        Shaping { structure, judged: None, ..wider }
    }

    /// Counts margins as fractions of the room between two limits; see
    /// [`Samples::count_fractions_of_room`].
    pub(crate) fn count_fractions_of_room(&mut self) {
        self.judged = None;
        self.samples.count_fractions_of_room(true);
    }

    /// Tightens every limit by this much from now on; see [`Samples::keep_in_reserve`].
    pub(crate) fn keep_in_reserve(&mut self, reserve_db: f64) {
        self.judged = None;
        self.samples.keep_in_reserve(reserve_db);
    }

    /// Evaluates the controller of this loop in place of the one at x, but with the objective at x:
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
        let looked = self.look(&forward);
        self.judgement(x, (&forward, &looked), (stable, instability))
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

    /// The least margin to the original limits of each specification at each frequency, by
    /// frequency; empty for a controller without a response.
    pub fn margins(&self, x: &[f64]) -> Vec<SpecificationMargin> {
        let Some(forward) = self.forward(x) else { return vec![] };
        let mut around = ColumnLoop::default();
        let mut margins = Vec::new();
        let plant = |index: usize| self.samples.plants()[index].clone();
        for (column, &[feedback, prefilter]) in self.samples.columns().iter().zip(&forward) {
            around.close(column, feedback, prefilter);
            for demand in column.demands.iter().filter(|demand| !demand.is_reserve()) {
                let worst = candidates(demand, column, &around, feedback).into_iter().next();
                margins.extend(worst.map(|worst| SpecificationMargin {
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

    /// Responses G and F at the frequencies of the samples; `None` if they cannot be sampled or are
    /// not finite.
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

    /// The slopes of ln G and of ln F at the frequencies of the samples, each padded with zeros for
    /// the numbers of the other.
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
        &self,
        x: &[f64],
        (forward, looked): (&[[Complex64; 2]], &LeastMargins),
        (stable, instability): (bool, f64),
    ) -> Judgement {
        let (objective_db, _) = self.objective(x, forward, &[]);
        Judgement { objective_db, worst_margin_db: looked.worst_db, stable, instability }
    }

    /// The loop at x with its margins, reused if x was evaluated last; `None` if it has no
    /// response.
    fn judged_at(&mut self, x: &[f64]) -> Option<JudgedLoop> {
        if let Some(known) = self.judged.take().filter(|known| known.x == x) {
            return Some(known);
        }
        let forward = self.forward(x)?;
        let looked = self.look(&forward);
        Some(JudgedLoop { x: x.to_vec(), forward, looked })
    }

    /// True if every plant is stable, and the measure of instability of the worst one.
    fn stability(&mut self, x: &[f64]) -> (bool, f64) {
        let timing = &self.samples.problem().timing;
        let continuous = self.structure.compensator(self.split(x).0).transfer_function();
        let feedback = continuous.and_then(|continuous| match timing.sample_time_s {
            None => Ok(continuous),
            Some(sample_time_s) => continuous.discretized(sample_time_s, timing.discretization),
        });
        feedback.map_or((false, f64::INFINITY), |feedback| self.stability_of(&feedback))
    }

    /// Stability with this G.
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
}

impl SearchProblem for Shaping {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let Some(found) = self.judged_at(x) else { return Judgement::UNUSABLE };
        let stability = self.stability(x);
        let judgement = self.judgement(x, (&found.forward, &found.looked), stability);
        self.judged = Some(found);
        judgement
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        let none =
            || Slopes { objective_db: f64::INFINITY, objective_slopes: vec![0.0; x.len()], margins: vec![] };
        let Some(slopes) = self.forward_slopes(x) else { return none() };
        let Some(found) = self.judged_at(x) else { return none() };
        let JudgedLoop { forward, looked, .. } = &found;
        let (objective_db, objective_slopes) = self.objective(x, forward, &slopes[0]);
        let margins = self.rows(looked, forward, &slopes);
        self.judged = Some(found);
        Slopes { objective_db, objective_slopes, margins }
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
