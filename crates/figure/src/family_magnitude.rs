//! Closed-loop magnitude of a family and its limits, over frequency.

use phea_dynamics::portable::log10;

use super::axis::{Axis, extent};
use super::colour::{Role, series_role};
use super::legend::LegendEntry;
use super::open_loop::decibel_axis;
use super::plot::{AxisDirection, Mark, Marker, MarkerStyle, Panel};
use super::scene::{Dash, Fill, Stroke};
use super::{Figure, Words};

/// Magnitude over frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MagnitudeCurve {
    /// Frequencies, rad/s, rising.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Magnitude at each frequency, a plain ratio in SI units.
    pub magnitudes: Vec<f64>,
}

/// Annotated point: a violation, or the least margin.
#[derive(Clone, Debug, PartialEq)]
pub struct MagnitudeMark {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Magnitude of the closed loop at this point, in SI units.
    pub magnitude: f64,
    /// Text, such as `19.2 dB over at 1304 rad/s`.
    pub text: String,
    /// True if it violates the limit.
    pub is_violation: bool,
}

/// Extremes of a family within a loop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FamilyEnvelope {
    /// Name of the loop; empty if there is only one.
    pub name: String,
    /// Greatest magnitude of the family.
    pub greatest: MagnitudeCurve,
    /// Least magnitude, if there is a lower limit.
    pub least: Option<MagnitudeCurve>,
}

/// Magnitudes of a closed loop for the whole family, and their limits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FamilyMagnitude {
    /// Closed loop, such as `|L/(1+L)|`.
    pub quantity: String,
    /// Greatest allowed magnitude, over the band in which it applies.
    pub upper_limit: Option<MagnitudeCurve>,
    /// Least allowed magnitude.
    pub lower_limit: Option<MagnitudeCurve>,
    /// Family within the loop, and within others for comparison.
    pub envelopes: Vec<FamilyEnvelope>,
    /// Some members.
    pub members: Vec<MagnitudeCurve>,
    /// Marked frequencies, rad/s.
    pub design_frequencies_rad_per_s: Vec<f64>,
    /// Excess over a limit up to which it is not shown as violated, dB.
    pub tolerance_db: f64,
    /// Annotated points.
    pub marks: Vec<MagnitudeMark>,
}

/// Depth below limits and marks down to which a magnitude is shown, dB.
const DEPTH_DB: f64 = 30.0;

impl FamilyEnvelope {
    fn curves(&self) -> impl Iterator<Item = &MagnitudeCurve> {
        [&self.greatest].into_iter().chain(&self.least)
    }
}

impl FamilyMagnitude {
    /// Draws the figure.
    pub fn draw(&self, words: &Words) -> Figure {
        let x = Axis::fit_logarithmic("Frequency (rad/s)", self.frequencies());
        let y = self.magnitude_axis();
        let mut marks = self.areas();
        marks.extend(self.lines());
        let foot = y.minimum + 0.018 * (y.maximum - y.minimum);
        let designs =
            self.design_frequencies_rad_per_s.iter().map(|&frequency| (frequency, foot, String::new()));
        marks.push(Mark::Markers { points: designs.collect(), style: DESIGN });
        for mark in &self.marks {
            let (frequency, value) = (mark.frequency_rad_per_s, 20.0 * log10(mark.magnitude));
            let style = if mark.is_violation { VIOLATION } else { MARGIN };
            let points = vec![(frequency, value, mark.text.clone())];
            marks.push(Mark::Markers { points, style });
            let at = vec![(frequency, value)];
            marks.push(Mark::Callout { at, text: mark.text.clone(), role: style.role });
        }
        let panels = vec![Panel::new(y, 280.0, marks)];
        words.with_plot(x, panels, self.legend())
    }

    fn curves(&self) -> impl Iterator<Item = &MagnitudeCurve> {
        let limits = self.upper_limit.iter().chain(&self.lower_limit);
        limits.chain(self.envelopes.iter().flat_map(FamilyEnvelope::curves))
    }

    fn frequencies(&self) -> Vec<f64> {
        let curves = self.curves().flat_map(|curve| &curve.frequencies_rad_per_s);
        let marks = self.marks.iter().map(|mark| &mark.frequency_rad_per_s);
        curves.chain(marks).chain(&self.design_frequencies_rad_per_s).copied().collect()
    }

