//! The design frequencies of a problem, prepared for evaluating one controller after the other.

use num_complex::Complex64;
use phea_dynamics::frequency::decibels;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use crate::bound::{BoundError, FrequencyBounds, Placement, TemplateFill};
use crate::closed_loop::Compensation;
use crate::family::Family;
use crate::specification::{LoopResponse, Specification};
use crate::template::{Template, TemplatePoint};
use crate::verification::{PlantPoint, SpecificationMargin, TrackingJudgement};

/// Templates and bounds at the design frequencies, independent of the controller.
///
/// # Example
/// Plant with a gain between 1 and 4 that must satisfy |S| <= 1/2: with G = 2 the smallest plant
/// gives |S| = 1/3, so that the loop gain may fall by half.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::controller::{Compensator, Controller, Element};
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_qft::bound::Placement;
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
/// use phea_qft::manual_shaping::DesignChart;
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::template::{TemplateOptions, template};
/// use phea_qft::verification::{PlantPoint, TrackingJudgement};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let gain = UncertainParameter { name: "k".into(), nominal: 4.0, minimum: 1.0, maximum: 4.0 };
/// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let along = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// let members = vec![vec![1.0], vec![4.0]];
/// let family = Family::Uncertain(UncertainFamily::new(plant, vec![along], members, Extent::Box)?);
/// let loop_of = |gain: f64| {
///     let feedback = Compensator::new(vec![Element::Gain(gain)]);
///     Compensation::new(&Controller { feedback, ..Controller::default() }, TransferFunction::gain_only(1.0))
/// };
/// let specification = Specification {
///     requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [1.0, 1.0],
/// };
/// let built = template(&family, &loop_of(1.0)?, 1.0, &TemplateOptions::default())?;
/// let chart = DesignChart::new(&family, vec![built.template], &[specification])?;
/// let [margin] = &chart.margins(&loop_of(2.0)?, TrackingJudgement::Spread)[..] else { panic!() };
/// assert!((margin.worst.margin_db - 20.0 * 1.5_f64.log10()).abs() < 1e-12); // 1/2 over 1/3
/// assert_eq!(margin.worst.plant, PlantPoint::Parameters(vec![1.0]));
/// let Placement::Allowed { slack_db } = margin.placement else { panic!() };
/// assert!((slack_db - 20.0 * 2_f64.log10()).abs() < 1e-9); // from L0 = 8 down to 4
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct DesignChart {
    measured: bool,
    specifications: Vec<Specification>,
    stations: Vec<Station>,
}

/// One design frequency.
#[derive(Clone, Debug)]
struct Station {
    template: Template,
    /// Bounds of all specifications together.
    bounds: FrequencyBounds,
    /// Bounds of each specification that applies at this design frequency, by its index.
    each: Vec<(usize, FrequencyBounds)>,
}

/// The worst margin of one specification at one design frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignMargin {
    /// The margin of the worst plant of the template.
    pub worst: SpecificationMargin,
    /// Position of the nominal loop relative to the gains that this specification allows at its
    /// phase, with the interior of the template counting as plants: the permitted, or required,
    /// move. Tracking is assessed by its spread.
    pub placement: Placement,
}

/// The nominal loop at one design frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPoint {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Nominal loop L0.
    pub nominal_loop: Complex64,
    /// Position relative to the bounds of all specifications together.
    pub placement: Placement,
}

impl DesignChart {
    /// Prepares the bounds of these specifications on the templates of a family.
    ///
    /// # Errors
    /// [`BoundError`], see [`FrequencyBounds::new`].
    pub fn new(
        family: &Family,
        templates: Vec<Template>,
        specifications: &[Specification],
    ) -> Result<DesignChart, BoundError> {
        let station = |template: Template| {
            let frequency = template.frequency_rad_per_s;
            let bounds = |of: &[Specification]| FrequencyBounds::new(&template, of, TemplateFill::Filled);
            let demanded = specifications.iter().enumerate().filter(|(_, one)| demands(one, frequency));
            let each = demanded.map(|(index, one)| Ok((index, bounds(std::slice::from_ref(one))?)));
            Ok(Station { bounds: bounds(specifications)?, each: each.collect::<Result<_, _>>()?, template })
        };
        Ok(DesignChart {
            measured: matches!(family, Family::Measured(_)),
            specifications: specifications.to_vec(),
            stations: templates.into_iter().map(station).collect::<Result<_, BoundError>>()?,
        })
    }

