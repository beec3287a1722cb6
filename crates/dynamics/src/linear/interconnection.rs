//! Series, parallel and negative feedback, for transfer functions and state space.
//!
//! The new zeros or poles of a sum are the roots of N_1 D_2 + N_2 D_1, evaluated from the factors
//! in twice the working precision; its coefficients serve only to start the search.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::double_double::{ComplexDoubleDouble, DoubleDouble};
use super::polynomial::expand;
use super::refinement::{refine, symmetrise};
use super::{LinearError, LinearOperation, Polynomial, StateSpace, TransferFunction};

/// gain (s - r_1) (s - r_2) ...
#[derive(Clone)]
struct RootFactors {
    gain: f64,
    roots: Vec<Complex64>,
}

impl RootFactors {
    fn product(gain: f64, left: &[Complex64], right: &[Complex64]) -> Self {
        RootFactors { gain, roots: [left, right].concat() }
    }

    /// Value and derivative at s.
    fn evaluate(&self, s: Complex64) -> (ComplexDoubleDouble, ComplexDoubleDouble) {
        let mut value = ComplexDoubleDouble::from(self.gain);
        let mut slope = ComplexDoubleDouble::default();
        for &root in &self.roots {
            let factor = ComplexDoubleDouble::difference_of(s, root);
            slope = slope * factor + value;
            value = value * factor;
        }
        (value, slope)
    }

    /// Factors of the sum of two products. Leading and trailing coefficients that cancel to
    /// rounding are zero.
    fn sum(&self, other: &RootFactors) -> Result<RootFactors, LinearError> {
        let (left, right) = (expand(self.gain, &self.roots), expand(other.gain, &other.roots));
        let length = left.len().max(right.len());
        let padded = |c: &[DoubleDouble], i: usize| {
            (i + c.len()).checked_sub(length).and_then(|k| c.get(k)).copied().unwrap_or_default()
        };
        let mut coefficients = Vec::with_capacity(length);
        let mut negligible = Vec::with_capacity(length);
        for index in 0..length {
            let (a, b) = (padded(&left, index), padded(&right, index));
            let sum = (a + b).value();
            coefficients.push(sum);
            negligible.push(sum.abs() <= 4.0 * f64::EPSILON * (a.abs() + b.abs()).value());
        }
        let clear = |pair: (&mut f64, &bool)| *pair.0 = 0.0;
        coefficients.iter_mut().zip(&negligible).take_while(|(_, small)| **small).for_each(clear);
        coefficients.iter_mut().zip(&negligible).rev().take_while(|(_, small)| **small).for_each(clear);
        let polynomial = Polynomial::new(coefficients);
        if polynomial.is_zero() {
            return Ok(RootFactors { gain: 0.0, roots: Vec::new() });
        }
        let mut roots = polynomial.roots()?;
        refine(&mut roots, 6, |s| {
            let ((a, a_slope), (b, b_slope)) = (self.evaluate(s), other.evaluate(s));
            let step = (a + b).value() / (a_slope + b_slope).value();
            step.is_finite().then_some(step)
        });
        Ok(RootFactors { gain: polynomial.leading_coefficient(), roots: symmetrise(&roots) })
    }
}

impl TransferFunction {
    /// Both systems in series; common factors are kept, dead times add.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`].
    pub fn series(&self, other: &TransferFunction) -> Result<Self, LinearError> {
        let domain = self.common_domain(other)?;
        let zeros = [self.zeros(), other.zeros()].concat();
        let poles = [self.poles(), other.poles()].concat();
        TransferFunction::assembled(self.gain() * other.gain(), zeros, poles, domain)
            .with_dead_time(self.dead_time_s() + other.dead_time_s())
    }

    /// Sum of both systems. Exactly equal poles appear once.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`]; [`LinearError::NotRational`] when the dead times differ.
    pub fn parallel(&self, other: &TransferFunction) -> Result<Self, LinearError> {
        let domain = self.common_domain(other)?;
        if self.dead_time_s() != other.dead_time_s() {
            return Err(LinearError::NotRational { operation: LinearOperation::Sum });
        }
        let mut only_other = other.poles().to_vec();
        let mut only_self = Vec::new();
        for &pole in self.poles() {
            match only_other.iter().position(|&candidate| candidate == pole) {
                Some(index) => drop(only_other.remove(index)),
                None => only_self.push(pole),
            }
        }
        let left = RootFactors::product(self.gain(), self.zeros(), &only_other);
        let right = RootFactors::product(other.gain(), other.zeros(), &only_self);
        let numerator = left.sum(&right)?;
        let poles = [self.poles(), &only_other].concat();
        TransferFunction::assembled(numerator.gain, numerator.roots, poles, domain)
            .with_dead_time(self.dead_time_s())
    }

