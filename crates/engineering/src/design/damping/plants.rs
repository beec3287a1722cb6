//! Plants for which a pressure feedback is found: responses from the command to the measured force
//! and to the pressure signal.

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, InnerFeedback, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{LinearError, Polynomial};
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::PlantMember;
use phea_qft::closed_loop::{Compensation, Member, TrialPlant};
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::inner_loop::{InnerPlant, InnerPoint};

use super::super::DesignError;
use super::MissingPlants;
use crate::family::family;
use crate::project::DeclaredPressureFeedback;
use crate::setup::{Setup, with_pressure_feedback};
use crate::source::Source;

/// Largest number of plants with which a feedback is found.
const MOST_PLANTS: usize = 65;
/// Number of points of the even grid, and its extent below its end.
const GRID_POINTS: usize = 200;
const DECADES: f64 = 1e-3;
/// Ratio of the end of the grid of a continuous loop to the natural frequency of the valve.
const BEYOND_VALVE: f64 = 10.0;
/// Number of points on each side of a resonance, and their range in half widths.
const ROOT_POINTS: i32 = 12;
const ROOT_WIDTHS: f64 = 12.0;
/// Number of refinements of the grid around the peaks of plants without polynomials.
const HALVINGS: usize = 3;
/// Damping ratio below which a pair of poles is a resonance.
const OSCILLATES: f64 = 0.7;

/// Plants with and without a small feedback.
pub(super) struct ProbedPlants {
    /// Responses of the plants; the reference of each is not set yet.
    pub(super) plants: Vec<InnerPlant>,
    /// Parameters of the plants.
    values: Vec<Vec<f64>>,
    /// Reasons why others have no responses.
    refused: Vec<DesignError>,
}

impl ProbedPlants {
    /// Nominal plant and others of the family of a project without feedback, and the reasons why
    /// some of them have no responses.
    ///
    /// # Errors
    /// [`DesignError`] for a family that cannot be built or sampled.
    pub(super) fn new(
        source: &dyn Source,
        undamped: &Setup<'_>,
        declared: &DeclaredPressureFeedback,
    ) -> Result<ProbedPlants, DesignError> {
        let own = uncertain(source, undamped)?;
        let rig = undamped.rig().map_err(|_| DesignError::NoPressureFeedback)?;
        let valve = &rig.actuator.components().valve;
        let gain = valve.nominal_voltage / rig.point.pressure_a.max(rig.point.pressure_b);
        let small = DeclaredPressureFeedback { gain, high_pass: None, low_pass: None, ..*declared };
        let probed = with_pressure_feedback(undamped.project, Some(small));
        let probed = uncertain(source, &Setup::new(&probed)?)?;
        let timing = undamped.timing;
        let inner = InnerFeedback { gain, ..InnerFeedback::default() };
        let around = [timing, Timing { inner_feedback: inner, ..timing }].map(|timing| {
            let open = Controller { timing, ..Controller::default() };
            Compensation::new(&open, undamped.sensor.clone())
        });
        let [plain, with] = around;
        let (plain, with) = (plain?, with?);
        let end = match timing.sample_time_s {
            Some(time_s) => std::f64::consts::PI / time_s,
            None => BEYOND_VALVE * valve.natural_frequency,
        };
        let pair = |values: &Vec<f64>| -> Result<InnerPlant, DesignError> {
            let member = |family: &UncertainFamily| family.plant().member(values).ok_or(LinearError::NoPlant);
            let own = member(&own)?;
            let resonances = resonances(&own);
            let own = plain.trial(own, None).ok_or(LinearError::NoPlant)?;
            let probed = with.trial(member(&probed)?, None).ok_or(LinearError::NoPlant)?;
            let at = |frequency: f64| {
                let [plant, fed_back] = [response(&own, frequency)?, response(&probed, frequency)?];
                Some(InnerPoint {
                    frequency_rad_per_s: frequency,
                    plant,
                    signal: (plant / fed_back - 1.0) / gain,
                })
            };
            let points = points(&at, end, resonances);
            let reference = points.first().copied().ok_or(LinearError::NoPlant)?;
            Ok(InnerPlant { points, reference })
        };
        let mut probed = ProbedPlants { plants: vec![], values: vec![], refused: vec![] };
        for values in chosen(&own) {
            match pair(&values) {
                Ok(plant) => {
                    probed.plants.push(plant);
                    probed.values.push(values);
                }
                Err(error) => probed.refused.push(error),
            }
        }
        Ok(probed)
    }

    /// The plants, if every one of them has responses.
    ///
    /// # Errors
    /// The reason why the first of the others has none.
    pub(super) fn complete(mut self) -> Result<ProbedPlants, DesignError> {
        if self.refused.is_empty() { Ok(self) } else { Err(self.refused.swap_remove(0)) }
    }

    /// Adds the plants of the rig with waves in its lines; returns the missing ones, if any.
    pub(super) fn add(&mut self, waves: Result<ProbedPlants, DesignError>) -> Option<MissingPlants> {
        let (of, refused) = match waves {
            Ok(waves) => {
                let of = waves.plants.len() + waves.refused.len();
                self.plants.extend(waves.plants);
                (of, waves.refused)
            }
            Err(error) => (self.values.len(), vec![error; self.values.len()]),
        };
        let reason = refused.first()?.clone();
        Some(MissingPlants { count: refused.len(), of, reason })
    }
}

