//! Sensitivity bars: the change of a result when one parameter is at its ends, the widest on top.

use super::axis::Axis;
use super::colour::Role;
use super::legend::{self, LegendEntry};
use super::scene::{Anchor, Baseline, Fill, Rectangle, Scene, Stroke, Text, point};
use super::ticks::plain;
use super::{Figure, LABEL_SIZE, SMALL_SIZE, TITLE_SIZE, WIDTH, Words, typeset};
use phea_quantity::DisplayUnit;

/// Effect of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct TornadoBar {
    /// Parameter, such as `β_0`.
    pub parameter: String,
    /// Text of its low setting, such as `1.3 GPa`.
    pub low_setting: String,
    /// Text of its high setting.
    pub high_setting: String,
    /// Result at the low setting, SI.
    pub low_value: f64,
    /// Result at the high setting, SI.
    pub high_value: f64,
}

/// Change of a result with each parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Tornado {
    /// Result, such as `Hydraulic stiffness K_H`.
    pub quantity: String,
    /// Unit of the result.
    pub unit: DisplayUnit,
    /// Result at the nominal settings, SI.
    pub nominal: f64,
    /// Parameters in any order.
    pub bars: Vec<TornadoBar>,
}

const ROW: f64 = 34.0;
const BAR: f64 = 18.0;
const TOP: f64 = 26.0;

impl Tornado {
    /// Draws the bars; a bar whose values are not finite is omitted.
    pub fn draw(&self, words: &Words) -> Figure {
        let mut bars: Vec<&TornadoBar> =
            self.bars.iter().filter(|bar| is_drawable(bar, self.nominal)).collect();
        let span = |bar: &TornadoBar| {
            let ends = [bar.low_value, bar.high_value, self.nominal];
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max)
                - ends.into_iter().fold(f64::INFINITY, f64::min)
        };
        bars.sort_by(|a, b| span(b).total_cmp(&span(a)));
        let frame = frame(&bars);
        let axis = self.axis(&bars, frame);
        let entries = [
            LegendEntry::area("parameter at its low setting", fill(false)),
            LegendEntry::area("at its high setting", fill(true)),
        ];
        let below = frame.bottom + 9.0 + LABEL_SIZE + 8.0 + TITLE_SIZE + 8.0;
        let mut scene = Scene::new(WIDTH, (below + legend::height(&entries, WIDTH - 16.0) + 8.0).ceil());
        scale(&mut scene, &axis, frame);
        for (index, bar) in bars.iter().enumerate() {
            self.draw_bar(&mut scene, bar, &axis, frame, index);
        }
        self.nominal_line(&mut scene, &axis, frame);
        legend::draw(&mut scene, &entries, frame.left.min(70.0), below, WIDTH - 16.0);
        words.with_scene(scene)
    }

    /// Axis with space for the labels at the ends of the longest bars.
    fn axis(&self, bars: &[&TornadoBar], frame: Rectangle) -> Axis {
        let (mut low, mut high) = (self.nominal, self.nominal);
        let (mut before, mut after) = (12.0_f64, 12.0_f64);
        for (value, _, words) in bars.iter().flat_map(|bar| ends(bar, self.nominal)) {
            (low, high) = (low.min(value), high.max(value));
            let room = typeset::width(&words, SMALL_SIZE).min(0.3 * frame.width()) + 12.0;
            if value < self.nominal {
                before = before.max(room);
            } else {
                after = after.max(room);
            }
        }
        let per_unit = (high - low) / (frame.width() - before - after);
        let (minimum, maximum) = (low - before * per_unit, high + after * per_unit);
        Axis::linear(self.unit.title(&self.quantity), self.unit.of(minimum), self.unit.of(maximum))
    }

    fn draw_bar(&self, scene: &mut Scene, bar: &TornadoBar, axis: &Axis, frame: Rectangle, index: usize) {
        let middle = frame.top + ROW * (index as f64 + 0.5);
        let name = typeset::fitted(&bar.parameter, LABEL_SIZE, frame.left - 16.0);
        let at = point(frame.left - 8.0, middle);
        scene.text(Text::new(at, name, LABEL_SIZE).held(Anchor::End, Baseline::Middle));
        let nominal = place(axis, frame, self.unit.of(self.nominal));
        let one_sided = (bar.low_value - self.nominal) * (bar.high_value - self.nominal) >= 0.0;
        for (value, high, words) in ends(bar, self.nominal) {
            let x = place(axis, frame, self.unit.of(value));
            // two ends on one side of the nominal value are in one row, one above the other
            let (from, to) = match (one_sided, high) {
                (false, _) => (middle - 0.5 * BAR, middle + 0.5 * BAR),
                (true, false) => (middle - 0.5 * BAR, middle),
                (true, true) => (middle, middle + 0.5 * BAR),
            };
            let area = Rectangle::from_corners(point(nominal.min(x), from), point(nominal.max(x), to));
            scene.rectangle(area, None, Some(fill(high)));
            let (dx, anchor) = if value < self.nominal { (-5.0, Anchor::End) } else { (5.0, Anchor::Start) };
            let limit = if dx > 0.0 { frame.right - x - 8.0 } else { x - frame.left - 8.0 };
            let words = typeset::fitted(&words, SMALL_SIZE, limit);
            let text = Text::new(point(x + dx, middle), words, SMALL_SIZE).held(anchor, Baseline::Middle);
            scene.text(text.coloured(Role::Muted));
        }
    }

    fn nominal_line(&self, scene: &mut Scene, axis: &Axis, frame: Rectangle) {
        let value = self.unit.of(self.nominal);
        let x = place(axis, frame, value);
        if !x.is_finite() {
            return;
        }
        scene.line(point(x, frame.top - 4.0), point(x, frame.bottom), Stroke::solid(Role::Text, 1.6));
        let text = format!("nominal {} {}", plain(value), self.unit.symbol);
        let half = 0.5 * typeset::width(&text, LABEL_SIZE);
        let middle = x.clamp(half + 4.0, WIDTH - half - 4.0);
        scene.text(
            Text::new(point(middle, frame.top - 9.0), text, LABEL_SIZE)
                .held(Anchor::Middle, Baseline::Letters),
        );
    }
}

