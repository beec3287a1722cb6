use phea_dynamics::portable::{argument, log10, magnitude};
use phea_engineering::response::{
    Averaging, LeftOut, LevelComparison, ReferenceSource, ResponseMember, Unusable,
};

use super::answer::relative_radius;
use super::{Compared, levels};
use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// Rows of a table for people; all of them are in the files.
const SHOWN: usize = 16;

/// A section for each record: its division into blocks, the response, and the omitted frequencies;
/// and one for each comparison of two records.
pub(crate) fn document(found: &[Compared], comparisons: &[LevelComparison]) -> Document {
    let mut out = Document::default();
    for compared in found {
        let member = &compared.member;
        let [input, output] = member.signals;
        let [below, above] = member.units;
        let every = member.points.len().div_ceil(SHOWN).max(1);
        let shown = member.points.iter().step_by(every).map(|point| {
            [
                Cell::number_in(point.frequency, 4, DisplayUnit::HERTZ),
                Cell::number_in(20.0 * log10(magnitude(point.response)), 4, DisplayUnit::DECIBEL),
                Cell::number_in(argument(point.response).to_degrees(), 4, DisplayUnit::IN_DEGREES),
                Cell::number_in(relative_radius(point), 2, DisplayUnit::PERCENT),
                Cell::number(point.coherence, 4),
            ]
        });
        let decibels = format!("dB re 1 {above}/{below}");
        let headings = ["frequency (Hz)", decibels.as_str(), "phase (deg)", "95 % within (%)", "coherence"];
        out.section(format!("{}: {output} over {input}", member.file), Table::new(headings).with(shown));
        out.sentences(blocks(member));
        if every > 1 {
            let all = member.points.len();
            out.sentences([format!("One row in {every} is shown; there are {all} frequencies.")]);
        }
        out.sentences(left_out(member));
        out.sentences(agreement(compared));
        out.sentences(compared.warnings().into_iter().map(|warning| format!("{warning}.")));
    }
    out.append(levels::document(comparisons, found));
    out
}

/// Blocks of the record.
fn blocks(member: &ResponseMember) -> Vec<String> {
    let seconds = |value: f64| significant(value, 4);
    let rows = format!("{} rows, {} s apart", member.rows, seconds(member.time_step));
    let how = match member.method {
        Averaging::Periods { period, count } => {
            format!(
                "{rows}: the input repeats every {} s; the last {count} periods are averaged.",
                seconds(period)
            )
        }
        Averaging::LocalPolynomials { bands, .. } => format!(
            "{rows}: the {} does not repeat; {bands} bands of the whole record have a response, a transient and noise of their own.",
            match member.reference {
                Some(ReferenceSource::Column(name)) => name,
                Some(ReferenceSource::Controller) => "reference",
                None => "input",
            }
        ),
        Averaging::Segments { length, count, independent } => format!(
            "{rows}: the input does not repeat; {count} segments of {} s with a Hann window overlap by half and count as {} without overlap.",
            seconds(length),
            significant(independent, 3)
        ),
    };
    let [input, output] = member.signals;
    let of_loop = member.reference.map(|source| match source {
        ReferenceSource::Column(name) => format!("The loop is taken as closed: the response follows from `{name}`, in which noise that returns through the controller has no part."),
        ReferenceSource::Controller => format!("The loop is taken as closed by the declared [controller]: the response follows from the reference that is calculated with it, y + u/C of `{output}` and `{input}`, in which noise that returns through the controller has no part."),
    });
    [Some(how), of_loop].into_iter().flatten().collect()
}

/// Frequencies that were left out, with the reasons.
fn left_out(member: &ResponseMember) -> Vec<String> {
    let of = |reason: Unusable| member.left_out.iter().filter(move |one| one.reason == reason);
    let hertz = |one: &LeftOut| significant(DisplayUnit::HERTZ.of(one.frequency), 4);
    let mut sentences = Vec::new();
    let incoherent: Vec<String> = of(Unusable::Incoherent)
        .take(SHOWN)
        .map(|one| format!("{} Hz ({})", hertz(one), significant(one.coherence, 2)))
        .collect();
    if !incoherent.is_empty() {
        let rest = of(Unusable::Incoherent).count() - incoherent.len();
        let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
        sentences.push(format!(
            "Left out, because the squared coherence is below {}: {}{more}.",
            significant(member.least_coherence, 2),
            incoherent.join(", ")
        ));
    }
    let silent = of(Unusable::NotExcited).count();
    if silent > 0 {
        sentences.push(format!("The input does not excite {silent} other frequencies."));
    }
    sentences
}

/// Agreement with the linear plant of the project.
fn agreement(compared: &Compared) -> Option<String> {
    let (held, apart) = compared.agreement()?;
    let all = compared.member.points.len();
    Some(format!(
        "The linear plant of the project is within the 95 % confidence of {held} of {all} frequencies, and at most {} dB away.",
        significant(apart, 3)
    ))
}
