//! Stability of a sample of plants with a given controller, evaluated thousands of times in a
//! search.
//!
//! ```text
//! D(s) Gd(s) + N(s) Gn(s) = 0          every root left of the imaginary axis?        Routh's table, N and D prepared once
//! in a sampled loop likewise in w = (z - 1)/(z + 1), whose imaginary axis is the unit circle of z
//! ```
//!
//! The table carries bounds of its rounding errors, so that its result is yes, no, or undecided; if
//! undecided, and for dead time and measured plants, the counts of [`crate::stability`] decide.

mod quotient;
mod rounded_polynomial;

use std::cell::OnceCell;

use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use crate::closed_loop::{Compensation, Member};
use crate::family::{COARSE, MeasuredPlant, points, table, tabulated};
use crate::stability::{
    FeedbackPath, Irresolution, LoopPoint, StabilityStatus, is_stable_by_points, member_stability, own_poles,
    points_with_sensor, poles_lie_below,
};
use quotient::BilinearQuotient;
use rounded_polynomial::{Hurwitz, RoundedPolynomial};

/// Resolution of real parts: number per decade, from the least to the largest.
const REAL_PARTS_PER_DECADE: f64 = 256.0;
const LEAST_REAL_PART: f64 = 1e-9;
const DECADES: usize = 21;
/// Factor above half the sampling rate up to which a plant without polynomials is tabulated.
const ABOVE_NYQUIST: f64 = 20.0;

/// Plants of one loop, prepared for testing many controllers.
///
/// The plants most recently found unstable are tested first, because [`SampleStability::is_stable`]
/// ends at the first unstable plant. Results do not depend on that order.
///
/// # Example
/// Plant k/(s (s + 1) (s + 2)), stable for 0 < k < 6; at k = 24 its poles are the roots of s^3 + 3
/// s^2 + 2 s + 24 = 0, two of which have the real part 0.5.
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::loop_shaping::SampleStability;
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let plant = |k| {
///     let command = RationalCoefficients { numerator: vec![k], denominator: vec![1.0, 3.0, 2.0, 0.0] };
///     compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })
/// };
/// let mut plants = SampleStability::new(&compensation, vec![plant(1.0)?, plant(4.0)?]);
/// assert!(plants.is_stable(&TransferFunction::gain_only(1.4))?);
/// let judgement = plants.judge(&TransferFunction::gain_only(6.0))?;
/// assert_eq!(judgement.unstable_plants, 2); // k = 6 is no longer stable, k = 24 less so
/// assert!((judgement.largest_real_part - 0.5).abs() < 0.005);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct SampleStability {
    compensation: Compensation,
    plants: Vec<PlantInLoop>,
    order: Vec<usize>,
}

/// The stability of the plants with a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleJudgement {
    /// Number of plants that are unstable, or that cannot be shown to be stable.
    pub unstable_plants: usize,
    /// Bound, to one percent, on the real parts of the closed-loop poles of the unstable plants
    /// (ln|z|/T in a sampled loop), 1/s: the decay rate that the loop lacks. 0 if all are stable or
    /// the bound is below 1e-9; infinite for a delayed loop whose gain grows with frequency.
    /// Measured plants, whose poles are unknown, do not count.
    pub largest_real_part: f64,
    /// Number of plants that the table could not decide.
    pub undecided_tables: usize,
}

/// A plant within the loop; without a quotient if it has dead time or is measured.
#[derive(Clone, Debug)]
struct PlantInLoop {
    member: Member,
    quotient: Option<BilinearQuotient>,
    /// Quotient with the dead time, if any, approximated: for ranking only.
    approximation: Option<BilinearQuotient>,
    /// Frequency, rad/s, and P H of a measured plant, which a controller does not change.
    with_sensor: Vec<LoopPoint>,
}

/// The controller under test.
struct TestedController {
    compensation: Compensation,
    feedback: Option<BilinearQuotient>,
    path: OnceCell<Result<FeedbackPath, Irresolution>>,
}

impl SampleStability {
    /// Prepares these plants within this loop; the controller of the loop is replaced by the
    /// controllers under test.
    pub fn new(compensation: &Compensation, members: Vec<Member>) -> SampleStability {
        let none = SampleStability { compensation: compensation.clone(), plants: vec![], order: vec![] };
        members.into_iter().fold(none, |mut plants, member| {
            plants.add(member);
            plants
        })
    }

