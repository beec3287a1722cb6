//! Factored form of a transfer function, for people.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};

use crate::quantity::{RATIO, display};

/// `0.001 (s + 8) / (s (s^2 + 20 s + 200))`, with this number of digits.
pub fn factored(function: &TransferFunction, digits: usize) -> String {
    let name = if function.domain() == TimeDomain::Continuous { "s" } else { "z" };
    let gain = display(function.gain(), &RATIO, digits);
    let zeros = product(function.zeros(), name, digits);
    let poles = product(function.poles(), name, digits);
    let above = match zeros.as_slice() {
        [] => gain,
        zeros if function.gain() == 1.0 => zeros.join(" "),
        zeros => format!("{gain} {}", zeros.join(" ")),
    };
    match poles.as_slice() {
        [] => above,
        [only] => format!("{above} / {only}"),
        poles => format!("{above} / ({})", poles.join(" ")),
    }
}

fn product(roots: &[Complex64], name: &str, digits: usize) -> Vec<String> {
    let term = |value: f64| {
        let sign = if value < 0.0 { '-' } else { '+' };
        format!("{sign} {}", display(value.abs(), &RATIO, digits))
    };
    let factor = |root: &Complex64| match (root.re, root.im) {
        (0.0, 0.0) => name.to_string(),
        (re, 0.0) => format!("({name} {})", term(-re)),
        (0.0, im) => format!("({name}^2 {})", term(im * im)),
        (re, im) => format!("({name}^2 {} {name} {})", term(-2.0 * re), term(re * re + im * im)),
    };
    roots.iter().filter(|root| root.im >= 0.0).map(factor).collect()
}
