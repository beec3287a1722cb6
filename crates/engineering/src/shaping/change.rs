//! Changes as they are requested in text.

use phea_dynamics::controller::{Compensator, Element as Solved, Stage};
use phea_qft::manual_shaping::{Edit, EditError, ElementPattern, apply, pass_through};

use super::ShapingError;
use super::piece::TextPiece;
use super::present;
use super::wish::{self, ElementWish};
use super::words::pass_words;
use super::workpiece::Workpiece;
use crate::project::{DeclaredElement, ElementKind, Findings, RawFinding, Refusal, value_or_finding};
use crate::robust::RobustProblem;

/// What is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// `ELEMENT`, at the end.
    Add,
    /// `N`
    Remove,
    /// `N=ELEMENT`
    Replace,
    /// `N`
    Enable,
    /// `N`
    Disable,
    /// `N=M`: element N to position M.
    Move,
    /// `[N=]KIND [with KEY VALUE] through POINT at FREQUENCY`: an element solved for, added or in
    /// place of N.
    Pass,
}

impl Change {
    /// Every change there is.
    pub const ALL: [Change; 7] = [
        Change::Add,
        Change::Remove,
        Change::Replace,
        Change::Enable,
        Change::Disable,
        Change::Move,
        Change::Pass,
    ];

    /// The option of the command line.
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
    /// What is changed.
    pub change: Change,
    /// How, in text.
    pub text: String,
}

/// An example of an element, for a message where none was written.
const ELEMENT_HELP: &str =
    "an element is an inline table: { kind = \"lead\", zero_frequency = 5, pole_frequency = 50 }";

/// The requested edit; `None` where it is impossible, with the reason in the findings.
pub(super) fn edit(
    requested: &RequestedChange,
    workpiece: &mut Workpiece<'_>,
    now: &Compensator,
    bare: &RobustProblem,
    findings: &mut Findings,
) -> Result<Option<Edit>, ShapingError> {
    let whole = taken_in(requested, findings);
    let count = now.stages.len();
    let stage = |piece: &TextPiece<'_>, workpiece: &mut Workpiece<'_>, findings: &mut Findings| {
        let declared = element(piece, workpiece.sample_time(), findings);
        declared.map(|declared| workpiece.know(declared)).transpose()
    };
    Ok(match requested.change {
        Change::Add => stage(&whole, workpiece, findings)?.map(|stage| Edit::Add { at: count, stage }),
        Change::Remove => number(&whole, count, findings).map(Edit::Remove),
        Change::Enable => number(&whole, count, findings).map(|index| Edit::Enable(index, true)),
        Change::Disable => number(&whole, count, findings).map(|index| Edit::Enable(index, false)),
        Change::Move => pair(&whole, "3=1", findings).and_then(|[from, to]| {
            Some(Edit::Move { from: number(&from, count, findings)?, to: number(&to, count, findings)? })
        }),
        Change::Replace => {
            let Some([place, new]) = pair(&whole, "2={ kind = \"integrator\" }", findings) else {
                return Ok(None);
            };
            let Some(index) = number(&place, count, findings) else { return Ok(None) };
            stage(&new, workpiece, findings)?.map(|stage| Edit::Replace(index, stage.element))
        }
        Change::Pass => match wish::read(&whole, findings) {
            Some(wish) => pass(&whole, &wish, workpiece, now, bare, findings)?,
            None => None,
        },
    })
}

/// The findings for a change that the list of elements does not allow.
pub(super) fn refused(requested: &RequestedChange, error: &EditError) -> Refusal {
    let mut findings = Findings::default();
    let whole = taken_in(requested, &mut findings);
    findings.push(RawFinding::error(whole.place(), error.to_string()));
    findings.report()
}

fn taken_in<'a>(requested: &'a RequestedChange, findings: &mut Findings) -> TextPiece<'a> {
    let RequestedChange { change, text } = requested;
    let index = findings.add_text(&format!("--{} {text}", change.option()), text, 0);
    TextPiece::whole(text, index)
}

/// The element of a request: in place of the one that it names, as a factor of the gain, or at the
/// end.
fn pass(
    whole: &TextPiece<'_>,
    wish: &ElementWish<'_>,
    workpiece: &mut Workpiece<'_>,
    now: &Compensator,
    bare: &RobustProblem,
    findings: &mut Findings,
) -> Result<Option<Edit>, ShapingError> {
    let replaced = match &wish.replaced {
        None => None,
        Some(piece) => match number(piece, now.stages.len(), findings) {
            None => return Ok(None),
            found => found,
        },
    };
    if replaced.and_then(|index| now.stages.get(index)).is_some_and(|stage| !stage.enabled) {
        return Ok(whole.refuse(findings, "this element is disabled", "enable it before it is solved for"));
    }
    let without = replaced.and_then(|index| apply(now, &Edit::Remove(index)).ok());
    let base = without.as_ref().unwrap_or(now);
    let Some(present) = present(workpiece, bare, base, wish.point.frequency_rad_per_s)? else {
        return Ok(whole.refuse(
            findings,
            "the nominal plant was not measured there",
            "choose another frequency",
        ));
    };
    let element = match pass_through(wish.pattern, &wish.point, present, &workpiece.timing()) {
        Ok(element) => element,
        Err(error) => {
            findings.push(RawFinding::error(whole.place(), pass_words(&error)));
            return Ok(None);
        }
    };
    if let (ElementPattern::RollOff { damping_ratio }, Solved::ComplexPoles { natural_frequency, .. }) =
        (wish.pattern, &element)
    {
        let (frequency, damping_ratio) = (*natural_frequency, Some(damping_ratio));
        workpiece.know(DeclaredElement::new(ElementKind::RollOff { frequency, damping_ratio }))?;
    }
    Ok(Some(match (replaced, wish.pattern, element) {
        (Some(index), _, element) => Edit::Replace(index, element),
        (None, ElementPattern::Gain, Solved::Gain(factor)) => Edit::ScaleGain(factor),
        (None, _, element) => Edit::Add { at: now.stages.len(), stage: Stage { element, enabled: true } },
    }))
}

fn element(
    piece: &TextPiece<'_>,
    sample_time: Option<f64>,
    findings: &mut Findings,
) -> Option<DeclaredElement> {
    if !piece.words.starts_with('{') {
        return piece.refuse(findings, "this is not an element", ELEMENT_HELP);
    }
    let node = value_or_finding(piece.text(), piece.range(), findings)?;
    DeclaredElement::read(&node, sample_time, findings)
}

/// Two parts with an equals sign between them.
fn pair<'a>(piece: &TextPiece<'a>, example: &str, findings: &mut Findings) -> Option<[TextPiece<'a>; 2]> {
    piece
        .split("=")
        .or_else(|| piece.refuse(findings, "there is no `=` in it", &format!("for instance {example}")))
}

/// The number of an element, from 1, as an index.
fn number(piece: &TextPiece<'_>, count: usize, findings: &mut Findings) -> Option<usize> {
    let message = format!("there is no element `{}`", piece.words);
    let Ok(number) = piece.words.parse::<usize>() else {
        return piece.refuse(findings, message, "elements are counted from 1");
    };
    if (1..=count).contains(&number) {
        return Some(number - 1);
    }
    let there = match count {
        0 => "there are no elements yet".to_string(),
        1 => "there is one element".to_string(),
        _ => format!("there are elements 1 to {count}"),
    };
    piece.refuse(findings, message, &there)
}