    /// Adds one more plant.
    pub fn add(&mut self, member: Member) {
        let member = match member {
            // a search evaluates this too often to use the plant itself
            Member::Responding { ref plant, .. } => match own_poles(&member, &self.compensation) {
                Some(own) => self.folded(&member, plant.as_ref(), own.ok()),
                None => self.compensation.measured(&self.tabulated(plant.as_ref())),
            },
            other => other,
        };
        let quotient = BilinearQuotient::of_member(&member);
        let approximation =
            if quotient.is_none() { BilinearQuotient::of_delayed_member(&member) } else { None };
        self.order.insert(0, self.plants.len());
        let with_sensor = points_with_sensor(&member, &self.compensation);
        self.plants.push(PlantInLoop { member, quotient, approximation, with_sensor });
    }

    /// A plant without polynomials, tabulated as far as the images of a sampled loop require.
    fn tabulated(&self, plant: &dyn RespondingPlant) -> MeasuredPlant {
        let [from, to] = plant.range_rad_per_s();
        let highest = self.compensation.sample_time_s().map_or(0.0, |sample| std::f64::consts::PI / sample);
        tabulated(plant, [from, to.max(ABOVE_NYQUIST * highest)], COARSE)
    }

    /// Response P H seen by the controller if a rate is fed back: a table of the sampled response.
    fn folded(&self, member: &Member, plant: &dyn RespondingPlant, own: Option<usize>) -> Member {
        let [from, to] = plant.range_rad_per_s();
        let response = |frequency: f64| {
            let found = member.response(frequency)?;
            Some([found.plant * found.sensor; 2])
        };
        let range = [from, to.min(self.compensation.highest_frequency_rad_per_s())];
        Member::Measured {
            plant: table(points(response, range, COARSE), own),
            sensor: TransferFunction::gain_only(1.0),
            delay_s: 0.0,
            sample_time_s: None,
        }
    }

    /// True if no plant has dead time or is only measured: testing is then cheap.
    pub fn is_rational(&self) -> bool {
        self.plants.iter().all(|plant| plant.quotient.is_some())
    }

    /// True if every plant is stable with this controller; a plant for which this cannot be shown
    /// counts as unstable.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`] for a controller that is not in the time domain of the loop.
    pub fn is_stable(&mut self, feedback: &TransferFunction) -> Result<bool, LinearError> {
        let question = self.question(feedback)?;
        let unstable = self.order.iter().position(|&index| {
            self.plants.get(index).is_some_and(|plant| !question.is_stable(plant, &mut 0))
        });
        self.evaluate_first(unstable);
        Ok(unstable.is_none())
    }

    /// Number of plants that are unstable with this controller, and degree of instability: for
    /// ranking controllers that fail, which takes about ten times as long as showing that one does
    /// not fail.
    ///
    /// # Errors
    /// Errors of [`SampleStability::is_stable`].
    pub fn judge(&mut self, feedback: &TransferFunction) -> Result<SampleJudgement, LinearError> {
        let question = self.question(feedback)?;
        let mut judgement =
            SampleJudgement { unstable_plants: 0, largest_real_part: 0.0, undecided_tables: 0 };
        let mut worst = None;
        for (position, plant) in self.order.iter().filter_map(|&index| self.plants.get(index)).enumerate() {
            if question.is_stable(plant, &mut judgement.undecided_tables) {
                continue;
            }
            judgement.unstable_plants += 1;
            let known = judgement.largest_real_part;
            if worst.is_none() || (known.is_finite() && !question.lies_below(plant, known)) {
                judgement.largest_real_part = question.largest_real_part(plant);
                worst = Some(position);
            }
        }
        self.evaluate_first(worst);
        Ok(judgement)
    }

    /// Bound, to one percent, on the real parts of all closed-loop poles, 1/s; 0 if none is
    /// positive. Dead time is replaced by its third-order Padé approximation: for ranking
    /// controllers that fail in a loop with dead time, where the poles themselves are expensive to
    /// compute. `None` if a plant is measured, the controller has dead time, or the loop is sampled
    /// and its delay is long.
    ///
    /// # Errors
    /// Errors of [`SampleStability::is_stable`].
    ///
    /// # Example
    /// Plant e^(-sT)/(s - 2): with a gain of 1 a pole between 0 and 2 1/s remains, here at 1.1 1/s:
    /// s - 2 + e^(-0.0957 s) = 0.
    /// ```
    /// use phea_dynamics::controller::Controller;
    /// use phea_dynamics::linear::TransferFunction;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
    /// use phea_qft::closed_loop::Compensation;
    /// use phea_qft::loop_shaping::SampleStability;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
    /// let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, -2.0] };
    /// let dead_time_s = -(0.9_f64).ln() / 1.1;
    /// let member = compensation.member(PlantCoefficients { command, disturbance: None, dead_time_s, rate: None })?;
    /// let plants = SampleStability::new(&compensation, vec![member]);
    /// let rightmost = plants.approximate_real_part(&TransferFunction::gain_only(1.0))?.ok_or("none")?;
    /// assert!((rightmost - 1.1).abs() < 0.011 + 1e-6);
    /// # Ok(())
    /// # }
    /// ```
    pub fn approximate_real_part(&self, feedback: &TransferFunction) -> Result<Option<f64>, LinearError> {
        let question = self.question(feedback)?;
        let mut greatest = 0.0_f64;
        for plant in &self.plants {
            let quotient = plant.quotient.as_ref().or(plant.approximation.as_ref());
            let Some((quotient, own)) = quotient.zip(question.feedback.as_ref()) else { return Ok(None) };
            let characteristic = quotient.closed(own);
            let lies_below = |real_part: f64| question.all_below(&characteristic, real_part);
            if !lies_below(greatest) {
                greatest = first_below(lies_below);
            }
        }
        Ok(Some(greatest))
    }

