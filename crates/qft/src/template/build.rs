//! The template of a family at one frequency.

use std::collections::BTreeSet;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::watch::{Watch, unwatched};

use super::explore::{Exploration, explore};
use super::plants::{Plants, Stop};
use super::region::Corner;
use super::{BuiltTemplate, Resolution, Template, TemplateError, TemplateOptions, TemplatePoint};
use crate::closed_loop::{Compensation, MemberResponse};
use crate::family::{Extent, Family, MeasuredFamily};

/// Builds the template of a family at one frequency.
///
/// ```text
/// template(w) = { P(jw) H(jw) : P in the family }                                                    thesis 3.1.1
/// ```
///
/// `points` are the members in order, then the plants found on the outline by refinement. The
/// outline is an inner approximation: its interior is filled by plants of the family, to the
/// tolerance of its chords. Plants beyond it were searched for, from every point of the outline and
/// with all witnesses, and none was found. Plants are compared in magnitude and phase, with the
/// phase continued from plant to plant; [`Template`] has an example. A member whose response is
/// zero or infinite is omitted; `NotResolved` names it.
///
/// # Errors
/// [`TemplateError`] for tolerances that cannot be met, plants that cannot be sampled, measurements
/// that do not cover the frequency, and a nominal plant that is zero or infinite.
///
/// # Example
/// Two measured plants, 1 and 2j at 1 rad/s: the template consists of these two points.
/// ```
/// use num_complex::Complex64;
/// # use phea_dynamics::controller::Controller;
/// # use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::portable::magnitude;
/// # use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Family, MeasuredFamily, MeasuredPlant};
/// use phea_qft::template::{TemplateOptions, template};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let measured = |name: &str, response: Complex64| MeasuredPlant {
///     name: name.into(),
///     frequencies_rad_per_s: vec![0.5, 1.0, 2.0],
///     command: vec![response; 3],
///     disturbance: None,
///     unstable_poles: 0,
///     radii: vec![],
///     integrators: None,
///     is_resolved: true,
/// };
/// let plants = vec![measured("one", Complex64::new(1.0, 0.0)), measured("other", Complex64::new(0.0, 2.0))];
/// let family = Family::Measured(MeasuredFamily::new(plants)?);
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let built = template(&family, &compensation, 1.0, &TemplateOptions::default())?;
/// let [one, other] = &built.template.points[..] else { panic!("two members") };
/// assert!(magnitude(one.response - 1.0) < 1e-12);
/// assert!(magnitude(other.response - Complex64::new(0.0, 2.0)) < 1e-12);
/// assert_eq!((built.template.nominal, built.evaluations), (one.response, 2));
/// # Ok(())
/// # }
/// ```
pub fn template(
    family: &Family,
    compensation: &Compensation,
    frequency_rad_per_s: f64,
    options: &TemplateOptions,
) -> Result<BuiltTemplate, TemplateError> {
    template_watched((family, compensation), frequency_rad_per_s, options, &mut unwatched)
}

/// Builds a template as [`template`] does, with a watch that is consulted at each plant.
///
/// # Errors
/// Errors of [`template`], and [`TemplateError::Stopped`].
pub(super) fn template_watched(
    (family, compensation): (&Family, &Compensation),
    frequency_rad_per_s: f64,
    options: &TemplateOptions,
    watch: Watch<'_>,
) -> Result<BuiltTemplate, TemplateError> {
    let TemplateOptions { phase_deg, magnitude_db, .. } = *options;
    let possible = phase_deg > 0.0 && phase_deg < 90.0 && magnitude_db > 0.0 && magnitude_db.is_finite();
    if !possible {
        return Err(TemplateError::Tolerance { phase_deg, magnitude_db });
    }
    match family {
        Family::Measured(family) => measured(family, compensation, frequency_rad_per_s),
        Family::Uncertain(family) => {
            let mut plants = Plants::new(family, compensation, frequency_rad_per_s, *options, watch);
            uncertain(&mut plants, frequency_rad_per_s)
        }
    }
}

