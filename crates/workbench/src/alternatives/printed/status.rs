//! Outcomes of an alternative in a word or two, as the cells of tables have them.

use phea_engineering::alternatives::JudgedAlternative;
use phea_engineering::linearize::PortView;
use phea_qft::verification::Verdict;
use serde::{Deserialize, Serialize};

use crate::document::{Cell, StatusMark};
use crate::quantity::DisplayUnit;
use crate::verdict_words::agreement_word;

/// An outcome with its mark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MarkedOutcome {
    words: String,
    mark: Option<StatusMark>,
}

impl MarkedOutcome {
    /// The outcome in a cell.
    pub(crate) fn cell(&self) -> Cell {
        let words = Cell::from(self.words.as_str());
        match self.mark {
            Some(mark) => words.marked(mark),
            None => words,
        }
    }
}

/// Stability of every plant of the family, with the declared load, in the designed loop.
pub(super) fn stable(one: &JudgedAlternative) -> Option<MarkedOutcome> {
    let view = one.design.as_ref().ok()?;
    let (words, mark) = match view.designed.view.audit.stability.verdict {
        Verdict::Met => ("yes", Some(StatusMark::Good)),
        Verdict::Violated => ("no", Some(StatusMark::Bad)),
        Verdict::NotProven => ("not proven", None),
    };
    Some(MarkedOutcome { words: words.to_string(), mark })
}

/// Agreement of the machine with the verdict.
pub(super) fn machine(one: &JudgedAlternative) -> Option<MarkedOutcome> {
    let agreement = one.design.as_ref().ok()?.trial.as_ref()?.agreement();
    Some(MarkedOutcome { words: agreement_word(agreement).to_string(), mark: Some(agreement.into()) })
}

/// Passivity of the impedance at the load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum PassivityStatus {
    /// At all frequencies.
    Passive,
    /// Except in one band, by its ends, rad/s.
    NotIn([f64; 2]),
    /// Except in several bands, by their number.
    NotInBands(usize),
    /// At no frequency.
    Active,
}

impl PassivityStatus {
    /// The passivity in a cell.
    pub(crate) fn cell(self) -> Cell {
        match self {
            PassivityStatus::Passive => "yes".into(),
            PassivityStatus::NotIn([from, to]) => {
                let from = Cell::number_in(from, 3, DisplayUnit::HERTZ);
                from.between("not in ", " to ").then(Cell::quantity(to, 3, DisplayUnit::HERTZ))
            }
            PassivityStatus::NotInBands(bands) => Cell::count(bands).between("not in ", " bands"),
            PassivityStatus::Active => "no".into(),
        }
    }
}

/// Passivity of the impedance at the load of the open or of the closed loop.
pub(super) fn passive(one: &JudgedAlternative, closed: bool) -> Option<PassivityStatus> {
    let found = one.linearization.as_ref().ok()?;
    let designed = found.closed_loop.as_ref().filter(|_| one.deployed.is_ok());
    let view: Option<&PortView> = if closed { designed } else { Some(&found.open_loop) };
    let report = &view?.passivity;
    Some(match (report.passive, report.bands.first(), report.bands.len()) {
        (true, ..) => PassivityStatus::Passive,
        (false, Some(band), 1) => PassivityStatus::NotIn([band.from_rad_per_s, band.to_rad_per_s]),
        (false, None, _) => PassivityStatus::Active,
        (false, Some(_), bands) => PassivityStatus::NotInBands(bands),
    })
}
