//! Bore from flow and oil velocity, Ledezma (2019), Figure 6.11, on logarithmic axes.
//!
//! ```text
//! v = 4 q / (pi d^2)
//! ```
//!
//! A bore is a straight line; the design flow is a vertical line; their intersection gives the
//! velocity in that bore.

use std::f64::consts::PI;

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, PointSide};
use super::scene::{Dash, Fill, Stroke};
use super::ticks::plain;
use super::{CandidateVerdict, Figure, Words};
use phea_quantity::DisplayUnit;

/// Commercial bore.
#[derive(Clone, Debug, PartialEq)]
pub struct NomographBore {
    /// Inner diameter, m.
    pub bore_m: f64,
    /// Additional name, such as the dash size; may be empty.
    pub label: String,
    /// Verdict of the procedure.
    pub verdict: CandidateVerdict,
}

/// Commercial bores over the flow, with the acceptable velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct Nomograph {
    /// Commercial bores.
    pub bores: Vec<NomographBore>,
    /// Largest flow of the system, m3/s.
    pub design_flow_m3_per_s: f64,
    /// Acceptable oil velocity, lowest and highest, m/s.
    pub velocity_range_m_per_s: (f64, f64),
}

/// Velocity in a bore.
fn velocity(flow_m3_per_s: f64, bore_m: f64) -> f64 {
    4.0 * flow_m3_per_s / (PI * bore_m * bore_m)
}

impl Nomograph {
    /// Draws the nomograph.
    pub fn draw(&self, words: &Words) -> Figure {
        let unit = DisplayUnit::LITRE_PER_MINUTE;
        let flow = unit.of(self.design_flow_m3_per_s);
        let (slowest, fastest) = self.velocity_range_m_per_s;
        let x = Axis::logarithmic(unit.title("Flow q"), flow / 5.0, flow * 2.2);
        let ends = [1.0, 2.2].into_iter().flat_map(|factor| {
            self.bores.iter().map(move |b| velocity(factor * self.design_flow_m3_per_s, b.bore_m))
        });
        let y = Axis::fit_logarithmic(
            "Oil velocity v (m/s)",
            ends.chain([slowest / 2.0, fastest * 2.0]).map(|v| v.max(slowest / 20.0).min(fastest * 10.0)),
        );
        let mut marks = vec![
            Mark::Band {
                direction: AxisDirection::Y,
                from: slowest,
                to: fastest,
                fill: Fill::tint(Role::Good),
                hatched: false,
                label: format!("{} to {} m/s", plain(slowest), plain(fastest)),
            },
            Mark::reference(
                AxisDirection::X,
                flow,
                Stroke::solid(Role::Accent, 1.8),
                format!("design flow {} L/min", plain(flow)),
            ),
        ];
        marks.extend(self.bores.iter().map(|bore| bore_line(bore, &x)));
        self.limits(&mut marks, &x);
        self.bore_markers(&mut marks, flow);
        marks.extend(self.bores.iter().map(|bore| bore_label(bore, &x)));
        let used = |verdict: &CandidateVerdict| self.bores.iter().any(|bore| bore.verdict == *verdict);
        let mut legend: Vec<LegendEntry> = CandidateVerdict::ALL
            .into_iter()
            .filter(used)
            .map(|verdict| LegendEntry::marker(format!("bore {}", verdict.label()), verdict.marker()))
            .collect();
        legend.push(LegendEntry::area("acceptable velocity", Fill::tint(Role::Good)));
        legend.push(LegendEntry::line("exact bores at its limits", limit_stroke()));
        let panels = vec![Panel::new(y, 340.0, marks)];
        words.with_plot(x, panels, legend)
    }

    /// Exact bores at which the velocity of the design flow is at the limits of the range, and the
    /// feasible part of the flow line.
    fn limits(&self, marks: &mut Vec<Mark>, x: &Axis) {
        let (slowest, fastest) = self.velocity_range_m_per_s;
        let flow = DisplayUnit::LITRE_PER_MINUTE.of(self.design_flow_m3_per_s);
        for limit in [slowest, fastest] {
            let bore = (4.0 * self.design_flow_m3_per_s / (PI * limit)).sqrt();
            marks.push(Mark::Line { points: line_of(bore, x), stroke: limit_stroke() });
            let text = format!("{} mm", plain(DisplayUnit::MILLIMETRE.of(bore)));
            marks.push(Mark::Label {
                at: vec![(flow, limit)],
                text,
                role: Role::Good,
                side: PointSide::Left,
            });
        }
        marks.push(Mark::Line {
            points: vec![(flow, slowest), (flow, fastest)],
            stroke: Stroke::solid(Role::Accent, 5.0),
        });
    }

    fn bore_markers(&self, marks: &mut Vec<Mark>, flow: f64) {
        for verdict in CandidateVerdict::ALL {
            let points: Vec<(f64, f64, String)> = self
                .bores
                .iter()
                .filter(|bore| bore.verdict == verdict)
                .map(|bore| {
                    let v = velocity(self.design_flow_m3_per_s, bore.bore_m);
                    let diameter = plain(DisplayUnit::MILLIMETRE.of(bore.bore_m));
                    (flow, v, format!("{diameter} mm: {} m/s, {}", plain(v), verdict.label()))
                })
                .collect();
            marks.push(Mark::Markers { points, style: verdict.marker() });
        }
    }
}

fn limit_stroke() -> Stroke {
    Stroke::solid(Role::Good, 1.3).dashed(Dash::Dashed)
}

/// Line of a bore over the whole axis.
fn line_of(bore_m: f64, x: &Axis) -> Vec<(f64, f64)> {
    let unit = DisplayUnit::LITRE_PER_MINUTE;
    [x.minimum, x.maximum].map(|flow| (flow, velocity(flow * unit.in_si, bore_m))).to_vec()
}

fn bore_line(bore: &NomographBore, x: &Axis) -> Mark {
    let stroke = match bore.verdict {
        CandidateVerdict::Accepted => Stroke::solid(Role::Good, 2.2),
        CandidateVerdict::Warned => Stroke::solid(Role::Axis, 1.6),
        CandidateVerdict::Rejected => Stroke::solid(Role::Muted, 1.0),
    };
    Mark::Line { points: line_of(bore.bore_m, x), stroke }
}

/// Name of the bore at the right end of its line.
fn bore_label(bore: &NomographBore, x: &Axis) -> Mark {
    let diameter = plain(DisplayUnit::MILLIMETRE.of(bore.bore_m));
    let text = match bore.label.as_str() {
        "" => format!("{diameter} mm"),
        label => format!("{diameter} mm ({label})"),
    };
    let role = match bore.verdict {
        CandidateVerdict::Rejected => Role::Muted,
        CandidateVerdict::Warned => Role::Text,
        CandidateVerdict::Accepted => Role::Good,
    };
    let flow_m3_per_s = x.maximum * DisplayUnit::LITRE_PER_MINUTE.in_si;
    Mark::EdgeLabel { at: velocity(flow_m3_per_s, bore.bore_m), text, role }
}
