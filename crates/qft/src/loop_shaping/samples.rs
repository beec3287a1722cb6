//! The samples of a search: plants, frequencies, and the response of each plant at each frequency,
//! evaluated once.

mod frequencies;

use frequencies::bends;
pub use frequencies::search_frequencies;

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller};
use phea_dynamics::linear::LinearError;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{PlantCoefficients, PlantMember, UncertainPlant};

use super::margins::{Demand, Keeping, demands};
use crate::closed_loop::{Compensation, Member, MemberResponse};
use crate::family::{Extent, Family, MeasuredPlant, UncertainFamily};
use crate::loop_shaping::DesignProblem;
use crate::specification::Specification;
use crate::template::around_disc;
use crate::verification::{PlantPoint, TrackingJudgement};

/// Relative distance from an undamped pole, where a plant has no response, at which it is evaluated
/// instead.
const BESIDE: f64 = 1e-9;

/// Reason why there are no samples.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SamplesError {
    /// The loop cannot be formed.
    #[error("{0}")]
    Linear(#[from] LinearError),
    /// A point that is not a plant of the family.
    #[error("{0:?} is not a plant of the family")]
    Plant(PlantPoint),
}

/// The plants and frequencies that a search evaluates in their loop: every plant at every frequency
/// of a grid, and additional single plants at single frequencies. Delay, hold and sensor are those
/// of the loop, as in the audit.
///
/// # Example
/// Plant k/s at 1 and 10 rad/s with gains of 1 and 4, then the counterexample k = 3 at 2 rad/s:
/// ```
/// use phea_dynamics::controller::Timing;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_qft::design::DesignProblem;
/// use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::loop_shaping::Samples;
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::PlantPoint;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let problem = DesignProblem {
///     family: Family::Uncertain(UncertainFamily::new(plant, vec![], vec![], Extent::Box)?),
///     additional_plants: vec![],
///     sensor: TransferFunction::gain_only(1.0),
///     timing: Timing::default(),
///     specifications: vec![Specification {
///         requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0)),
///         frequencies_rad_per_s: vec![1.0],
///         band_rad_per_s: [0.0, f64::INFINITY],
///     }],
///     minimum_delay_margin_s: 0.0,
/// };
/// let k = |value: f64| PlantPoint::Parameters(vec![value]);
/// let mut samples = Samples::new(&problem, &[k(1.0), k(4.0)], &[1.0, 10.0])?;
/// assert!(samples.add(&[k(3.0)], 2.0)?);
/// assert!(!samples.add(&[k(3.0)], 2.0)?); // known already
/// assert_eq!(samples.frequencies_rad_per_s(), [1.0, 2.0, 10.0]);
/// assert_eq!((samples.plants().len(), samples.pairs()), (3, 5));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Samples {
    problem: DesignProblem,
    /// Loop with a controller of gain 1.
    around: Compensation,
    tracking: TrackingJudgement,
    keeping: Keeping,
    plants: Vec<PlantPoint>,
    members: Vec<Member>,
    columns: Vec<FrequencyColumn>,
}

/// The plants at one frequency: P, Pd and H as they enter the closed loops, each quantity in a
/// separate array.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FrequencyColumn {
    pub(super) frequency: f64,
    /// True if every plant is evaluated here.
    grid: bool,
    pub(super) demands: Vec<Demand>,
    /// Indices of the plants; the fields that follow are in this order.
    pub(super) plants: Vec<usize>,
    /// True if the plants are the first of all, each once, in their order.
    pub(super) in_order: bool,
    /// Real part of P H.
    pub(super) loop_re: Vec<f64>,
    pub(super) loop_im: Vec<f64>,
    /// Squared magnitude |P H|^2.
    pub(super) loop_squared: Vec<f64>,
    /// Squared magnitude |P|^2.
    pub(super) plant_squared: Vec<f64>,
    /// Squared magnitude |Pd|^2.
    pub(super) load_motion_squared: Vec<f64>,
}

impl Samples {
    /// Samples of every one of these plants at every one of these frequencies, rad/s, positive, at
    /// most pi/T in a sampled loop. The first plant is the nominal one.
    ///
    /// # Errors
    /// A point that is not a plant of the family; a plant or sensor that does not fit the loop.
    pub fn new(
        problem: &DesignProblem,
        plants: &[PlantPoint],
        frequencies_rad_per_s: &[f64],
    ) -> Result<Samples, SamplesError> {
        let mut samples = Samples {
            problem: problem.clone(),
            around: around(problem)?,
            tracking: TrackingJudgement::Spread,
            keeping: Keeping::default(),
            plants: vec![],
            members: vec![],
            columns: vec![],
        };
        for &frequency in frequencies_rad_per_s {
            let place = samples.column(frequency);
            samples.columns[place].grid = true;
        }
        for plant in plants {
            samples.add_plant(plant)?;
        }
        Ok(samples)
    }

