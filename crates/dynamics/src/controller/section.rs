use num_complex::Complex64;

use crate::linear::{LinearError, LinearOperation, Polynomial, TimeDomain, TransferFunction};
use crate::order::sort_by_number;

/// Largest denominator at z = 1 of a section that integrates: 1e-12 rad of pole angle, below any
/// sampled plant.
const INTEGRATING: f64 = 1e-12;

/// Second-order difference equation, in the transposed direct form that rounds least.
///
/// ```text
/// H(z) = (b0 + b1 z^-1 + b2 z^-2)/(1 + a1 z^-1 + a2 z^-2)
/// y = b0 x + s1,    s1' = b1 x - a1 y + s2,    s2' = b2 x - a2 y
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Coefficients b0, b1, b2.
    pub numerator: [f64; 3],
    /// Coefficients a1, a2.
    pub denominator: [f64; 2],
}

impl Section {
    /// A sampled transfer function as sections in series, in the order in which a
    /// [`super::SampledController`] runs them. The section with the pole nearest z = 1 comes last,
    /// so that the integral part acts on the command itself and anti-windup can act on it.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] for a continuous one, [`LinearError::Improper`],
    /// [`LinearError::NotRational`] for one with dead time, which is not a section.
    ///
    /// # Example
    /// An integrator of 2/s every 0.1 s by the bilinear rule, and back:
    /// ```
    /// use phea_dynamics::controller::{Element, Section};
    /// use phea_dynamics::linear::Discretization;
    /// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
    /// let function = Element::Integrator.transfer_function()?.discretized(0.1, Discretization::Tustin)?;
    /// let sections = Section::in_series(&function)?;
    /// assert_eq!(sections, [Section { numerator: [0.05, 0.05, 0.0], denominator: [-1.0, 0.0] }]);
    /// assert_eq!(sections[0].transfer_function(0.1)?, function);
    /// # Ok(())
    /// # }
    /// ```
    pub fn in_series(function: &TransferFunction) -> Result<Vec<Section>, LinearError> {
        if function.domain() == TimeDomain::Continuous {
            return Err(LinearError::WrongDomain { operation: LinearOperation::Sections, needed: "sampled" });
        }
        if !function.is_proper() {
            return Err(LinearError::Improper {
                zeros: function.zeros().len(),
                poles: function.poles().len(),
            });
        }
        if function.dead_time_s() != 0.0 {
            return Err(LinearError::NotRational { operation: LinearOperation::Sections });
        }
        Ok(cascade(function))
    }

    /// The section as a transfer function in z; poles at z = 0 that only pad its order are left
    /// out.
    ///
    /// # Errors
    /// Errors of [`Polynomial::roots`], and [`LinearError::SampleTime`].
    pub fn transfer_function(&self, sample_time_s: f64) -> Result<TransferFunction, LinearError> {
        let [a1, a2] = self.denominator;
        let [b0, b1, b2] = self.numerator;
        let kept = if a2 != 0.0 || b2 != 0.0 { 3 } else { 2 - usize::from(a1 == 0.0 && b1 == 0.0) };
        let polynomial =
            |coefficients: [f64; 3]| Polynomial::new(coefficients.into_iter().take(kept).collect());
        TransferFunction::from_polynomials(&polynomial([b0, b1, b2]), &polynomial([1.0, a1, a2]))?
            .in_domain(TimeDomain::Discrete { sample_time_s })
    }

    /// Output for this input and state.
    pub fn output(&self, state: [f64; 2], input: f64) -> f64 {
        self.numerator[0] * input + state[0]
    }

    /// State in which a constant input gives a constant output, which replaces the input; for a
    /// section that integrates, the output is the wanted one.
    pub(super) fn settled(&self, signal: &mut f64, wanted: f64) -> [f64; 2] {
        let input = *signal;
        let under = 1.0 + self.denominator.iter().sum::<f64>();
        let integrates = under.abs() <= INTEGRATING;
        *signal = if integrates { wanted } else { self.numerator.iter().sum::<f64>() / under * input };
        let second = self.numerator[2] * input - self.denominator[1] * *signal;
        [self.numerator[1] * input - self.denominator[0] * *signal + second, second]
    }

    /// Final output for a constant input of one; `None` for a section that integrates.
    pub fn steady_gain(&self) -> Option<f64> {
        let under = 1.0 + self.denominator.iter().sum::<f64>();
        (under.abs() > INTEGRATING).then(|| self.numerator.iter().sum::<f64>() / under)
    }

    /// Next state, once the output is known (limited or not).
    pub fn advance(&self, state: [f64; 2], input: f64, output: f64) -> [f64; 2] {
        [
            self.numerator[1] * input - self.denominator[0] * output + state[1],
            self.numerator[2] * input - self.denominator[1] * output,
        ]
    }
}

fn cascade(function: &TransferFunction) -> Vec<Section> {
    let mut poles = grouped(function.poles());
    sort_by_number(&mut poles, |group| -distance_from_one(group));
    let mut zeros = grouped(function.zeros());
    // pairs first: they need a section of order two, of which there are always enough
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

/// Groups of roots: conjugate pairs, then real roots two by two beginning with those nearest z = 1,
/// a single one last.
fn grouped(roots: &[Complex64]) -> Vec<Vec<Complex64>> {
    let mut groups: Vec<Vec<Complex64>> =
        roots.iter().filter(|root| root.im > 0.0).map(|root| vec![*root, root.conj()]).collect();
    let mut real: Vec<Complex64> = roots.iter().copied().filter(|root| root.im == 0.0).collect();
    sort_by_number(&mut real, |root| (root.re - 1.0).abs());
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
