//! The criteria by which controllers are compared, in words.

use phea_engineering::design::AuditedController;
use phea_qft::verification::Verdict;

use crate::audit::{above_one_again, crossover_cell};
use crate::document::Cell;
use crate::quantity::DisplayUnit;
use crate::specification::numbered_cell;
use crate::verdict_words::verdict_words;

/// A criterion by which controllers are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ComparedBy {
    Verdict,
    /// The margin of a specification, by its index.
    Margin(usize),
    Order,
    HighFrequencyGain,
    Crossover,
    AboveOneAgain,
    GainMargin,
    PhaseMargin,
    ModulusMargin,
    DelayMargin,
}

/// A controller by one criterion.
pub(super) struct ComparedFigure {
    pub(super) by: ComparedBy,
    /// The name of the criterion.
    pub(super) name: Cell,
    pub(super) cell: Cell,
}

/// The criteria by which a controller is compared: verdicts first, then size, then margins. The
/// gain is in V per the unit of the controlled quantity, if the plant has units.
pub(super) fn compared(side: &AuditedController, per: Option<&str>) -> Vec<ComparedFigure> {
    let verdict = side.view.verdict();
    let cell = match verdict {
        Verdict::Met | Verdict::Violated => {
            Cell::from(verdict_words(verdict)).marked(verdict == Verdict::Met)
        }
        Verdict::NotProven => verdict_words(verdict).into(),
    };
    let mut rows = vec![ComparedFigure { by: ComparedBy::Verdict, name: "verdict".into(), cell }];
    rows.extend(side.view.audit.specifications.iter().enumerate().map(|(index, finding)| {
        let cell = finding.worst.as_ref().map(|worst| Cell::margin(worst.margin_db)).into();
        let name = Cell::from("margin of ").then(numbered_cell(side.view.named(index)));
        ComparedFigure { by: ComparedBy::Margin(index), name, cell }
    }));
    let named = |(by, name, cell): (ComparedBy, &str, Cell)| ComparedFigure { by, name: name.into(), cell };
    rows.extend(figures(side, per).map(named));
    rows
}

/// Size and margins of a controller.
fn figures(side: &AuditedController, per: Option<&str>) -> [(ComparedBy, &'static str, Cell); 8] {
    let figures = &side.figures;
    let nominal = figures.nominal.as_ref();
    [
        (
            ComparedBy::Order,
            "order of controller and prefilter",
            Cell::count(figures.order).then(" and ").then(Cell::count(figures.prefilter_order)),
        ),
        (ComparedBy::HighFrequencyGain, "high-frequency gain", high_frequency_gain(side, per)),
        (
            ComparedBy::Crossover,
            "crossover of the nominal loop",
            nominal.map(|margins| crossover_cell(&margins.crossovers)).into(),
        ),
        (
            ComparedBy::AboveOneAgain,
            "|L| of the nominal loop above 1 again",
            nominal.map(|margins| above_one_again(&margins.crossovers).unwrap_or("nowhere".into())).into(),
        ),
        (
            ComparedBy::GainMargin,
            "gain margin of the nominal loop",
            nominal.map(|margins| limited(margins.gain_margin_db, DisplayUnit::DECIBEL)).into(),
        ),
        (
            ComparedBy::PhaseMargin,
            "phase margin of the nominal loop",
            nominal.map(|margins| phase(side, margins.phase_margin_deg)).into(),
        ),
        (
            ComparedBy::ModulusMargin,
            "modulus margin of the family",
            figures.modulus_margin.map(|margin| Cell::number(margin, 3)).into(),
        ),
        (
            ComparedBy::DelayMargin,
            "delay margin of the family",
            figures.delay_margin_s.map(|delay| limited(delay, DisplayUnit::MILLISECOND)).into(),
        ),
    ]
}

fn high_frequency_gain(side: &AuditedController, per: Option<&str>) -> Cell {
    let gain = |degree: i64| gain_at_high_frequency(side.figures.high_frequency_gain_db, 5, degree, per);
    match side.is_in_z() {
        true => gain(0).then(", |G| at pi/T"),
        false if side.problem.compensation.sample_time_s().is_some() => {
            gain(side.figures.relative_degree).then(", of the continuous law")
        }
        false => gain(side.figures.relative_degree),
    }
}

/// `-20.6 dB re 1 V/(N s)`, the limit of s^r G for a controller of relative degree r, in dB of the
/// unit of that limit; `-20.6 dB, s G` for a plant without units.
pub(super) fn gain_at_high_frequency(
    gain_db: f64,
    digits: usize,
    relative_degree: i64,
    per: Option<&str>,
) -> Cell {
    let gain = Cell::quantity(gain_db, digits, DisplayUnit::DECIBEL);
    let Some(per) = per else {
        let of = match relative_degree {
            0 => String::new(),
            1 => ", s G".to_string(),
            degree => format!(", s^{degree} G"),
        };
        return gain.then(of);
    };
    let under = match relative_degree {
        0 if per.contains('.') => format!("({per})"),
        0 => per.to_string(),
        1 => format!("({per} s)"),
        degree => format!("({per} s^{degree})"),
    };
    // the reference is a part of the unit
    gain.then(" re ").then(Cell::unit(format!("1 V/{under}")))
}

/// The least change of phase that reaches -1; a stable loop with several crossovers may be nearest
/// to it in lead.
fn phase(side: &AuditedController, phase_deg: f64) -> Cell {
    match side.view.audit.stability.verdict {
        Verdict::Met if phase_deg < 0.0 => {
            Cell::magnitude(phase_deg, 3, DisplayUnit::IN_DEGREES).then(", of lead")
        }
        _ => limited(phase_deg, DisplayUnit::IN_DEGREES),
    }
}

/// A margin with its unit, which nothing may limit.
pub(super) fn limited(value: f64, unit: DisplayUnit) -> Cell {
    if value == f64::INFINITY { "unlimited".into() } else { Cell::quantity(value, 3, unit) }
}
