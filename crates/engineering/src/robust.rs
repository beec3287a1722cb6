//! The problem of the robust method for a project: its family within its loop, templates and bounds
//! at the design frequencies, and the position of the given loop.

use num_complex::Complex64;
use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_qft::bound::{BoundError, CombinedBound, FrequencyBounds, PhaseGrid, Placement, TemplateFill};
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::specification::{LoopResponse, Specification};
use phea_qft::template::{BuiltTemplate, TemplateError, TemplateOptions, Templates};
use phea_qft::verification::PlantPoint;

use crate::caveat::{Caveat, caveats};
use crate::common_position::CommonPosition;
use crate::family::{ProjectFamilyError, family};
use crate::limit_kind::DesignLimitKind;
use crate::plant_names::PlantNames;
use crate::quantity::Units;
use crate::rig::OutsideParameter;
use crate::setup::{ControlError, Setup, pressure_noise, velocity_noise, with_pressure_feedback};
use crate::side_by_side::left_behind;
use crate::simulate::{TimeRequirement, time_requirements};
use crate::source::Source;
use crate::specification::{
    NamedSpecification, SpecificationError, SpecificationName, closed_loops, of_rounding, specifications,
};
use phea_dynamics::watch::{Stopped, Watch, part};

/// A family of plants within a loop, and the specifications of the loop.
#[derive(Clone, Debug)]
pub struct RobustProblem {
    /// Family of plants.
    pub family: Family,
    /// The plants without the pressure feedback that a continuous controller closes within them;
    /// `None` without such feedback.
    pub before_feedback: Option<Family>,
    /// The names of the parameters of a plant.
    pub names: PlantNames,
    /// Loop around the plants; with a controller of 1 if none is given.
    pub compensation: Compensation,
    /// True if the project gives a controller.
    pub has_controller: bool,
    /// True if the project gives a prefilter; otherwise tracking is judged by its spread.
    pub has_prefilter: bool,
    /// The specifications in file order, then those for the rounding of converters.
    pub specifications: Vec<Specification>,
    /// Names of the specifications, except the limits of a design.
    pub specification_names: Vec<SpecificationName>,
    /// Number in the file, from 1, of each specification that is declared there; the others follow.
    pub specification_numbers: Vec<usize>,
    /// Kinds of the limits of a design, which are the last specifications, in their order.
    pub design_limits: Vec<DesignLimitKind>,
    /// Requirements in time: those of separate specifications, then those of limits of tracking.
    pub in_time: Vec<TimeRequirement>,
    /// The rig as a family of one, if the family does not contain it, with its parameters outside
    /// the family.
    pub rig_outside: Option<(Family, Vec<OutsideParameter>)>,
    /// Reason why the plants of the family have no polynomials; `None` if they have them.
    pub without_polynomials: Option<NoPolynomials>,
    /// Noise of the velocity that a sampled controller feeds forward, m/s rms; zero without such
    /// feedforward.
    pub velocity_noise: f64,
    /// Noise of the pressure signal at the samples, Pa rms, if it is fed back; zero otherwise.
    pub pressure_noise: f64,
    /// Tolerance of a margin, dB: a margin of minus this much still counts as met.
    pub tolerance_db: f64,
    /// Position of every plant; `None` if the plants differ in it or in its stiffness, and without
    /// a rig.
    pub position: Option<CommonPosition>,
    /// Motion of the rig.
    pub units: Units,
    /// Declared effects that the problem does not include.
    pub caveats: Vec<Caveat>,
}

/// Template and bounds at one design frequency.
#[derive(Clone, Debug)]
pub struct DesignFrequency {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Template of the plants at this frequency.
    pub template: BuiltTemplate,
    /// Bounds with the interior of the template counted as plants.
    pub bounds: CombinedBound,
    /// Bounds before sampling over the phase: they judge any loop at this frequency.
    pub exact_bounds: FrequencyBounds,
    /// Nominal loop L0 at this frequency.
    pub nominal_loop: Complex64,
    /// Position of the nominal loop among bounds that count only the plants of the template.
    pub placement: Placement,
    /// Position of the nominal loop among bounds that also count the interior of the template.
    pub filled_placement: Placement,
}

