use std::f64::consts::PI;

use num_complex::Complex64;

use crate::portable::{cos, sin};

/// Discrete Fourier transform of a fixed length, any length.
///
/// ```text
/// X_k = sum over n of x_n exp(-2 pi i k n/N)
/// ```
///
/// Powers of two by halving (Cooley and Tukey 1965), other lengths as a convolution with a chirp
/// (Bluestein 1970). Not from a library, because libraries choose the vector instructions of the
/// processor and the platform's sine and cosine: their last digits differ from machine to machine.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::spectrum::Transform;
/// let alternating = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
/// let lines = Transform::new(6).of_real(&alternating);
/// assert!((lines[3] - 6.0).norm_sqr() < 1e-28);
/// assert!(lines.iter().enumerate().all(|(k, line)| k == 3 || line.norm_sqr() < 1e-28));
/// ```
#[derive(Clone, Debug)]
pub struct Transform {
    length: usize,
    /// Transform whose length is the power of two.
    halving: Halving,
    /// Chirp, if the length is not a power of two.
    chirp: Option<Chirp>,
}

impl Transform {
    /// Transform for signals of this many samples, at least one.
    pub fn new(length: usize) -> Transform {
        let length = length.max(1);
        if length.is_power_of_two() {
            return Transform { length, halving: Halving::new(length), chirp: None };
        }
        let halving = Halving::new((2 * length - 1).next_power_of_two());
        let chirp = Chirp::new(length, &halving);
        Transform { length, halving, chirp: Some(chirp) }
    }

    /// Number of samples of a signal.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Transform of a signal; one of another length is cut or padded with zeros.
    pub fn of(&self, samples: &[Complex64]) -> Vec<Complex64> {
        let mut values = samples.to_vec();
        values.resize(self.length, Complex64::ZERO);
        match &self.chirp {
            None => self.halving.transform(&mut values),
            Some(chirp) => values = chirp.transform(&values, &self.halving),
        }
        values
    }

    /// Transform of a real signal, all of its N lines.
    pub fn of_real(&self, samples: &[f64]) -> Vec<Complex64> {
        let samples: Vec<Complex64> = samples.iter().map(|value| Complex64::new(*value, 0.0)).collect();
        self.of(&samples)
    }

    /// Output of a linear system for a real signal, as if the signal repeated. `response` is the
    /// response of the system at an angle in radians per sample. The mean of the signal is
    /// discarded, since an integrator has an infinite response to it.
    ///
    /// # Example
    /// A delay of one sample.
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::portable::exp_complex;
    /// use phea_dynamics::spectrum::Transform;
    /// let delay = |angle: f64| exp_complex(Complex64::new(0.0, -angle));
    /// let delayed = Transform::new(4).filtered(&[0.0, 3.0, -1.0, -2.0], &delay);
    /// for (value, expected) in delayed.iter().zip([-2.0, 0.0, 3.0, -1.0]) {
    ///     assert!((value - expected).abs() < 1e-14);
    /// }
    /// ```
    pub fn filtered(&self, samples: &[f64], response: &dyn Fn(f64) -> Complex64) -> Vec<f64> {
        let count = self.length;
        let mut lines = self.of_real(samples);
        for (index, line) in lines.iter_mut().enumerate() {
            let from_end = count - index;
            let angle = 2.0 * PI * index.min(from_end) as f64 / count as f64;
            *line = match index {
                0 => Complex64::ZERO,
                _ if index == from_end => *line * response(angle).re,
                _ if index < from_end => (*line * response(angle)).conj(),
                _ => (*line * response(angle).conj()).conj(),
            };
        }
        self.of(&lines).into_iter().map(|value| value.re / count as f64).collect()
    }
}

/// Transform whose length is a power of two.
#[derive(Clone, Debug)]
struct Halving {
    /// Factors exp(-2 pi i j/N), j < N/2.
    rotations: Vec<Complex64>,
}

impl Halving {
    fn new(length: usize) -> Halving {
        let rotation = |index: usize| turned(-2.0 * PI * index as f64 / length as f64);
        Halving { rotations: (0..length / 2).map(rotation).collect() }
    }

    fn transform(&self, values: &mut [Complex64]) {
        let length = values.len();
        if length < 2 {
            return;
        }
        let unused = usize::BITS - length.trailing_zeros();
        for index in 0..length {
            let mirrored = index.reverse_bits() >> unused;
            if mirrored > index {
                values.swap(index, mirrored);
            }
        }
        let mut half = 1;
        while half < length {
            let stride = length / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (even, odd) = block.split_at_mut(half);
                let rotations = self.rotations.iter().step_by(stride);
                for ((even, odd), rotation) in even.iter_mut().zip(odd).zip(rotations) {
                    let turned = *odd * rotation;
                    (*even, *odd) = (*even + turned, *even - turned);
                }
            }
            half *= 2;
        }
    }
}

/// Transform of any length as a convolution.
///
/// ```text
/// X_k = c_k sum over n of (x_n c_n) c*_(k-n)        c_n = exp(-i pi n^2/N)
/// ```
#[derive(Clone, Debug)]
struct Chirp {
    /// Values c_n.
    values: Vec<Complex64>,
    /// Transform of c*, over the length of the convolution.
    spectrum: Vec<Complex64>,
}

impl Chirp {
    fn new(length: usize, halving: &Halving) -> Chirp {
        let whole = 2 * halving.rotations.len();
        // n^2 modulo 2 N: the angle stays exact at any signal length
        let square = |n: usize| (n as u128 * n as u128 % (2 * length as u128)) as f64;
        let values: Vec<Complex64> = (0..length).map(|n| turned(-PI * square(n) / length as f64)).collect();
        let mut spectrum = vec![Complex64::ZERO; whole];
        for (n, value) in values.iter().enumerate() {
            for index in [n, (whole - n) % whole] {
                if let Some(slot) = spectrum.get_mut(index) {
                    *slot = value.conj();
                }
            }
        }
        halving.transform(&mut spectrum);
        Chirp { values, spectrum }
    }

    fn transform(&self, samples: &[Complex64], halving: &Halving) -> Vec<Complex64> {
        let whole = self.spectrum.len();
        let mut product: Vec<Complex64> = samples.iter().zip(&self.values).map(|(x, c)| x * c).collect();
        product.resize(whole, Complex64::ZERO);
        halving.transform(&mut product);
        // inverse by the forward transform of the conjugates
        for (value, factor) in product.iter_mut().zip(&self.spectrum) {
            *value = (*value * factor).conj();
        }
        halving.transform(&mut product);
        product.iter().zip(&self.values).map(|(value, c)| value.conj() * c / whole as f64).collect()
    }
}

fn turned(angle: f64) -> Complex64 {
    Complex64::new(cos(angle), sin(angle))
}
