//! Parts of a Nichols chart in position: axes, marks, labels, legend.

use std::ops::RangeInclusive;

use phea_qft::bound::Bound;

use super::super::axis::{Axis, extent};
use super::super::bode::decibel;
use super::super::colour::{Role, ramp_role, series_role};
use super::super::legend::LegendEntry;
use super::super::open_loop::{UnwrappedResponse, decibel_axis, phase_near};
use super::super::plot::{Mark, Marker, MarkerStyle, PointSide};
use super::super::scene::{Dash, Stroke};
use super::super::series::{series_dash, series_marker};
use super::super::templates::PlacedTemplate;
use super::super::ticks::{TickSteps, decimal, plain};
use super::{Boundary, NicholsChart, OpenLoopViolation, boundaries, magnitude_contour};

/// Phases that every chart shows, degrees.
const PHASES: [f64; 2] = [-270.0, 0.0];
/// Magnitude below which a loop is far from the critical points at any phase, dB.
const FAR_BELOW_DB: f64 = -12.0;
/// Magnitudes of the points that may widen the phase axis beyond a whole turn, dB: outside this
/// range the phase of a loop is irrelevant.
const NEAR_DB: RangeInclusive<f64> = -30.0..=30.0;
/// Largest number of turns that a phase axis shows on either side of -360 to 0 degrees.
const TURNS: i32 = 2;

