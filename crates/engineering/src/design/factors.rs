//! A transfer function by its factors: for people, and as a project declares it.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};

use super::project::{RationalFunction, Transfer, Variable};
use super::quantity::{RATIO, display};

/// As [controller] or [prefilter] declares it.
pub(super) fn declared(function: &TransferFunction) -> Transfer {
    let in_z = variable(function) == Variable::Z;
    let ratio = RationalFunction {
        gain: Some(function.gain()),
        zeros: pairs(function.zeros()),
        poles: pairs(function.poles()),
        domain: in_z.then_some(Variable::Z),
        ..RationalFunction::default()
    };
    Transfer { ratio, ..Transfer::default() }
}

fn sample_time_s(function: &TransferFunction) -> Option<f64> {
    match function.domain() {
        TimeDomain::Continuous => None,
        TimeDomain::Discrete { sample_time_s } => Some(sample_time_s),
    }
}

fn variable(function: &TransferFunction) -> Variable {
    if sample_time_s(function).is_some() { Variable::Z } else { Variable::S }
}

fn pairs(roots: &[Complex64]) -> Vec<[f64; 2]> {
    // a negative zero is not intended
    roots.iter().map(|root| [root.re + 0.0, root.im + 0.0]).collect()
}

/// `0.001 (s + 8) / (s (s^2 + 20 s + 200))`, its numbers with this number of digits.
pub fn factored(function: &TransferFunction, digits: usize) -> String {
    let name = variable(function).name();
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

#[cfg(test)]
mod tests {
    use super::*;

    fn text(gain: f64, zeros: &[[f64; 2]], poles: &[[f64; 2]]) -> String {
        let roots = |pairs: &[[f64; 2]]| pairs.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
        factored(&TransferFunction::from_factors(gain, roots(zeros), roots(poles)).unwrap(), 3)
    }

    #[test]
    fn factors_read_as_they_are_written_by_hand() {
        assert_eq!(text(0.001, &[[-8.0, 0.0]], &[[0.0, 0.0]]), "0.001 (s + 8) / s");
        assert_eq!(
            text(1.0, &[[2.0, 0.0]], &[[0.0, 0.0], [-3.0, 4.0], [-3.0, -4.0]]),
            "(s - 2) / (s (s^2 + 6 s + 25))"
        );
        assert_eq!(text(-2.0, &[], &[]), "-2");
        assert_eq!(text(9.0, &[], &[[0.0, 3.0], [0.0, -3.0]]), "9 / (s^2 + 9)");
    }

    #[test]
    fn a_law_in_z_is_declared_in_z() {
        let pole = TransferFunction::from_factors(0.5, vec![], vec![Complex64::new(0.9, 0.0)]).unwrap();
        let sampled = pole.in_domain(TimeDomain::Discrete { sample_time_s: 0.001 }).unwrap();
        assert_eq!(declared(&sampled).ratio.domain, Some(Variable::Z));
        assert_eq!(factored(&sampled, 2), "0.5 / (z - 0.9)");
    }
}
