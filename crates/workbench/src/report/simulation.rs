//! The chapter on the nonlinear model: each scenario over time under each controller, and its
//! metrics compared with requirements in time, published values and measurements.

use super::chapter::Chapter;
use super::driven::MachineChapter;
use super::driving;
use crate::document::{Cell, Document, StatusMark, Table, capital};
use crate::figure::Figure;
use crate::project::{Project, Scenario};
use crate::quantity::{MotionWords, Units};
use crate::simulate::{
    Metric, Metrics, NamedRun, StepLimits, TimeRequirement, Window, adjustment_sentence, cause_words,
    cells_of, close_ups, coarse_sentence, gas_sentence, headline, label_within, measured, measured_together,
    metrics_row, occurrence_sentences, pictures, published, published_row, required_overshoot,
    required_settling, requirement_of, together, turns, windows,
};

/// The chapter.
pub(super) fn chapter(project: &Project, driven: &MachineChapter) -> Chapter {
    let mut out = Document::default();
    for side in &driven.sides {
        if let Err(error) = &side.runs {
            let with = if driven.sides.len() > 1 {
                format!(" with the {} controller", side.name)
            } else {
                String::new()
            };
            out.verdict(StatusMark::Bad, format!("Not simulated{with}: {error}"), vec![]);
        }
    }
    let any = (0..project.scenarios.len()).any(|index| !driven.of_scenario(index).is_empty());
    let cell = project.motion().words().load_cell;
    out.explanations(any.then(|| format!("The rig as a whole, simulated: spool with saturation, the flow of each edge, chambers that grow and shrink, friction as declared, {cell} and load, under the controller as it is deployed. Peaks and settling times are those of the solution over each step of the integration, so that they do not depend on the rows of the table.")));
    for (index, declared) in project.scenarios.iter().enumerate() {
        let runs = driven.of_scenario(index);
        let required = driven.required_of(index);
        if !runs.is_empty() {
            let drawn = drawn(&driven.drawn(index), index + 1, driven.requirement_of(index));
            out.append(scenario(&runs, declared, required, drawn));
        }
    }
    Chapter::of("simulation", "Nonlinear simulation", out)
}

/// The appendix: the signals inside the machine at each event, for each of several controllers.
pub(super) fn inside(project: &Project, driven: &MachineChapter) -> Option<Chapter> {
    let scenarios = 0..project.scenarios.len();
    let several =
        scenarios.map(|index| (index, driven.of_scenario(index))).filter(|(_, runs)| runs.len() > 1);
    let figures: Vec<Figure> = several
        .flat_map(|(index, runs)| runs.into_iter().flat_map(move |named| close_ups(named, index + 1)))
        .collect();
    if figures.is_empty() {
        return None;
    }
    let mut out = Document::default();
    let MotionWords { force, piston, .. } = project.motion().words();
    out.explanation(format!("What the figures of both controllers leave out: the spool and the command, both chambers, and hydraulic and measured {force}, between which lie the friction and the acceleration of the {piston}; in the order of Figure 6.17 of Ledezma (2019)."));
    out.figures(figures);
    Some(Chapter::of("inside", "Inside the simulated rig at each event", out))
}