    /// Axis that covers limits and marks, the family above them, and no more than 30 dB of the
    /// family below them.
    fn magnitude_axis(&self) -> Axis {
        let finite = |value: &f64| value.is_finite();
        let of = |curve: &MagnitudeCurve| points(curve).into_iter().map(|point| point.1).filter(finite);
        let limits: Vec<f64> = self.upper_limit.iter().chain(&self.lower_limit).flat_map(of).collect();
        let marked = self.marks.iter().map(|mark| 20.0 * log10(mark.magnitude)).filter(finite);
        let wanted: Vec<f64> = limits.into_iter().chain(marked).collect();
        let (lowest, _) = extent(wanted.iter().copied());
        let family = self.envelopes.iter().flat_map(FamilyEnvelope::curves).flat_map(of);
        let family = family.filter(|value| lowest.is_nan() || *value > lowest - DEPTH_DB);
        decibel_axis(&format!("{} (dB)", self.quantity), wanted.iter().copied().chain(family))
    }

    /// Area between the greatest and least magnitude of the family, areas beyond a limit, and
    /// faintly their frequencies.
    fn areas(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (index, FamilyEnvelope { greatest, least, .. }) in self.behind_first() {
            let Some(least) = least else { continue };
            let around = points(greatest).into_iter().chain(points(least).into_iter().rev()).collect();
            let fill = Fill { role: series_role(index), opacity: 0.1 };
            marks.push(Mark::Area { corners: around, fill });
        }
        for corners in self.violated() {
            let (from, to) = extent(corners.iter().map(|corner| corner.0));
            marks.push(Mark::band(AxisDirection::X, [from, to], Fill { opacity: 0.09, ..EXCESS }));
            marks.push(Mark::Area { corners, fill: EXCESS });
        }
        marks
    }

    /// Envelopes with their indices, the first one last, which draws it on top.
    fn behind_first(&self) -> impl Iterator<Item = (usize, &FamilyEnvelope)> {
        let all = || self.envelopes.iter().enumerate();
        all().skip(1).chain(all().take(1))
    }

    /// Areas beyond a limit by more than the tolerance, for every loop.
    fn violated(&self) -> Vec<Vec<(f64, f64)>> {
        let moved = |curve: &MagnitudeCurve, by: f64| -> Vec<(f64, f64)> {
            points(curve).into_iter().map(|(frequency, value)| (frequency, value + by)).collect()
        };
        let upper = self.upper_limit.as_ref().map(|limit| moved(limit, self.tolerance_db));
        let lower = self.lower_limit.as_ref().map(|limit| moved(limit, -self.tolerance_db));
        let mut areas = Vec::new();
        for FamilyEnvelope { greatest, least, .. } in &self.envelopes {
            areas.extend(upper.iter().flat_map(|limit| excess(&points(greatest), limit)));
            areas.extend(lower.iter().zip(least).flat_map(|(limit, least)| excess(limit, &points(least))));
        }
        areas
    }

    fn lines(&self) -> Vec<Mark> {
        let line = |curve: &MagnitudeCurve, stroke: Stroke| Mark::Line { points: points(curve), stroke };
        let mut marks: Vec<Mark> = self.members.iter().map(|member| line(member, member_stroke())).collect();
        for (index, envelope) in self.behind_first() {
            let strokes = envelope_strokes(index);
            let both = envelope.curves().zip(strokes).map(|(curve, stroke)| line(curve, stroke));
            let mut both: Vec<Mark> = both.collect();
            // for another loop the greatest magnitude is on top
            if index > 0 {
                both.reverse();
            }
            marks.extend(both);
        }
        let upper = self.upper_limit.iter().map(|limit| points(limit).into_iter().rev().collect());
        let lower = self.lower_limit.iter().map(points);
        for limit in upper.chain(lower).collect::<Vec<Vec<(f64, f64)>>>() {
            let fringe = Stroke::solid(limit_stroke().role, 0.7);
            marks.push(Mark::Fringe { points: limit.clone(), stroke: fringe });
            marks.push(Mark::Line { points: limit, stroke: limit_stroke() });
        }
        marks
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let mut legend = Vec::new();
        let named = |name: &str, greatest: &str| {
            if name.is_empty() { greatest.to_string() } else { format!("{name}: {greatest}") }
        };
        for (index, FamilyEnvelope { name, least, .. }) in self.envelopes.iter().enumerate() {
            let [of_greatest, of_least] = envelope_strokes(index);
            let word = if least.is_some() || !name.is_empty() { "greatest" } else { "worst" };
            let word = if name.is_empty() { format!("{word} of the family") } else { word.to_string() };
            legend.push(LegendEntry::line(named(name, &word), of_greatest));
            if least.is_some() {
                legend.push(LegendEntry::line(named(name, "least"), of_least));
            }
        }
        if !self.members.is_empty() {
            legend.push(LegendEntry::line("members", member_stroke()));
        }
        match (&self.upper_limit, &self.lower_limit) {
            (None, None) => {}
            (Some(_), Some(_)) => legend.push(LegendEntry::line("limits", limit_stroke())),
            _ => legend.push(LegendEntry::line("limit", limit_stroke())),
        }
        if !self.design_frequencies_rad_per_s.is_empty() {
            legend.push(LegendEntry::marker("design frequency", DESIGN));
        }
        if !self.violated().is_empty() {
            legend.push(LegendEntry::area("violated", EXCESS));
        }
        legend
    }
}

