//! The nominal loops of both controllers among the bounds (thesis, Figure 6.14).

use phea_dynamics::linear::LinearError;
use phea_engineering::design::{AuditedController, ProjectDesign};
use phea_engineering::robust::DesignFrequency;
use phea_qft::bound::Placement;

use super::super::bounds::{NO_BOUNDS, WITHIN_TOLERANCE, group, nearest_bounds, nearest_words, nominal_loop};
use crate::document::frequency_number;
use crate::figure::{Figure, FrequencySeries, NicholsChart, OpenLoopViolation, Words};

/// The chart; `None` without a nominal plant.
pub(super) fn figure(view: &ProjectDesign, found: &[DesignFrequency]) -> Result<Option<Figure>, LinearError> {
    let is_only_controller = view.published.is_none();
    let mut loops = Vec::new();
    let mut violations = Vec::new();
    for (name, side) in [("designed", Some(&view.designed)), ("given", view.published.as_deref())] {
        let Some(side) = side else { continue };
        let Some(series) = nominal_loop(&side.problem)? else { continue };
        loops.push(FrequencySeries { name: format!("{name}, nominal plant"), ..series });
        violations.extend(
            found.iter().filter_map(|one| forbidden(side, if is_only_controller { "" } else { name }, one)),
        );
    }
    if loops.is_empty() {
        return Ok(None);
    }
    let sides = std::iter::once(&view.designed).chain(view.published.as_deref());
    let problems: Vec<_> = sides.map(|side| &side.problem).collect();
    let (bounds, left_out) = nearest_bounds(found, &problems);
    let chart = NicholsChart {
        loops,
        design_frequencies_rad_per_s: view.designed.problem.design_frequencies(),
        bounds: group("bounds of all specifications", &bounds),
        violations,
        ..NicholsChart::default()
    };
    let (title, whose) = match is_only_controller {
        true => ("Nichols chart of the designed loop", "loop"),
        false => ("Nichols chart of both loops", "loops"),
    };
    if bounds.is_empty() {
        return Ok(Some(chart.draw(&Words::new("design_nichols", title, NO_BOUNDS))));
    }
    let caption = format!(
        "The nominal {whose} among the bounds of all specifications; crossed out where a bound forbids it.{WITHIN_TOLERANCE}{}",
        nearest_words(left_out)
    );
    Ok(Some(chart.draw(&Words::new("design_nichols", title, caption))))
}

/// Violation by the loop of a side at a design frequency; `None` if there is none.
fn forbidden(side: &AuditedController, name: &str, one: &DesignFrequency) -> Option<OpenLoopViolation> {
    let frequency_rad_per_s = one.frequency_rad_per_s;
    let feedback = side.problem.compensation.response(frequency_rad_per_s).feedback;
    let open_loop = one.template.template.nominal * feedback;
    // within the tolerance of the audit a loop counts as on its bound
    let specifications = &side.view.audit.specifications;
    let cases = specifications.iter().flat_map(|finding| &finding.at_design_frequencies);
    let own = cases.filter(|case| case.frequency_rad_per_s == frequency_rad_per_s);
    let worst_db = own.map(|case| case.margin_db).fold(f64::INFINITY, f64::min);
    if worst_db.is_finite() && worst_db >= -side.view.audit.tolerance_db {
        return None;
    }
    let Placement::Forbidden { .. } = one.exact_bounds.placement(open_loop) else { return None };
    let text = match name {
        "" => "forbidden".to_string(),
        name => format!("{name} at {}", frequency_number(frequency_rad_per_s)),
    };
    Some(OpenLoopViolation { frequency_rad_per_s, open_loop, text })
}
