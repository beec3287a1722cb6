//! The chapter on templates and bounds: the plants at each design frequency, the regions forbidden
//! to the nominal loop, and the position of the given loop among the bounds.

use num_complex::Complex64;
use phea_dynamics::linear::LinearError;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable::exp_complex;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::robust::{DesignFrequency, RobustProblem};
use phea_engineering::specification::kind_key;
use phea_qft::bound::{Bound, Collision, Feasibility, Placement};
use phea_qft::template::{Resolution, Template};
use phea_qft::verification::Verdict;

use super::chapter::Chapter;
use crate::answer::significant;
use crate::audit::closed_loop_symbol;
use crate::design::drawn;
use crate::document::{Cell, Document, StatusMark, Table, frequency_number};
use crate::error::CommandError;
use crate::figure::{
    BoundGroup, Figure, FrequencySeries, NicholsChart, OpenLoopViolation, USUAL_CONTOURS_DB, Words, templates,
};
use crate::quantity::DisplayUnit;
use crate::specification::{name_words, stated};

/// The chapter; `chart` is the Nichols chart of the given loop if it is shown nowhere else.
pub(super) fn chapter(problem: &RobustProblem, found: &[DesignFrequency], chart: Option<Figure>) -> Chapter {
    let templates: Vec<Template> = found.iter().map(|one| one.template.template.clone()).collect();
    let mut out = Document::default();
    out.explanation("What the robust method works with: the plants at each design frequency (templates), and the gains and phases that the nominal open loop must avoid there (bounds), so that every plant satisfies the specifications. Bounds count the interior of a template as plants, where that is known to be filled.");
    out.figures([template_figure(&templates)]);
    out.table(
        Table::new(["rad/s", "plants", "closeness of neighbours"]).with(found.iter().map(template_row)),
    );
    out.figures(specification_figures(problem, found));
    out.figures(chart);
    out.explanations(unreached(problem, found));
    if problem.has_controller {
        out.heading("The given loop among the bounds");
        out.explanation("At the design frequencies only: bounds state nothing about the frequencies between them, or about stability.");
        out.table(placements(problem, found));
    }
    for sentence in feasibility(problem, found) {
        out.verdict(StatusMark::Bad, sentence, vec![]);
    }
    Chapter::of("bounds", "Templates and bounds", out)
}

fn template_row(one: &DesignFrequency) -> [String; 3] {
    let closeness = match &one.template.template.resolution {
        Resolution::Members => "only these plants; nothing between them is known".to_string(),
        Resolution::Resolved { phase_deg, magnitude_db } => {
            format!("within {}° and {} dB", significant(*phase_deg, 2), significant(*magnitude_db, 2))
        }
        Resolution::NotResolved { phase_deg, magnitude_db, .. } => format!(
            "does not close: gaps of {}° and {} dB remain; a resonance inside the family keeps it open",
            significant(*phase_deg, 2),
            significant(*magnitude_db, 2)
        ),
    };
    let plants = one.template.template.points.len().to_string();
    [frequency_number(one.frequency_rad_per_s), plants, closeness]
}

fn template_figure(found: &[Template]) -> Figure {
    let caption = "Every plant of the family by phase and magnitude, at each design frequency; the nominal plant marked.";
    templates(&Words::new("templates", "Templates", caption), found)
}

fn specification_figures(problem: &RobustProblem, found: &[DesignFrequency]) -> Vec<Figure> {
    let mut figures = Vec::new();
    for (index, specification) in problem.specifications.iter().enumerate() {
        let bounds: Vec<Bound> = found
            .iter()
            .filter_map(|one| one.bounds.parts.iter().find(|part| part.specification == index))
            .map(|part| part.bound.clone())
            .collect();
        let requirement = &specification.requirement;
        let name = format!("bounds_{}_{}", index + 1, kind_key(requirement));
        let title = format!("Bounds of {}", stated(problem.named(index)));
        let caption = format!(
            "Where the nominal loop may not be, so that every plant satisfies the limit of {}; ticks point to the forbidden side.",
            closed_loop_symbol(requirement)
        );
        let chart = NicholsChart {
            bounds: vec![BoundGroup { name: name_words(problem.named(index)).to_string(), bounds: &bounds }],
            contours_db: USUAL_CONTOURS_DB.to_vec(),
            ..NicholsChart::default()
        };
        figures.push(chart.draw(&Words::new(name, title, caption)));
    }
    figures
}

/// Bounds that a chart of loops shows at most.
const SHOWN_BOUNDS: usize = 5;

/// Phases next to a loop at which a bound is searched for, degrees, and the number of degrees that
/// count as much as a decibel.
const PHASE_OFFSETS_DEG: [f64; 9] = [0.0, -10.0, 10.0, -20.0, 20.0, -30.0, 30.0, -40.0, 40.0];
const DEGREES_PER_DECIBEL: f64 = 4.0;

