//! The answer of `shape`.

use phea_engineering::plant_names::NamedPlant;
use phea_engineering::shaping::{ProjectShaping, Shaped};
use phea_engineering::specification::kind_key;
use phea_qft::bound::Placement;
use phea_qft::manual_shaping::{DesignMargin, DesignPoint};
use phea_qft::verification::Verdict;

use super::document::polar;
use crate::answer::{Answer, Csv, OrReason, OutputFile, words};
use crate::audit::{self, SpecificationMarginAnswer, StableAnswer, stability_reason, stable};
use crate::caveat;
use crate::project::{DeclaredElement, ElementKind, SpecificationKind};
use crate::specification::number_cell;

/// Answer of `shape`.
#[derive(Answer)]
pub(crate) struct ShapeAnswer {
    /// Law that is shaped.
    shaped: Shaped,
    /// Number of changes that were made.
    changes: usize,
    /// Elements of the law after the changes, including disabled ones.
    elements: Vec<ShapedElementAnswer>,
    #[answer(flatten)]
    stable: StableAnswer,
    /// Stability of the family in the loop.
    stability: ShapedStabilityAnswer,
    /// Margin of every specification at each of its design frequencies, the worst first.
    margins: Vec<ShapedMarginAnswer>,
    /// Nominal loop at the design frequencies.
    #[answer(key = "loop")]
    points: Vec<LoopPointAnswer>,
    /// Design frequencies that the measurement of a plant does not contain.
    unreached_rad_per_s: Vec<f64>,
    /// Declared effects that the margins do not include.
    warnings: Vec<String>,
}

words! {
    /// Law that is shaped, by its table in the project file.
    Shaped by Shaped::table [Controller, Prefilter]
}

/// Element of a controller or prefilter.
#[derive(Answer)]
struct ShapedElementAnswer {
    /// Number of the element, from 1.
    number: usize,
    /// Kind of the element, as in the project file.
    kind: ElementKind,
    /// True if the element is part of the law.
    enabled: bool,
    /// Element as the project file states it.
    element: String,
}

words! {
    /// Kind of an element of a controller or prefilter, as in the project file.
    ElementKind {
        Gain { .. } => "gain",
        Integrator => "integrator",
        Differentiator => "differentiator",
        Zero { .. } => "zero",
        Pole { .. } => "pole",
        ComplexZeros { .. } => "complex_zeros",
        ComplexPoles { .. } => "complex_poles",
        Lead { .. } => "lead",
        Lag { .. } => "lag",
        Notch { .. } => "notch",
        RollOff { .. } => "roll_off",
        ProportionalIntegral { .. } => "pi",
        ProportionalIntegralDerivative { .. } => "pid",
        General(_) => "general",
    }
}

/// Stability of a family in the shaped loop.
#[derive(Answer)]
struct ShapedStabilityAnswer {
    /// Verdict on stability.
    verdict: Verdict,
    /// Plant with the pole of the largest real part, or that is unstable, or that could not be
    /// resolved.
    plant: NamedPlant,
    /// Reason for the verdict.
    reason: String,
}

/// Margin of a specification at a design frequency.
#[derive(Answer)]
struct ShapedMarginAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Kind of the specification.
    kind: SpecificationKind,
    #[answer(flatten)]
    margin: SpecificationMarginAnswer,
    #[answer(flatten)]
    placement: PlacementAnswer,
}

/// Nominal loop at a design frequency.
#[derive(Answer)]
struct LoopPointAnswer {
    /// Design frequency.
    frequency_rad_per_s: f64,
    /// Magnitude of the nominal loop.
    magnitude_db: f64,
    /// Phase of the nominal loop, greater than -360 and at most 0.
    phase_deg: f64,
    #[answer(flatten)]
    placement: PlacementAnswer,
}