/// Reason why a project is not a problem of the robust method.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RobustError {
    /// The controller, prefilter or sensor is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The loop cannot be sampled.
    #[error("the linear models: {0}")]
    Linear(#[from] LinearError),
    /// The family of plants cannot be built.
    #[error(transparent)]
    Family(#[from] ProjectFamilyError),
    /// A specification is contradictory, or no loop can meet it.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
}

/// Reason why templates or bounds cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoundsError {
    /// A template cannot be computed.
    #[error("a template: {0}")]
    Template(TemplateError),
    /// A bound cannot be computed.
    #[error("a bound at {frequency_rad_per_s} rad/s: {error}")]
    Bound {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Reason why the bound cannot be computed.
        error: BoundError,
    },
    /// The progress callback cancelled the computation.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<TemplateError> for BoundsError {
    fn from(error: TemplateError) -> BoundsError {
        match error {
            TemplateError::Stopped(stopped) => BoundsError::Stopped(stopped),
            error => BoundsError::Template(error),
        }
    }
}

/// Name of the stage.
const TEMPLATES: &str = "templates and bounds";

/// The robust problem of a project.
///
/// # Errors
/// [`RobustError`] for parts that are not valid transfer functions, families or limits.
pub fn robust_problem(source: &dyn Source, setup: &Setup<'_>) -> Result<RobustProblem, RobustError> {
    let compensation = match &setup.controller {
        Some(given) => setup.compensation(given)?,
        None => {
            let prefilter = setup.prefilter.clone().unwrap_or_default();
            let open = Controller { prefilter, timing: setup.timing, ..Controller::default() };
            Compensation::new(&open, setup.sensor.clone())?
        }
    };
    let (specifications, specification_names) =
        named_specifications(setup, compensation.highest_frequency_rad_per_s())?;
    let family = family(setup, source)?;
    let has_lines_in_motion = without_polynomials(setup, &family) == Some(NoPolynomials::LinesInMotion);
    let default_tolerance_db =
        if has_lines_in_motion { TOLERANCE_IN_MOTION_DB } else { DEFAULT_TOLERANCE_DB };
    Ok(RobustProblem {
        without_polynomials: without_polynomials(setup, &family),
        names: PlantNames::of_family(setup.project, &family),
        before_feedback: before_feedback(setup, source)?,
        family,
        compensation,
        has_controller: setup.controller.is_some(),
        has_prefilter: setup.prefilter.is_some(),
        specifications,
        specification_names,
        specification_numbers: closed_loops(setup.project).map(|(number, ..)| number).collect(),
        design_limits: vec![],
        in_time: time_requirements(setup.project)?,
        rig_outside: match setup.outside() {
            Some((alone, beyond)) => Some((self::family(&Setup::new(&alone)?, source)?, beyond)),
            None => None,
        },
        velocity_noise: velocity_noise(setup.project),
        pressure_noise: pressure_noise(setup.project),
        tolerance_db: setup.project.tolerance_db().unwrap_or(default_tolerance_db),
        position: CommonPosition::of(setup),
        units: setup.project.units,
        caveats: caveats(setup),
    })
}

/// Family of a project without its pressure feedback, if a continuous controller closes it.
fn before_feedback(setup: &Setup<'_>, source: &dyn Source) -> Result<Option<Family>, RobustError> {
    let fed_back = setup.project.controller.as_ref().and_then(|controller| controller.pressure_feedback);
    if fed_back.is_none() || setup.timing.sample_time_s.is_some() {
        return Ok(None);
    }
    let without = with_pressure_feedback(setup.project, None);
    Ok(Some(family(&Setup::new(&without)?, source)?))
}

/// Tolerance of a margin if the project states none, dB: a margin of minus this much counts as met,
/// since no result depends on less than the accuracy to which a rig is known.
pub const DEFAULT_TOLERANCE_DB: f64 = 0.01;

/// Tolerance of a margin for lines with waves, whose fit is known to 0.3 dB near their resonances,
/// dB.
pub const TOLERANCE_IN_MOTION_DB: f64 = 0.1;

/// The reason why the plants of a family have no polynomials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPolynomials {
    /// Waves travel in the lines.
    LinesInMotion,
    /// A continuous controller feeds the pressures back with a delay.
    PressuresFedBackLate,
    /// The velocity of the load is fed forward with a delay.
    LoadVelocityFedForwardLate,
}

