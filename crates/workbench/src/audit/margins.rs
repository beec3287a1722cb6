//! Margins of the nominal loop, and the worst of the family, in words and in JSON.

use phea_engineering::audit::{Crossovers, LoopMargin, MarginSet, NominalMargins, ProjectAudit};
use phea_engineering::plant_names::{NamedPlant, PlantNames};
use phea_qft::verification::{Evidence, Remark};

use crate::answer::{Answer, OrReason};
use crate::document::{Cell, Table};
use crate::quantity::{DisplayUnit, significant};

/// Reason why the nominal loop has none.
pub(super) const NO_NOMINAL: &str = "no margin: the nominal loop is not known to be stable";
/// Reason why the family has none.
const NO_FAMILY: &str = "no margin: not every plant is known to be stable";
/// Reason why there is no frequency.
const UNLIMITED: &str = "nothing limits it";

/// Margins of the nominal loop and the worst of the family, which is also in front.
#[derive(Answer)]
pub(super) struct AuditMarginsAnswer {
    /// Worst factor by which the gain may grow; `inf` if nothing limits it.
    gain_db: OrReason<f64>,
    /// Worst factor to which the gain may fall, negative; `-inf` if it may vanish.
    gain_reduction_db: OrReason<f64>,
    /// Worst angle between L and -1 where |L| = 1: positive if a lag makes the loop unstable,
    /// negative if a lead does.
    phase_deg: OrReason<f64>,
    /// Least |1 + L|.
    modulus: OrReason<f64>,
    /// Least additional dead time that brings L to -1.
    delay_s: OrReason<f64>,
    /// Evidence for the worst of the family.
    evidence: Evidence,
    /// Number of examined plants.
    plants: usize,
    /// Margins of the nominal loop.
    nominal: OrReason<MarginSetAnswer>,
    /// Worst margins of the family, each with its place.
    family: OrReason<MarginSetAnswer>,
}

/// Margins of a loop, or the worst of each in a family.
#[derive(Answer)]
struct MarginSetAnswer {
    /// Factor by which the gain may grow; `inf` if nothing limits it.
    gain_db: f64,
    /// Factor to which the gain may fall, negative; `-inf` if it may vanish.
    gain_reduction_db: f64,
    /// Least angle between L and -1 where |L| = 1: positive if a lag makes the loop unstable,
    /// negative if a lead does.
    phase_deg: f64,
    /// Least |1 + L|.
    modulus: f64,
    /// Least additional dead time that brings L to -1.
    delay_s: f64,
    /// Place of each margin.
    at: MarginPlacesAnswer,
}

/// Places of margins.
#[derive(Answer)]
struct MarginPlacesAnswer {
    /// Place of the gain margin.
    gain_db: MarginPlaceAnswer,
    /// Place of the margin to a fall of the gain.
    gain_reduction_db: MarginPlaceAnswer,
    /// Place of the phase margin.
    phase_deg: MarginPlaceAnswer,
    /// Place of the modulus margin.
    modulus: MarginPlaceAnswer,
    /// Place of the delay margin.
    delay_s: MarginPlaceAnswer,
}

/// Frequency and plant of a margin.
#[derive(Answer)]
struct MarginPlaceAnswer {
    /// Frequency of the margin.
    frequency_rad_per_s: OrReason<f64>,
    /// Plant with the margin.
    plant: NamedPlant,
}

/// The worst of the family, and the same keys of both.
pub(super) fn answer(view: &ProjectAudit) -> AuditMarginsAnswer {
    let margins = &view.margins;
    let worst = |of: fn(&MarginSet) -> &LoopMargin| {
        OrReason::new(margins.family.as_ref().map(|set| of(set).value), NO_FAMILY)
    };
    let set = |set: Option<&MarginSet>| set.map(|set| set_answer(&view.names, set));
    AuditMarginsAnswer {
        gain_db: worst(|set| &set.gain_db),
        gain_reduction_db: worst(|set| &set.gain_reduction_db),
        phase_deg: worst(|set| &set.phase_deg),
        modulus: worst(|set| &set.modulus),
        delay_s: worst(|set| &set.delay_s),
        evidence: if is_measured(view) { Evidence::Grid } else { Evidence::Search },
        plants: margins.plants,
        nominal: OrReason::new(set(margins.nominal.as_ref()), NO_NOMINAL),
        family: OrReason::new(set(margins.family.as_ref()), NO_FAMILY),
    }
}

fn set_answer(names: &PlantNames, set: &MarginSet) -> MarginSetAnswer {
    let place = |margin: &LoopMargin| MarginPlaceAnswer {
        frequency_rad_per_s: OrReason::new(margin.frequency_rad_per_s, UNLIMITED),
        plant: names.named(&margin.plant),
    };
    MarginSetAnswer {
        gain_db: set.gain_db.value,
        gain_reduction_db: set.gain_reduction_db.value,
        phase_deg: set.phase_deg.value,
        modulus: set.modulus.value,
        delay_s: set.delay_s.value,
        at: MarginPlacesAnswer {
            gain_db: place(&set.gain_db),
            gain_reduction_db: place(&set.gain_reduction_db),
            phase_deg: place(&set.phase_deg),
            modulus: place(&set.modulus),
            delay_s: place(&set.delay_s),
        },
    }
}

