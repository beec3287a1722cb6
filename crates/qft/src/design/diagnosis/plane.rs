//! The half plane on which S and T are analytic, and the harmonic measure of its boundary.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::order::sort_numbers;
use phea_dynamics::portable;

/// The open right half plane of s or, for a sampled loop, the half plane to which the outside of
/// the unit circle is mapped:
///
/// ```text
/// sigma = (2/T) (z - 1)/(z + 1),     z = e^(jwT)  ->  j (2/T) tan(w T/2)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) sample_time_s: Option<f64>,
}

impl Plane {
    /// Place of a frequency on the boundary.
    pub(super) fn place(self, frequency: f64) -> f64 {
        match self.sample_time_s {
            None => frequency,
            Some(sample) if frequency * sample >= PI => f64::INFINITY,
            Some(sample) => 2.0 / sample * portable::tan(frequency * sample / 2.0),
        }
    }

    /// The frequency of a place on the boundary, rad/s.
    pub(super) fn frequency(self, place: f64) -> f64 {
        match self.sample_time_s {
            None => place,
            Some(sample) => 2.0 / sample * portable::atan(place * sample / 2.0),
        }
    }

    /// Image of a root of the continuous plant: z = e^(sT) in a sampled loop.
    pub(super) fn image(self, root: Complex64) -> Complex64 {
        match self.sample_time_s {
            None => root,
            Some(sample) => {
                let decay = portable::exp_complex(-root * sample);
                (1.0 - decay) / (1.0 + decay) * (2.0 / sample)
            }
        }
    }

    /// Root whose image this or its conjugate is, ln(z)/T in a sampled loop.
    pub(super) fn root(self, image: Complex64) -> Complex64 {
        match self.sample_time_s {
            None => image,
            Some(sample) => {
                let half = image * (sample / 2.0);
                let z = (1.0 + half) / (1.0 - half);
                Complex64::new(portable::ln(portable::magnitude(z)), portable::argument(z).abs()) / sample
            }
        }
    }

    /// The image of z = infinity: where every sample of delay has a zero.
    pub(super) fn image_of_delay(self) -> Option<f64> {
        self.sample_time_s.map(|sample| 2.0 / sample)
    }
}

/// Harmonic measure: the weight, at a point, of the boundary between two places and between their
/// conjugates.
///
/// ```text
/// (1/pi) integral of Re s0/|s0 - j w|^2 dw = (1/pi) [atan((w - Im s0)/Re s0)]        1 for the whole axis
/// ```
pub(super) fn fraction(point: Complex64, [from, to]: [f64; 2]) -> f64 {
    let angle = |place: f64| portable::atan((place - point.im) / point.re);
    let mirrored = |place: f64| portable::atan((place + point.im) / point.re);
    (angle(to) - angle(from) + mirrored(to) - mirrored(from)) / PI
}

/// The magnitude at a point of the function of magnitude 1 on the boundary that vanishes at exactly
/// these roots (Blaschke).
///
/// ```text
/// prod |s0 - r|/|s0 + conj r|
/// ```
pub(super) fn vanishing(point: Complex64, roots: &[Complex64]) -> f64 {
    let factor =
        |root: &Complex64| portable::magnitude(point - root) / portable::magnitude(point + root.conj());
    roots.iter().map(factor).product()
}

/// The boundary cut into cells, with two frequencies in each at which limits are taken.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BoundaryCells {
    pub(super) plane: Plane,
    /// `[from, to]` of each cell.
    pub(super) cells: Vec<[f64; 2]>,
    /// Frequencies, two for each cell, rad/s.
    pub(super) frequencies: Vec<f64>,
    /// The last frequency of interest: beyond it the limits are powers of s.
    pub(super) highest: f64,
}

const CELLS_PER_DECADE: f64 = 48.0;
const DECADES_MAXIMUM: f64 = 14.0;
/// Factor by which the cells extend beyond the frequencies of interest.
const REACH: f64 = 1e3;

