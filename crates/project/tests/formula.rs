//! Formulas in text: polynomials, ratios, parameters, and errors with the position of the
//! character.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use phea_dynamics::scalar::Dual;
use phea_project::{Formula, Variable};

#[track_caller]
fn polynomial(text: &str, expected: &[f64]) {
    assert_eq!(Formula::parse(text).unwrap().polynomial().as_deref(), Some(expected), "{text}");
}

#[test]
fn polynomials_expand() {
    // ORIGIN: analytic
    polynomial("s", &[1.0, 0.0]);
    polynomial("0.001*s + 0.008", &[0.001, 0.008]);
    polynomial("s^2 + 73.6*s + 2116", &[1.0, 73.6, 2116.0]);
    polynomial("2116*(s + 75)/75", &[2116.0 / 75.0, 2116.0]);
    polynomial("(s^2 + 40*s + 400)*(s + 50)", &[1.0, 90.0, 2400.0, 20000.0]);
    polynomial("400*50", &[20000.0]);
    polynomial("-s^2", &[-1.0, 0.0, 0.0]);
    polynomial("(-s)^2", &[1.0, 0.0, 0.0]);
    polynomial("s - s + 1", &[1.0]);
    polynomial("(s+1)^3", &[1.0, 3.0, 3.0, 1.0]);
    polynomial("s^0", &[1.0]);
    polynomial("1e-3*z", &[1e-3, 0.0]);
    polynomial("8/2/2", &[2.0]);
}

#[test]
fn ratios_keep_both_sides() {
    let ratio = Formula::parse("1/s + s/(s + 2)").unwrap().numbers().unwrap();
    assert_eq!(ratio.numerator, [1.0, 1.0, 2.0]);
    assert_eq!(ratio.denominator, [1.0, 2.0, 0.0]);
    assert_eq!(Formula::parse("1/(1/s)").unwrap().polynomial(), Some(vec![1.0, 0.0]));
    assert_eq!(Formula::parse("1/s").unwrap().polynomial(), None);
}

#[test]
fn parameters_are_numbers_of_any_kind() {
    let formula = Formula::parse("k*a/(s*(s + a))").unwrap();
    assert_eq!(formula.variable(), Some(Variable::S));
    assert_eq!(formula.parameters(), [("k", 0..1), ("a", 2..3)]);
    let a = Dual::<1>::variable(3.0, 0);
    let value = |name: &str| match name {
        "k" => Some(Dual::constant(2.0)),
        "a" => Some(a),
        _ => None,
    };
    let ratio = formula.ratio(&value).unwrap();
    assert_eq!((ratio.numerator[0].value(), ratio.numerator[0].gradient()[0]), (6.0, 2.0));
    let denominator: Vec<f64> = ratio.denominator.iter().map(|c| c.value()).collect();
    assert_eq!(denominator, [1.0, 3.0, 0.0]);
}

#[track_caller]
fn refuse(text: &str, message: &str, at: std::ops::Range<usize>) {
    let error = Formula::parse(text).and_then(|formula| formula.numbers()).unwrap_err();
    assert_eq!((error.message.as_str(), error.range), (message, at), "{text}");
}

#[test]
fn refusals_have_their_position() {
    refuse("", "an empty formula", 0..0);
    refuse("s + ", "the formula ends where a number or name should follow", 4..4);
    refuse("2s + 1", "unexpected `s`", 1..2);
    refuse("(s + 1", "this parenthesis is not closed", 0..1);
    refuse("s + 1)", "unexpected `)`", 5..6);
    refuse("s^-1", "expected a whole power from 0 to 50", 2..3);
    refuse("s^51", "expected a whole power from 0 to 50", 2..4);
    refuse("s^0.5", "expected a whole power from 0 to 50", 2..3);
    refuse("s + z", "both `s` and `z` in one formula", 4..5);
    refuse("1 + k*s", "unknown parameter `k`", 4..5);
    refuse("1e999", "the number is too large", 0..5);
    refuse("1 + s/0", "a coefficient is too large, or divided by zero", 4..7);
    refuse("1e300*1e300", "a coefficient is too large, or divided by zero", 0..11);
    refuse("0/0", "a coefficient is too large, or divided by zero", 0..3);
    refuse("(s^50)*s", "the power of the polynomial is above 50", 0..8);
    refuse("((s+1)^10)^10", "the power of the polynomial is above 50", 0..13);
    refuse("s + é", "unknown parameter `é`", 4..6);
    refuse("1 € 2", "unexpected `€`", 2..5);
    refuse("s - - 1", "a second sign", 4..5);
}

#[test]
fn work_is_bounded() {
    assert!(Formula::parse(&"(".repeat(1000)).is_err());
    assert!(Formula::parse(&"s+".repeat(5000)).is_err());
    let long = format!("{}1", "s+".repeat(900));
    assert_eq!(Formula::parse(&long).unwrap().polynomial(), Some(vec![900.0, 1.0]));
}