/// Chart in position: axes, curves, and the colour of each frequency.
pub(super) struct PlacedChart<'a> {
    chart: &'a NicholsChart<'a>,
    frequencies: Vec<f64>,
    loops: Vec<UnwrappedResponse>,
    marks: Vec<LoopMark>,
    violations: Vec<(f64, f64)>,
    templates: Vec<PlacedTemplate>,
    /// Edges between -360 and 0 degrees for each group and each of its bounds.
    boundaries: Vec<Vec<Vec<Boundary>>>,
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl<'a> PlacedChart<'a> {
    pub(super) fn new(chart: &'a NicholsChart<'a>) -> PlacedChart<'a> {
        let frequencies = frequencies(chart);
        let loops: Vec<UnwrappedResponse> = chart.loops.iter().map(UnwrappedResponse::new).collect();
        let nominal = loops.first();
        let on_loop = |frequency: f64| nominal.and_then(|nominal| nominal.at(frequency));
        let marks = loop_marks(&loops, &chart.design_frequencies_rad_per_s);
        let violations = chart
            .violations
            .iter()
            .map(|violation| (phase_on_nearest(&loops, violation), decibel(violation.open_loop)));
        let violations: Vec<(f64, f64)> = violations.collect();
        let templates = chart.templates.iter().filter_map(|template| {
            let place = on_loop(template.frequency_rad_per_s)?;
            Some(PlacedTemplate::new(template, place, role(&frequencies, template.frequency_rad_per_s)))
        });
        let templates: Vec<PlacedTemplate> = templates.collect();
        let boundaries: Vec<Vec<Vec<Boundary>>> =
            chart.bounds.iter().map(|group| group.bounds.iter().map(boundaries).collect()).collect();
        let mut placed = PlacedChart {
            chart,
            frequencies,
            loops,
            marks,
            violations,
            templates,
            boundaries,
            x: Axis::linear("Open-loop phase (°)", PHASES[0], PHASES[1]),
            y: Axis::linear("Open-loop magnitude (dB)", -20.0, 20.0),
        };
        placed.y = placed.magnitude_axis();
        placed.x = placed.phase_axis();
        placed
    }

    /// All marks within the frame from back to front; labels in order of priority.
    pub(super) fn all_marks(&self) -> Vec<Mark> {
        let mut marks = self.contours();
        marks.extend(self.templates.iter().flat_map(PlacedTemplate::marks));
        marks.extend(self.bounds());
        marks.extend(self.loops());
        marks.extend(self.critical_points());
        marks.extend(self.violations());
        marks.extend(self.frequency_labels());
        marks.extend(self.bound_labels());
        marks.extend(self.contour_labels());
        marks
    }

    /// Magnitude axis that covers marks, templates and violations, and the parts of bounds between
    /// -60 and 80 dB; also of loops without marks.
    fn magnitude_axis(&self) -> Axis {
        let marked = self
            .marks
            .iter()
            .map(|mark| mark.magnitude_db)
            .chain(self.violations.iter().map(|place| place.1));
        let filled = self.templates.iter().flat_map(|template| template.extent().map(|place| place.1));
        let edges = self.boundaries.iter().flatten().flatten().flat_map(|edge| &edge.points);
        let unmarked = self.loops.iter().filter(|_| self.marks.is_empty()).flat_map(|one| &one.points);
        let near = edges.chain(unmarked).map(|point| point.1).filter(|value| (-60.0..=80.0).contains(value));
        decibel_axis(&self.y.title, marked.chain(filled).chain(near).chain([-20.0, 20.0]))
    }

    /// Phase axis from -270 to 0 degrees, extended by quarter turns if a loop near 0 dB, or a
    /// visible violation, requires it; a mark or a template far from 0 dB extends it to -360
    /// degrees at most.
    fn phase_axis(&self) -> Axis {
        let loops = self.loops.iter().flat_map(|one| one.points.iter().copied());
        let loops = loops.filter(|point| (FAR_BELOW_DB..=*NEAR_DB.end()).contains(&point.1));
        let marked = self.marks.iter().map(|mark| (mark.phase_deg, mark.magnitude_db));
        let filled = self.templates.iter().flat_map(PlacedTemplate::extent);
        let in_turn = |(phase, magnitude): (f64, f64)| match NEAR_DB.contains(&magnitude) {
            true => (phase, magnitude),
            false => (phase.clamp(-360.0, 0.0), magnitude),
        };
        let all = loops.chain(marked.chain(filled).map(in_turn)).chain(self.violations.iter().copied());
        let seen = all.filter(|point| (self.y.minimum..=self.y.maximum).contains(&point.1));
        let (low, high) = extent(seen.map(|point| point.0).chain(PHASES));
        let most = 360.0 * f64::from(TURNS);
        let low = (90.0 * (low / 90.0).floor()).max(-360.0 - most);
        let high = (90.0 * (high / 90.0).ceil()).min(most);
        let steps = if high - low > 450.0 { TickSteps::Every(90) } else { TickSteps::Every(45) };
        Axis { steps, ..Axis::linear(self.x.title.clone(), low, high) }
    }

    /// Shifts by whole turns that bring points between -360 and 0 degrees into the range of the
    /// axis.
    fn turns(&self) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = (self.x.minimum, self.x.maximum);
        (-TURNS..=TURNS)
            .map(|turn| 360.0 * f64::from(turn))
            .filter(move |shift| shift - 360.0 < high && *shift > low)
    }

    fn contours(&self) -> Vec<Mark> {
        let contours = self.chart.contours_db.iter().map(|contour| magnitude_contour(*contour));
        let contours: Vec<Vec<(f64, f64)>> = contours.collect();
        self.turns()
            .flat_map(|shift| {
                contours.iter().map(move |contour| Mark::Line {
                    points: shifted(contour, shift),
                    stroke: contour_stroke(),
                })
            })
            .collect()
    }

    fn bounds(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (group, index, edge) in self.edges() {
            let Some(bound) = self.bound(group, index) else { continue };
            let stroke = self.bound_stroke(group, bound);
            for shift in self.turns() {
                let points = shifted(&edge.points, shift);
                let fringe = Stroke::solid(stroke.role, 0.7);
                marks.push(Mark::Fringe { points: points.clone(), stroke: fringe });
                marks.push(Mark::Line { points, stroke });
            }
        }
        marks
    }

    /// All edges with the index of their group and of their bound.
    fn edges(&self) -> impl Iterator<Item = (usize, usize, &Boundary)> {
        self.boundaries.iter().enumerate().flat_map(|(group, bounds)| {
            bounds
                .iter()
                .enumerate()
                .flat_map(move |(index, edges)| edges.iter().map(move |edge| (group, index, edge)))
        })
    }

    fn bound(&self, group: usize, index: usize) -> Option<&Bound> {
        self.chart.bounds.get(group)?.bounds.get(index)
    }

    /// Stroke of a bound: colour by frequency; dash pattern by group, or by frequency if there is
    /// one group.
    fn bound_stroke(&self, group: usize, bound: &Bound) -> Stroke {
        let role = role(&self.frequencies, bound.frequency_rad_per_s);
        let dash = match (self.chart.bounds.len(), role) {
            (1, Role::Ramp(step)) => series_dash(usize::from(step)),
            _ => series_dash(group),
        };
        Stroke::solid(role, 1.8).dashed(dash)
    }

    fn loops(&self) -> Vec<Mark> {
        let lines = self
            .loops
            .iter()
            .enumerate()
            .map(|(index, one)| Mark::Line { points: one.points.clone(), stroke: self.loop_stroke(index) });
        let marks = self.marks.iter().map(|mark| {
            let (frequency, phase, magnitude) = (mark.frequency, mark.phase_deg, mark.magnitude_db);
            let note = format!("{} rad/s: {}°, {} dB", plain(frequency), plain(phase), plain(magnitude));
            let style =
                MarkerStyle { role: role(&self.frequencies, frequency), ..loop_marker(mark.loop_index) };
            Mark::Markers { points: vec![(phase, magnitude, note)], style }
        });
        lines.chain(marks).collect()
    }

    fn critical_points(&self) -> Vec<Mark> {
        let note = "critical point −1".to_string();
        self.turns()
            .map(|shift| Mark::Markers {
                points: vec![(shift - 180.0, 0.0, note.clone())],
                style: CRITICAL_POINT,
            })
            .collect()
    }

    fn violations(&self) -> Vec<Mark> {
        let texts = self.chart.violations.iter().map(|violation| &violation.text);
        texts
            .zip(&self.violations)
            .flat_map(|(text, &(phase, magnitude))| {
                let at = vec![(phase, magnitude)];
                let label = Mark::Callout { at, text: text.clone(), role: Role::Bad };
                [Mark::Markers { points: vec![(phase, magnitude, text.clone())], style: VIOLATION }, label]
            })
            .collect()
    }

    /// Frequency labels on the first loop; on the others the colour shows the frequency.
    fn frequency_labels(&self) -> Vec<Mark> {
        self.marks
            .iter()
            .filter(|mark| mark.loop_index == 0)
            .map(|mark| Mark::Callout {
                at: vec![(mark.phase_deg, mark.magnitude_db)],
                text: format!("{} rad/s", plain(mark.frequency)),
                role: Role::Text,
            })
            .collect()
    }

    /// Stroke of a loop: a single loop has the text colour; several are distinguished by colour and
    /// dash pattern.
    fn loop_stroke(&self, index: usize) -> Stroke {
        let role = if self.loops.len() > 1 { series_role(index) } else { Role::Text };
        Stroke::solid(role, 2.4).dashed(series_dash(index))
    }

    /// Frequency label on the longest edge of each bound, each at a different part of it.
    fn bound_labels(&self) -> Vec<Mark> {
        let mut marks = Vec::new();
        for (group, bounds) in self.boundaries.iter().enumerate() {
            for (index, edges) in bounds.iter().enumerate() {
                let seen = |edge: &Boundary| {
                    let range = self.y.minimum..=self.y.maximum;
                    edge.points.iter().copied().filter(move |point| range.contains(&point.1)).collect()
                };
                let longest = edges.iter().map(seen).max_by_key(Vec::len).unwrap_or_default();
                let Some(bound) = self.bound(group, index) else { continue };
                marks.push(Mark::Label {
                    at: spread(&longest, group + index),
                    text: plain(bound.frequency_rad_per_s),
                    role: Role::Text,
                    side: PointSide::On,
                });
            }
        }
        marks
    }

    /// Contour labels: on closed contours above the critical point, on the others at the border.
    fn contour_labels(&self) -> Vec<Mark> {
        let text = |contour: f64| decimal(contour, usize::from(contour.fract() != 0.0));
        self.chart
            .contours_db
            .iter()
            .filter_map(|&contour| {
                let points = magnitude_contour(contour);
                let role = Role::Muted;
                if contour < 0.0 {
                    let at = points.last()?.1;
                    return Some(Mark::EdgeLabel { at, text: text(contour), role });
                }
                let at = spread(&points, 0);
                Some(Mark::Label { at, text: text(contour), role, side: PointSide::On })
            })
            .collect()
    }

    pub(super) fn legend(&self) -> Vec<LegendEntry> {
        let loops = self.chart.loops.iter().enumerate();
        let mut legend: Vec<LegendEntry> =
            loops.map(|(index, one)| LegendEntry::line(&one.name, self.loop_stroke(index))).collect();
        if self.loops.len() > 1 {
            let entries = legend.iter_mut().enumerate();
            entries.for_each(|(index, entry)| entry.marker = Some(loop_marker(index)));
        } else if !self.marks.is_empty() {
            legend.push(LegendEntry::marker("design frequency", loop_marker(0)));
        }
        let several = self.chart.bounds.len() > 1;
        for (index, group) in self.chart.bounds.iter().enumerate() {
            let dash = if several { series_dash(index) } else { Dash::Solid };
            legend.push(LegendEntry::line(&group.name, Stroke::solid(Role::Text, 1.8).dashed(dash)));
        }
        if !self.chart.contours_db.is_empty() {
            legend.push(LegendEntry::line("|T| in dB", contour_stroke()));
        }
        legend.push(LegendEntry::marker("critical point", CRITICAL_POINT));
        if !self.violations.is_empty() {
            legend.push(LegendEntry::marker("violation", VIOLATION));
        }
        if self.chart.bounds.iter().any(|group| !group.bounds.is_empty()) {
            legend.push(LegendEntry::note("numbers on bounds: rad/s; ticked side forbidden"));
        }
        legend
    }
}