fn without_polynomials(setup: &Setup<'_>, family: &Family) -> Option<NoPolynomials> {
    let Family::Uncertain(family) = family else { return None };
    let rig = setup.rig().ok()?;
    let late = rig.fed_back.is_some_and(|back| !back.sampled && back.delay_s > 0.0);
    let why = match (rig.in_motion.is_some(), late) {
        (true, _) => NoPolynomials::LinesInMotion,
        (false, true) => NoPolynomials::PressuresFedBackLate,
        (false, false) => NoPolynomials::LoadVelocityFedForwardLate,
    };
    (!family.plant().is_rational()).then_some(why)
}

/// Specifications and their names. Bounds on the rounding of converters are drawn at every design
/// frequency that the loop reaches.
fn named_specifications(
    setup: &Setup<'_>,
    highest_frequency_rad_per_s: f64,
) -> Result<(Vec<Specification>, Vec<SpecificationName>), SpecificationError> {
    let mut specifications = specifications(setup.project)?;
    let of_kind = |one: &Specification| SpecificationName::ClosedLoop(one.requirement.closed_loop());
    let mut names: Vec<SpecificationName> = specifications.iter().map(of_kind).collect();
    let mut frequencies: Vec<f64> =
        specifications.iter().flat_map(|one| one.frequencies_rad_per_s.iter().copied()).collect();
    frequencies.retain(|frequency| *frequency <= highest_frequency_rad_per_s);
    let frequencies = sorted_distinct(frequencies);
    for (specification, name) in of_rounding(setup, &frequencies) {
        specifications.push(specification);
        names.push(name);
    }
    Ok((specifications, names))
}

impl RobustProblem {
    /// A specification by its number and its name; `None` for a limit of a design.
    pub fn named(&self, index: usize) -> Option<NamedSpecification> {
        let name = *self.specification_names.get(index)?;
        Some(NamedSpecification { number: self.number_of(index), name })
    }

    /// The number of a specification in the file, from 1; `None` for one that is not declared.
    pub fn number_of(&self, index: usize) -> Option<usize> {
        self.specification_numbers.get(index).copied()
    }

    /// Every frequency at which a bound is drawn, rad/s, increasing.
    pub fn design_frequencies(&self) -> Vec<f64> {
        let all = self.specifications.iter().flat_map(|one| one.frequencies_rad_per_s.iter().copied());
        let highest = self.compensation.highest_frequency_rad_per_s();
        sorted_distinct(all.filter(|&frequency| frequency <= highest).collect())
    }

    /// Templates and bounds at every design frequency that the family reaches.
    ///
    /// # Errors
    /// [`BoundsError`], including cancellation by `watch`.
    pub fn at_design_frequencies(&self, watch: Watch<'_>) -> Result<Vec<DesignFrequency>, BoundsError> {
        // the union of the polygons of a template may take a minute without a progress report
        let problem = self.clone();
        left_behind(watch, TEMPLATES, move |watch| match problem.templates_and_bounds(watch) {
            Err(BoundsError::Stopped(stopped)) => Err(stopped),
            found => Ok(found),
        })?
    }

    fn templates_and_bounds(&self, watch: Watch<'_>) -> Result<Vec<DesignFrequency>, BoundsError> {
        let frequencies = self.design_frequencies();
        let options = TemplateOptions::default();
        let mut found = Vec::new();
        let mut templates = Templates::new(&self.family, &self.compensation, &frequencies, options);
        let fraction = |done: usize| done as f64 / frequencies.len().max(1) as f64;
        for index in 0..frequencies.len() {
            let own = [index, index + 1].map(fraction);
            let watch = &mut part(&mut *watch, TEMPLATES, own);
            match templates.next_watched(watch) {
                // a measurement contains nothing beyond its range, so there is no template either
                None | Some(Err(TemplateError::OutOfReach { .. })) => {}
                Some(built) => found.push(self.at_template(built?)?),
            }
        }
        Ok(found)
    }

    fn at_template(&self, template: BuiltTemplate) -> Result<DesignFrequency, BoundsError> {
        let frequency_rad_per_s = template.template.frequency_rad_per_s;
        let explain = |error| BoundsError::Bound { frequency_rad_per_s, error };
        let bounds =
            |fill| FrequencyBounds::new(&template.template, &self.specifications, fill).map_err(explain);
        let (points, filled) = (bounds(TemplateFill::Points)?, bounds(TemplateFill::Filled)?);
        let nominal_loop =
            template.template.nominal * self.compensation.response(frequency_rad_per_s).feedback;
        Ok(DesignFrequency {
            frequency_rad_per_s,
            bounds: filled.combined(&PhaseGrid::default()),
            nominal_loop,
            placement: points.placement(nominal_loop),
            filled_placement: filled.placement(nominal_loop),
            exact_bounds: filled,
            template,
        })
    }