    /// System closed by `other` in negative feedback, P / (1 + P H). Common factors of P and H are
    /// kept.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`]; [`LinearError::NotRational`] with dead time in the loop;
    /// [`LinearError::IllPosedLoop`] when the loop's gain at infinite frequency is -1.
    pub fn feedback(&self, other: &TransferFunction) -> Result<Self, LinearError> {
        let domain = self.common_domain(other)?;
        if self.dead_time_s() != 0.0 || other.dead_time_s() != 0.0 {
            return Err(LinearError::NotRational { operation: LinearOperation::ClosedLoop });
        }
        let open = RootFactors::product(1.0, self.poles(), other.poles());
        let loop_numerator = RootFactors::product(self.gain() * other.gain(), self.zeros(), other.zeros());
        let characteristic = open.sum(&loop_numerator)?;
        let degree = open.roots.len().max(loop_numerator.roots.len());
        if characteristic.roots.len() < degree || characteristic.gain == 0.0 {
            return Err(LinearError::IllPosedLoop);
        }
        let zeros = [self.zeros(), other.poles()].concat();
        let gain = self.gain() / characteristic.gain;
        Ok(TransferFunction::assembled(gain, zeros, characteristic.roots, domain))
    }

    fn common_domain(&self, other: &TransferFunction) -> Result<super::TimeDomain, LinearError> {
        if self.domain() == other.domain() {
            return Ok(self.domain());
        }
        // a pure gain fits either domain
        let is_gain = |system: &TransferFunction| {
            system.zeros().is_empty() && system.poles().is_empty() && system.dead_time_s() == 0.0
        };
        if is_gain(other) {
            Ok(self.domain())
        } else if is_gain(self) {
            Ok(other.domain())
        } else {
            Err(LinearError::DomainMismatch)
        }
    }
}

impl StateSpace {
    /// System followed by `next`, whose inputs are this system's outputs.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`], [`LinearError::Shape`].
    pub fn series(&self, next: &StateSpace) -> Result<Self, LinearError> {
        self.check_join(next, "the next system's D", next.d().shape(), (next.outputs(), self.outputs()))?;
        let a = blocks(self.a(), &zeros(self.order(), next.order()), &(next.b() * self.c()), next.a());
        let b = stacked(self.b(), &(next.b() * self.d()));
        let c = stacked(&(next.d() * self.c()).transpose(), &next.c().transpose()).transpose();
        StateSpace::new(a, b, c, next.d() * self.d(), self.domain())
    }

    /// Sum of both systems' outputs for one input.
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`], [`LinearError::Shape`].
    pub fn parallel(&self, other: &StateSpace) -> Result<Self, LinearError> {
        self.check_join(other, "the other system's D", other.d().shape(), self.d().shape())?;
        let (own, others) = (self.order(), other.order());
        let a = blocks(self.a(), &zeros(own, others), &zeros(others, own), other.a());
        let b = stacked(self.b(), other.b());
        let c = stacked(&self.c().transpose(), &other.c().transpose()).transpose();
        StateSpace::new(a, b, c, self.d() + other.d(), self.domain())
    }

    /// System closed by `other` in negative feedback.
    ///
    /// ```text
    /// u = r - H y
    /// ```
    ///
    /// # Errors
    /// [`LinearError::DomainMismatch`], [`LinearError::Shape`], [`LinearError::IllPosedLoop`] when
    /// I + H D is singular.
    pub fn feedback(&self, other: &StateSpace) -> Result<Self, LinearError> {
        let expected = (self.inputs(), self.outputs());
        self.check_join(other, "the feedback system's D", other.d().shape(), expected)?;
        // e = r - H y,  y = C x + D e  =>  e = E (r - D_h C x - C_h x_h),  E = (I + D_h D)^-1
        let identity = DMatrix::<f64>::identity(self.inputs(), self.inputs());
        let e = (identity + other.d() * self.d()).try_inverse().ok_or(LinearError::IllPosedLoop)?;
        let from_own = -(&e * other.d() * self.c());
        let from_other = -(&e * other.c());
        let c_own = self.c() + self.d() * &from_own;
        let c_other = self.d() * &from_other;
        let d = self.d() * &e;
        let a = blocks(
            &(self.a() + self.b() * &from_own),
            &(self.b() * &from_other),
            &(other.b() * &c_own),
            &(other.a() + other.b() * &c_other),
        );
        let b = stacked(&(self.b() * &e), &(other.b() * &d));
        let c = stacked(&c_own.transpose(), &c_other.transpose()).transpose();
        StateSpace::new(a, b, c, d, self.domain())
    }

    fn check_join(
        &self,
        other: &StateSpace,
        matrix: &'static str,
        found: (usize, usize),
        expected: (usize, usize),
    ) -> Result<(), LinearError> {
        if self.domain() != other.domain() {
            return Err(LinearError::DomainMismatch);
        }
        if found != expected {
            return Err(LinearError::Shape { matrix, found, expected });
        }
        Ok(())
    }
}

fn zeros(rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::zeros(rows, columns)
}

fn stacked(top: &DMatrix<f64>, bottom: &DMatrix<f64>) -> DMatrix<f64> {
    let mut result = DMatrix::zeros(top.nrows() + bottom.nrows(), top.ncols());
    result.rows_mut(0, top.nrows()).copy_from(top);
    result.rows_mut(top.nrows(), bottom.nrows()).copy_from(bottom);
    result
}

/// [a b; c d]
fn blocks(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>, d: &DMatrix<f64>) -> DMatrix<f64> {
    let left = stacked(a, c).transpose();
    let right = stacked(b, d).transpose();
    stacked(&left, &right).transpose()
}
