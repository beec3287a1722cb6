//! Edges of a bound: from forbidden gains at each phase to curves.

use phea_dynamics::portable::log10;
use phea_qft::bound::Bound;

/// Magnitude that represents a gain of zero or infinity, dB: outside every chart.
const FAR_DB: f64 = 1e3;

/// Piece of the edge of a bound. The forbidden side is on its right, seen along it on a chart with
/// phase to the right and magnitude upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Points (phase in degrees, magnitude in dB); a gain of zero or infinity as a magnitude of
    /// -1000 or 1000.
    pub points: Vec<(f64, f64)>,
    /// True if the last point joins the first: an island.
    pub closed: bool,
}

/// Forbidden spans at one phase, degrees and dB.
struct PhaseColumn {
    phase: f64,
    spans: Vec<[f64; 2]>,
}

impl PhaseColumn {
    fn gaps(&self) -> Vec<[f64; 2]> {
        self.spans.windows(2).filter_map(|pair| Some([pair.first()?[1], pair.get(1)?[0]])).collect()
    }
}

/// Link from the end of one span to the next end along the edge.
#[derive(Clone)]
struct Link {
    to: usize,
    via: Vec<(f64, f64)>,
}

/// The edges of a bound. Spans that overlap at neighbouring phases belong together; where a span
/// appears, ends, splits or joins, its tip is drawn as a parabola whose position follows from the
/// last two phases.
///
/// # Example
/// ```
/// use phea_qft::bound::{Bound, GainIntervals};
/// use phea_figure::nichols::boundaries;
/// let span = |low: f64, high: f64| GainIntervals::union_of(vec![[low, high]]);
/// let bound = Bound {
///     frequency_rad_per_s: 1.0,
///     phases_rad: vec![-4.0, -3.0, -2.0, -1.0],
///     forbidden: vec![span(1.0, 1.0), span(0.5, 2.0), span(0.5, 2.0), span(1.0, 1.0)],
/// };
/// let edges = boundaries(&bound);
/// assert!(edges.len() == 1 && edges[0].closed);
/// ```
pub fn boundaries(bound: &Bound) -> Vec<Boundary> {
    let columns = columns(bound);
    let mut first_ends = Vec::with_capacity(columns.len());
    let mut count = 0;
    for column in &columns {
        first_ends.push(count);
        count += 2 * column.spans.len();
    }
    let mut links: Vec<Option<Link>> = vec![None; count];
    for index in 1..columns.len() {
        let strip = Strip { columns: &columns, first_ends: &first_ends, left: index - 1, right: index };
        strip.connect(&mut links);
    }
    let ends: Vec<(f64, f64)> = columns
        .iter()
        .flat_map(|column| {
            column.spans.iter().flat_map(|[low, high]| [(column.phase, *low), (column.phase, *high)])
        })
        .collect();
    chained(&ends, links)
}

/// Finite and increasing phases, each with its spans in dB.
fn columns(bound: &Bound) -> Vec<PhaseColumn> {
    let decibel = |gain: f64| {
        if gain > 0.0 { (20.0 * log10(gain)).clamp(-FAR_DB, FAR_DB) } else { -FAR_DB }
    };
    let mut columns: Vec<PhaseColumn> = Vec::with_capacity(bound.phases_rad.len());
    for (phase, forbidden) in bound.phases_rad.iter().zip(&bound.forbidden) {
        let phase = phase.to_degrees();
        if phase.is_finite() && columns.last().is_none_or(|last| last.phase < phase) {
            let spans = forbidden.intervals().iter().map(|[low, high]| [decibel(*low), decibel(*high)]);
            columns.push(PhaseColumn { phase, spans: spans.collect() });
        }
    }
    columns
}

/// Pair of neighbouring phases. The ends of spans are counted from the first phase on, the lower
/// end of a span before its upper one. Along an edge upper ends lead to the right and lower ends to
/// the left.
struct Strip<'a> {
    columns: &'a [PhaseColumn],
    first_ends: &'a [usize],
    left: usize,
    right: usize,
}