/// A row for each margin; empty if there are none.
pub(super) fn table(view: &ProjectAudit) -> Table {
    let (nominal, family) = (view.margins.nominal.as_ref(), view.margins.family.as_ref());
    if nominal.is_none() && family.is_none() {
        return Table::default();
    }
    let mut rows = Table::new(["margin", "nominal loop", "at rad/s", "worst of the family", "at rad/s"]);
    for (words, of, unit) in rows_of() {
        let both = [nominal, family].map(|set| set.map(of));
        let unlimited = both.iter().flatten().all(|one| one.value == f64::NEG_INFINITY);
        if unlimited {
            continue;
        }
        let cells = both.map(|one| one.map_or([Cell::Missing, Cell::Missing], |one| cells(one, unit)));
        let [[value, at], [worst, place]] = cells;
        rows.row([words.into(), value, at, worst, place]);
    }
    rows
}

type PrintedMargin = (&'static str, fn(&MarginSet) -> &LoopMargin, DisplayUnit);

fn rows_of() -> [PrintedMargin; 5] {
    [
        ("gain may grow by", |set| &set.gain_db, DisplayUnit::DECIBEL),
        ("gain may fall by", |set| &set.gain_reduction_db, DisplayUnit::DECIBEL),
        ("phase", |set| &set.phase_deg, DisplayUnit::IN_DEGREES),
        ("modulus, least |1 + L|", |set| &set.modulus, DisplayUnit::ONE),
        ("delay", |set| &set.delay_s, DisplayUnit::MILLISECOND),
    ]
}

/// A margin and its frequency; a reduction of the gain is shown without its sign, a phase with its
/// side.
fn cells(margin: &LoopMargin, unit: DisplayUnit) -> [Cell; 2] {
    if margin.value.is_infinite() {
        return ["no limit".into(), Cell::Missing];
    }
    let mut value = Cell::magnitude(margin.value, 3, unit);
    if unit == DisplayUnit::IN_DEGREES {
        value = value.then(if margin.value < 0.0 { " of lead" } else { " of lag" });
    }
    [value, margin.frequency_rad_per_s.map_or(Cell::Missing, Cell::frequency)]
}

/// The plants among which the worst of the family was searched for; `None` if there is none.
pub(super) fn sentence(view: &ProjectAudit) -> Option<String> {
    view.margins.family.as_ref()?;
    let plants = view.margins.plants;
    if is_measured(view) {
        let discs = match has_discs(view) {
            true => {
                ": gain and phase those of the responses themselves, modulus and delay the worst within their discs"
            }
            false => "",
        };
        return Some(format!("The worst margins are those of the {plants} measured responses{discs}."));
    }
    // the search between plants without polynomials is too expensive
    let searched = if view.without_polynomials.is_some() { "" } else { ", and of a search from these" };
    (plants > 1).then(|| {
        format!(
            "The worst margins are those of {plants} plants: members and corners spread over the family, the worst of the audit{searched}."
        )
    })
}

/// True if the family is measured; then no plants between its responses are searched.
fn is_measured(view: &ProjectAudit) -> bool {
    matches!(view.names, PlantNames::Measured(_))
}

/// True if these responses are known within confidence discs.
fn has_discs(view: &ProjectAudit) -> bool {
    let mut remarks = view.audit.specifications.iter().flat_map(|finding| &finding.remarks);
    remarks.any(|remark| matches!(remark, Remark::WorstWithinDiscs | Remark::OpenWithinDiscs { .. }))
}

/// The decrease of the gain that the nominal loop tolerates, which a loop around an unstable plant
/// needs; `None` if the gain may vanish.
pub(super) fn reduction_sentence(margins: &NominalMargins) -> Option<String> {
    let db = margins.gain_reduction_db;
    db.is_finite().then(|| {
        format!(
            "the nominal loop needs its gain: it becomes unstable where that falls by {} dB",
            significant(-db, 3)
        )
    })
}

/// `40.9 rad/s`; `none` if |L| does not fall below 1.
pub(crate) fn crossover_cell(crossovers: &Crossovers) -> Cell {
    let first = crossovers.first_rad_per_s;
    first.map_or("none".into(), |rad_per_s| Cell::quantity(rad_per_s, 3, DisplayUnit::RADIAN_PER_SECOND))
}

/// The range in which |L| is above 1 again, in words; `None` if it remains below.
pub fn above_one_again_words(crossovers: &Crossovers) -> Option<String> {
    above_one_again(crossovers).map(|cell| cell.text())
}

/// `between 655 and 681 rad/s`, the range in which |L| is above 1 again; `None` if it remains
/// below.
pub(crate) fn above_one_again(crossovers: &Crossovers) -> Option<Cell> {
    let [low, high] = crossovers.again_rad_per_s?;
    let unit = DisplayUnit::RADIAN_PER_SECOND;
    Some(match high.is_infinite() {
        true => Cell::quantity(low, 3, unit).between("from ", " on"),
        false => Cell::number(low, 3).between("between ", " and ").then(Cell::quantity(high, 3, unit)),
    })
}
