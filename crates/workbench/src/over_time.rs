//! Charts over time: samples in SI, shown in the units of their panels.

use crate::document::capital;
use crate::figure::axis::extent;
use crate::figure::{Curve, CurveChart, CurvePanel, CurveRange, CurveStyle, DisplayUnit, SettlingBand};
use crate::quantity::{MotionKind, Units};

/// Time in s and value in SI, rising in time.
pub(crate) type Trace = Vec<(f64, f64)>;

/// Values at these times.
pub(crate) fn trace(times_s: &[f64], values: &[f64]) -> Trace {
    times_s.iter().copied().zip(values.iter().copied()).collect()
}

/// A panel of lines, each in the colour of its place.
pub(crate) fn panel(quantity: &str, unit: DisplayUnit, height: f64, lines: Vec<Trace>) -> CurvePanel {
    let lines = lines.into_iter().enumerate().map(|(place, line)| Curve::line(shown(line, unit), place));
    CurvePanel::new(unit.title(quantity), height, lines.collect())
}

/// The panel with a name for each of its lines, shown in the panel itself.
pub(crate) fn named<'n>(panel: CurvePanel, names: impl IntoIterator<Item = &'n str>) -> CurvePanel {
    let names = names.into_iter().enumerate();
    let named =
        names.filter(|(place, _)| panel.curves.get(*place).is_some_and(|curve| !curve.points.is_empty()));
    let named = named.map(|(place, name)| (name.to_string(), CurveStyle::Line(place))).collect();
    CurvePanel { named, ..panel }
}

/// The panel with further lines, drawn beneath those that it has.
pub(crate) fn with_lines_beneath(
    mut panel: CurvePanel,
    unit: DisplayUnit,
    style: CurveStyle,
    lines: impl IntoIterator<Item = Trace>,
) -> CurvePanel {
    let lines = lines.into_iter().map(|line| Curve { points: shown(line, unit).collect(), style });
    panel.curves.splice(0..0, lines.collect::<Vec<_>>());
    panel
}

fn shown(trace: Trace, unit: DisplayUnit) -> impl Iterator<Item = (f64, f64)> {
    trace.into_iter().map(move |(time, value)| (time, unit.of(value)))
}

/// True if a panel has a line of this style.
pub(crate) fn has(panel: &CurvePanel, style: CurveStyle) -> bool {
    panel.curves.iter().any(|curve| curve.style == style)
}

/// Panels on one time axis, with the names of the lines and with events; the words of the events
/// are in the tallest panel, which has most room next to the curves.
pub(crate) fn chart(
    mut panels: Vec<CurvePanel>,
    names: impl IntoIterator<Item = String>,
    events: &[(f64, String)],
    span_s: [f64; 2],
) -> CurveChart {
    let tallest = panels.iter().map(|panel| panel.height).fold(0.0, f64::max);
    let worded = panels.iter().position(|panel| panel.height == tallest);
    for (index, panel) in panels.iter_mut().enumerate() {
        let word = |word: &String| if Some(index) == worded { word.clone() } else { String::new() };
        panel.marked = events.iter().map(|(time_s, label)| (*time_s, word(label))).collect();
    }
    let named = names.into_iter().enumerate().map(|(place, name)| (name, CurveStyle::Line(place)));
    let further = [("reference", CurveStyle::Reference), ("required in time", CurveStyle::Limit)];
    let unnamed = |panel: &CurvePanel, style| has(panel, style) && panel.named.is_empty();
    let drawn = further.into_iter().filter(|(_, style)| panels.iter().any(|panel| unnamed(panel, *style)));
    let legend = named.chain(drawn.map(|(name, style)| (name.to_string(), style))).collect();
    CurveChart { x_title: "Time (s)".to_string(), x_range: span_s, panels, legend }
}

/// The measured force or torque with its symbol, for the labels of axes.
pub(crate) fn measured_force(motion: MotionKind) -> String {
    format!("{} {}", capital(motion.words().force), motion.symbols().measured)
}

/// Force after a step of the reference, and the command.
pub(crate) struct ForceStep<'a> {
    pub(crate) times_s: &'a [f64],
    /// Reference, N
    pub(crate) reference: &'a [f64],
    /// Force, N
    pub(crate) force: &'a [f64],
    /// Reference after the prefilter, N
    pub(crate) filtered_reference: &'a [f64],
    /// Command, V
    pub(crate) command: &'a [f64],
    /// The motion and the unit of forces.
    pub(crate) units: Units,
    /// Band in which the force has to settle, N.
    pub(crate) settling_band: Option<SettlingBand>,
    /// Settling time, s, with its words.
    pub(crate) settled: Option<(f64, String)>,
}

impl ForceStep<'_> {
    /// The chart of the step.
    pub(crate) fn chart(self) -> CurveChart {
        let of = |values: &[f64]| trace(self.times_s, values);
        let Units { motion, force: unit, .. } = self.units;
        let quantity = measured_force(motion);
        let forces = panel(&quantity, unit, 250.0, vec![of(self.force), of(self.filtered_reference)]);
        let level = |band: SettlingBand| SettlingBand { level: unit.of(band.level), ..band };
        let forces = CurvePanel {
            settling_band: self.settling_band.map(level),
            ..with_lines_beneath(forces, unit, CurveStyle::Reference, [of(self.reference)])
        };
        let command = CurvePanel {
            range: CurveRange::WithZero,
            ..panel("Control U_C", DisplayUnit::VOLT, 110.0, vec![of(self.command)])
        };
        let names = [motion.words().force, "prefiltered reference"].map(String::from);
        let events: Vec<(f64, String)> = self.settled.into_iter().collect();
        let (start, end) = extent(self.times_s.iter().copied());
        chart(vec![forces, command], names, &events, [start, end])
    }
}
