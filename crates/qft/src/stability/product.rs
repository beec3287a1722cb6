//! A sampled polynomial in factored form: expanded in z, fast poles near z = 0 would cost the
//! digits of the slow ones.

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;

/// Product gain (v - v_1) (v - v_2) ... with v = z - 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RootProduct {
    pub(super) gain: f64,
    pub(super) roots: Vec<Complex64>,
}

/// Numerator and denominator of a sampled function, without its dead time.
pub(super) fn products(function: &TransferFunction) -> [RootProduct; 2] {
    let shifted = |roots: &[Complex64]| roots.iter().map(|root| root - 1.0).collect();
    [
        RootProduct { gain: function.gain(), roots: shifted(function.zeros()) },
        RootProduct { gain: 1.0, roots: shifted(function.poles()) },
    ]
}

impl RootProduct {
    pub(super) fn times(&self, other: &RootProduct) -> RootProduct {
        RootProduct { gain: self.gain * other.gain, roots: [&self.roots[..], &other.roots[..]].concat() }
    }

    pub(super) fn at(&self, v: Complex64) -> Complex64 {
        self.roots.iter().fold(Complex64::new(self.gain, 0.0), |product, root| product * (v - root))
    }

    /// Value and derivative.
    pub(super) fn with_slope(&self, v: Complex64) -> (Complex64, Complex64) {
        let start = (Complex64::new(self.gain, 0.0), Complex64::new(0.0, 0.0));
        self.roots.iter().fold(start, |(value, slope), root| {
            let factor = v - root;
            (value * factor, slope * factor + value)
        })
    }

    /// Coefficients of |gain| (|v - v_1| + u) (|v - v_2| + u) ..., lowest power of u first: no
    /// Taylor coefficient of the product at v is larger.
    pub(super) fn majorant(&self, v: Complex64) -> Vec<f64> {
        let mut terms = Vec::with_capacity(self.roots.len() + 1);
        terms.push(self.gain.abs());
        for root in &self.roots {
            let distance = portable::magnitude(v - root);
            let mut below = 0.0;
            for term in &mut terms {
                (*term, below) = (*term * distance + below, *term);
            }
            terms.push(below);
        }
        terms
    }

    /// Product with z = r z', divided by r to its degree, where `shift` is r - 1.
    pub(super) fn moved(&self, shift: f64) -> RootProduct {
        let roots = self.roots.iter().map(|root| (root - shift) / (1.0 + shift)).collect();
        RootProduct { gain: self.gain, roots }
    }
}
