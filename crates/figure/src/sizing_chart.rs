//! Length of the compliant line against stiffness and proportional gain: the two branches of the
//! sizing procedure at once.

use super::axis::Axis;
use super::colour::Role;
use super::legend::LegendEntry;
use super::plot::{AxisDirection, Mark, Panel, PointSide};
use super::scene::{Dash, Fill, Stroke};
use super::series::series_stroke;
use super::{CandidateVerdict, Figure, Words};
use phea_quantity::DisplayUnit;

/// Stiffness and gain over the length of one hose or pipe; the vectors have one value for each
/// length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SizingCurve {
    /// Name of hose and stiffness model.
    pub name: String,
    /// Lengths of one line, m, rising.
    pub lengths_m: Vec<f64>,
    /// Smallest hydraulic stiffness over the stroke, N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// Proportional gain that meets the time constant, V/N.
    pub gain_v_per_n: Vec<f64>,
}

/// Candidate on the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct SizingCandidate {
    /// Short name; may be empty.
    pub label: String,
    /// Length, m.
    pub length_m: f64,
    /// Stiffness, N/m.
    pub stiffness_n_per_m: f64,
    /// Gain, V/N.
    pub gain_v_per_n: f64,
    /// Verdict of the procedure.
    pub verdict: CandidateVerdict,
}

/// Stiffness and gain over the length, with the examined candidates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SizingChart {
    /// Curves.
    pub curves: Vec<SizingCurve>,
    /// Candidates.
    pub candidates: Vec<SizingCandidate>,
    /// Acceptable length of one line, m.
    pub length_range_m: Option<(f64, f64)>,
    /// Smallest acceptable proportional gain, V/N.
    pub minimum_gain_v_per_n: Option<f64>,
    /// Gain at which the requested stiffness becomes infinite, V/N.
    pub pole_gain_v_per_n: Option<f64>,
}

impl SizingChart {
    /// Draws the chart.
    pub fn draw(&self, words: &Words) -> Figure {
        let (stiffness, gain) = (DisplayUnit::MEGANEWTON_PER_METRE, DisplayUnit::MILLIVOLT_PER_NEWTON);
        let lengths = self.curves.iter().flat_map(|c| c.lengths_m.iter().copied());
        let x = Axis::fit_logarithmic(
            "Length of one line (m)",
            lengths.chain(self.candidates.iter().map(|c| c.length_m)),
        );
        let stiffnesses = self.curves.iter().flat_map(|c| c.stiffness_n_per_m.iter());
        let gains = self.curves.iter().flat_map(|c| c.gain_v_per_n.iter());
        let floors = self.minimum_gain_v_per_n.iter().chain(&self.pole_gain_v_per_n);
        let upper = Panel::new(
            Axis::fit_logarithmic(
                stiffness.title("K_H"),
                stiffnesses
                    .copied()
                    .chain(self.candidates.iter().map(|c| c.stiffness_n_per_m))
                    .map(|v| stiffness.of(v)),
            ),
            190.0,
            self.panel_marks(|c| &c.stiffness_n_per_m, |c| c.stiffness_n_per_m, stiffness, true),
        );
        let mut lower = Panel::new(
            Axis::fit_logarithmic(
                gain.title("K_p"),
                gains
                    .chain(floors)
                    .copied()
                    .chain(self.candidates.iter().map(|c| c.gain_v_per_n))
                    .map(|v| gain.of(v)),
            ),
            190.0,
            self.panel_marks(|c| &c.gain_v_per_n, |c| c.gain_v_per_n, gain, false),
        );
        self.gain_limits(&mut lower.marks);
        words.with_plot(x, vec![upper, lower], self.legend())
    }

    fn panel_marks(
        &self,
        curve_values: impl Fn(&SizingCurve) -> &Vec<f64>,
        candidate_value: impl Fn(&SizingCandidate) -> f64,
        unit: DisplayUnit,
        named: bool,
    ) -> Vec<Mark> {
        let mut marks = Vec::new();
        if let Some((from, to)) = self.length_range_m {
            marks.push(Mark::band(AxisDirection::X, [from, to], Fill::tint(Role::Good)));
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let values = curve_values(curve).iter().map(|v| unit.of(*v));
            let points = curve.lengths_m.iter().copied().zip(values).collect();
            marks.push(Mark::Line { points, stroke: series_stroke(index) });
        }
        for candidate in &self.candidates {
            let y = unit.of(candidate_value(candidate));
            let note = format!("{} ({})", candidate.label, candidate.verdict.label());
            let points = vec![(candidate.length_m, y, note)];
            marks.push(Mark::Markers { points, style: candidate.verdict.marker() });
        }
        for candidate in self.candidates.iter().filter(|c| named && !c.label.is_empty()) {
            let at = (candidate.length_m, unit.of(candidate_value(candidate)));
            let role = candidate.verdict.role();
            marks.push(Mark::Label {
                at: vec![at],
                text: candidate.label.clone(),
                role,
                side: PointSide::Above,
            });
        }
        marks
    }

    fn gain_limits(&self, marks: &mut Vec<Mark>) {
        let unit = DisplayUnit::MILLIVOLT_PER_NEWTON;
        if let Some(floor) = self.minimum_gain_v_per_n {
            let stroke = Stroke::solid(Role::Warning, 1.6).dashed(Dash::LongDash);
            marks.push(Mark::reference(AxisDirection::Y, unit.of(floor), stroke, "smallest gain"));
        }
        if let Some(pole) = self.pole_gain_v_per_n {
            let stroke = Stroke::solid(Role::Bad, 1.6).dashed(Dash::DashDot);
            marks.push(Mark::reference(AxisDirection::Y, unit.of(pole), stroke, "K_H infinite"));
        }
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let mut legend = LegendEntry::of_series(self.curves.iter().map(|curve| &curve.name));
        let used = |verdict: &CandidateVerdict| self.candidates.iter().any(|c| c.verdict == *verdict);
        let verdicts = CandidateVerdict::ALL.into_iter().filter(used);
        legend.extend(verdicts.map(|verdict| LegendEntry::marker(verdict.label(), verdict.marker())));
        if self.length_range_m.is_some() {
            legend.push(LegendEntry::area("acceptable length", Fill::tint(Role::Good)));
        }
        legend
    }
}
