//! Ticks: round values that cover an axis, and their labels.

/// Tick; one without a label is a minor tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Value, in the unit of the axis.
    pub value: f64,
    /// Number at the tick.
    pub label: Option<String>,
}

/// Set of round steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TickSteps {
    /// Steps of 1, 2, 5 times a power of ten.
    Decimal,
    /// Steps of 15, 30, 45, 90, 180, 360 degrees.
    Angle,
    /// Steps of 10, 20, 40, 60, 80, 100 decibels: 20 for a factor of ten.
    Decibel,
    /// Fixed step, for a chart with customary numbers.
    Every(u16),
}

/// Smallest round step that divides `span` into at most `count` intervals.
///
/// # Example
/// ```
/// use phea_figure::ticks::{TickSteps, round_step};
/// assert_eq!(round_step(0.5, 5, TickSteps::Decimal), 0.1);
/// assert_eq!(round_step(360.0, 5, TickSteps::Angle), 90.0);
/// assert_eq!(round_step(360.0, 5, TickSteps::Every(45)), 45.0);
/// ```
pub fn round_step(span: f64, count: usize, steps: TickSteps) -> f64 {
    if let TickSteps::Every(step) = steps {
        return f64::from(step.max(1));
    }
    let least = span / count.max(1) as f64;
    let listed: &[f64] = match steps {
        TickSteps::Angle if least > 5.0 => &[15.0, 30.0, 45.0, 90.0, 180.0, 360.0],
        TickSteps::Decibel if least > 5.0 && least <= 100.0 => &[10.0, 20.0, 40.0, 60.0, 80.0, 100.0],
        _ => &[],
    };
    if let (Some(found), _) | (None, Some(found)) = (
        listed.iter().copied().find(|step| *step >= least * 0.999_999),
        listed.last().map(|last| last * (least / last).ceil()),
    ) {
        return found;
    }
    let mut decade = decimal_power(floor_log10(least));
    if !(decade.is_finite() && decade > 0.0) {
        decade = least;
    }
    let found =
        [1.0, 2.0, 5.0].into_iter().map(|digit| digit * decade).find(|step| *step >= least * 0.999_999);
    found.unwrap_or(10.0 * decade)
}

/// Ticks of a linear axis from `minimum` to `maximum`, at most `count` intervals, labels divided by
/// 10^`exponent`. If only one remained, which would show no scale, the steps are finer.
///
/// # Example
/// ```
/// use phea_figure::ticks::{TickSteps, linear};
/// let labels: Vec<String> = linear(15.0, 35.0, 2, TickSteps::Decimal, 0).into_iter().filter_map(|tick| tick.label).collect();
/// assert_eq!(labels, ["20", "30"]);
/// let labels: Vec<String> = linear(22.0, 38.0, 2, TickSteps::Decimal, 0).into_iter().filter_map(|tick| tick.label).collect();
/// assert_eq!(labels, ["25", "30", "35"]);
/// ```
pub fn linear(minimum: f64, maximum: f64, count: usize, steps: TickSteps, exponent: i32) -> Vec<Tick> {
    let slack = 1e-9 * (maximum - minimum);
    let ends = |step: f64| [((minimum - slack) / step).ceil(), ((maximum + slack) / step).floor()];
    let mut step = round_step(maximum - minimum, count, steps);
    if steps == TickSteps::Decimal && ends(step)[1] - ends(step)[0] < 1.0 {
        step = round_step(maximum - minimum, 2 * count, steps);
    }
    let [first, last] = ends(step);
    let decimals = decimals_of(step / decimal_power(exponent));
    let number = (last - first).clamp(0.0, 100.0) as usize;
    (0..=number)
        .map(|index| {
            let value = (first + index as f64) * step;
            Tick { value, label: Some(decimal(value / decimal_power(exponent), decimals)) }
        })
        .filter(|tick| tick.value >= minimum - slack && tick.value <= maximum + slack)
        .collect()
}

/// Ticks of a logarithmic axis: decades with labels, at most `count` of them, and 2 to 9 between
/// them as minor ones. If space remains, 2 and 5 have labels as well.
pub fn logarithmic(minimum: f64, maximum: f64, count: usize) -> Vec<Tick> {
    let (low, high) = (floor_log10(minimum), floor_log10(maximum));
    let decades = (high - low).max(1) as usize;
    let stride = decades.div_ceil(count.max(1)) as i32;
    let narrow = 3.0 * phea_dynamics::portable::log10(maximum / minimum) <= count as f64;
    let (from, to) = (minimum * (1.0 - 1e-9), maximum * (1.0 + 1e-9));
    let mut ticks = Vec::new();
    for exponent in low..=high {
        let decade = decimal_power(exponent);
        for digit in 1..=9_u8 {
            let value = f64::from(digit) * decade;
            if value < from || value > to {
                continue;
            }
            let labelled = digit == 1 && (exponent - low) % stride == 0;
            let label = if narrow && matches!(digit, 1 | 2 | 5) {
                Some(plain(value))
            } else {
                labelled.then(|| power_label(exponent))
            };
            if label.is_some() || stride == 1 {
                ticks.push(Tick { value, label });
            }
        }
    }
    ticks
}