    /// Adds these plants at this frequency; returns true if one of them is new there.
    ///
    /// # Errors
    /// Errors of [`Samples::new`].
    pub fn add(&mut self, plants: &[PlantPoint], frequency_rad_per_s: f64) -> Result<bool, SamplesError> {
        let mut new = false;
        for plant in plants {
            let index = self.plant(plant)?;
            let place = self.column(frequency_rad_per_s);
            new |= self.put(index, place);
        }
        Ok(new)
    }

    /// Adds this plant at every frequency of the grid.
    ///
    /// # Errors
    /// Errors of [`Samples::new`].
    pub(crate) fn add_plant(&mut self, plant: &PlantPoint) -> Result<(), SamplesError> {
        let index = self.plant(plant)?;
        for place in 0..self.columns.len() {
            if self.columns[place].grid {
                self.put(index, place);
            }
        }
        Ok(())
    }

    /// Adds the nominal plant of another family, which the loop must also control.
    ///
    /// # Errors
    /// Errors of [`Samples::new`].
    pub(crate) fn take_in(&mut self, plant: UncertainPlant) -> Result<(), SamplesError> {
        let point = PlantPoint::Additional(self.problem.additional_plants.len());
        self.problem.additional_plants.push(plant);
        self.add_plant(&point)?;
        self.sample_densely(&point)
    }

    /// Adds this plant at the frequencies where its response bends, since a resonance may be
    /// between the frequencies of the grid.
    ///
    /// # Errors
    /// Errors of [`Samples::new`].
    pub(crate) fn sample_densely(&mut self, point: &PlantPoint) -> Result<(), SamplesError> {
        let highest = self.around.highest_frequency_rad_per_s();
        for frequency in bends(&self.problem, point)?.into_iter().filter(|frequency| *frequency <= highest) {
            self.add(std::slice::from_ref(point), frequency)?;
        }
        Ok(())
    }

    /// Evaluation of tracking.
    pub fn tracking(&self) -> TrackingJudgement {
        self.tracking
    }

    /// Sets the evaluation of tracking.
    pub(crate) fn judge_tracking_by(&mut self, tracking: TrackingJudgement) {
        self.tracking = tracking;
        self.demand_anew();
    }

    /// Replaces the limits.
    pub(super) fn judge_by(&mut self, specifications: Vec<Specification>, minimum_delay_margin_s: f64) {
        self.problem.specifications = specifications;
        self.problem.minimum_delay_margin_s = minimum_delay_margin_s;
        self.demand_anew();
    }

    /// Tightens every limit by this much, dB; by a fraction of it if two limits are close together.
    pub(crate) fn keep_in_reserve(&mut self, reserve_db: f64) {
        self.keeping.reserve_db = reserve_db;
        self.demand_anew();
    }

    /// Measures a margin as a fraction of the distance between two limits, if that is less than 1
    /// dB. Otherwise limits that meet, as those of tracking do at zero frequency, would leave no
    /// margin to increase.
    pub(crate) fn count_fractions_of_room(&mut self, fraction_of_room: bool) {
        self.keeping.fraction_of_room = fraction_of_room;
        self.demand_anew();
    }

    fn demand_anew(&mut self) {
        for place in 0..self.columns.len() {
            self.columns[place].demands = self.demands(self.columns[place].frequency);
        }
    }

    fn demands(&self, frequency: f64) -> Vec<Demand> {
        let highest = self.around.highest_frequency_rad_per_s();
        demands(&self.problem.specifications, self.tracking, self.keeping, [frequency, highest])
    }

    /// The family with the plants of the samples as its members; its box, if it has one, is
    /// unchanged.
    pub fn family(&self) -> Family {
        match &self.problem.family {
            Family::Uncertain(family) if family.extent() == Extent::Box => {
                let values = self.plants.iter().filter_map(|plant| match plant {
                    PlantPoint::Parameters(values) => Some(values.clone()),
                    PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
                });
                let plant = family.plant().clone();
                let coordinates = family.coordinates().to_vec();
                UncertainFamily::new(plant, coordinates, values.collect(), Extent::Box)
                    .map_or_else(|_| self.problem.family.clone(), Family::Uncertain)
            }
            whole => whole.clone(),
        }
    }

    /// The design problem.
    pub fn problem(&self) -> &DesignProblem {
        &self.problem
    }

    /// The plants, in the given order, the nominal one first.
    pub fn plants(&self) -> &[PlantPoint] {
        &self.plants
    }

    /// The plants as they are in the loop, in that order.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The frequencies, increasing, rad/s.
    pub fn frequencies_rad_per_s(&self) -> Vec<f64> {
        self.columns.iter().map(|column| column.frequency).collect()
    }

    /// The frequencies at which every plant is evaluated, increasing, rad/s.
    pub(crate) fn grid_frequencies_rad_per_s(&self) -> Vec<f64> {
        self.columns.iter().filter(|column| column.grid).map(|column| column.frequency).collect()
    }

    /// Number of pairs of a plant and a frequency.
    pub fn pairs(&self) -> usize {
        self.columns.iter().map(|column| column.plants.len()).sum()
    }