    /// Nominal plant within the loop.
    ///
    /// # Errors
    /// [`LinearError`] if it cannot be sampled.
    pub fn nominal(&self) -> Result<Option<Member>, LinearError> {
        match &self.family {
            Family::Uncertain(family) => {
                self.compensation.member_of(family.plant(), &family.plant().nominal()).map(Some)
            }
            Family::Measured(family) => {
                Ok(family.plants().first().map(|plant| self.compensation.measured(plant)))
            }
        }
    }

    /// All members within the loop.
    ///
    /// # Errors
    /// [`LinearError`] if one of them cannot be sampled.
    pub fn members(&self) -> Result<Vec<Member>, LinearError> {
        match &self.family {
            Family::Uncertain(family) => {
                let plants = family.members().iter();
                plants.map(|values| self.compensation.member_of(family.plant(), values)).collect()
            }
            Family::Measured(family) => {
                Ok(family.plants().iter().map(|plant| self.compensation.measured(plant)).collect())
            }
        }
    }

    /// One plant of the family within the loop; `None` if it cannot be sampled.
    pub fn member(&self, plant: &PlantPoint) -> Option<Member> {
        match (&self.family, plant) {
            (Family::Uncertain(family), PlantPoint::Parameters(values)) => {
                self.compensation.member_of(family.plant(), values).ok()
            }
            (Family::Measured(family), PlantPoint::Measured(index)) => {
                family.plants().get(*index).map(|plant| self.compensation.measured(plant))
            }
            _ => None,
        }
    }

    /// Response of the whole loop of a member at a frequency; `None` outside the range of a
    /// measurement.
    pub fn response(&self, member: &Member, frequency_rad_per_s: f64) -> Option<LoopResponse> {
        let found = member.response(frequency_rad_per_s)?;
        let loop_side = self.compensation.response(frequency_rad_per_s);
        Some(LoopResponse {
            plant: found.plant,
            load_motion: found.load_motion,
            controller: loop_side.feedback,
            prefilter: loop_side.prefilter,
            sensor: found.sensor,
        })
    }

    /// Frequencies for drawing from `from` to `to`, rad/s: even in their logarithm, and denser
    /// around the lightly damped roots of the nominal plant and of the controller.
    pub fn drawn_frequencies(&self, from: f64, to: f64) -> Vec<f64> {
        let to = to.min(self.compensation.highest_frequency_rad_per_s());
        let mut frequencies = logarithmic_grid(from, to, GRID_POINTS).unwrap_or_default();
        let mut roots: Vec<Complex64> = self.compensation.feedback().zeros().to_vec();
        roots.extend(self.compensation.feedback().poles());
        if let Family::Uncertain(family) = &self.family {
            roots.extend(nominal_roots(family));
        }
        for root in roots.iter().filter(|root| root.im > 0.0) {
            let (size, width) = (portable::magnitude(*root), root.re.abs());
            let offsets = (-ROOT_POINTS..=ROOT_POINTS).map(|step| {
                let fraction = f64::from(step) / f64::from(ROOT_POINTS);
                size + ROOT_WIDTHS * width * fraction * fraction * fraction
            });
            frequencies.extend(offsets.filter(|frequency| (from..=to).contains(frequency)));
        }
        frequencies.extend(self.design_frequencies().into_iter().filter(|f| (from..=to).contains(f)));
        sorted_distinct(frequencies)
    }
}

/// Number of points of the even grid.
const GRID_POINTS: usize = 500;
/// Number of points on each side of a lightly damped root.
const ROOT_POINTS: i32 = 20;
/// Range of these points, in half widths of the resonance.
const ROOT_WIDTHS: f64 = 12.0;

fn nominal_roots(family: &UncertainFamily) -> Vec<Complex64> {
    let Some(plant) = family.plant().member(&family.plant().nominal()) else { return Vec::new() };
    let function = plant.slow().command.transfer_function();
    function.map_or_else(|_| vec![], |function| [function.zeros(), function.poles()].concat())
}