/// Position of the nominal loop relative to its bounds.
#[derive(Answer)]
enum PlacementAnswer {
    Allowed {
        /// True if the bounds allow the nominal loop.
        allowed: bool,
        /// Distance to the nearest gain that the bounds forbid at this phase, `inf` if there is
        /// none; only of an allowed loop.
        slack_db: f64,
        /// Change to the nearest gain that the bounds allow at this phase, positive for more gain;
        /// zero if the loop is allowed.
        gain_change_db: OrReason<f64>,
    },
    Forbidden {
        /// False, since the bounds forbid the nominal loop.
        allowed: bool,
        /// Change to the nearest gain that the bounds allow at this phase.
        gain_change_db: OrReason<f64>,
    },
}

/// The elements, the margins and the loop.
pub(crate) fn body(view: &ProjectShaping) -> ShapeAnswer {
    let stability = &view.stability;
    let elements = view.elements.iter().enumerate();
    ShapeAnswer {
        shaped: view.shaped,
        changes: view.changes,
        elements: elements.map(|(index, element)| shaped_element(index, element)).collect(),
        stable: stable(stability),
        stability: ShapedStabilityAnswer {
            verdict: stability.verdict,
            plant: view.names.named(&stability.plant),
            reason: stability_reason(stability),
        },
        margins: view.margins.iter().filter_map(|margin| shaped_margin(view, margin)).collect(),
        points: view.points.iter().map(point).collect(),
        unreached_rad_per_s: view.unreached_rad_per_s.clone(),
        warnings: caveat::sentences(&view.problem.caveats, &view.problem.units),
    }
}

fn shaped_element(index: usize, element: &DeclaredElement) -> ShapedElementAnswer {
    ShapedElementAnswer {
        number: index + 1,
        kind: element.kind.clone(),
        enabled: element.enabled,
        element: element.print(),
    }
}

/// A margin; every one is of a specification of the problem.
fn shaped_margin(view: &ProjectShaping, margin: &DesignMargin) -> Option<ShapedMarginAnswer> {
    let DesignMargin { worst, placement } = margin;
    let specification = view.problem.specifications.get(worst.specification)?;
    Some(ShapedMarginAnswer {
        specification: worst.specification + 1,
        kind: SpecificationKind::ClosedLoop(specification.requirement.closed_loop()),
        margin: audit::margin(&view.names, worst),
        placement: self::placement(placement),
    })
}

fn point(point: &DesignPoint) -> LoopPointAnswer {
    let (magnitude_db, phase_deg) = polar(point.nominal_loop);
    LoopPointAnswer {
        frequency_rad_per_s: point.frequency_rad_per_s,
        magnitude_db,
        phase_deg,
        placement: placement(&point.placement),
    }
}

fn placement(placement: &Placement) -> PlacementAnswer {
    match placement {
        Placement::Allowed { slack_db } => {
            PlacementAnswer::Allowed { allowed: true, slack_db: *slack_db, gain_change_db: OrReason(Ok(0.0)) }
        }
        Placement::Forbidden { nearest_db, .. } => PlacementAnswer::Forbidden {
            allowed: false,
            gain_change_db: OrReason::new(*nearest_db, "no gain is allowed at this phase"),
        },
    }
}

fn kind(view: &ProjectShaping, specification: usize) -> &'static str {
    view.problem.specifications.get(specification).map_or("", |one| kind_key(&one.requirement))
}

/// Name of the project with the changed elements in it.
pub const SHAPED_PROJECT: &str = "shaped.toml";

/// The project file with the changed elements; then the margins as a table for other programs.
pub fn files(view: &ProjectShaping) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,margin_db,allowed");
    for margin in &view.margins {
        let DesignMargin { worst, placement } = margin;
        let number = number_cell(view.problem.number_of(worst.specification));
        let kind = kind(view, worst.specification);
        let allowed = matches!(placement, Placement::Allowed { .. });
        csv.row(&[&number, &kind, &worst.frequency_rad_per_s, &worst.margin_db, &allowed]);
    }
    vec![OutputFile::new(SHAPED_PROJECT, view.saved.clone()), OutputFile::new("margins.csv", csv.text())]
}
