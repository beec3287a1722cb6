//! Transcendental functions that are bit-identical on every machine.
//!
//! The platform's mathematical library differs between operating systems and versions; `libm` is
//! one implementation in Rust, used both natively and in WebAssembly. The lint
//! `clippy::disallowed_methods` keeps the methods of `f64` out. (`sqrt`, `abs` and the four
//! operations are exact by IEEE 754 and need no substitute.)

use num_complex::Complex64;

pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, erfc, exp, expm1, hypot, log as ln, log1p, log10, pow, sin,
    sinh, tan, tanh,
};

/// Nearest number with this many significant digits.
///
/// # Example
/// ```
/// # use phea_dynamics::portable::rounded;
/// assert_eq!([1234.56, -0.1, f64::INFINITY].map(|value| rounded(value, 3)), [1230.0, -0.1, f64::INFINITY]);
/// ```
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Magnitude |z|, free of overflow.
///
/// # Example
/// ```
/// # use phea_dynamics::portable::magnitude;
/// # use num_complex::Complex64;
/// assert_eq!(magnitude(Complex64::new(3.0, -4.0)), 5.0);
/// ```
pub fn magnitude(z: Complex64) -> f64 {
    hypot(z.re, z.im)
}

/// Principal argument of z in (-pi, pi], in radians.
///
/// # Example
/// ```
/// # use phea_dynamics::portable::argument;
/// # use num_complex::Complex64;
/// assert_eq!(argument(Complex64::new(0.0, 2.0)), std::f64::consts::FRAC_PI_2);
/// ```
pub fn argument(z: Complex64) -> f64 {
    atan2(z.im, z.re)
}

/// Complex exponential e^z = e^(Re z) (cos Im z + i sin Im z).
///
/// # Example
/// ```
/// # use phea_dynamics::portable::exp_complex;
/// # use num_complex::Complex64;
/// let half_turn = exp_complex(Complex64::new(0.0, std::f64::consts::PI));
/// assert!((half_turn - Complex64::new(-1.0, 0.0)).norm_sqr() < 1e-30);
/// ```
pub fn exp_complex(z: Complex64) -> Complex64 {
    let scale = exp(z.re);
    Complex64::new(scale * cos(z.im), scale * sin(z.im))
}

/// Principal square root of z, the one with Re >= 0.
///
/// # Example
/// ```
/// # use phea_dynamics::portable::sqrt_complex;
/// # use num_complex::Complex64;
/// assert_eq!(sqrt_complex(Complex64::new(-4.0, 0.0)), Complex64::new(0.0, 2.0));
/// ```
pub fn sqrt_complex(z: Complex64) -> Complex64 {
    let modulus = magnitude(z);
    let half = ((modulus + z.re.abs()) / 2.0).sqrt();
    if modulus == 0.0 {
        Complex64::new(0.0, 0.0)
    } else if z.re >= 0.0 {
        Complex64::new(half, z.im / (2.0 * half))
    } else {
        Complex64::new(z.im.abs() / (2.0 * half), half.copysign(z.im))
    }
}