/// Ticks of a signed logarithmic axis: zero, and decades from `limit` on either side.
pub(crate) fn signed_logarithmic(minimum: f64, maximum: f64, limit: f64, count: usize) -> Vec<Tick> {
    let start = floor_log10(limit * (1.0 + 1e-9));
    let reach = |bound: f64| if bound > limit { floor_log10(bound * (1.0 + 1e-9)) - start + 1 } else { 0 };
    let (below, above) = (reach(-minimum), reach(maximum));
    let stride = ((below + above) as usize).div_ceil(count.max(2)).max(1) as i32;
    let side = |sign: f64, number: i32| {
        (0..number).map(move |index| {
            let label = (index % stride == 0).then(|| {
                let sign = if sign < 0.0 { "\u{2212}" } else { "" };
                format!("{sign}{}", power_label(start + index))
            });
            Tick { value: sign * decimal_power(start + index), label }
        })
    };
    let mut ticks: Vec<Tick> = side(-1.0, below).collect();
    ticks.reverse();
    if minimum <= 0.0 && maximum >= 0.0 {
        ticks.push(Tick { value: 0.0, label: Some("0".to_string()) });
    }
    ticks.extend(side(1.0, above));
    ticks
}

/// Label of a power of ten: small ones written out, others as `10^n`.
fn power_label(exponent: i32) -> String {
    match exponent {
        -2 => "0.01".to_string(),
        -1 => "0.1".to_string(),
        0 => "1".to_string(),
        1 => "10".to_string(),
        2 => "100".to_string(),
        _ => format!("10^{exponent}"),
    }
}

/// Power 10^n, the correctly rounded double for |n| <= 22 and within an ulp or two elsewhere.
pub fn decimal_power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// Largest integer n with 10^n <= value, for a positive finite value.
pub fn floor_log10(value: f64) -> i32 {
    if !(value.is_finite() && value > 0.0) {
        return 0;
    }
    // the exponent of the shortest decimal form: exact, without a logarithm whose last bit could be
    // wrong
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Exponent, a multiple of three, by which labels of an axis are divided: 0 while they are
/// readable.
pub(crate) fn engineering_exponent(minimum: f64, maximum: f64) -> i32 {
    let largest = minimum.abs().max(maximum.abs());
    let power = floor_log10(largest);
    if (-2..=4).contains(&power) { 0 } else { 3 * power.div_euclid(3) }
}

fn decimals_of(step: f64) -> usize {
    // a step such as 0.25 would need one more; steps are 1, 2, 5 or whole degrees
    usize::try_from(-floor_log10(step * (1.0 + 1e-9))).unwrap_or(0).min(12)
}

/// Number with fixed decimals and a real minus sign, without a negative zero.
///
/// # Example
/// ```
/// assert_eq!(phea_figure::ticks::decimal(-2.25, 1), "\u{2212}2.2");
/// assert_eq!(phea_figure::ticks::decimal(-0.01, 1), "0.0");
/// ```
pub fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().any(|b| b.is_ascii_digit() && b != b'0') => format!("\u{2212}{rest}"),
        Some(rest) => rest.to_string(),
        None => text,
    }
}

/// Number with three significant digits for an annotation: fixed decimals from 0.001 to 99999,
/// otherwise `a×10^n`.
///
/// # Example
/// ```
/// use phea_figure::ticks::plain;
/// assert_eq!(plain(12.7), "12.7");
/// assert_eq!(plain(2938.0), "2938");
/// assert_eq!(plain(2.73e-4), "2.73×10^-4");
/// ```
pub fn plain(value: f64) -> String {
    if !value.is_finite() {
        return "\u{2014}".to_string();
    }
    if value == 0.0 {
        return "0".to_string();
    }
    let power = floor_log10(value.abs());
    let trimmed = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
    };
    if (-3..=4).contains(&power) {
        return trimmed(decimal(value, usize::try_from(2 - power).unwrap_or(0)));
    }
    let text = format!("{value:.2e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}×10^{exponent}", trimmed(digits.replace('-', "\u{2212}")))
}
