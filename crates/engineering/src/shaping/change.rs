//! Changes, as requested in text.

use phea_dynamics::controller::{Compensator, Element as Solved, Stage};
use phea_qft::manual_shaping::{Edit, EditError, ElementPattern, apply, pass_through};

use super::ShapingError;
use super::element_request::{self, ElementRequest};
use super::piece::TextPiece;
use super::present;
use super::refused::{ChangeProblem, RefusedChange};
use super::workpiece::Workpiece;
use crate::project::{DeclaredElement, ElementKind, Findings, value_or_finding};
use crate::robust::RobustProblem;

/// Kind of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Adds `ELEMENT` at the end.
    Add,
    /// Removes element `N`.
    Remove,
    /// Replaces element `N`: `N=ELEMENT`.
    Replace,
    /// Enables element `N`.
    Enable,
    /// Disables element `N`.
    Disable,
    /// Moves element N to position M: `N=M`.
    Move,
    /// Solves for an element, added or in place of N: `[N=]KIND [with KEY VALUE] through POINT at
    /// FREQUENCY`.
    Pass,
}

impl Change {
    /// All kinds of changes.
    pub const ALL: [Change; 7] = [
        Change::Add,
        Change::Remove,
        Change::Replace,
        Change::Enable,
        Change::Disable,
        Change::Move,
        Change::Pass,
    ];

    /// Name of the command-line option.
    pub fn option(self) -> &'static str {
        match self {
            Change::Add => "add",
            Change::Remove => "remove",
            Change::Replace => "replace",
            Change::Enable => "enable",
            Change::Disable => "disable",
            Change::Move => "move",
            Change::Pass => "pass",
        }
    }
}

/// A requested change. Elements are counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RequestedChange {
    /// Kind of the change.
    pub change: Change,
    /// Details of the change, in text.
    pub text: String,
}

impl RequestedChange {
    /// Option with its text, as on the command line.
    pub fn option_with_text(&self) -> String {
        format!("--{} {}", self.change.option(), self.text)
    }
}

/// The requested edit.
///
/// # Errors
/// [`ShapingError`] for a change that cannot be made.
pub(super) fn edit(
    requested: &RequestedChange,
    workpiece: &mut Workpiece<'_>,
    now: &Compensator,
    bare: &RobustProblem,
) -> Result<Edit, ShapingError> {
    let whole = TextPiece::whole(requested);
    let count = now.stages.len();
    let stage = |piece: &TextPiece<'_>, workpiece: &mut Workpiece<'_>| {
        let declared = element(requested, piece, workpiece.sample_time())?;
        Ok::<_, ShapingError>(workpiece.know(declared)?)
    };
    Ok(match requested.change {
        Change::Add => Edit::Add { at: count, stage: stage(&whole, workpiece)? },
        Change::Remove => Edit::Remove(number(&whole, count)?),
        Change::Enable => Edit::Enable(number(&whole, count)?, true),
        Change::Disable => Edit::Enable(number(&whole, count)?, false),
        Change::Move => {
            let [from, to] = pair(&whole)?;
            Edit::Move { from: number(&from, count)?, to: number(&to, count)? }
        }
        Change::Replace => {
            let [place, new] = pair(&whole)?;
            let index = number(&place, count)?;
            Edit::Replace(index, stage(&new, workpiece)?.element)
        }
        Change::Pass => pass(&whole, &element_request::read(&whole)?, workpiece, now, bare)?,
    })
}

/// Error for a change that the list of elements does not permit.
pub(super) fn refused(requested: &RequestedChange, error: EditError) -> Box<RefusedChange> {
    TextPiece::whole(requested).refused(ChangeProblem::Edit(error))
}

/// Element of a request: in place of the one that it names, as a factor of the gain, or at the end.
fn pass(
    whole: &TextPiece<'_>,
    wish: &ElementRequest<'_>,
    workpiece: &mut Workpiece<'_>,
    now: &Compensator,
    bare: &RobustProblem,
) -> Result<Edit, ShapingError> {
    let replaced = wish.replaced.as_ref().map(|piece| number(piece, now.stages.len())).transpose()?;
    if replaced.and_then(|index| now.stages.get(index)).is_some_and(|stage| !stage.enabled) {
        return Err(whole.refused(ChangeProblem::Disabled).into());
    }
    let without = replaced.and_then(|index| apply(now, &Edit::Remove(index)).ok());
    let base = without.as_ref().unwrap_or(now);
    let present = present(workpiece, bare, base, wish.point.frequency_rad_per_s)?
        .ok_or_else(|| whole.refused(ChangeProblem::NotMeasured))?;
    let element = pass_through(wish.pattern, &wish.point, present, &workpiece.timing())
        .map_err(|error| whole.refused(ChangeProblem::Pass(error)))?;
    if let (ElementPattern::RollOff { damping_ratio }, Solved::ComplexPoles { natural_frequency, .. }) =
        (wish.pattern, &element)
    {
        let (frequency, damping_ratio) = (*natural_frequency, Some(damping_ratio));
        workpiece.know(DeclaredElement::new(ElementKind::RollOff { frequency, damping_ratio }))?;
    }
    Ok(match (replaced, wish.pattern, element) {
        (Some(index), _, element) => Edit::Replace(index, element),
        (None, ElementPattern::Gain, Solved::Gain(factor)) => Edit::ScaleGain(factor),
        (None, _, element) => Edit::Add { at: now.stages.len(), stage: Stage { element, enabled: true } },
    })
}

fn element(
    requested: &RequestedChange,
    piece: &TextPiece<'_>,
    sample_time: Option<f64>,
) -> Result<DeclaredElement, ShapingError> {
    if !piece.words.starts_with('{') {
        return Err(piece.refused(ChangeProblem::NotAnElement).into());
    }
    let mut findings = Findings::default();
    let text = findings.add_text(&requested.option_with_text(), requested.text.as_str(), 0);
    let node = value_or_finding(text, piece.range(), &mut findings);
    let declared = node.and_then(|node| DeclaredElement::read(&node, sample_time, &mut findings));
    declared.ok_or_else(|| ShapingError::Refused(findings.report()))
}

/// Two parts with an equals sign between them.
fn pair<'a>(piece: &TextPiece<'a>) -> Result<[TextPiece<'a>; 2], Box<RefusedChange>> {
    piece.split("=").ok_or_else(|| piece.refused(ChangeProblem::NoEqualsSign))
}

/// The number of an element, from 1, as an index.
fn number(piece: &TextPiece<'_>, count: usize) -> Result<usize, Box<RefusedChange>> {
    let written = piece.words.to_string();
    let Ok(number) = piece.words.parse::<usize>() else {
        return Err(piece.refused(ChangeProblem::NotANumberOfAnElement(written)));
    };
    match (1..=count).contains(&number) {
        true => Ok(number - 1),
        false => Err(piece.refused(ChangeProblem::NoElement { number: written, count })),
    }
}
