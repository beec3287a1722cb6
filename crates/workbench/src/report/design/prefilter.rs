//! The band that each loop leaves for its prefilter, and the prefilter in it (thesis 3.1.5).

use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;
use phea_engineering::design::{AuditedController, ProjectDesign};
use phea_engineering::robust::DEFAULT_TOLERANCE_DB;
use phea_qft::prefilter::{PrefilterBand, PrefilterBandPoint};
use phea_qft::specification::Specification;
use phea_qft::verification::Verdict;

use crate::answer::significant;
use crate::figure::{Figure, PrefilterPanel, PrefilterPoint, Words, prefilter_band};
use crate::specification::stated;
use crate::verdict_words::frequency_words;

/// Distance of tracking limits below which they are not distinguishable in a figure, dB.
const DISTINGUISHED_DB: f64 = 0.01;
/// Factors by which the drawn frequencies extend below and above the design frequencies.
const BEYOND: [f64; 2] = [0.1, 10.0];

/// A figure for each tracking specification for which a prefilter was designed.
pub(in crate::report) fn figures(view: &ProjectDesign) -> Result<Vec<Figure>, LinearError> {
    let mut figures = Vec::new();
    for (index, one) in view.designed.problem.specifications.iter().enumerate() {
        if one.requirement.is_tracking() && view.designed.problem.has_prefilter {
            figures.extend(figure(view, index, one)?);
        }
    }
    Ok(figures)
}

fn figure(
    view: &ProjectDesign,
    index: usize,
    specification: &Specification,
) -> Result<Option<Figure>, LinearError> {
    let mut panels = Vec::new();
    let mut tightest = Vec::new();
    for (name, side) in [("designed", Some(&view.designed)), ("given", view.published.as_deref())] {
        let Some((panel, sentence)) =
            side.map(|side| panel(name, side, index, specification)).transpose()?.flatten()
        else {
            continue;
        };
        panels.push(panel);
        tightest.push(sentence);
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let caption = format!(
        "What the spread of the family leaves for |F|, from the lower limit over the least |T| to the upper one over the greatest, and the prefilter. {}",
        tightest.join(" ")
    );
    let name = format!("design_{}_prefilter", index + 1);
    let words =
        Words::new(name, format!("Prefilter for {}", stated(view.designed.problem.named(index))), caption);
    Ok(Some(prefilter_band(&words, &panels)))
}

/// The band of one loop, with a sentence on its narrowest place; `None` for a loop that is not
/// stable, or not known.
fn panel(
    name: &str,
    side: &AuditedController,
    index: usize,
    specification: &Specification,
) -> Result<Option<(PrefilterPanel, String)>, LinearError> {
    let problem = &side.problem;
    let frequencies = problem.design_frequencies();
    let (Some(first), Some(last)) = (frequencies.first(), frequencies.last()) else { return Ok(None) };
    if side.view.audit.stability.verdict == Verdict::Violated {
        return Ok(None);
    }
    let drawn = problem.drawn_frequencies(first * BEYOND[0], last * BEYOND[1]);
    let finding = side.view.audit.specifications.get(index);
    let worst = finding.and_then(|found| problem.member(&found.worst.as_ref()?.plant));
    let mut members = problem.members()?;
    members.extend(worst);
    let band = PrefilterBand::of_family(&problem.compensation, &members, &drawn, specification);
    // if a measurement does not cover the range, or the band contains no frequency, there is
    // nothing to draw
    let Ok(band) = band else { return Ok(None) };
    let size =
        |frequency: f64| decibels(portable::magnitude(problem.compensation.response(frequency).prefilter));
    let shown = shown(&band, &drawn);
    let points = shown.iter().map(|point| PrefilterPoint {
        frequency_rad_per_s: point.frequency_rad_per_s,
        least_db: point.least_db,
        greatest_db: point.greatest_db,
        prefilter_db: problem.has_prefilter.then(|| size(point.frequency_rad_per_s)),
    });
    let sentence = sentence(name, &band, &shown);
    Ok(Some((PrefilterPanel { name: name.to_string(), points: points.collect() }, sentence)))
}

/// The band at drawn frequencies, beginning where its limits can be distinguished.
fn shown(band: &PrefilterBand, drawn: &[f64]) -> Vec<PrefilterBandPoint> {
    let ends = drawn.first().copied().unwrap_or_default()..=drawn.last().copied().unwrap_or_default();
    let inside = band.points().iter().filter(|point| ends.contains(&point.frequency_rad_per_s));
    let points: Vec<PrefilterBandPoint> = inside.copied().collect();
    let first = points.iter().position(|point| point.allowed_db >= DISTINGUISHED_DB).unwrap_or(0);
    points.into_iter().skip(first).collect()
}

fn sentence(name: &str, band: &PrefilterBand, shown: &[PrefilterBandPoint]) -> String {
    if let Some(closed) = band.closed(DEFAULT_TOLERANCE_DB) {
        return format!(
            "The {name} loop leaves none: the family spreads {} dB too far {}.",
            significant(-closed.width_db(), 3),
            frequency_words(closed.frequency_rad_per_s)
        );
    }
    let fraction = |point: &PrefilterBandPoint| point.width_db() / point.allowed_db;
    let tightest = shown.iter().min_by(|one, other| fraction(one).total_cmp(&fraction(other)));
    let Some(tightest) = tightest else { return String::new() };
    format!(
        "The {name} loop uses most of its share {}: {} of {} dB are left.",
        frequency_words(tightest.frequency_rad_per_s),
        significant(tightest.width_db(), 3),
        significant(tightest.allowed_db, 3)
    )
}