impl BoundaryCells {
    /// Cells around these places, none of which is inside a cell. On the first and the last cell
    /// the mean logarithm of a power of s is exact.
    pub(super) fn new(plane: Plane, places: &[f64]) -> BoundaryCells {
        let sound = |place: &&f64| **place > 0.0 && place.is_finite();
        let places: Vec<f64> = places.iter().filter(sound).copied().collect();
        let least = places.iter().copied().fold(f64::INFINITY, f64::min).min(f64::MAX);
        let greatest = places.iter().copied().fold(0.0, f64::max);
        let (low, high) = if places.is_empty() { (1.0, 1.0) } else { (least, greatest) };
        let low = low / REACH;
        let decades = portable::log10(high * REACH / low).min(DECADES_MAXIMUM);
        let count = (decades * CELLS_PER_DECADE).ceil();
        let step = decades * std::f64::consts::LN_10 / count;
        let mut ends: Vec<f64> =
            (0..=count as u32).map(|index| low * portable::exp(step * f64::from(index))).collect();
        ends.extend(places.iter().filter(|place| **place > low));
        sort_numbers(&mut ends);
        ends.dedup_by(|next, last| *next <= *last * (1.0 + 1e-9));
        let last = ends.last().copied().unwrap_or(low);
        let mut cells = vec![[0.0, low]];
        cells.extend(ends.iter().zip(ends.iter().skip(1)).map(|(&from, &to)| [from, to]));
        cells.push([last, f64::INFINITY]);
        let frequencies = cells.iter().flat_map(|cell| nodes(*cell)).map(|place| plane.frequency(place));
        BoundaryCells { plane, frequencies: frequencies.collect(), cells, highest: high }
    }
}

/// The two Gauss points in the logarithm of frequency; on the first and the last cell the point at
/// which a logarithm equals its mean.
fn nodes([from, to]: [f64; 2]) -> [f64; 2] {
    let e = std::f64::consts::E;
    if from == 0.0 {
        return [to / e; 2];
    }
    if to == f64::INFINITY {
        return [from * e; 2];
    }
    let half = portable::ln(to / from) / 2.0;
    let middle = (from * to).sqrt();
    let apart = portable::exp(half / 3.0_f64.sqrt());
    [middle / apart, middle * apart]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean value theorem for harmonic functions: ln|f| of a function without zeros in the
    /// right half plane is the mean of its boundary values, in either plane.
    #[test]
    fn the_mean_over_the_boundary_is_the_value_at_the_point() {
        for (sample_time_s, point) in [
            (None, Complex64::new(2.0, 0.0)),
            (None, Complex64::new(0.3, 4.0)),
            (Some(0.1), Complex64::new(7.0, 3.0)),
        ] {
            let plane = Plane { sample_time_s };
            let boundary = BoundaryCells::new(plane, &[0.5, 3.0, 10.0]);
            let function = |s: Complex64| (s + 3.0) / (s * s + s * 0.5 + 9.0) / (s + 10.0);
            let value = |frequency: f64| {
                portable::ln(portable::magnitude(function(Complex64::new(0.0, plane.place(frequency)))))
            };
            let mean: f64 = boundary
                .cells
                .iter()
                .zip(boundary.frequencies.chunks_exact(2))
                .map(|(cell, nodes)| fraction(point, *cell) * (value(nodes[0]) + value(nodes[1])) / 2.0)
                .sum();
            let truth = portable::ln(portable::magnitude(function(point)));
            assert!((mean - truth).abs() < 1e-3, "{mean} {truth}");
        }
    }

    #[test]
    fn roots_come_back_and_frequencies_lie_where_their_image_is() {
        let plane = Plane { sample_time_s: Some(0.2) };
        let root = Complex64::new(1.5, 4.0);
        assert!((plane.root(plane.image(root)) - root).norm_sqr() < 1e-24);
        assert!((plane.image(Complex64::new(0.0, 4.0)).im - plane.place(4.0)).abs() < 1e-12);
        assert!((plane.frequency(plane.place(4.0)) - 4.0).abs() < 1e-12);
    }
}