/// True if the values are finite, and not so large that differences overflow.
fn is_drawable(bar: &TornadoBar, nominal: f64) -> bool {
    [bar.low_value, bar.high_value, nominal].iter().all(|value| value.abs() < 1e200)
}

fn frame(bars: &[&TornadoBar]) -> Rectangle {
    let widest = bars.iter().map(|bar| typeset::width(&bar.parameter, LABEL_SIZE)).fold(40.0, f64::max);
    Rectangle {
        left: (widest + 18.0).min(0.42 * WIDTH),
        top: TOP,
        right: WIDTH - 18.0,
        bottom: TOP + ROW * bars.len().max(1) as f64,
    }
}

fn fill(high: bool) -> Fill {
    if high {
        Fill { role: Role::Series(0), opacity: 0.85 }
    } else {
        Fill { role: Role::Series(1), opacity: 0.85 }
    }
}

fn place(axis: &Axis, frame: Rectangle, value: f64) -> f64 {
    frame.left + axis.fraction(value).clamp(0.0, 1.0) * frame.width()
}

fn scale(scene: &mut Scene, axis: &Axis, frame: Rectangle) {
    for tick in axis.ticks(6) {
        let x = place(axis, frame, tick.value);
        scene.line(point(x, frame.top), point(x, frame.bottom), Stroke::solid(Role::Grid, 1.0));
        let label = tick.label.unwrap_or_default();
        let text = Text::new(point(x, frame.bottom + 9.0), label, LABEL_SIZE);
        scene.text(text.held(Anchor::Middle, Baseline::Top));
    }
    scene.rectangle(frame, Some(Stroke::solid(Role::Axis, 1.0)), None);
    let at = point(frame.centre().x, frame.bottom + 9.0 + LABEL_SIZE + 6.0);
    scene.text(
        Text::new(at, typeset::fitted(&axis.full_title(), TITLE_SIZE, frame.width()), TITLE_SIZE)
            .held(Anchor::Middle, Baseline::Top),
    );
}

/// End of a bar and the label there: one text for both ends if they are on one side.
fn ends(bar: &TornadoBar, nominal: f64) -> Vec<(f64, bool, String)> {
    let low = (bar.low_value, false, bar.low_setting.clone());
    let high = (bar.high_value, true, bar.high_setting.clone());
    if (bar.low_value - nominal) * (bar.high_value - nominal) < 0.0 {
        return vec![low, high];
    }
    let both = format!("{} / {}", bar.low_setting, bar.high_setting);
    if (bar.low_value - nominal).abs() > (bar.high_value - nominal).abs() {
        vec![(bar.low_value, false, both), (bar.high_value, true, String::new())]
    } else {
        vec![(bar.low_value, false, String::new()), (bar.high_value, true, both)]
    }
}
