//! The stages of a design as files: templates, bounds, loop, prefilter, audit, rounds, and the
//! project that it makes.

use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::watch::Watch;
use phea_engineering::design::{
    AuditedController, DESIGNED_CERTIFICATE, DESIGNED_PROJECT, DesignPart, NEAREST_PROJECT, ProjectDesign,
    Repair,
};
use phea_engineering::robust::{BoundsError, DesignFrequency, RobustProblem};
use phea_engineering::specification::kind_key;
use phea_qft::bound::Placement;

use super::answer::factors;
use super::words::{structure_parts, unusable_words};
use crate::answer::{Body, Csv, OutputFile};
use crate::audit::{self, certificate_of};
use crate::error::CommandError;
use crate::project::{Loaded, with_laws, with_line_model, with_pressure_feedback};
use crate::quantity::MotionKind;
use crate::specification::number_cell;

/// Factors from the design frequencies to the ends of the drawn range.
const BEYOND: [f64; 2] = [0.1, 30.0];

/// Factor from the inverse of a required settling time to the upper end of the drawn range.
const BEYOND_BANDWIDTH: f64 = 300.0;

/// The nominal loop over frequency.
const LOOP: &str = "loop.csv";

/// The project with the designed controller and prefilter in it, and with the model of its lines if
/// that was chosen; every other byte is unchanged.
pub fn files(loaded: &Loaded, view: &ProjectDesign) -> Vec<OutputFile> {
    let nearest = view.repair.as_ref().and_then(Repair::nearest);
    let named = [(DESIGNED_PROJECT, Some(view)), (NEAREST_PROJECT, nearest)];
    let file = |(name, design): (&str, Option<&ProjectDesign>)| {
        let (controller, prefilter) = (&design?.declared_controller, design?.declared_prefilter.as_ref());
        let laws = (controller, prefilter);
        let bytes = with_laws(&loaded.bytes, &loaded.settings, laws, loaded.project.motions());
        let bytes = match &design?.pressure_feedback {
            Some(_) => with_pressure_feedback(&bytes, controller.pressure_feedback.as_ref()),
            None => bytes,
        };
        let bytes = match &loaded.lines {
            Some(chosen) => with_line_model(&bytes, chosen),
            None => bytes,
        };
        Some(OutputFile::new(name, marked(&bytes, unusable_words(design?))))
    };
    let certificate = certificate_of(loaded, &view.designed.view, DESIGNED_CERTIFICATE);
    named.into_iter().filter_map(file).chain(certificate).collect()
}

/// First words of the comment above a controller that must not be used.
const UNUSABLE: &str = "# DO NOT USE THIS CONTROLLER: ";

/// A project below the reason why its controller must not be used; the reason of an earlier design
/// is removed.
fn marked(bytes: &[u8], unusable: Option<String>) -> Vec<u8> {
    let mut own = bytes;
    while own.starts_with(UNUSABLE.as_bytes()) {
        own = own.iter().position(|byte| *byte == b'\n').map_or(&[], |end| &own[end + 1..]);
    }
    let first = unusable.map(|why| format!("{UNUSABLE}{why}.\n").into_bytes()).unwrap_or_default();
    [first.as_slice(), own].concat()
}

/// Every stage. A design that was stopped has no templates and bounds, which take long to compute;
/// if the watch stops their computation, a note says that there are none.
///
/// # Errors
/// [`CommandError`] for a template that cannot be computed.
pub fn stage_files(
    loaded: &Loaded,
    view: &mut ProjectDesign,
    watch: Watch<'_>,
) -> Result<Vec<OutputFile>, CommandError> {
    let found = match view.is_stopped() {
        true => None,
        false => match view.designed.problem.at_design_frequencies(watch) {
            Err(BoundsError::Stopped(_)) => None,
            found => Some(found?),
        },
    };
    if found.is_none() {
        view.leave(DesignPart::TemplatesAndBounds);
    }
    let side = &view.designed;
    let found = found.unwrap_or_default();
    let mut files = files(loaded, view);
    files.extend(bound_files(&side.problem, &found));
    files.push(nominal_loop(&side.problem, &found)?);
    files.push(transfer_file("controller.json", side.problem.compensation.feedback()));
    if side.problem.has_prefilter {
        files.push(transfer_file("prefilter.json", side.problem.compensation.prefilter()));
    }
    files.extend(prefilter_band(side)?);
    files.push(OutputFile::new("verification.json", audit::json(loaded, &side.view)));
    files.extend(audit::files(&side.view));
    files.push(rounds(view));
    files.retain(has_rows);
    Ok(files)
}

/// False for a table that has headings only: if only steps are required, there are no templates.
fn has_rows(file: &OutputFile) -> bool {
    let lines = file.bytes.iter().filter(|byte| **byte == b'\n').count();
    !file.name.ends_with(".csv") || lines > 1
}

fn transfer_file(name: &str, function: &TransferFunction) -> OutputFile {
    OutputFile::new(name, factors(function).into_object().print(MotionKind::default()))
}

