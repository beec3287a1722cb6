//! Pairs of values of which one may not be above the other.

use super::{Check, last};
use crate::Bench;
use crate::toml_text::quoted;

impl Check<'_, '_> {
    /// Value as in the file or the setting, without quotes; empty if it is not stated.
    fn written(&self, path: &str) -> String {
        let place = self.reader.places.get(path).copied().unwrap_or_default();
        let text = self.reader.findings.content(place.text).get(place.start..place.end);
        text.unwrap_or_default().trim_matches(['"', '\'']).to_string()
    }

    /// Message that the value of one key is above or below that of another, each as written.
    fn compared(&self, path: &str, word: &str, other: &str) -> String {
        let other = match self.written(other) {
            written if written.is_empty() => format!("the default of `{}`", last(other)),
            written => format!("`{}`, {written}", last(other)),
        };
        format!("`{}`, {}, is {word} {other}", last(path), self.written(path))
    }

    /// Two values of a list as written.
    fn written_pair(&self, path: &str) -> Option<[String; 2]> {
        let written = self.written(path);
        let (first, second) = written.trim_matches(['[', ']']).split_once(',')?;
        let bare = |text: &str| text.trim_matches([' ', '\n', '\r', '\t', ',', '"', '\'']).to_string();
        Some([bare(first), bare(second)])
    }

    /// Checks that two numbers of one list are in order.
    pub(super) fn ascending(&mut self, path: &str, pair: Option<[f64; 2]>) {
        if let Some([low, high]) = pair
            && low > high
        {
            self.reversed(path);
        }
    }

    /// Checks that two numbers are in order and not equal.
    pub(super) fn strictly_ascending(&mut self, path: &str, pair: Option<[f64; 2]>) {
        match pair {
            Some([low, high]) if low == high => {
                self.error(path, format!("`{}` is empty: both ends are equal", last(path)));
            }
            pair => self.ascending(path, pair),
        }
    }

    fn reversed(&mut self, path: &str) {
        let name = last(path);
        match self.written_pair(path) {
            Some([first, second]) => {
                let message = format!(
                    "`{name}` is reversed: {first} is above {second}, and the lower value comes first"
                );
                let [low, high] = [second, first].map(|value| in_toml_as_written(&value));
                self.error_with_help(path, message, format!("exchange them: `{name} = [{low}, {high}]`"));
            }
            None => self.error(path, format!("`{name}` is reversed: the lower value comes first")),
        }
    }

    /// Remedy for two keys in the wrong order: both are exchanged, or the stated one moves to the
    /// other side of a default.
    fn exchanged(&self, lower: &str, upper: &str) -> String {
        let [low, high] = [lower, upper].map(|path| self.written(path));
        let [least, most] = [last(lower), last(upper)];
        match (low.is_empty(), high.is_empty()) {
            (false, false) => {
                let [low, high] = [low, high].map(|value| in_toml_as_written(&value));
                format!("if they were exchanged: `{least} = {high}` and `{most} = {low}`")
            }
            (true, _) => format!("state a lower `{least}` too, or a higher `{most}`"),
            (_, true) => format!("state a higher `{most}` too, or a lower `{least}`"),
        }
    }

    /// Checks that two numbers of one table are in order, each with its path; the error is at the
    /// first one, or at the second if only that one is stated.
    pub(super) fn in_order(&mut self, [lower, upper]: [&str; 2], [low, high]: [f64; 2]) {
        if low > high && !self.refused(lower) && !self.refused(upper) {
            let (at, word, other) = match self.declared(lower) {
                true => (lower, "above", upper),
                false => (upper, "below", lower),
            };
            self.error_with_help(at, self.compared(at, word, other), self.exchanged(lower, upper));
        }
    }

    /// Checks that minimum, nominal and maximum are in order.
    pub(super) fn bounds(&mut self, path: &str, [minimum, nominal, maximum]: [f64; 3]) {
        let parts = ["minimum", "nominal", "maximum"].map(|name| format!("{path}.{name}"));
        let [least, usual, most] = [&parts[0], &parts[1], &parts[2]];
        if parts.iter().any(|part| self.refused(part) || !self.declared(part)) {
            return;
        }
        if minimum > maximum {
            return self.in_order([least, most], [minimum, maximum]);
        }
        let [low, high] = [least, most].map(|path| self.written(path));
        let within = format!("state a `nominal` from {low} to {high}, or widen the range to it");
        if minimum > nominal {
            self.error_with_help(least, self.compared(least, "above", usual), &*within);
        }
        if maximum < nominal {
            self.error_with_help(most, self.compared(most, "below", usual), within);
        }
    }
}

/// Value as written, without quotes, in TOML.
fn in_toml_as_written(value: &str) -> String {
    let is_bare = value.replace('_', "").parse::<f64>().is_ok();
    if is_bare { value.to_string() } else { quoted(value) }
}

/// Checks ranges of the virtual bench.
pub(super) fn bench(bench: &Bench, check: &mut Check<'_, '_>) {
    let low_flow = bench.low_flow_meter.as_ref().map(|small| small.meter);
    let meters = [
        ("leak_meter", Some(bench.leak_meter)),
        ("flow_meter", Some(bench.flow_meter)),
        ("low_flow_meter", low_flow),
    ];
    for (name, meter) in meters.into_iter().filter_map(|(name, meter)| Some((name, meter?))) {
        let [minimum, range] = ["minimum", "range"].map(|key| format!("bench.{name}.{key}"));
        check.in_order([&minimum, &range], [meter.minimum, meter.range]);
    }
    if let Some(line) = &bench.line {
        check.strictly_ascending("bench.line.pressures", Some(line.pressures));
        check.strictly_ascending("bench.line.frequencies", Some(line.frequencies));
    }
    if let Some(friction) = &bench.friction {
        let paths = ["bench.friction.slowest", "bench.friction.fastest"];
        check.in_order(paths, [friction.slowest, friction.fastest]);
        check.strictly_ascending("bench.friction.shaken.frequencies", friction.shaken.frequencies);
    }
}
