//! A sweep for people and for programs, and its figure.

use num_complex::Complex64;

use phea_engineering::linearize::{Sweep, SweepPoint, Swept};

use super::roots;
use super::words::no_bandwidth_words;
use crate::answer::{Answer, Csv, OutputFile, words};
use crate::caveat;
use crate::document::{Cell, Document, Table};
use crate::figure::{Figure, PoleSweep, PoleSweepPoint, Words};
use crate::quantity::{DisplayUnit, MotionKind, QuantityName, STIFFNESS};

/// Swept key of the project.
#[derive(Answer)]
pub(super) struct SweptKeyAnswer {
    /// Path of the key.
    key: String,
    /// Unit of the values.
    unit: &'static str,
    /// Number of values.
    points: usize,
    /// Spacing of the values.
    spacing: SweepSpacing,
    /// True if the plant of every verdict depends on the key; otherwise poles, resonance and
    /// bandwidth are those of the derived parameters.
    plant_follows: bool,
}

enum SweepSpacing {
    Log,
    Linear,
}

words! {
    /// Spacing of the values of a sweep: by ratio or by difference.
    SweepSpacing { Log => "log", Linear => "linear" }
}

/// Linear models at one value of the swept key; null where there are none.
#[derive(Answer)]
pub(super) struct SweptPointAnswer {
    /// Value of the swept key.
    value: f64,
    /// Hydraulic stiffness over the stroke, with the nominal wall of the lines.
    stiffness: Option<SweptStiffnessAnswer>,
    /// Poles from the command to the force.
    poles: Option<SweptPolesAnswer>,
    /// Resonance of the least damped pole; null if no pole has one.
    resonance: Option<SweptResonanceAnswer>,
    /// Frequency up to which the force of the nominal loop stays within 3 dB of its value towards
    /// zero frequency, with the given controller.
    bandwidth_rad_per_s: Option<f64>,
    /// Reason for which there is no bandwidth, only if there are linear models.
    #[answer(optional)]
    bandwidth_rad_per_s_reason: Option<&'static str>,
    /// Passivity of the driving-point impedance at the load.
    passive: Option<SweptPassivityAnswer>,
    /// Reason for which there are no linear models, only in that case.
    #[answer(optional)]
    reason: Option<String>,
}

/// Hydraulic stiffness over the stroke.
#[derive(Answer)]
struct SweptStiffnessAnswer {
    /// Least stiffness.
    #[answer(key = QuantityName::moving("minimum", &STIFFNESS))]
    minimum: f64,
    /// Greatest stiffness.
    #[answer(key = QuantityName::moving("maximum", &STIFFNESS))]
    maximum: f64,
}

/// Poles from the command to the force.
#[derive(Answer)]
struct SweptPolesAnswer {
    /// Plant of every verdict, with the parameters in use.
    plant: Vec<Complex64>,
    /// Plant with the derived parameters.
    derived: Vec<Complex64>,
}

/// Resonance of a pole.
#[derive(Answer)]
struct SweptResonanceAnswer {
    /// Magnitude of the pole.
    frequency_rad_per_s: f64,
    /// Damping ratio of the pole, negative if it is unstable.
    damping_ratio: f64,
}

/// Passivity of the driving-point impedance at the load.
#[derive(Answer)]
struct SweptPassivityAnswer {
    /// True if the impedance is passive with constant command.
    open_loop: bool,
    /// True if the impedance is passive with the given controller; null if it is not computed.
    closed_loop: Option<bool>,
}

/// The swept key, in the JSON of `linearize`.
pub(super) fn head(sweep: &Sweep) -> SweptKeyAnswer {
    SweptKeyAnswer {
        key: sweep.path.clone(),
        unit: sweep.si,
        points: sweep.points.len(),
        spacing: if sweep.by_ratio { SweepSpacing::Log } else { SweepSpacing::Linear },
        plant_follows: sweep.plant_follows,
    }
}

/// The results at each value.
pub(super) fn rows(sweep: &Sweep) -> Vec<SweptPointAnswer> {
    sweep.points.iter().map(|point| row(point, sweep.units.motion)).collect()
}

fn row(point: &SweepPoint, motion: MotionKind) -> SweptPointAnswer {
    let found = point.found.as_ref().ok();
    let models = found.map(|found| &found.linearization);
    let resonance = found.and_then(resonance);
    SweptPointAnswer {
        value: point.value,
        stiffness: models.map(|models| SweptStiffnessAnswer {
            minimum: models.stiffness[0].minimum,
            maximum: models.stiffness[0].maximum,
        }),
        poles: models.map(|models| SweptPolesAnswer {
            plant: models.plant.command.poles().to_vec(),
            derived: models.derived_plant.poles().to_vec(),
        }),
        resonance: resonance.map(|[frequency_rad_per_s, damping_ratio]| SweptResonanceAnswer {
            frequency_rad_per_s,
            damping_ratio,
        }),
        bandwidth_rad_per_s: found.and_then(|found| found.bandwidth_rad_per_s.ok()),
        bandwidth_rad_per_s_reason: found
            .and_then(|found| found.bandwidth_rad_per_s.err())
            .map(|why| no_bandwidth_words(why, motion)),
        passive: models.map(|models| SweptPassivityAnswer {
            open_loop: models.open_loop.passivity.passive,
            closed_loop: models.closed_loop.as_ref().map(|view| view.passivity.passive),
        }),
        reason: point.found.as_ref().err().map(ToString::to_string),
    }
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

fn cells(sweep: &Sweep, point: &SweepPoint) -> [Cell; 7] {
    let value = Cell::number_in(point.value, 4, sweep.unit);
    let Ok(found) = &point.found else {
        let [a, b, c, d, e, f] = [(); 6].map(|()| Cell::Missing);
        return [value, a, b, c, d, e, f];
    };
    let stiffness = found.linearization.stiffness[0];
    let mega = |value: f64| Cell::number_in(value, 3, stiffness_unit(sweep));
    let [frequency, damping] = match resonance(found) {
        Some([frequency, ratio]) => [Cell::number(frequency, 4), Cell::number(ratio, 3)],
        None => [Cell::Missing, Cell::Missing],
    };
    let yes = |passive: bool| if passive { "yes" } else { "no" };
    let open = yes(found.linearization.open_loop.passivity.passive);
    let closed = found.linearization.closed_loop.as_ref().map(|view| yes(view.passivity.passive));
    [
        value,
        mega(stiffness.minimum).then(" to ").then(mega(stiffness.maximum)),
        roots(&found.poles),
        frequency,
        damping,
        found.bandwidth_rad_per_s.map_or_else(
            |why| no_bandwidth_words(why, sweep.units.motion).into(),
            |bandwidth| Cell::number(bandwidth, 4),
        ),
        closed.map_or(open.into(), |closed| format!("{open}, closed loop {closed}").into()),
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
