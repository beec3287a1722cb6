//! What a sweep says to people and to programs, and its figure.

use serde::Serialize;

use super::root_list;
use super::{Sweep, SweepPoint, Swept};
use crate::answer::{Csv, OutputFile, significant};
use crate::document::Table;
use crate::figure::{Figure, PoleSweepInput, PoleSweepPoint, Words, pole_sweep};
use crate::quantity::DisplayUnit;

/// A value of the swept key in the JSON of `linearize`.
#[derive(Serialize)]
pub(super) struct SweepRow {
    /// SI.
    value: f64,
    stiffness: Option<SweptStiffness>,
    poles: Option<SweptPoles>,
    resonance: Option<SweptResonance>,
    bandwidth_rad_per_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bandwidth_rad_per_s_reason: Option<&'static str>,
    passive: Option<Passive>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Serialize)]
struct SweptStiffness {
    minimum_n_per_m: f64,
    maximum_n_per_m: f64,
}

#[derive(Serialize)]
struct SweptPoles {
    plant: Vec<[f64; 2]>,
    derived: Vec<[f64; 2]>,
}

#[derive(Serialize)]
struct SweptResonance {
    frequency_rad_per_s: f64,
    damping_ratio: f64,
}

#[derive(Serialize)]
struct Passive {
    open_loop: bool,
    closed_loop: Option<bool>,
}

/// What was swept, in the JSON of `linearize`.
#[derive(Serialize)]
pub(super) struct SweptRow<'a> {
    key: &'a str,
    unit: &'static str,
    points: usize,
    spacing: &'static str,
    plant_follows: bool,
}

pub(super) fn head(sweep: &Sweep) -> SweptRow<'_> {
    SweptRow {
        key: &sweep.path,
        unit: sweep.si,
        points: sweep.points.len(),
        spacing: if sweep.by_ratio { "log" } else { "linear" },
        plant_follows: sweep.plant_follows,
    }
}

pub(super) fn rows(sweep: &Sweep) -> Vec<SweepRow> {
    sweep.points.iter().map(row).collect()
}

fn row(point: &SweepPoint) -> SweepRow {
    let found = point.found.as_ref().ok();
    let pairs = |function: &phea_dynamics::linear::TransferFunction| {
        function.poles().iter().map(|pole| [pole.re, pole.im]).collect()
    };
    let models = found.map(|found| &found.linearization);
    SweepRow {
        value: point.value,
        stiffness: models.map(|models| SweptStiffness {
            minimum_n_per_m: models.stiffness[0].minimum,
            maximum_n_per_m: models.stiffness[0].maximum,
        }),
        poles: models.map(|models| SweptPoles {
            plant: pairs(&models.plant.command),
            derived: pairs(&models.derived_full.command),
        }),
        resonance: found.and_then(resonance).map(|[frequency_rad_per_s, damping_ratio]| SweptResonance {
            frequency_rad_per_s,
            damping_ratio,
        }),
        bandwidth_rad_per_s: found.and_then(|found| found.bandwidth_rad_per_s.ok()),
        bandwidth_rad_per_s_reason: found.and_then(|found| found.bandwidth_rad_per_s.err()),
        passive: models.map(|models| Passive {
            open_loop: models.open_loop.passivity.passive,
            closed_loop: models.closed_loop.as_ref().map(|view| view.passivity.passive),
        }),
        reason: point.found.as_ref().err().cloned(),
    }
}

/// Frequency and damping ratio of the resonance.
fn resonance(found: &Swept) -> Option<[f64; 2]> {
    let pole = found.resonance?;
    let frequency = phea_dynamics::portable::magnitude(pole);
    Some([frequency, -pole.re / frequency])
}

