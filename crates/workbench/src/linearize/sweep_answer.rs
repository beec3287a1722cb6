//! A sweep for people and for programs, and its figure.

use super::root_list;
use super::words::no_bandwidth_words;
use super::{Sweep, SweepPoint, Swept};
use crate::answer::{Csv, Object, OutputFile, significant};
use crate::caveat;
use crate::document::{Document, Table};
use crate::figure::{Figure, PoleSweep, PoleSweepPoint, Words};
use crate::quantity::{DisplayUnit, MotionKind, QuantityName, STIFFNESS};

/// The swept number, in the JSON of `linearize`.
pub(super) fn head(sweep: &Sweep) -> Object {
    Object::new()
        .with("key", sweep.path.as_str())
        .with("unit", sweep.si)
        .with("points", sweep.points.len())
        .with("spacing", if sweep.by_ratio { "log" } else { "linear" })
        .with("plant_follows", sweep.plant_follows)
}

/// The result at each value.
pub(super) fn rows(sweep: &Sweep) -> Vec<Object> {
    sweep.points.iter().map(|point| row(point, sweep.units.motion)).collect()
}

fn row(point: &SweepPoint, motion: MotionKind) -> Object {
    let found = point.found.as_ref().ok();
    let models = found.map(|found| &found.linearization);
    let stiffness = models.map(|models| {
        Object::new()
            .with(QuantityName::moving("minimum", &STIFFNESS), models.stiffness[0].minimum)
            .with(QuantityName::moving("maximum", &STIFFNESS), models.stiffness[0].maximum)
    });
    let poles = models.map(|models| {
        Object::new()
            .with("plant", models.plant.command.poles())
            .with("derived", models.derived_plant.poles())
    });
    let resonance = found.and_then(resonance).map(|[frequency, damping_ratio]| {
        Object::new().with("frequency_rad_per_s", frequency).with("damping_ratio", damping_ratio)
    });
    let passive = models.map(|models| {
        let closed_loop = models.closed_loop.as_ref().map(|view| view.passivity.passive);
        Object::new().with("open_loop", models.open_loop.passivity.passive).with("closed_loop", closed_loop)
    });
    Object::new()
        .with("value", point.value)
        .with("stiffness", stiffness)
        .with("poles", poles)
        .with("resonance", resonance)
        .with("bandwidth_rad_per_s", found.and_then(|found| found.bandwidth_rad_per_s.ok()))
        .maybe(
            "bandwidth_rad_per_s_reason",
            found
                .and_then(|found| found.bandwidth_rad_per_s.err())
                .map(|why| no_bandwidth_words(why, motion)),
        )
        .with("passive", passive)
        .maybe("reason", point.found.as_ref().err().map(ToString::to_string))
}

/// Frequency and damping ratio of the resonance.
fn resonance(found: &Swept) -> Option<[f64; 2]> {
    let pole = found.resonance?;
    let frequency = phea_dynamics::portable::magnitude(pole);
    Some([frequency, -pole.re / frequency])
}

/// The table of a sweep for people.
pub(crate) fn sweep_document(sweep: &Sweep) -> Document {
    let mut out = Document::default();
    out.warnings(caveat::sentences(&sweep.caveats, &sweep.units));
    if let Some(sentence) = unmoved(sweep) {
        out.line(format!("note: {sentence}"));
    }
    let key = match sweep.unit.symbol {
        "1" | "" => sweep.path.clone(),
        symbol => format!("{}, {symbol}", sweep.path),
    };
    let symbol = sweep.units.motion.symbols().stiffness;
    let stiffness = format!("{symbol} over the stroke, {}", stiffness_unit(sweep).symbol);
    let heads = [
        key.as_str(),
        stiffness.as_str(),
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
    out.table(lines);
    out.sentences([format!(
        "{symbol} is of the nominal wall; the bandwidth is that of the nominal loop with the given controller, to -3 dB."
    )]);
    let reasons = sweep.points.iter().filter_map(|point| Some((point.value, point.found.as_ref().err()?)));
    out.sentences(reasons.map(|(value, reason)| format!("{}: {reason}", sweep.unit.text(value, 4))));
    out
}

/// A remark on a key on which the plant does not depend.
fn unmoved(sweep: &Sweep) -> Option<String> {
    (!sweep.plant_follows).then(|| {
        format!(
            "the plant of every verdict does not follow `{}`, for the project states the parameters of its linear model; poles, resonance and bandwidth are those of the derived parameters",
            sweep.path
        )
    })
}

fn stiffness_unit(sweep: &Sweep) -> DisplayUnit {
    sweep.units.motion.unit(DisplayUnit::MEGANEWTON_PER_METRE)
}

fn cells(sweep: &Sweep, point: &SweepPoint) -> [String; 7] {
    let value = sweep.unit.number(point.value, 4);
    let Ok(found) = &point.found else {
        let [a, b, c, d, e, f] = ["-"; 6].map(String::from);
        return [value, a, b, c, d, e, f];
    };
    let stiffness = found.linearization.stiffness[0];
    let mega = |value: f64| stiffness_unit(sweep).number(value, 3);
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
        found.bandwidth_rad_per_s.map_or_else(
            |why| no_bandwidth_words(why, sweep.units.motion).to_string(),
            |bandwidth| significant(bandwidth, 4),
        ),
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
    let chart = PoleSweep {
        quantity: sweep.path.clone(),
        unit: sweep.unit,
        motion: sweep.units.motion,
        stiffness_unit: stiffness_unit(sweep),
        by_ratio: sweep.by_ratio,
        points: points.collect(),
    };
    chart.draw(&Words::new("sweep", format!("Poles over {}", sweep.path), caption))
}

/// Every pole at every value as a table for other programs.
pub(crate) fn sweep_files(sweep: &Sweep) -> Vec<OutputFile> {
    let mut csv = Csv::new("value,real_rad_per_s,imaginary_rad_per_s");
    for point in &sweep.points {
        for pole in point.found.iter().flat_map(|found| &found.poles) {
            csv.row(&[&point.value, &pole.re, &pole.im]);
        }
    }
    vec![OutputFile::new("sweep.csv", csv.text())]
}