const DESIGN: MarkerStyle = MarkerStyle { marker: Marker::Triangle, role: Role::Text, radius: 4.0 };
const VIOLATION: MarkerStyle = MarkerStyle { marker: Marker::Cross, role: Role::Bad, radius: 4.5 };
const MARGIN: MarkerStyle = MarkerStyle { marker: Marker::Circle, role: Role::Good, radius: 4.0 };
const EXCESS: Fill = Fill { role: Role::Bad, opacity: 0.28 };

fn limit_stroke() -> Stroke {
    Stroke::solid(Role::Bad, 1.8).dashed(Dash::LongDash)
}

fn member_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 0.5)
}

/// Strokes of the greatest and the least magnitude within a loop.
fn envelope_strokes(index: usize) -> [Stroke; 2] {
    let dashes = if index == 0 { [Dash::Solid, Dash::Dashed] } else { [Dash::DashDot, Dash::Dotted] };
    let stroke = |width: f64, dash: Dash| Stroke::solid(series_role(index), width).dashed(dash);
    [stroke(2.2, dashes[0]), stroke(2.0, dashes[1])]
}

/// Points (rad/s, dB).
fn points(curve: &MagnitudeCurve) -> Vec<(f64, f64)> {
    let values = curve.magnitudes.iter().map(|magnitude| 20.0 * log10(*magnitude));
    curve.frequencies_rad_per_s.iter().copied().zip(values).collect()
}

/// Areas in which the first curve is above the second, linear in dB over log frequency between
/// points.
pub(super) fn excess(above: &[(f64, f64)], below: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let mut frequencies: Vec<f64> = above.iter().chain(below).map(|point| point.0).collect();
    frequencies.retain(|frequency| frequency.is_finite() && *frequency > 0.0);
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup();
    let both: Vec<(f64, f64, f64)> = frequencies
        .into_iter()
        .filter_map(|frequency| Some((frequency, between(above, frequency)?, between(below, frequency)?)))
        .collect();
    let mut areas = Vec::new();
    let mut upper: Vec<(f64, f64)> = Vec::new();
    let mut lower: Vec<(f64, f64)> = Vec::new();
    let mut before: Option<(f64, f64, f64)> = None;
    for &(frequency, high, low) in &both {
        if let Some((earlier, high_before, low_before)) = before {
            let (depth_before, depth) = (high_before - low_before, high - low);
            if (depth_before > 0.0) != (depth > 0.0) {
                let part = depth_before / (depth_before - depth);
                let crossing = earlier * phea_dynamics::portable::pow(frequency / earlier, part);
                upper.push((crossing, high_before + part * (high - high_before)));
            }
        }
        if high > low {
            upper.push((frequency, high));
            lower.push((frequency, low));
        } else {
            areas.extend(closed(&mut upper, &mut lower));
        }
        before = Some((frequency, high, low));
    }
    areas.extend(closed(&mut upper, &mut lower));
    areas
}

/// Corners along the upper edge and back along the lower.
fn closed(upper: &mut Vec<(f64, f64)>, lower: &mut Vec<(f64, f64)>) -> Option<Vec<(f64, f64)>> {
    let mut around = std::mem::take(upper);
    around.extend(std::mem::take(lower).into_iter().rev());
    (around.len() > 2).then_some(around)
}

/// Value at a frequency; `None` outside the curve or next to a point without a value.
fn between(curve: &[(f64, f64)], frequency: f64) -> Option<f64> {
    let next = curve.partition_point(|point| point.0 < frequency);
    let &(high, above) = curve.get(next)?;
    let value = if high == frequency {
        above
    } else {
        let &(low, below) = curve.get(next.checked_sub(1)?)?;
        below + (above - below) * log10(frequency / low) / log10(high / low)
    };
    value.is_finite().then_some(value)
}