/// The table of a sweep for people.
pub(crate) fn sweep_text(sweep: &Sweep) -> String {
    let mut out = String::new();
    for caveat in &sweep.caveats {
        out.push_str(&format!("warning: {}\n", caveat.sentence));
    }
    if let Some(sentence) = unmoved(sweep) {
        out.push_str(&format!("note: {sentence}\n"));
    }
    let key = match sweep.unit.symbol {
        "1" | "" => sweep.path.clone(),
        symbol => format!("{}, {symbol}", sweep.path),
    };
    let heads = [
        key.as_str(),
        "K_H over the stroke, MN/m",
        "poles, rad/s",
        "resonance, rad/s",
        "damping",
        "bandwidth, rad/s",
        "passive",
    ];
    let mut lines = Table::new(heads);
    for point in &sweep.points {
        lines.row(cells(sweep, point));
    }
    out.push_str(&format!("{}\n", lines.text()));
    out.push_str("  K_H is of the nominal wall; the bandwidth is that of the nominal loop with the given controller, to -3 dB.\n");
    let reasons = sweep.points.iter().filter_map(|point| Some((point.value, point.found.as_ref().err()?)));
    for (value, reason) in reasons {
        out.push_str(&format!("  {}: {reason}\n", sweep.unit.text(value, 4)));
    }
    out
}

/// What a reader must know of a key that the plant does not follow.
fn unmoved(sweep: &Sweep) -> Option<String> {
    (!sweep.plant_follows).then(|| {
        format!(
            "the plant of every verdict does not follow `{}`, for the project states the parameters of its linear model; poles, resonance and bandwidth are those of the derived parameters",
            sweep.path
        )
    })
}

fn cells(sweep: &Sweep, point: &SweepPoint) -> [String; 7] {
    let value = sweep.unit.number(point.value, 4);
    let Ok(found) = &point.found else {
        let [a, b, c, d, e, f] = ["-"; 6].map(String::from);
        return [value, a, b, c, d, e, f];
    };
    let stiffness = found.linearization.stiffness[0];
    let mega = |value: f64| DisplayUnit::MEGANEWTON_PER_METRE.number(value, 3);
    let [frequency, damping] = resonance(found)
        .map_or(["-".to_string(), "-".to_string()], |[frequency, ratio]| {
            [significant(frequency, 4), significant(ratio, 3)]
        });
    let yes = |passive: bool| if passive { "yes" } else { "no" };
    let open = yes(found.linearization.open_loop.passivity.passive);
    let closed = found.linearization.closed_loop.as_ref().map(|view| yes(view.passivity.passive));
    [
        value,
        format!("{} to {}", mega(stiffness.minimum), mega(stiffness.maximum)),
        root_list(&found.poles),
        frequency,
        damping,
        found.bandwidth_rad_per_s.map_or_else(str::to_string, |bandwidth| significant(bandwidth, 4)),
        closed.map_or(open.to_string(), |closed| format!("{open}, closed loop {closed}")),
    ]
}

/// The poles over the swept key.
pub(crate) fn sweep_figure(sweep: &Sweep) -> Figure {
    let points = sweep.points.iter().filter_map(|point| {
        let found = point.found.as_ref().ok()?;
        let stiffness = found.linearization.stiffness[0];
        Some(PoleSweepPoint {
            value: point.value,
            poles: found.poles.clone(),
            stiffness_n_per_m: [stiffness.minimum, stiffness.maximum],
            bandwidth_rad_per_s: found.bandwidth_rad_per_s.ok(),
        })
    });
    let caption = format!(
        "Magnitude and damping ratio of each pole, the bandwidth of the loop with the given controller, and the stiffness over the stroke.{}",
        unmoved(sweep).map_or(String::new(), |sentence| format!(" Note: {sentence}."))
    );
    let input = PoleSweepInput {
        quantity: sweep.path.clone(),
        unit: sweep.unit,
        by_ratio: sweep.by_ratio,
        points: points.collect(),
    };
    pole_sweep(Words::new("sweep", format!("Poles over {}", sweep.path), caption), &input)
}

/// Every pole at every value as a table for other programs.
pub(crate) fn sweep_files(sweep: &Sweep) -> Vec<OutputFile> {
    let mut csv = Csv::new("value,real_rad_per_s,imaginary_rad_per_s");
    for point in &sweep.points {
        for pole in point.found.iter().flat_map(|found| &found.poles) {
            csv.row(&[&point.value, &pole.re, &pole.im]);
        }
    }
    vec![csv.file("sweep.csv")]
}