/// Figures of all controllers together; for a single controller, figures of all signals.
fn drawn(runs: &[NamedRun<'_>], number: usize, requirement: Option<&StepLimits>) -> Vec<Figure> {
    match runs {
        [only] => pictures(only.run, number),
        several => {
            let mut figures = together(several, number, requirement);
            figures.extend(measured_together(several, number));
            figures
        }
    }
}

fn scenario(
    runs: &[NamedRun<'_>],
    declared: &Scenario,
    required: Option<&TimeRequirement>,
    figures: Vec<Figure>,
) -> Document {
    let mut out = Document::default();
    out.heading(runs.first().map(|named| named.run.name.as_str()).unwrap_or_default());
    out.explanations(runs.iter().map(|named| format!("{}{}.", of(named, runs), headline(named.run))));
    let units = runs.first().map_or(Units::default(), |named| named.run.record.units);
    out.explanations(driving::sentences(declared, units, runs.iter().any(|named| turns(&named.run.record))));
    out.figures(figures);
    out.append(metrics(runs, declared, required));
    let names = runs.iter().map(|named| (Some(named.name).filter(|_| runs.len() > 1), named.run));
    let measured = measured(&names.collect::<Vec<_>>());
    if !measured.is_empty() {
        out.table(measured);
        out.explanation(
            "NRMSE is the root mean square of measured less simulated, over the range of what was measured.",
        );
    }
    let remarks = declared.reference.iter().filter_map(|step| step.published()?.remark.clone());
    let notes = runs.iter().flat_map(|named| {
        let adjusted = adjustment_sentence(named.run).into_iter().chain(gas_sentence(named.run));
        let sentences = coarse_sentence(named.run).into_iter().chain(adjusted);
        let sentences = sentences.chain(occurrence_sentences(named.run));
        sentences.map(|sentence| match runs.len() {
            0 | 1 => format!("{}.", capital(&sentence)),
            _ => format!("{}{sentence}.", of(named, runs)),
        })
    });
    out.explanations(remarks.chain(notes));
    out
}

/// The controller of a sentence, if there are several.
fn of(named: &NamedRun<'_>, runs: &[NamedRun<'_>]) -> String {
    if runs.len() > 1 { format!("{}: ", capital(named.name)) } else { String::new() }
}

/// The metrics of each event: a row for each controller, compared with published values.
fn metrics(runs: &[NamedRun<'_>], declared: &Scenario, required: Option<&TimeRequirement>) -> Document {
    let mut out = Document::default();
    let Some(first) = runs.first().map(|named| named.run).filter(|first| !first.windows.is_empty()) else {
        return out;
    };
    match runs {
        [only] => out.table(windows(only.run, required, Some(declared))),
        several => {
            let shown = shown_metrics(several.iter().flat_map(|named| &named.run.windows));
            let (band, motion) = (first.settling_band_percent, first.record.units.motion);
            let words = shown.iter().map(|metric| label_within(*metric, [band], motion));
            let heads = std::iter::once(String::new()).chain(words);
            let mut rows = Table::grouped_by("event", heads);
            for (index, (window, _)) in first.windows.iter().enumerate() {
                rows.group(cause_words(window, first.record.units));
                for named in several {
                    if let Some((_, metrics)) = named.run.windows.get(index) {
                        rows.row(metrics_row(
                            named.name.to_string(),
                            &shown,
                            (metrics, named.run.record.units),
                            requirement_of(required, window),
                        ));
                    }
                }
                if let Some((source, cells)) = published(declared, window, first.record.units) {
                    rows.row(published_row(source, &shown, cells));
                }
            }
            out.table(rows);
        }
    }
    let requirement =
        required.and_then(|required| Some((required, requirement_words(&required.step_limits)?)));
    let requirement = requirement.map_or(String::new(), |(required, words)| {
        let steps = if required.steps.are_stated() { "the required step" } else { "every step" };
        format!(
            " Wished of {steps}: {words}; a disc with a tick satisfies it, a square with a cross does not."
        )
    });
    out.explanation(format!(
        "Settling is to {} % of the step, or of the reference that a load motion disturbs; the steady-state error is reference less {}, averaged over the last tenth of the window; the rise is from 10 to 90 % of the step.{requirement}",
        first.settling_band_percent,
        first.record.units.motion.words().force
    ));
    out
}

/// The requirement in time, in words.
fn requirement_words(requirement: &StepLimits) -> Option<String> {
    let words: Vec<String> =
        [required_overshoot(requirement), required_settling(requirement)].into_iter().flatten().collect();
    (!words.is_empty()).then(|| words.join(", "))
}

/// The metrics that some of these windows can have.
pub(super) fn shown_metrics<'a>(windows: impl Iterator<Item = &'a (Window, Metrics)>) -> Vec<Metric> {
    let cells: Vec<_> = windows.map(|(_, metrics)| cells_of(metrics, Units::default())).collect();
    Metric::ALL
        .into_iter()
        .filter(|metric| cells.iter().any(|cells| cells[*metric] != Cell::Missing))
        .collect()
}
