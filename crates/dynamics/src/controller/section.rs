use num_complex::Complex64;

use crate::linear::TransferFunction;

/// A second-order difference equation, in the transposed direct form that rounds least.
///
/// ```text
/// H(z) = (b0 + b1 z^-1 + b2 z^-2)/(1 + a1 z^-1 + a2 z^-2)
/// y = b0 x + s1,    s1' = b1 x - a1 y + s2,    s2' = b2 x - a2 y
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// b0, b1, b2
    pub numerator: [f64; 3],
    /// a1, a2
    pub denominator: [f64; 2],
}

impl Section {
    /// The output for this input and state.
    pub fn output(&self, state: [f64; 2], input: f64) -> f64 {
        self.numerator[0] * input + state[0]
    }

    /// The next state, once the output is known (limited or not).
    pub fn advance(&self, state: [f64; 2], input: f64, output: f64) -> [f64; 2] {
        [
            self.numerator[1] * input - self.denominator[0] * output + state[1],
            self.numerator[2] * input - self.denominator[1] * output,
        ]
    }
}

/// A sampled transfer function as a cascade. The section with the pole nearest z = 1 comes last: the integral part acts
/// on the command itself, where a limit can be told to it.
pub(super) fn cascade(function: &TransferFunction) -> Vec<Section> {
    let mut poles = grouped(function.poles());
    poles.sort_by(|one, other| distance_from_one(other).total_cmp(&distance_from_one(one)));
    let mut zeros = grouped(function.zeros());
    // Pairs first: they need a section of order two, and there are always enough of those.
    zeros.sort_by_key(|group| std::cmp::Reverse(group.len()));
    let mut sections: Vec<(Vec<Complex64>, Vec<Complex64>)> =
        poles.into_iter().map(|group| (group, vec![])).collect();
    for group in zeros {
        let place = sections.iter_mut().rev().find(|(poles, zeros)| poles.len() - zeros.len() >= group.len());
        if let Some((_, zeros)) = place {
            zeros.extend(group);
        }
    }
    if sections.is_empty() {
        sections.push((vec![], vec![]));
    }
    let last = sections.len() - 1;
    let gain = |index: usize| if index == last { function.gain() } else { 1.0 };
    sections.iter().enumerate().map(|(index, (poles, zeros))| section(poles, zeros, gain(index))).collect()
}

/// Conjugate pairs together, real roots two by two beginning with those nearest z = 1, a single one left over.
fn grouped(roots: &[Complex64]) -> Vec<Vec<Complex64>> {
    let mut groups: Vec<Vec<Complex64>> =
        roots.iter().filter(|root| root.im > 0.0).map(|root| vec![*root, root.conj()]).collect();
    let mut real: Vec<Complex64> = roots.iter().copied().filter(|root| root.im == 0.0).collect();
    real.sort_by(|one, other| (one.re - 1.0).abs().total_cmp(&(other.re - 1.0).abs()));
    groups.extend(real.chunks(2).map(<[Complex64]>::to_vec));
    groups
}

fn distance_from_one(group: &[Complex64]) -> f64 {
    group.iter().map(|root| (root - 1.0).norm_sqr()).fold(f64::INFINITY, f64::min)
}

fn section(poles: &[Complex64], zeros: &[Complex64], gain: f64) -> Section {
    let [a1, a2] = monic(poles);
    let [c1, c2] = monic(zeros);
    // z^m + c1 z^(m-1) + ... over z^n + ...: fewer zeros than poles delay the numerator.
    let full = [gain, gain * c1, gain * c2];
    let numerator = match poles.len().saturating_sub(zeros.len()) {
        0 => full,
        1 => [0.0, full[0], full[1]],
        _ => [0.0, 0.0, full[0]],
    };
    Section { numerator, denominator: [a1, a2] }
}

/// Coefficients of the monic polynomial with up to two roots, below the leading one.
fn monic(roots: &[Complex64]) -> [f64; 2] {
    match roots {
        [] => [0.0, 0.0],
        [root] => [-root.re, 0.0],
        [one, other, ..] => [-(one + other).re, (one * other).re],
    }
}