/// Number of corners of the polygon around a disc, 2 % outside it.
const CORNERS: usize = 16;

fn measured(
    family: &MeasuredFamily,
    compensation: &Compensation,
    frequency_rad_per_s: f64,
) -> Result<BuiltTemplate, TemplateError> {
    let (mut points, mut around, mut outlines) = (vec![], vec![], vec![]);
    for (member, plant) in family.plants().iter().enumerate() {
        let within = compensation.measured(plant);
        let response = within.response(frequency_rad_per_s);
        let response = response.ok_or(TemplateError::OutOfReach { frequency_rad_per_s })?;
        points.push(finite(point(Some(member), vec![], response), frequency_rad_per_s)?);
        let mut outline = vec![];
        for plant in around_disc(response.plant, within.radius(frequency_rad_per_s, &response)) {
            let corner = point(Some(member), vec![], MemberResponse { plant, ..response });
            outline.push(corner.response);
            around.push(finite(corner, frequency_rad_per_s)?);
        }
        outlines.extend(Some(outline).filter(|outline| !outline.is_empty()));
    }
    let evaluations = points.len();
    points.extend(around);
    built(frequency_rad_per_s, points, outlines, Resolution::Members, evaluations)
}

/// Corners of a polygon around the disc of a response; none around an exact one.
pub(crate) fn around_disc(centre: Complex64, radius: f64) -> impl Iterator<Item = Complex64> {
    let corners = if radius > 0.0 { CORNERS } else { 0 };
    let step = 2.0 * std::f64::consts::PI / CORNERS as f64;
    let reach = radius / portable::cos(step / 2.0);
    (0..corners).map(move |corner| {
        let angle = step * corner as f64;
        centre + Complex64::new(portable::cos(angle), portable::sin(angle)) * reach
    })
}

fn uncertain(plants: &mut Plants, frequency_rad_per_s: f64) -> Result<BuiltTemplate, TemplateError> {
    let family = plants.family;
    let mut points = vec![];
    let mut infinite = None;
    for (member, values) in family.members().iter().enumerate() {
        let point = point(Some(member), values.clone(), plants.response(values)?);
        match finite(point, frequency_rad_per_s) {
            Ok(point) => points.push(point),
            Err(_) if member > 0 && family.extent() == Extent::Box => infinite = Some(values.clone()),
            Err(error) => return Err(error),
        }
    }
    if family.extent() == Extent::Members {
        let evaluations = plants.evaluations;
        return built(frequency_rad_per_s, points, vec![], Resolution::Members, evaluations);
    }
    let mut exploration = Exploration::new(member_witnesses(plants, &points));
    let exhausted = match explore(plants, &mut exploration) {
        Ok(()) => false,
        Err(Stop::Exhausted) => true,
        Err(Stop::Failed(error)) => return Err(error),
    };
    let outlines = exploration.outlines(plants);
    let resolution = match infinite {
        Some(near) => Resolution::NotResolved { phase_deg: 180.0, magnitude_db: f64::INFINITY, near },
        None => resolution(plants, &exploration, &outlines, exhausted),
    };
    let refined = outline_points(plants, &outlines, &points);
    points.extend(refined);
    let response = |corner: &Corner| match corner.plant {
        Some(plant) => loop_response(plants.list[plant].response),
        None => corner.place.response(),
    };
    let outlines = outlines.iter().map(|outline| outline.iter().map(response).collect()).collect();
    built(frequency_rad_per_s, points, outlines, resolution, plants.evaluations)
}

fn built(
    frequency_rad_per_s: f64,
    points: Vec<TemplatePoint>,
    outlines: Vec<Vec<Complex64>>,
    resolution: Resolution,
    evaluations: usize,
) -> Result<BuiltTemplate, TemplateError> {
    let nothing = TemplateError::OutOfReach { frequency_rad_per_s };
    let nominal = points.first().ok_or(nothing)?.response;
    let template = Template { frequency_rad_per_s, nominal, points, outlines, resolution };
    Ok(BuiltTemplate { template, evaluations })
}

