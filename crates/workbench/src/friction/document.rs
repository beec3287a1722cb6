//! The friction of a cylinder for people.

use phea_engineering::estimate::Estimate;
use phea_engineering::friction::{
    DirectionEvidence, DirectionModel, FrictionIdentification, OpenCoefficient, ShakenRows, VaryingVelocity,
};
use phea_engineering::identify::DECISIVE;

use super::{because, coefficients, misfit_in_words};
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// Coefficients with their intervals and the reasons why some are open, the friction map, and the
/// quality of the fit.
pub(crate) fn document(found: &FrictionIdentification) -> Document {
    let mut out = Document::default();
    write(found, &mut out);
    out
}

/// Appends the document to a chapter of the report.
pub(crate) fn write(found: &FrictionIdentification, out: &mut Document) {
    let headings = ["coefficient", "identified", "95 % from", "to", "unit"];
    out.section("Friction of the cylinder", Table::new(headings).with(rows(found)));
    out.sentences(remarks(found));
    let points = found.steady_points();
    if !points.is_empty() {
        let headings = ["file", "velocity (mm/s)", "friction (N)", "by the curve (N)"];
        let rows = points.iter().map(|point| {
            [
                Cell::from(file(found, point.recording)),
                Cell::number_in(point.velocity, 4, DisplayUnit::MILLIMETRE),
                Cell::number(point.force, 4),
                Cell::number(point.modelled, 4),
            ]
        });
        out.section("Friction at constant velocities", Table::new(headings).with(rows));
    }
    if !found.varying.is_empty() {
        out.heading("Left out: velocities that are not constant");
        out.sentences(found.varying.iter().map(|one| varying(found, one)));
    }
    if !found.presses.is_empty() {
        out.heading("Before the piston breaks away");
        out.sentences(found.presses.iter().map(|press| {
            let end =
                if press.breaks_away { "then the piston breaks away" } else { "it does not break away" };
            format!("{}: {} rows are explained; {end}.", file(found, press.recording), press.rows)
        }));
    }
    if !found.shakes.is_empty() {
        out.heading("Shaken on the bristles");
        out.sentences(found.shakes.iter().map(|shake| shaken(found, shake)));
    }
    out.heading("How well the recordings are explained");
    out.sentences(explained(found));
}

/// A run that sticks and slips, or whose velocity varies otherwise.
fn varying(found: &FrictionIdentification, one: &VaryingVelocity) -> String {
    let [mean, least, greatest] =
        [one.velocity, one.range[0], one.range[1]].map(|velocity| DisplayUnit::MILLIMETRE.of(velocity));
    format!(
        "{}: {} rows move by {} mm/s on average and go from {} to {} mm/s; steady friction is not what drives them, and they determine nothing here.",
        file(found, one.recording),
        one.rows.len(),
        significant(mean, 3),
        significant(least, 2),
        significant(greatest, 2)
    )
}

fn shaken(found: &FrictionIdentification, shake: &ShakenRows) -> String {
    let all = || shake.force.frequencies.iter().map(|one| DisplayUnit::HERTZ.of(*one));
    let [low, high] = [all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max)];
    let ringing = (found.lugre.bristle_stiffness / found.moving_mass).sqrt();
    let damping = found.lugre.bristle_damping + found.lugre.curve.viscous;
    let ratio = damping / (2.0 * ringing * found.moving_mass);
    format!(
        "{}: {} rows of {} sines from {} to {} Hz are explained. The mass rings on its bristles at {} Hz, with a damping ratio (sigma_1 + sigma_2)/(2 (sigma_0 M)^0.5) of {}.",
        file(found, shake.recording),
        shake.force.rows,
        shake.force.frequencies.len(),
        significant(low, 3),
        significant(high, 3),
        significant(DisplayUnit::HERTZ.of(ringing), 3),
        significant(ratio, 2)
    )
}

fn file(found: &FrictionIdentification, recording: usize) -> String {
    found.recordings.get(recording).map_or(String::new(), |one| one.file.clone())
}