const CRITICAL_POINT: MarkerStyle = MarkerStyle { marker: Marker::Plus, role: Role::Text, radius: 6.0 };
const VIOLATION: MarkerStyle = MarkerStyle { marker: Marker::Cross, role: Role::Bad, radius: 5.0 };

fn contour_stroke() -> Stroke {
    Stroke::solid(Role::Muted, 0.6)
}

/// Design frequency on one of the loops.
struct LoopMark {
    loop_index: usize,
    /// Frequency, rad/s.
    frequency: f64,
    phase_deg: f64,
    magnitude_db: f64,
}

fn loop_marks(loops: &[UnwrappedResponse], frequencies: &[f64]) -> Vec<LoopMark> {
    let mut marks = Vec::new();
    for (loop_index, one) in loops.iter().enumerate() {
        let at = |&frequency: &f64| {
            let (phase_deg, magnitude_db) = one.at(frequency)?;
            Some(LoopMark { loop_index, frequency, phase_deg, magnitude_db })
        };
        marks.extend(frequencies.iter().filter_map(at));
    }
    marks
}

/// Marker of a loop: circles on the first, squares on the second, and so on.
fn loop_marker(index: usize) -> MarkerStyle {
    MarkerStyle { role: Role::Text, radius: 4.5, ..series_marker(index) }
}