    /// The loop, with a controller of gain 1.
    pub(super) fn around(&self) -> &Compensation {
        &self.around
    }

    pub(super) fn columns(&self) -> &[FrequencyColumn] {
        &self.columns
    }

    /// The index of a plant, which is added to the loop if it is new.
    fn plant(&mut self, point: &PlantPoint) -> Result<usize, SamplesError> {
        if let Some(index) = self.plants.iter().position(|known| known == point) {
            return Ok(index);
        }
        let member = match plant_at(&self.problem, point)? {
            FamilyPlant::Rational(coefficients) => self.around.member(coefficients)?,
            FamilyPlant::Measured(measured) => self.around.measured(measured),
            FamilyPlant::Responding(plant) => self.around.responding(plant),
        };
        self.plants.push(point.clone());
        self.members.push(member);
        Ok(self.plants.len() - 1)
    }

    /// The index of the column of a frequency, which is added if it is new.
    fn column(&mut self, frequency: f64) -> usize {
        let place = self.columns.partition_point(|column| column.frequency < frequency);
        if self.columns.get(place).is_none_or(|column| column.frequency != frequency) {
            let demands = self.demands(frequency);
            self.columns.insert(place, FrequencyColumn::new(frequency, demands));
        }
        place
    }

    /// Evaluates a plant in a column; true if it was not there before. A measured plant is not
    /// evaluated where it was not measured.
    fn put(&mut self, plant: usize, place: usize) -> bool {
        let column = &mut self.columns[place];
        if column.plants.contains(&plant) {
            return false;
        }
        let finite = |frequency: f64| {
            let response = self.members[plant].response(frequency)?;
            let parts = [response.plant, response.plant * response.sensor, response.load_motion];
            let is_finite = parts.iter().all(|part| part.is_finite());
            is_finite.then(|| (response, self.members[plant].radius(frequency, &response)))
        };
        let Some((response, radius)) =
            finite(column.frequency).or_else(|| finite(column.frequency * (1.0 + BESIDE)))
        else {
            return false;
        };
        column.push(plant, &response);
        for corner in around_disc(response.plant, radius) {
            column.push(plant, &MemberResponse { plant: corner, ..response });
        }
        true
    }
}

impl FrequencyColumn {
    fn new(frequency: f64, demands: Vec<Demand>) -> FrequencyColumn {
        FrequencyColumn {
            frequency,
            grid: false,
            demands,
            plants: vec![],
            in_order: true,
            loop_re: vec![],
            loop_im: vec![],
            loop_squared: vec![],
            plant_squared: vec![],
            load_motion_squared: vec![],
        }
    }

    /// Adds a response of a plant; a plant known within a disc has several.
    fn push(&mut self, plant: usize, response: &MemberResponse) {
        let with_sensor = response.plant * response.sensor;
        self.in_order &= plant == self.plants.len();
        self.plants.push(plant);
        self.loop_re.push(with_sensor.re);
        self.loop_im.push(with_sensor.im);
        self.loop_squared.push(with_sensor.norm_sqr());
        self.plant_squared.push(response.plant.norm_sqr());
        self.load_motion_squared.push(response.load_motion.norm_sqr());
    }

    /// Response P H of the plant at this place.
    pub(super) fn loop_at(&self, place: usize) -> Complex64 {
        Complex64::new(self.loop_re[place], self.loop_im[place])
    }
}

/// A plant of a family.
enum FamilyPlant<'a> {
    Rational(PlantCoefficients<f64>),
    Measured(&'a MeasuredPlant),
    Responding(Arc<dyn RespondingPlant>),
}

fn plant_at<'a>(problem: &'a DesignProblem, point: &PlantPoint) -> Result<FamilyPlant<'a>, SamplesError> {
    let of_box = |plant: PlantMember| match plant {
        PlantMember::Rational(coefficients) => FamilyPlant::Rational(coefficients),
        PlantMember::Responding(plant) => FamilyPlant::Responding(plant),
    };
    let plant = match (&problem.family, point) {
        (_, PlantPoint::Additional(index)) => {
            let beside = problem.additional_plants.get(*index);
            beside.and_then(|plant| plant.member(&plant.nominal())).map(of_box)
        }
        (Family::Uncertain(family), PlantPoint::Parameters(values)) => {
            let complete = values.len() == family.plant().parameters().len();
            complete.then(|| family.plant().member(values)).flatten().map(of_box)
        }
        (Family::Measured(family), PlantPoint::Measured(index)) => {
            family.plants().get(*index).map(FamilyPlant::Measured)
        }
        _ => None,
    };
    plant.ok_or_else(|| SamplesError::Plant(point.clone()))
}

/// The loop with a controller of gain 1.
fn around(problem: &DesignProblem) -> Result<Compensation, LinearError> {
    let controller =
        Controller { feedback: Compensator::default(), timing: problem.timing, ..Controller::default() };
    Compensation::new(&controller, problem.sensor.clone())
}