/// The bounds of all specifications at the frequencies at which one of these loops comes nearest to
/// them, in order of frequency; true if others are left out.
pub(super) fn nearest_bounds(found: &[DesignFrequency], loops: &[&RobustProblem]) -> (Vec<Bound>, bool) {
    let distance = |one: &DesignFrequency| {
        let of = |problem: &&RobustProblem| {
            let feedback = problem.compensation.response(one.frequency_rad_per_s).feedback;
            let open_loop = one.template.template.nominal * feedback;
            // a bound may be to the left or right of the loop, and not above or below it
            let distance_db = |degrees: f64| {
                let turned = exp_complex(Complex64::new(0.0, degrees.to_radians()));
                let above_db = match one.exact_bounds.placement(open_loop * turned) {
                    Placement::Allowed { slack_db } => slack_db,
                    Placement::Forbidden { .. } => 0.0,
                };
                let phase_db = degrees / DEGREES_PER_DECIBEL;
                (above_db * above_db + phase_db * phase_db).sqrt()
            };
            PHASE_OFFSETS_DEG.into_iter().map(distance_db).fold(f64::INFINITY, f64::min)
        };
        loops.iter().map(of).fold(f64::INFINITY, f64::min)
    };
    let mut order: Vec<(f64, &DesignFrequency)> = found.iter().map(|one| (distance(one), one)).collect();
    if !loops.is_empty() {
        sort_by_number(&mut order, |one| one.0);
        order.truncate(SHOWN_BOUNDS);
        sort_by_number(&mut order, |one| one.1.frequency_rad_per_s);
    }
    let left_out = order.len() < found.len();
    (order.into_iter().map(|(_, one)| one.bounds.union.clone()).collect(), left_out)
}

/// The bounds that a chart shows, in a sentence.
pub(super) const fn nearest_words(left_out: bool) -> &'static str {
    if left_out { " Bounds: of the five frequencies nearest to a loop." } else { "" }
}

/// Caption of the chart of a loop for which only steps are required.
pub(super) const NO_BOUNDS: &str =
    "The nominal loop around the critical point; nothing is required over frequency that would draw a bound.";

/// The bounds of a chart under their name; empty if there are none.
pub(super) fn group<'a>(name: &str, bounds: &'a [Bound]) -> Vec<BoundGroup<'a>> {
    let group = BoundGroup { name: name.to_string(), bounds };
    if bounds.is_empty() { vec![] } else { vec![group] }
}

/// Reason why a loop that meets a specification may be beyond its bound.
pub(super) const WITHIN_TOLERANCE: &str = " Bounds are drawn without the tolerance of the verdict: where one is steep, a loop that is met within it may lie some decibels beyond.";

/// L0 over the frequencies around those of the design; `None` without a controller or a nominal
/// plant.
pub(super) fn nominal_loop(problem: &RobustProblem) -> Result<Option<FrequencySeries>, LinearError> {
    if !problem.has_controller {
        return Ok(None);
    }
    let Some(nominal) = problem.nominal()? else { return Ok(None) };
    let mut series = FrequencySeries {
        name: "nominal loop L0".to_string(),
        frequencies_rad_per_s: vec![],
        response: vec![],
    };
    for frequency in drawn(problem) {
        if let Some(response) = problem.response(&nominal, frequency) {
            series.frequencies_rad_per_s.push(frequency);
            series.response.push(response.open_loop());
        }
    }
    Ok(Some(series))
}

/// The Nichols chart of the given loop, or of the bounds only; `None` if there is neither.
///
/// # Errors
/// A loop that cannot be computed.
pub(super) fn chart(
    problem: &RobustProblem,
    found: &[DesignFrequency],
    view: Option<&ProjectAudit>,
) -> Result<Option<Figure>, CommandError> {
    let nominal = nominal_loop(problem)?;
    if nominal.is_none() && problem.specifications.is_empty() {
        return Ok(None);
    }
    let given = [problem];
    let (bounds, left_out) = nearest_bounds(found, if problem.has_controller { &given } else { &[] });
    let violations = view.map_or_else(Vec::new, |view| violations(problem, view));
    let has_violations = !violations.is_empty();
    let chart = NicholsChart {
        loops: nominal.into_iter().collect(),
        design_frequencies_rad_per_s: problem.design_frequencies(),
        bounds: group("all specifications", &bounds),
        templates: &[],
        violations,
        contours_db: vec![],
    };
    if bounds.is_empty() {
        return Ok(Some(chart.draw(&Words::new("nichols", "Nichols chart of the loop", NO_BOUNDS))));
    }
    let shown = match (problem.has_controller, has_violations) {
        (true, true) => {
            ", the nominal loop with its design frequencies, and the plants that violate a specification most"
        }
        (true, false) => ", and the nominal loop with its design frequencies",
        (false, _) => "",
    };
    let caption = "a loop above a bound that is open upwards, and outside closed ones, satisfies all of them at that frequency.";
    let within = if view.is_some() { WITHIN_TOLERANCE } else { "" };
    let caption = format!(
        "The bounds of all specifications together{shown}: {caption}{within}{}",
        nearest_words(left_out)
    );
    Ok(Some(chart.draw(&Words::new("nichols", "Nichols chart of the loop", caption))))
}