    /// The margin of every specification at each of its design frequencies, the worst first; equal
    /// ones by frequency.
    pub fn margins(&self, compensation: &Compensation, tracking: TrackingJudgement) -> Vec<DesignMargin> {
        let mut margins: Vec<DesignMargin> =
            self.stations.iter().flat_map(|station| self.at(station, compensation, tracking)).collect();
        sort_by_number(&mut margins, |margin| margin.worst.margin_db);
        margins
    }

    /// The nominal loop at the design frequencies, in the order of the templates.
    pub fn points(&self, compensation: &Compensation) -> Vec<DesignPoint> {
        let point = |station: &Station| {
            let frequency_rad_per_s = station.template.frequency_rad_per_s;
            let nominal_loop = station.nominal_loop(compensation);
            let placement = station.bounds.placement(nominal_loop);
            DesignPoint { frequency_rad_per_s, nominal_loop, placement }
        };
        self.stations.iter().map(point).collect()
    }

    fn at(
        &self,
        station: &Station,
        compensation: &Compensation,
        tracking: TrackingJudgement,
    ) -> Vec<DesignMargin> {
        let frequency_rad_per_s = station.template.frequency_rad_per_s;
        let loop_side = compensation.response(frequency_rad_per_s);
        let response = |point: &TemplatePoint| LoopResponse {
            plant: point.response / point.sensor,
            load_motion: point.load_motion,
            controller: loop_side.feedback,
            prefilter: loop_side.prefilter,
            sensor: point.sensor,
        };
        let plants: Vec<(LoopResponse, &TemplatePoint)> =
            station.template.points.iter().map(|point| (response(point), point)).collect();
        let nominal_loop = station.nominal_loop(compensation);
        let margin = |(index, bounds): &(usize, FrequencyBounds)| {
            let specification = self.specifications.get(*index)?;
            let is_spread = tracking == TrackingJudgement::Spread && specification.requirement.is_tracking();
            let judge = if is_spread { spread } else { worst };
            let (margin_db, plant, other) = judge(specification, frequency_rad_per_s, &plants)?;
            let worst = SpecificationMargin {
                specification: *index,
                frequency_rad_per_s,
                margin_db,
                plant: self.plant(plant),
                other: other.map(|other| self.plant(other)),
            };
            Some(DesignMargin { worst, placement: bounds.placement(nominal_loop) })
        };
        station.each.iter().filter_map(margin).collect()
    }

    fn plant(&self, point: &TemplatePoint) -> PlantPoint {
        match point.member {
            Some(index) if self.measured => PlantPoint::Measured(index),
            _ => PlantPoint::Parameters(point.values.clone()),
        }
    }
}

impl Station {
    fn nominal_loop(&self, compensation: &Compensation) -> Complex64 {
        self.template.nominal * compensation.response(self.template.frequency_rad_per_s).feedback
    }
}

/// True if a specification has this design frequency, and a limit there.
fn demands(specification: &Specification, frequency: f64) -> bool {
    let (lower, upper) = specification.requirement.limits();
    specification.frequencies_rad_per_s.contains(&frequency)
        && lower.into_iter().chain([upper]).all(|limit| limit.magnitude(frequency).is_some())
}

type ChartPlants<'a> = [(LoopResponse, &'a TemplatePoint)];

/// The least margin, dB, with its plant, or with both plants of a spread.
type ChartMargin<'a> = (f64, &'a TemplatePoint, Option<&'a TemplatePoint>);

/// The plant with the least margin.
fn worst<'a>(
    specification: &Specification,
    frequency: f64,
    plants: &ChartPlants<'a>,
) -> Option<ChartMargin<'a>> {
    let margins = plants
        .iter()
        .filter_map(|(response, point)| Some((specification.margin_db(response, frequency)?, *point, None)));
    margins.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The two plants farthest apart: 20 log10(upper/lower) - 20 log10(max|T|/min|T|).
fn spread<'a>(
    specification: &Specification,
    frequency: f64,
    plants: &ChartPlants<'a>,
) -> Option<ChartMargin<'a>> {
    let (lower, upper) = specification.requirement.limits();
    let allowed = upper.magnitude(frequency)? / lower?.magnitude(frequency)?;
    let without_prefilter =
        |response: &LoopResponse| LoopResponse { prefilter: Complex64::new(1.0, 0.0), ..*response };
    let magnitudes = || {
        plants.iter().map(|(response, point)| {
            let closed = specification.requirement.closed_loop().response(&without_prefilter(response));
            (portable::magnitude(closed), *point)
        })
    };
    let (greatest, plant) = magnitudes().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (least, other) = magnitudes().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((decibels(allowed * least / greatest), plant, Some(other)))
}