    fn question(&self, feedback: &TransferFunction) -> Result<TestedController, LinearError> {
        let compensation = self.compensation.with_feedback(feedback.clone())?;
        Ok(TestedController {
            compensation,
            feedback: BilinearQuotient::of_function(feedback),
            path: OnceCell::new(),
        })
    }

    fn evaluate_first(&mut self, position: Option<usize>) {
        if let Some(first) = position.and_then(|position| self.order.get_mut(..=position)) {
            first.rotate_right(1);
        }
    }
}

impl TestedController {
    fn is_stable(&self, plant: &PlantInLoop, undecided_tables: &mut usize) -> bool {
        match self.characteristic(plant).map(|characteristic| characteristic.hurwitz()) {
            Some(Hurwitz::Yes) => true,
            Some(Hurwitz::No) => false,
            Some(Hurwitz::Undecided) => {
                *undecided_tables += 1;
                self.is_shown_stable(&plant.member)
            }
            None if matches!(plant.member, Member::Measured { .. }) => {
                is_stable_by_points(&plant.member, &plant.with_sensor, &self.compensation)
            }
            None => self.delayed_poles_lie_below(&plant.member, 0.0) == Ok(true),
        }
    }

    fn is_shown_stable(&self, member: &Member) -> bool {
        member_stability(member, &self.compensation).status == StabilityStatus::Stable
    }

    /// The characteristic polynomial; `None` if dead time leaves no polynomial.
    fn characteristic(&self, plant: &PlantInLoop) -> Option<RoundedPolynomial> {
        Some(plant.quotient.as_ref()?.closed(self.feedback.as_ref()?))
    }

    /// True if no pole has a real part above this one, or this cannot be decided, unless the number
    /// of turns is unlimited.
    fn lies_below(&self, plant: &PlantInLoop, real_part: f64) -> bool {
        if let Some(characteristic) = self.characteristic(plant) {
            return self.all_below(&characteristic, real_part);
        }
        let found = self.delayed_poles_lie_below(&plant.member, real_part);
        !matches!(found, Ok(false) | Err(Irresolution::Budget { .. }))
    }

    /// True if no root of this characteristic polynomial is known to have a real part above this
    /// one.
    fn all_below(&self, characteristic: &RoundedPolynomial, real_part: f64) -> bool {
        let moved = match self.compensation.sample_time_s() {
            None => characteristic.substituted(real_part, 0.0),
            Some(sample_time_s) => {
                // z = e^(real_part T) z'
                let shift = portable::tanh(0.5 * real_part * sample_time_s);
                characteristic.substituted(shift, shift)
            }
        };
        moved.hurwitz() != Hurwitz::No
    }

    fn delayed_poles_lie_below(&self, member: &Member, real_part: f64) -> Result<bool, Irresolution> {
        match self.path.get_or_init(|| FeedbackPath::new(&self.compensation)) {
            Ok(path) => poles_lie_below(member, path, real_part),
            Err(reason) => Err(reason.clone()),
        }
    }

    /// The first of the resolved real parts above all poles.
    fn largest_real_part(&self, plant: &PlantInLoop) -> f64 {
        first_below(|real_part| self.lies_below(plant, real_part))
    }
}

/// The first of the resolved real parts for which the condition holds; 0 if it holds for all,
/// infinity if it holds for none.
fn first_below(lies_below: impl Fn(f64) -> bool) -> f64 {
    let per_decade = std::f64::consts::LN_10 / REAL_PARTS_PER_DECADE;
    let real_part = |number: usize| LEAST_REAL_PART * portable::exp(per_decade * number as f64);
    let (mut above, mut below) = (0, DECADES * REAL_PARTS_PER_DECADE as usize);
    if lies_below(real_part(above)) {
        return 0.0;
    }
    if !lies_below(real_part(below)) {
        return f64::INFINITY;
    }
    while below - above > 1 {
        let middle = above + (below - above) / 2;
        if lies_below(real_part(middle)) {
            below = middle;
        } else {
            above = middle;
        }
    }
    real_part(below)
}
