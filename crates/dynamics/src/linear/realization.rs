//! A transfer function as a cascade of first- and second-order sections.
//!
//! Each section keeps its poles on the diagonal of A, has about unit gain at its corner, and takes the zeros nearest to
//! it; the companion form of the whole would lose the small roots beside the large ones.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::{LinearError, StateSpace, TimeDomain, TransferFunction};
use crate::portable::magnitude;

/// One or two poles with at most as many zeros.
struct Section {
    poles: Vec<Complex64>,
    zeros: Vec<Complex64>,
}

pub(crate) fn cascade(system: &TransferFunction) -> Result<StateSpace, LinearError> {
    let delay = match system.domain() {
        _ if system.dead_time_s() == 0.0 => 0,
        TimeDomain::Continuous => return Err(LinearError::NotRational { operation: "a state space" }),
        TimeDomain::Discrete { sample_time_s } => whole_samples(system.dead_time_s() / sample_time_s),
    };
    let (zeros, poles) = (system.zeros(), system.poles());
    if zeros.len() > poles.len() {
        return Err(LinearError::Improper { zeros: zeros.len(), poles: poles.len() });
    }
    let domain = system.domain();
    let constant = |d: f64| StateSpace::new(zero(0, 0), zero(0, 1), zero(1, 0), scalar(d), domain);
    let mut result = constant(1.0)?;
    let mut remaining = system.gain();
    for section in sections(zeros, poles) {
        let gain = corner_gain(&section);
        remaining /= gain;
        result = result.series(&realise(&section, gain, domain)?)?;
    }
    for _ in 0..delay {
        let sample = StateSpace::new(scalar(0.0), scalar(1.0), scalar(1.0), scalar(0.0), domain)?;
        result = result.series(&sample)?;
    }
    result.series(&constant(remaining)?)
}

/// The nearest count; a dead time of a sampled system has been checked to be one.
pub(crate) fn whole_samples(samples: f64) -> usize {
    let mut count = 0_usize;
    let mut reached = 0.5;
    while reached < samples {
        count += 1;
        reached += 1.0;
    }
    count
}

fn scalar(value: f64) -> DMatrix<f64> {
    DMatrix::from_element(1, 1, value)
}

fn zero(rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::zeros(rows, columns)
}

/// Groups poles in pairs and gives each zero (or pair) to the nearest section with room.
fn sections(zeros: &[Complex64], poles: &[Complex64]) -> Vec<Section> {
    let complex_zeros: Vec<Complex64> = zeros.iter().copied().filter(|z| z.im > 0.0).collect();
    let real_zeros: Vec<Complex64> = zeros.iter().copied().filter(|z| z.im == 0.0).collect();
    let mut result: Vec<Section> = poles
        .iter()
        .filter(|pole| pole.im > 0.0)
        .map(|&pole| Section { poles: vec![pole.conj(), pole], zeros: vec![] })
        .collect();
    let real_poles: Vec<Complex64> = poles.iter().copied().filter(|pole| pole.im == 0.0).collect();
    let missing = complex_zeros.len().saturating_sub(result.len());
    // real poles share a section only where complex zeros need the room
    let (paired, single) = real_poles.split_at((2 * missing).min(real_poles.len()));
    result.extend(paired.chunks(2).map(|pair| Section { poles: pair.to_vec(), zeros: vec![] }));
    result.extend(single.iter().map(|&pole| Section { poles: vec![pole], zeros: vec![] }));
    for &zero in &complex_zeros {
        place(&mut result, &[zero.conj(), zero]);
    }
    for &zero in &real_zeros {
        place(&mut result, &[zero]);
    }
    result.sort_by(|a, b| size(a).total_cmp(&size(b)));
    result
}

fn size(section: &Section) -> f64 {
    section.poles.iter().map(|pole| magnitude(*pole)).fold(0.0, f64::max)
}