/// The open loop of each worst plant at which it violates a specification.
fn violations(problem: &RobustProblem, view: &ProjectAudit) -> Vec<OpenLoopViolation> {
    let violated = view.audit.specifications.iter().filter(|finding| finding.verdict == Verdict::Violated);
    violated
        .filter_map(|finding| {
            let worst = finding.worst.as_ref()?;
            let frequency_rad_per_s = worst.frequency_rad_per_s;
            let member = problem.member(&worst.plant)?;
            let response = problem.response(&member, frequency_rad_per_s)?;
            let symbol = closed_loop_symbol(&finding.requirement);
            let size = significant(worst.margin_db.abs(), 3);
            let text = format!("{symbol} {size} dB off at {} rad/s", frequency_number(frequency_rad_per_s));
            Some(OpenLoopViolation { frequency_rad_per_s, open_loop: response.open_loop(), text })
        })
        .collect()
}

/// Design frequencies that a measurement does not reach.
fn unreached(problem: &RobustProblem, found: &[DesignFrequency]) -> Option<String> {
    let is_found = |frequency: &f64| found.iter().any(|one| one.frequency_rad_per_s == *frequency);
    let missing: Vec<String> =
        problem.design_frequencies().into_iter().filter(|one| !is_found(one)).map(frequency_number).collect();
    let listed = missing.join(", ");
    (!missing.is_empty())
        .then(|| format!("Not measured, and therefore without template and bound: {listed} rad/s."))
}

fn placements(problem: &RobustProblem, found: &[DesignFrequency]) -> Table {
    let row = |one: &DesignFrequency| {
        [
            Cell::frequency(one.frequency_rad_per_s),
            placement(problem, &one.placement),
            placement(problem, &one.filled_placement),
        ]
    };
    Table::new(["rad/s", "counting the plants alone", "counting the interior of the template"])
        .with(found.iter().map(row))
}

fn placement(problem: &RobustProblem, placement: &Placement) -> Cell {
    match placement {
        Placement::Allowed { slack_db } if slack_db.is_infinite() => {
            Cell::from("allowed, nothing is forbidden at this phase").marked(true)
        }
        Placement::Allowed { slack_db } => {
            let slack = Cell::quantity(*slack_db, 3, DisplayUnit::DECIBEL);
            slack.between("allowed, ", " from a bound").marked(true)
        }
        Placement::Forbidden { by, nearest_db } => {
            let names: Vec<String> = by.iter().map(|index| named(problem, *index)).collect();
            let change = match nearest_db {
                Some(change) => {
                    Cell::from("allowed with ").then(Cell::change(*change, 2, DisplayUnit::DECIBEL))
                }
                None => "no gain is allowed at this phase".into(),
            };
            Cell::from(format!("forbidden by {}; ", names.join(", "))).then(change).marked(false)
        }
    }
}

fn named(problem: &RobustProblem, index: usize) -> String {
    let name = name_words(problem.named(index));
    problem.number_of(index).map_or_else(|| name.to_string(), |number| format!("{number} ({name})"))
}

/// Frequencies at which no loop can satisfy the specifications, and the conflicting ones.
fn feasibility(problem: &RobustProblem, found: &[DesignFrequency]) -> Vec<String> {
    let sentence = |collision: &Collision| {
        let names: Vec<String> =
            collision.specifications.iter().map(|index| named(problem, *index)).collect();
        let [from, to] = collision.phases_rad.map(|phase| significant(phase.to_degrees(), 3));
        let who = match names.as_slice() {
            [one] => format!("{one} alone forbids every gain"),
            _ => format!("{} leave no gain to each other", names.join(" and ")),
        };
        format!(
            "At {} rad/s, phases {from}° to {to}°: {who}",
            frequency_number(collision.frequency_rad_per_s)
        )
    };
    let mut sentences = Vec::new();
    for one in found {
        if let Feasibility::Nowhere { collisions } = &one.bounds.feasibility {
            let frequency = frequency_number(one.frequency_rad_per_s);
            sentences.push(format!(
                "No loop satisfies all specifications at {frequency} rad/s, whatever its controller"
            ));
            sentences.extend(collisions.iter().map(sentence));
        }
    }
    sentences
}