/// The frequencies at which a loop is drawn: around the design frequencies, or, if only a step is
/// required, around the bandwidth that it needs.
pub(crate) fn drawn(problem: &RobustProblem) -> Vec<f64> {
    let frequencies = problem.design_frequencies();
    match (frequencies.first(), frequencies.last()) {
        (Some(first), Some(last)) => problem.drawn_frequencies(first * BEYOND[0], last * BEYOND[1]),
        // only steps are required
        _ => problem.in_time.first().map_or_else(Vec::new, |required| {
            let bandwidth = 1.0 / required.step_limits.horizon_s;
            problem.drawn_frequencies(bandwidth * BEYOND[0], bandwidth * BEYOND_BANDWIDTH)
        }),
    }
}

/// L0 over frequency, and its distance from the bounds at the design frequencies.
fn nominal_loop(problem: &RobustProblem, found: &[DesignFrequency]) -> Result<OutputFile, LinearError> {
    let mut csv = Csv::new("frequency_rad_per_s,magnitude_db,phase_deg,allowed,distance_db");
    let Some(nominal) = problem.nominal()? else { return Ok(OutputFile::new(LOOP, csv.text())) };
    for frequency in drawn(problem) {
        let Some(response) = problem.response(&nominal, frequency) else { continue };
        let value = response.open_loop();
        let (magnitude, phase) = (portable::magnitude(value), portable::argument(value).to_degrees());
        let place = found.iter().find(|one| one.frequency_rad_per_s == frequency);
        let (allowed, distance) = match place.map(|one| &one.filled_placement) {
            None => ("", String::new()),
            Some(Placement::Allowed { slack_db }) => ("true", slack_db.to_string()),
            Some(Placement::Forbidden { nearest_db, .. }) => {
                ("false", nearest_db.map_or(String::new(), |distance| distance.to_string()))
            }
        };
        csv.row(&[&frequency, &decibels(magnitude), &phase, &allowed, &distance]);
    }
    Ok(OutputFile::new(LOOP, csv.text()))
}

/// Least and greatest |F T| of the members, the limits of tracking, and the remaining distance on
/// either side; `None` without tracking or prefilter.
fn prefilter_band(side: &AuditedController) -> Result<Option<OutputFile>, LinearError> {
    let problem = &side.problem;
    let mut csv = Csv::new(
        "specification,frequency_rad_per_s,lower_db,least_db,greatest_db,upper_db,left_below_db,left_above_db",
    );
    let mut any = false;
    for (index, one) in problem.specifications.iter().enumerate() {
        let (Some(lower), upper) = one.requirement.limits() else { continue };
        if !problem.has_prefilter {
            continue;
        }
        any = true;
        let number = number_cell(problem.number_of(index));
        let [from, to] = one.band_rad_per_s;
        let members = problem.members()?;
        for frequency in drawn(problem).into_iter().filter(|frequency| (from..=to).contains(frequency)) {
            let [mut least, mut greatest] = [f64::INFINITY, 0.0_f64];
            for response in members.iter().filter_map(|member| problem.response(member, frequency)) {
                let size = portable::magnitude(one.requirement.closed_loop().response(&response));
                (least, greatest) = (least.min(size), greatest.max(size));
            }
            let [Some(low), Some(high)] = [lower, upper].map(|limit| limit.magnitude(frequency)) else {
                continue;
            };
            let [low, least, greatest, high] = [low, least, greatest, high].map(decibels);
            let (below, above) = (least - low, high - greatest);
            csv.row(&[&number, &frequency, &low, &least, &greatest, &high, &below, &above]);
        }
    }
    Ok(any.then(|| OutputFile::new("prefilter_band.csv", csv.text())))
}

fn rounds(view: &ProjectDesign) -> OutputFile {
    let mut csv =
        Csv::new("round,structure,objective_db,plants,frequencies,searched_margin_db,audited_margin_db");
    for (index, round) in view.design.rounds.iter().enumerate() {
        let audited = round.audited_margin_db.map_or(String::new(), |margin| margin.to_string());
        let structure = structure_parts(&round.structure).join(" + ");
        let number = index + 1;
        csv.row(&[
            &number,
            &structure,
            &round.objective_db,
            &round.plants,
            &round.frequencies,
            &round.searched_margin_db,
            &audited,
        ]);
    }
    OutputFile::new("rounds.csv", csv.text())
}

/// Bounds and templates as tables for other programs.
pub(crate) fn bound_files(problem: &RobustProblem, found: &[DesignFrequency]) -> Vec<OutputFile> {
    let mut bounds =
        Csv::new("specification,kind,frequency_rad_per_s,phase_deg,forbidden_from_gain,forbidden_to_gain");
    let mut plants = Csv::new("frequency_rad_per_s,real,imaginary");
    for one in found {
        for part in &one.bounds.parts {
            let Some(specification) = problem.specifications.get(part.specification) else { continue };
            let number = number_cell(problem.number_of(part.specification));
            let kind = kind_key(&specification.requirement);
            for (phase, forbidden) in part.bound.phases_rad.iter().zip(&part.bound.forbidden) {
                for [low, high] in forbidden.intervals() {
                    let phase_deg = phase.to_degrees();
                    bounds.row(&[&number, &kind, &one.frequency_rad_per_s, &phase_deg, &low, &high]);
                }
            }
        }
        for point in &one.template.template.points {
            let response = point.response;
            plants.row(&[&one.frequency_rad_per_s, &response.re, &response.im]);
        }
    }
    vec![OutputFile::new("bounds.csv", bounds.text()), OutputFile::new("templates.csv", plants.text())]
}
