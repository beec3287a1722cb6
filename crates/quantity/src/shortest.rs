//! Numbers without insignificant digits.

/// Number with at most this number of significant digits, without trailing zeros.
pub(crate) fn shortest(value: f64, digits: usize) -> String {
    plain(rounded(value, digits.clamp(1, 17)))
}

/// Number rounded to this number of significant digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// Number without trailing zeros.
pub(crate) fn plain(value: f64) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    let ordinary = value.abs() >= 1e-4 && value.abs() < 1e7;
    if ordinary { format!("{value}") } else { format!("{value:e}") }
}
