//! A transfer function by its factors, as declared in a project.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};

use super::project::{RationalFunction, Transfer, Variable};

/// Declaration for [controller] or [prefilter].
pub(super) fn declared(function: &TransferFunction) -> Transfer {
    let in_z = function.domain() != TimeDomain::Continuous;
    let ratio = RationalFunction {
        gain: Some(function.gain()),
        zeros: pairs(function.zeros()),
        poles: pairs(function.poles()),
        domain: in_z.then_some(Variable::Z),
        ..RationalFunction::default()
    };
    Transfer { ratio, ..Transfer::default() }
}

fn pairs(roots: &[Complex64]) -> Vec<[f64; 2]> {
    // a negative zero is not intended
    roots.iter().map(|root| [root.re + 0.0, root.im + 0.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_in_z_is_declared_in_z() {
        let pole = TransferFunction::from_factors(0.5, vec![], vec![Complex64::new(0.9, 0.0)]).unwrap();
        let sampled = pole.in_domain(TimeDomain::Discrete { sample_time_s: 0.001 }).unwrap();
        assert_eq!(declared(&sampled).ratio.domain, Some(Variable::Z));
    }
}