/// Phase in degrees, on the turn of the loop that passes nearest at that frequency.
fn phase_on_nearest(loops: &[UnwrappedResponse], violation: &OpenLoopViolation) -> f64 {
    let magnitude = decibel(violation.open_loop);
    let places = loops.iter().filter_map(|one| one.at(violation.frequency_rad_per_s));
    let turned = places.map(|(phase, other)| {
        let on_turn = phase_near(violation.open_loop, phase);
        (on_turn, (on_turn - phase).abs() + (magnitude - other).abs())
    });
    let nearest = turned.min_by(|one, other| one.1.total_cmp(&other.1));
    nearest.map_or_else(|| phase_near(violation.open_loop, -180.0), |(phase, _)| phase)
}

/// All frequencies of the chart, rising.
fn frequencies(chart: &NicholsChart<'_>) -> Vec<f64> {
    let bounds = chart.bounds.iter().flat_map(|group| group.bounds).map(|bound| bound.frequency_rad_per_s);
    let templates = chart.templates.iter().map(|template| template.frequency_rad_per_s);
    let design = chart.design_frequencies_rad_per_s.iter().copied();
    let mut all: Vec<f64> = design.chain(bounds).chain(templates).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Colour of a frequency.
fn role(frequencies: &[f64], frequency: f64) -> Role {
    let index = frequencies.iter().position(|other| *other == frequency).unwrap_or(0);
    ramp_role(index, frequencies.len())
}

fn shifted(points: &[(f64, f64)], shift: f64) -> Vec<(f64, f64)> {
    points.iter().map(|(phase, magnitude)| (phase + shift, *magnitude)).collect()
}

/// About twenty of the points as candidates for a label, beginning at a different part for each
/// start.
fn spread(points: &[(f64, f64)], start: usize) -> Vec<(f64, f64)> {
    const PLACES: usize = 20;
    let stride = points.len().div_ceil(PLACES).max(1);
    let mut places: Vec<(f64, f64)> = points.iter().copied().step_by(stride).collect();
    if !places.is_empty() {
        let by = 3 * (start + 1) % places.len();
        places.rotate_left(by);
    }
    places
}
