//! State-space systems.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::eigenvalues::eigenvalues;
use super::structure::{Resolvent, product, widened};
use super::transfer_function::is_stable_pole;
use super::{LinearError, LinearNumber, TimeDomain, TransferFunction, realization, zeros};
use crate::portable;

/// A linear system with any number of inputs and outputs.
///
/// ```text
/// dx/dt = A x + B u,    y = C x + D u          (sampled: x(k+1) in place of dx/dt)
/// ```
///
/// States may have units as different as pascals and micrometres; poles, zeros and responses do not
/// depend on the choice of units.
///
/// # Example
/// ```
/// use nalgebra::DMatrix;
/// use num_complex::Complex64;
/// use phea_dynamics::linear::{StateSpace, TimeDomain};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// // mass on a damper: force in, velocity out
/// let scalar = |value| DMatrix::from_element(1, 1, value);
/// let mass = StateSpace::new(scalar(-2.0), scalar(0.5), scalar(1.0), scalar(0.0), TimeDomain::Continuous)?;
/// assert_eq!(mass.poles()?, [Complex64::new(-2.0, 0.0)]);
/// assert_eq!(mass.at_frequency(2.0, 0, 0)?, Complex64::new(0.125, -0.125));
/// assert_eq!(mass.to_transfer_function(0, 0)?.gain(), 0.5);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
    domain: TimeDomain,
}

impl StateSpace {
    /// System with these matrices. The order and the numbers of inputs and outputs may be zero.
    ///
    /// # Errors
    /// [`LinearError::Shape`] when the matrices do not fit, [`LinearError::NotFinite`],
    /// [`LinearError::SampleTime`].
    pub fn new(
        a: DMatrix<f64>,
        b: DMatrix<f64>,
        c: DMatrix<f64>,
        d: DMatrix<f64>,
        domain: TimeDomain,
    ) -> Result<Self, LinearError> {
        let order = a.nrows();
        let shapes = [
            ("A", a.shape(), (order, order)),
            ("B", b.shape(), (order, b.ncols())),
            ("C", c.shape(), (c.nrows(), order)),
            ("D", d.shape(), (c.nrows(), b.ncols())),
        ];
        for (matrix, found, expected) in shapes {
            if found != expected {
                return Err(LinearError::Shape { matrix, found, expected });
            }
        }
        if [&a, &b, &c, &d].iter().any(|matrix| matrix.iter().any(|entry| !entry.is_finite())) {
            return Err(LinearError::NotFinite { what: LinearNumber::MatrixEntry });
        }
        if let TimeDomain::Discrete { sample_time_s } = domain
            && !(sample_time_s.is_finite() && sample_time_s > 0.0)
        {
            return Err(LinearError::SampleTime { sample_time_s });
        }
        Ok(StateSpace { a, b, c, d, domain })
    }

    /// Well-scaled realisation of a transfer function: a cascade of first- and second-order
    /// sections.
    ///
    /// A whole number of samples of dead time becomes that many poles at z = 0.
    ///
    /// # Errors
    /// [`LinearError::Improper`]; [`LinearError::NotRational`] for a continuous system with dead
    /// time; [`LinearError::TooManyDelayStates`].
    pub fn from_transfer_function(system: &TransferFunction) -> Result<Self, LinearError> {
        realization::cascade(system)
    }

    /// System matrix A.
    pub fn a(&self) -> &DMatrix<f64> {
        &self.a
    }

    /// Input matrix B.
    pub fn b(&self) -> &DMatrix<f64> {
        &self.b
    }

    /// Output matrix C.
    pub fn c(&self) -> &DMatrix<f64> {
        &self.c
    }

    /// Feedthrough matrix D.
    pub fn d(&self) -> &DMatrix<f64> {
        &self.d
    }

    /// Time domain.
    pub fn domain(&self) -> TimeDomain {
        self.domain
    }

    /// Number of states.
    pub fn order(&self) -> usize {
        self.a.nrows()
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.b.ncols()
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.c.nrows()
    }

    /// Eigenvalues of A, sorted by magnitude, in exact conjugate pairs.
    ///
    /// # Errors
    /// [`LinearError::EigenvaluesNotConverged`].
    pub fn poles(&self) -> Result<Vec<Complex64>, LinearError> {
        eigenvalues(&self.a)
    }

    /// True if every pole lies strictly inside the stable region.
    ///
    /// # Errors
    /// [`LinearError::EigenvaluesNotConverged`].
    pub fn is_stable(&self) -> Result<bool, LinearError> {
        Ok(self.poles()?.iter().all(|&pole| is_stable_pole(pole, self.domain)))
    }

    /// Channel from one input to one output, counted from zero, with all states.
    ///
    /// # Errors
    /// [`LinearError::NoSuchPort`].
    pub fn channel(&self, input: usize, output: usize) -> Result<Self, LinearError> {
        if input >= self.inputs() {
            return Err(LinearError::NoSuchPort { port: "input", index: input, count: self.inputs() });
        }
        if output >= self.outputs() {
            return Err(LinearError::NoSuchPort { port: "output", index: output, count: self.outputs() });
        }
        Ok(StateSpace {
            a: self.a.clone(),
            b: self.b.columns(input, 1).into_owned(),
            c: self.c.rows(output, 1).into_owned(),
            d: self.d.view((output, input), (1, 1)).into_owned(),
            domain: self.domain,
        })
    }

    /// Response from one input to one output at jw (or exp(jwT)), by solving (jw I - A) x = B;
    /// infinite at a pole.
    ///
    /// # Errors
    /// [`LinearError::NoSuchPort`].
    pub fn at_frequency(
        &self,
        frequency: f64,
        input: usize,
        output: usize,
    ) -> Result<Complex64, LinearError> {
        let channel = self.channel(input, output)?;
        let point = match self.domain {
            TimeDomain::Continuous => Complex64::new(0.0, frequency),
            TimeDomain::Discrete { sample_time_s } => {
                let angle = frequency * sample_time_s;
                Complex64::new(portable::cos(angle), portable::sin(angle))
            }
        };
        Ok(channel.responses(point)[(0, 0)])
    }

    /// Response C (s I - A)^-1 B + D for all channels at any s (or z); infinite entries where s is
    /// an eigenvalue of A.
    ///
    /// The solution is refined in twice the working precision: the result is accurate for the given
    /// matrices.
    pub fn responses(&self, s: Complex64) -> DMatrix<Complex64> {
        let resolvent = Resolvent::new(&self.a, s);
        let mut values =
            DMatrix::from_element(self.outputs(), self.inputs(), Complex64::new(f64::INFINITY, 0.0));
        for input in 0..self.inputs() {
            if let Some(states) = resolvent.solve(&widened(self.b.column(input).iter())) {
                for output in 0..self.outputs() {
                    let start = self.d[(output, input)];
                    values[(output, input)] = product(self.c.row(output).iter(), &states, start);
                }
            }
        }
        values
    }

    /// Transfer function from one input to one output: poles from A, zeros from the system pencil,
    /// gain from the first Markov parameter that is not zero. Modes that cancel remain as common
    /// factors ([`TransferFunction::without_common_factors`] removes them).
    ///
    /// # Errors
    /// [`LinearError::NoSuchPort`], [`LinearError::EigenvaluesNotConverged`].
    pub fn to_transfer_function(&self, input: usize, output: usize) -> Result<TransferFunction, LinearError> {
        let channel = self.channel(input, output)?;
        let poles = channel.poles()?;
        let (gain, zeros) = zeros::of_channel(&channel, &poles)?;
        Ok(TransferFunction::assembled(gain, zeros, poles, self.domain))
    }
}
