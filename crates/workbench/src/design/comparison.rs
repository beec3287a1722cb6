//! The criteria by which controllers are compared, in words.

use phea_engineering::design::AuditedController;
use phea_qft::verification::Verdict;

use crate::audit::{above_one_again_words, crossover_words};
use crate::document::Cell;
use crate::quantity::{DisplayUnit, significant};
use crate::specification::numbered;
use crate::verdict_words::{margin_words, verdict_words};

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
    pub(super) name: String,
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
    let mut rows = vec![ComparedFigure { by: ComparedBy::Verdict, name: "verdict".to_string(), cell }];
    rows.extend(side.view.audit.specifications.iter().enumerate().map(|(index, finding)| {
        let margin = finding.worst.as_ref().map_or("-".to_string(), |worst| margin_words(worst.margin_db));
        let name = format!("margin of {}", numbered(side.view.named(index)));
        ComparedFigure { by: ComparedBy::Margin(index), name, cell: margin.into() }
    }));
    let named = |(by, name, text): (ComparedBy, &str, String)| ComparedFigure {
        by,
        name: name.to_string(),
        cell: text.into(),
    };
    rows.extend(figures(side, per).map(named));
    rows
}

/// Size and margins of a controller.
fn figures(side: &AuditedController, per: Option<&str>) -> [(ComparedBy, &'static str, String); 8] {
    let figures = &side.figures;
    let nominal = figures.nominal.as_ref();
    let or_dash = |text: Option<String>| text.unwrap_or("-".to_string());
    [
        (
            ComparedBy::Order,
            "order of controller and prefilter",
            format!("{} and {}", figures.order, figures.prefilter_order),
        ),
        (ComparedBy::HighFrequencyGain, "high-frequency gain", high_frequency_words(side, per)),
        (
            ComparedBy::Crossover,
            "crossover of the nominal loop",
            or_dash(nominal.map(|margins| crossover_words(&margins.crossovers))),
        ),
        (
            ComparedBy::AboveOneAgain,
            "|L| of the nominal loop above 1 again",
            or_dash(
                nominal.map(|margins| {
                    above_one_again_words(&margins.crossovers).unwrap_or("nowhere".to_string())
                }),
            ),
        ),
        (
            ComparedBy::GainMargin,
            "gain margin of the nominal loop",
            or_dash(nominal.map(|margins| limited(margins.gain_margin_db, "dB"))),
        ),
        (
            ComparedBy::PhaseMargin,
            "phase margin of the nominal loop",
            or_dash(nominal.map(|margins| phase_words(side, margins.phase_margin_deg))),
        ),
        (
            ComparedBy::ModulusMargin,
            "modulus margin of the family",
            or_dash(figures.modulus_margin.map(|margin| significant(margin, 3))),
        ),
        (
            ComparedBy::DelayMargin,
            "delay margin of the family",
            or_dash(figures.delay_margin_s.map(|delay| limited(DisplayUnit::MILLISECOND.of(delay), "ms"))),
        ),
    ]
}

fn high_frequency_words(side: &AuditedController, per: Option<&str>) -> String {
    let gain = significant(side.figures.high_frequency_gain_db, 5);
    match side.is_in_z() {
        true => format!("{}, |G| at pi/T", gain_at_high_frequency(&gain, 0, per)),
        false if side.problem.compensation.sample_time_s().is_some() => {
            let gain = gain_at_high_frequency(&gain, side.figures.relative_degree, per);
            format!("{gain}, of the continuous law")
        }
        false => gain_at_high_frequency(&gain, side.figures.relative_degree, per),
    }
}

/// `-20.6 dB re 1 V/(N s)`, the limit of s^r G for a controller of relative degree r, in dB of the
/// unit of that limit; `-20.6 dB, s G` for a plant without units.
pub(super) fn gain_at_high_frequency(gain_db: &str, relative_degree: i64, per: Option<&str>) -> String {
    let Some(per) = per else {
        let of = match relative_degree {
            0 => String::new(),
            1 => ", s G".to_string(),
            degree => format!(", s^{degree} G"),
        };
        return format!("{gain_db} dB{of}");
    };
    let under = match relative_degree {
        0 if per.contains('.') => format!("({per})"),
        0 => per.to_string(),
        1 => format!("({per} s)"),
        degree => format!("({per} s^{degree})"),
    };
    format!("{gain_db} dB re 1 V/{under}")
}

/// The least change of phase that reaches -1; a stable loop with several crossovers may be nearest
/// to it in lead.
fn phase_words(side: &AuditedController, phase_deg: f64) -> String {
    match side.view.audit.stability.verdict {
        Verdict::Met if phase_deg < 0.0 => format!("{}, of lead", limited(-phase_deg, "deg")),
        _ => limited(phase_deg, "deg"),
    }
}

fn limited(value: f64, unit: &str) -> String {
    if value == f64::INFINITY { "unlimited".to_string() } else { format!("{} {unit}", significant(value, 3)) }
}