/// The family over a box of parameters.
fn uncertain(source: &dyn Source, setup: &Setup<'_>) -> Result<UncertainFamily, DesignError> {
    match family(setup, source).map_err(crate::robust::RobustError::from)? {
        Family::Uncertain(family) => Ok(family),
        Family::Measured(_) => Err(DesignError::NoPressureFeedback),
    }
}

/// Members of a family, or the nominal one with the vertices if there are too many.
fn chosen(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let members = family.members();
    if members.len() <= MOST_PLANTS {
        return members.to_vec();
    }
    let parameters = family.plant().parameters();
    let is_vertex = |values: &&Vec<f64>| {
        let each = values.iter().zip(parameters);
        each.into_iter().all(|(value, one)| *value == one.minimum || *value == one.maximum)
    };
    let nominal = family.plant().nominal();
    let vertices: Vec<Vec<f64>> = members.iter().filter(is_vertex).cloned().collect();
    let others = if vertices.is_empty() { members.to_vec() } else { vertices };
    let step = others.len().div_ceil(MOST_PLANTS - 1).max(1);
    std::iter::once(nominal).chain(others.into_iter().step_by(step)).collect()
}

/// Response P H at a frequency, with hold and delay.
fn response(plant: &TrialPlant, frequency: f64) -> Option<Complex64> {
    match plant {
        TrialPlant::Held(held) => held.at(frequency).map(|found| found.with_sensor),
        TrialPlant::Whole(member) => member.response(frequency).map(|found| found.plant * found.sensor),
    }
}

/// Lightly damped poles of a plant with polynomials.
fn resonances(plant: &PlantMember) -> Vec<Complex64> {
    let PlantMember::Rational(coefficients) = plant else { return vec![] };
    let roots = Polynomial::new(coefficients.command.denominator.clone()).roots().unwrap_or_default();
    let oscillates = |root: &Complex64| root.im > 0.0 && -root.re < OSCILLATES * portable::magnitude(*root);
    roots.into_iter().filter(oscillates).collect()
}

/// Points of an even grid up to an end, denser around resonances.
fn points(at: &dyn Fn(f64) -> Option<InnerPoint>, end: f64, resonances: Vec<Complex64>) -> Vec<InnerPoint> {
    let mut frequencies = logarithmic_grid(DECADES * end, end, GRID_POINTS).unwrap_or_default();
    for root in &resonances {
        let (size, width) = (portable::magnitude(*root), root.re.abs());
        let offsets = (-ROOT_POINTS..=ROOT_POINTS).map(|step| {
            let fraction = f64::from(step) / f64::from(ROOT_POINTS);
            size + ROOT_WIDTHS * width * fraction * fraction * fraction
        });
        frequencies.extend(offsets.filter(|frequency| (DECADES * end..=end).contains(frequency)));
    }
    let mut points: Vec<InnerPoint> = sorted_distinct(frequencies).into_iter().filter_map(at).collect();
    if resonances.is_empty() {
        for _ in 0..HALVINGS {
            let peaks = points.windows(3).filter(|three| {
                let size = |point: &InnerPoint| point.plant.norm_sqr();
                matches!(three, [low, peak, high] if size(peak) > size(low) && size(peak) > size(high))
            });
            let between = peaks.flat_map(|three| {
                let middle = |pair: &[InnerPoint]| {
                    pair.iter().map(|point| point.frequency_rad_per_s / 2.0).sum::<f64>()
                };
                three.windows(2).map(middle).collect::<Vec<f64>>()
            });
            let between: Vec<InnerPoint> = between.filter_map(at).collect();
            points.extend(between);
            points.sort_by(|one, other| one.frequency_rad_per_s.total_cmp(&other.frequency_rad_per_s));
        }
    }
    points
}

/// Least damping ratio of the oscillations of these plants within a band, rad/s, in the loop of a
/// project, opened; `None` if a plant has no polynomials, or none oscillates there.
pub(super) fn least_damping_ratio(
    source: &dyn Source,
    setup: &Setup<'_>,
    (probed, band): (&ProbedPlants, [f64; 2]),
) -> Result<Option<f64>, DesignError> {
    let family = uncertain(source, setup)?;
    let open = Controller { timing: setup.timing, ..Controller::default() };
    let around = Compensation::new(&open, setup.sensor.clone())?;
    let mut least = f64::INFINITY;
    for values in &probed.values {
        let poles: Vec<Complex64> = match around.member_of(family.plant(), values)? {
            Member::Continuous { plant, .. } => Polynomial::new(plant.command.denominator).roots()?,
            Member::Sampled { command, .. } => {
                let time_s = around.sample_time_s().unwrap_or(1.0);
                let in_s = |pole: &Complex64| {
                    Complex64::new(portable::ln(portable::magnitude(*pole)), portable::argument(*pole))
                        / time_s
                };
                command.poles().iter().filter(|pole| pole.norm_sqr() > 0.0).map(in_s).collect()
            }
            Member::Responding { .. } | Member::Measured { .. } => return Ok(None),
        };
        let sizes = poles.into_iter().filter(|pole| pole.im > 0.0);
        let sizes = sizes.map(|pole| (portable::magnitude(pole), -pole.re));
        let near = sizes.filter(|(size, _)| (band[0]..=band[1]).contains(size));
        least = near.map(|(size, decay)| decay / size).fold(least, f64::min);
    }
    Ok(least.is_finite().then_some(least))
}