fn rows(found: &FrictionIdentification) -> Vec<[Cell; 5]> {
    let row = |(name, unit, one): (String, &'static str, &Result<Estimate, OpenCoefficient>)| {
        let (value, interval) = match one {
            Ok(Estimate { value, interval }) => (Cell::number(*value, 4), interval),
            Err(open) => (Cell::Missing, &open.estimate.interval),
        };
        let [low, high] = interval.map(|end| match end.is_finite() {
            true => Cell::number(end, 4),
            false => Cell::Missing,
        });
        [Cell::Code(name), value, low, high, Cell::unit(unit)]
    };
    coefficients(found).map(row).collect()
}

/// Open coefficients, and the zero of the force.
fn remarks(found: &FrictionIdentification) -> Vec<String> {
    let open = coefficients(found).filter_map(|(name, _, one)| {
        Some(format!("`{name}` is not determined: {}.", because(one.as_ref().err()?)))
    });
    let zero = match &found.zero {
        Some(zero) => {
            let [value, low, high] =
                [zero.value, zero.interval[0], zero.interval[1]].map(|value| significant(value, 3));
            let directions = if zero.interval[0] <= 0.0 && 0.0 <= zero.interval[1] {
                ""
            } else {
                " An error of their zero looks like a friction that differs by twice as much between both directions, as that of a rod seal may: the coefficients are the mean of both, and reading the pressures with both ports open to the tank tells which it is."
            };
            format!("Without friction the instruments show {value} N (95 %: {low} to {high} N).{directions}")
        }
        None if found.retracting.is_some() => {
            "The instruments are taken to show no force without friction: an error of their zero would make each level of one direction greater by as much, and each of the other smaller. Reading the pressures with both ports open to the tank shows it."
                .to_string()
        }
        None => {
            "The recordings go one way: that the instruments show no force without friction is taken for granted."
                .to_string()
        }
    };
    open.chain(found.evidence.iter().map(directions)).chain([zero]).collect()
}

/// The model that the recordings support: equal in both directions, or different by direction.
fn directions(evidence: &DirectionEvidence) -> String {
    let by = significant(evidence.difference().abs(), 3);
    match (evidence.chosen(), evidence.difference() > 0.0) {
        (DirectionModel::DiffersByDirection, _) => format!(
            "The friction differs by direction: the information criterion of Schwarz is lower by {by} with levels for each than with the same for both, where {DECISIVE} is decisive. Coefficients without `retracting` are those of extending, or of both."
        ),
        (DirectionModel::SameBothWays, true) => format!(
            "One friction for both directions: with levels for each the information criterion of Schwarz is lower by {by}, where {DECISIVE} would be decisive."
        ),
        (DirectionModel::SameBothWays, false) => format!(
            "One friction for both directions: with levels for each the information criterion of Schwarz is higher by {by}."
        ),
    }
}

fn explained(found: &FrictionIdentification) -> Vec<String> {
    let [force, position] = found.residual_rms;
    let mut sentences = Vec::new();
    sentences.extend(force.map(|rms| {
        format!("Root mean square of what is left of the force, in each row: {} N.", significant(rms, 3))
    }));
    sentences.extend(position.map(|rms| {
        let micrometres = 1e3 * DisplayUnit::MILLIMETRE.of(rms);
        format!("Root mean square of what is left of the position: {} um.", significant(micrometres, 3))
    }));
    if found.independent < 1.0 {
        sentences.push(format!(
            "Neighbouring residuals are alike: as few as {} % of them count as independent, and the intervals are wider for it.",
            significant(100.0 * found.independent, 2)
        ));
    }
    sentences.extend(found.misfits.iter().map(|one| format!("Misfit: {}.", misfit_in_words(found, one))));
    if !found.misfits.is_empty() {
        sentences.push(
            "The intervals cover noise, not a misfit: friction that changes with the position or the temperature, or runs that are not steady, may be the cause."
                .to_string(),
        );
    }
    if !found.has_converged() {
        sentences.push("The search has not converged.".to_string());
    }
    sentences
}