fn place(sections: &mut [Section], group: &[Complex64]) {
    let Some(&zero) = group.first() else { return };
    let distance = |section: &Section| {
        section.poles.iter().map(|pole| magnitude(pole - zero)).fold(f64::INFINITY, f64::min)
    };
    let with_room = sections.iter_mut().filter(|s| s.zeros.len() + group.len() <= s.poles.len());
    if let Some(section) = with_room.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        section.zeros.extend_from_slice(group);
    }
}

/// A power of two that brings the section to about unit gain at its corner.
fn corner_gain(section: &Section) -> f64 {
    let corner = Complex64::new(0.0, corner(section));
    let product = |roots: &[Complex64]| roots.iter().map(|root| magnitude(corner - root)).product::<f64>();
    let gain = product(&section.poles) / product(&section.zeros);
    if gain.is_finite() && gain > 0.0 { power_of_two(gain) } else { 1.0 }
}

fn corner(section: &Section) -> f64 {
    let size = size(section);
    if size > 0.0 { size } else { 1.0 }
}

fn power_of_two(value: f64) -> f64 {
    let (_, exponent) = libm::frexp(value);
    libm::ldexp(1.0, exponent)
}

fn realise(section: &Section, gain: f64, domain: TimeDomain) -> Result<StateSpace, LinearError> {
    let scale = power_of_two(corner(section));
    let proper = section.zeros.len() == section.poles.len();
    let d = if proper { gain } else { 0.0 };
    match section.poles[..] {
        [pole] => {
            // gain (s - z)/(s - p) = gain + gain (p - z)/(s - p)
            let residue = section.zeros.first().map_or(gain, |zero| gain * (pole.re - zero.re));
            let (b, c) = (scalar(scale), scalar(residue / scale));
            StateSpace::new(scalar(pole.re), b, c, scalar(d), domain)
        }
        [first, second] if first.im != 0.0 => {
            // x_2 = (s - sigma)/den, x_1 = scale/den, den = (s - sigma)^2 + omega^2
            let (sigma, omega) = (first.re, second.im);
            let a = DMatrix::from_row_slice(2, 2, &[sigma, scale, -omega * (omega / scale), sigma]);
            let (linear, constant) = match section.zeros[..] {
                [] => (0.0, gain),
                [z] => (gain, gain * (sigma - z.re)),
                [z, w] if z.im != 0.0 => {
                    let part = (sigma - z.re) * (sigma - z.re) + (w.im - omega) * (w.im + omega);
                    (2.0 * gain * (sigma - z.re), gain * part)
                }
                [z, w, ..] => {
                    let part = (sigma - z.re) * (sigma - w.re) - omega * omega;
                    (gain * (sigma - z.re + (sigma - w.re)), gain * part)
                }
            };
            let c = DMatrix::from_row_slice(1, 2, &[constant / scale / scale, linear / scale]);
            StateSpace::new(a, DMatrix::from_row_slice(2, 1, &[0.0, scale]), c, scalar(d), domain)
        }
        [first, second] => {
            // x_2 = 1/(s - p_2), x_1 = scale/((s - p_1)(s - p_2)); here the zeros are a complex pair or none
            let a = DMatrix::from_row_slice(2, 2, &[first.re, scale, 0.0, second.re]);
            let (linear, constant) = match section.zeros[..] {
                [z, w] => {
                    let sum = (first.re - z.re) + (second.re - w.re);
                    let value = (Complex64::new(first.re, 0.0) - z) * (Complex64::new(first.re, 0.0) - w);
                    (gain * sum, gain * value.re)
                }
                [z] => (gain, gain * (first.re - z.re)),
                _ => (0.0, gain),
            };
            let c = DMatrix::from_row_slice(1, 2, &[constant / scale / scale, linear / scale]);
            StateSpace::new(a, DMatrix::from_row_slice(2, 1, &[0.0, scale]), c, scalar(d), domain)
        }
        _ => StateSpace::new(zero(0, 0), zero(0, 1), zero(1, 0), scalar(gain), domain),
    }
}