/// Response P H.
fn loop_response(response: MemberResponse) -> Complex64 {
    response.plant * response.sensor
}

fn point(member: Option<usize>, values: Vec<f64>, response: MemberResponse) -> TemplatePoint {
    let MemberResponse { load_motion, sensor, .. } = response;
    TemplatePoint { member, values, response: loop_response(response), load_motion, sensor }
}

fn finite(point: TemplatePoint, frequency_rad_per_s: f64) -> Result<TemplatePoint, TemplateError> {
    let TemplatePoint { member, response, .. } = point;
    let square = response.norm_sqr();
    if response.re.is_finite() && response.im.is_finite() && square > 0.0 {
        return Ok(point);
    }
    Err(TemplateError::NotFinite { member: member.unwrap_or(0), response, frequency_rad_per_s })
}

/// The members that are points of the box; the nominal plant need not be one of them if parameters
/// are correlated.
fn member_witnesses(plants: &mut Plants, points: &[TemplatePoint]) -> Vec<usize> {
    let family = plants.family;
    let mut witnesses = vec![];
    for point in points {
        let fractions = family.fractions(&point.values);
        let same = family
            .values(&fractions)
            .iter()
            .zip(&point.values)
            .all(|(&back, &value)| (back - value).abs() <= 1e-9 * value.abs());
        if same {
            let plant = point.response / point.sensor;
            let response = MemberResponse { plant, load_motion: point.load_motion, sensor: point.sensor };
            witnesses.push(plants.keep(fractions, response));
        }
    }
    witnesses
}

/// Plants on the outlines, each once, without the members.
fn outline_points(
    plants: &Plants,
    outlines: &[Vec<Corner>],
    members: &[TemplatePoint],
) -> Vec<TemplatePoint> {
    let bits = |response: Complex64| (response.re.to_bits(), response.im.to_bits());
    let mut seen: BTreeSet<(u64, u64)> = members.iter().map(|member| bits(member.response)).collect();
    let found = outlines.iter().flatten().filter_map(|corner| plants.list.get(corner.plant?));
    let fresh = found.filter(|plant| seen.insert(bits(loop_response(plant.response))));
    fresh.map(|plant| point(None, plants.family.values(&plant.fractions), plant.response)).collect()
}

fn resolution(
    plants: &Plants,
    exploration: &Exploration,
    outlines: &[Vec<Corner>],
    exhausted: bool,
) -> Resolution {
    let values = |plant: usize| plants.family.values(&plants.list[plant].fractions);
    if let Some(gap) = &plants.gap {
        let near = values(gap.plant);
        return Resolution::NotResolved { phase_deg: gap.phase_deg, magnitude_db: gap.magnitude_db, near };
    }
    let (mut phase_deg, mut magnitude_db, mut widest) = (0.0_f64, 0.0_f64, 0);
    for outline in outlines {
        for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let magnitude = (to.place.magnitude_db - from.place.magnitude_db).abs();
            if magnitude > magnitude_db {
                widest = from.plant.unwrap_or(widest);
            }
            magnitude_db = magnitude_db.max(magnitude);
            phase_deg = phase_deg.max((to.place.phase_deg - from.place.phase_deg).abs());
        }
    }
    match &exploration.outside {
        Some(outside) => Resolution::NotResolved {
            phase_deg: outside.distance * plants.options.phase_deg,
            magnitude_db: outside.distance * plants.options.magnitude_db,
            near: values(outside.plant),
        },
        None if exhausted => {
            let near =
                plants.list.get(widest).map_or_else(|| plants.family.plant().nominal(), |_| values(widest));
            Resolution::NotResolved { phase_deg, magnitude_db, near }
        }
        None => Resolution::Resolved { phase_deg, magnitude_db },
    }
}