impl Strip<'_> {
    fn column(&self, index: usize) -> Option<&PhaseColumn> {
        self.columns.get(index)
    }

    fn spans(&self, index: usize) -> &[[f64; 2]] {
        self.column(index).map_or(&[], |column| &column.spans)
    }

    fn lower(&self, column: usize, span: usize) -> usize {
        self.first_ends.get(column).copied().unwrap_or(0) + 2 * span
    }

    fn upper(&self, column: usize, span: usize) -> usize {
        self.lower(column, span) + 1
    }

    /// Links the ends of all spans of both phases.
    fn connect(&self, links: &mut [Option<Link>]) {
        let (left, right) = (self.spans(self.left), self.spans(self.right));
        if left.len() == right.len() {
            for span in 0..left.len() {
                self.join(span..span + 1, span..span + 1, links);
            }
            return;
        }
        let (mut i, mut j) = (0, 0);
        while i < left.len() || j < right.len() {
            let (from_i, from_j) = (i, j);
            let mut reach = f64::NEG_INFINITY;
            loop {
                let fresh = i == from_i && j == from_j;
                let next = |spans: &[[f64; 2]], at: usize| spans.get(at).copied();
                let (a, b) = (next(left, i), next(right, j));
                let lowest = |span: [f64; 2], other: Option<[f64; 2]>| {
                    fresh && other.is_none_or(|other| span[0] <= other[0])
                };
                match (a, b) {
                    (Some(span), _) if span[0] < reach || lowest(span, b) => {
                        reach = reach.max(span[1]);
                        i += 1;
                    }
                    (_, Some(span)) if span[0] < reach || lowest(span, a) => {
                        reach = reach.max(span[1]);
                        j += 1;
                    }
                    _ => break,
                }
            }
            self.join(from_i..i, from_j..j, links);
        }
    }

    /// Links the ends of spans that belong together: the outermost ends across, the others around
    /// the tips between them.
    fn join(&self, left: std::ops::Range<usize>, right: std::ops::Range<usize>, links: &mut [Option<Link>]) {
        let mut set = |from: usize, to: usize, via: Vec<(f64, f64)>| {
            if let Some(link) = links.get_mut(from) {
                *link = Some(Link { to, via });
            }
        };
        let (l, r) = (self.left, self.right);
        match (left.is_empty(), right.is_empty()) {
            (false, false) => {
                set(self.upper(l, left.end - 1), self.upper(r, right.end - 1), Vec::new());
                set(self.lower(r, right.start), self.lower(l, left.start), Vec::new());
            }
            (false, true) => {
                let tip = self.tip(l, r, left.start, PhaseColumn::whole);
                set(self.upper(l, left.start), self.lower(l, left.start), tip.downwards());
            }
            (true, false) => {
                let tip = self.tip(r, l, right.start, PhaseColumn::whole);
                set(self.lower(r, right.start), self.upper(r, right.start), tip.upwards());
            }
            (true, true) => {}
        }
        for span in left.start + 1..left.end {
            let tip = self.tip(l, r, span - 1, PhaseColumn::gaps);
            set(self.upper(l, span - 1), self.lower(l, span), tip.upwards());
        }
        for span in right.start + 1..right.end {
            let tip = self.tip(r, l, span - 1, PhaseColumn::gaps);
            set(self.lower(r, span), self.upper(r, span - 1), tip.downwards());
        }
    }

    /// Tip of a span or gap that exists at one phase and not at the next. Its height shrinks with
    /// the square root of the distance to the tip, so its square at two phases gives the position.
    fn tip(&self, at: usize, beyond: usize, which: usize, of: impl Fn(&PhaseColumn) -> Vec<[f64; 2]>) -> Tip {
        let phase = |index: usize| self.column(index).map_or(0.0, |column| column.phase);
        let spans = |index: usize| self.column(index).map(&of).unwrap_or_default();
        let span = spans(at).get(which).copied().unwrap_or([0.0, 0.0]);
        let (here, room) = (phase(at), phase(beyond) - phase(at));
        let before = if beyond > at { at.checked_sub(1) } else { Some(at + 1) };
        let wider = before.and_then(|before| {
            let other = spans(before).into_iter().find(|o| o[0] < span[1] && span[0] < o[1])?;
            Some((phase(before), other[1] - other[0]))
        });
        let height = span[1] - span[0];
        let reach = match wider {
            Some((phase, other)) if other > height && other < FAR_DB => {
                (here - phase) * height * height / (other * other - height * height)
            }
            _ => 0.5 * room,
        };
        let reach = if reach.abs() < 0.95 * room.abs() { reach } else { 0.95 * room };
        Tip { phase: here, reach, span }
    }
}

impl PhaseColumn {
    fn whole(&self) -> Vec<[f64; 2]> {
        self.spans.clone()
    }
}

/// Parabola that closes a span.
struct Tip {
    phase: f64,
    reach: f64,
    span: [f64; 2],
}

impl Tip {
    /// Points from the upper end of the span to the lower.
    fn downwards(&self) -> Vec<(f64, f64)> {
        let (middle, half) = (0.5 * (self.span[0] + self.span[1]), 0.5 * (self.span[1] - self.span[0]));
        [0.8, 0.5, 0.2, 0.0, -0.2, -0.5, -0.8]
            .map(|part: f64| (self.phase + self.reach * (1.0 - part * part), middle + part * half))
            .to_vec()
    }

    fn upwards(&self) -> Vec<(f64, f64)> {
        let mut points = self.downwards();
        points.reverse();
        points
    }
}

/// Follows the links: first the open edges, then the closed ones.
fn chained(ends: &[(f64, f64)], mut links: Vec<Option<Link>>) -> Vec<Boundary> {
    let mut is_reached = vec![false; ends.len()];
    for link in links.iter().flatten() {
        if let Some(reached) = is_reached.get_mut(link.to) {
            *reached = true;
        }
    }
    let beginnings = (0..ends.len()).filter(|end| is_reached.get(*end) == Some(&false));
    let mut result = Vec::new();
    for start in beginnings.collect::<Vec<_>>().into_iter().chain(0..ends.len()) {
        let mut points = Vec::new();
        let mut at = start;
        let mut closed = false;
        while let Some(link) = links.get_mut(at).and_then(Option::take) {
            points.extend(ends.get(at));
            points.extend(link.via);
            at = link.to;
            closed = at == start;
        }
        if points.is_empty() {
            continue;
        }
        points.extend(ends.get(at));
        result.push(Boundary { points, closed });
    }
    result
}
