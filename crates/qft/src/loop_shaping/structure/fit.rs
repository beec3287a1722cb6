//! Conversion of a controller to a structure: the point at which a structure equals it, and the
//! structure around it.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Element};
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::{Structure, StructureFactor};

/// Relative distance below which roots count as equal.
const SAME: f64 = 1e-9;

impl Structure {
    /// The x at which this structure equals that controller; `None` if there is none within the
    /// bounds.
    ///
    /// A complex pair of roots or any two real ones go to a pair, a real root to a single factor:
    /// the first assignment within the bounds is used, in the order of the roots' magnitude.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Element};
    /// use phea_qft::loop_shaping::{StructureFactor, Structure};
    /// let parts = vec![StructureFactor::PolePair { natural_frequency: [1.0, 100.0], damping_ratio: [0.1, 10.0] }];
    /// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts };
    /// let given = [Element::Gain(2.0), Element::RealPole { frequency: 4.0 }, Element::RealPole { frequency: 9.0 }];
    /// let x = structure.point_of(&Compensator::new(given.to_vec())).ok_or("it fits")?;
    /// let found = x.iter().map(|x| x.exp()).collect::<Vec<_>>(); // k, sqrt(4 9), (4 + 9)/(2 sqrt(4 9))
    /// assert!([2.0, 6.0, 13.0 / 12.0].iter().zip(&found).all(|(expected, found)| (expected - found).abs() < 1e-14));
    /// assert_eq!(structure.point_of(&Compensator::new(vec![Element::Integrator])), None);
    /// # Ok::<(), &str>(())
    /// ```
    pub fn point_of(&self, compensator: &Compensator) -> Option<Vec<f64>> {
        let function = compensator.transfer_function().ok()?;
        let fixed = self.fixed().ok()?;
        let continuous = [&function, &fixed].iter().all(|part| part.domain() == TimeDomain::Continuous);
        if !continuous || function.dead_time_s() != fixed.dead_time_s() {
            return None;
        }
        let mut others =
            [without(function.zeros(), fixed.zeros())?, without(function.poles(), fixed.poles())?];
        let notches = self.parts.iter().filter(|part| matches!(part, StructureFactor::Notch { .. }));
        let notches: Option<Vec<[f64; 3]>> = notches.map(|part| taken_notch(part, &mut others)).collect();
        let mut notches = notches?.into_iter();
        let mut zeros = self.assigned(1.0, &others[0])?.into_iter();
        let mut poles = self.assigned(-1.0, &others[1])?.into_iter();
        let mut gain = self.sign * function.gain() / fixed.gain();
        let mut numbers = Vec::new();
        for part in &self.parts {
            let &[factor] = part.factors() else {
                // its gain is 1 at zero frequency and at infinity
                if !part.factors().is_empty() {
                    numbers.extend(notches.next()?);
                }
                continue;
            };
            let own = if factor.power > 0.0 { zeros.next()? } else { poles.next()? };
            let frequency = *own.first()?;
            let leading = if factor.pair { frequency * frequency } else { frequency };
            gain = if factor.power > 0.0 { gain * leading } else { gain / leading };
            numbers.extend(own);
        }
        let all: Vec<f64> = std::iter::once(gain).chain(numbers).map(portable::ln).collect();
        let ranges: Vec<[f64; 2]> = self.ranges().map(|range| range.map(portable::ln)).collect();
        // the ends of the range are included
        let inside = |(x, [low, high]): (&f64, &[f64; 2])| low - SAME <= *x && *x <= high + SAME;
        all.iter().zip(&ranges).all(inside).then(|| {
            let clamped = all.iter().zip(&ranges).map(|(x, [low, high])| x.max(*low).min(*high));
            self.of_free(clamped)
        })
    }

    /// A structure with the poles and zeros of this controller, each number free within this factor
    /// (above 1) up and down, and the point at which it equals the controller. Roots at the origin,
    /// on the imaginary axis and in the right half plane remain fixed. `None` for a sampled
    /// controller, one with zero gain, and a factor that is not above 1.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::Element;
    /// use phea_qft::loop_shaping::{StructureFactor, Structure};
    /// let integral = Element::ProportionalIntegral { proportional_gain: 0.001, integral_gain: 0.008 };
    /// let published = integral.transfer_function()?; // 0.008 (s/8 + 1)/s
    /// let (structure, x) = Structure::around(&published, 10.0).ok_or("a structure")?;
    /// assert_eq!(structure.parts[0], StructureFactor::Fixed(Element::Integrator));
    /// let zero = &structure.parts[1];
    /// assert!(matches!(zero, StructureFactor::RealZero { frequency: [low, high] } if (low * high - 64.0).abs() < 1e-12));
    /// assert!((x[0].exp() - 0.008).abs() < 1e-17 && (x[1].exp() - 8.0).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn around(function: &TransferFunction, factor: f64) -> Option<(Structure, Vec<f64>)> {
        let sound = factor > 1.0 && factor.is_finite() && function.gain() != 0.0;
        if !sound || function.domain() != TimeDomain::Continuous {
            return None;
        }
        let free = |value: f64| [value / factor, value * factor];
        let (mut parts, mut gain) = (vec![], function.gain());
        let mut numbers = vec![];
        let (mut other_zeros, mut other_poles) = (vec![], vec![]);
        for (roots, power, others) in
            [(function.poles(), -1.0, &mut other_poles), (function.zeros(), 1.0, &mut other_zeros)]
        {
            for &root in roots.iter().filter(|root| root.im >= 0.0) {
                if root == Complex64::new(0.0, 0.0) {
                    parts.push(StructureFactor::Fixed(if power > 0.0 {
                        Element::Differentiator
                    } else {
                        Element::Integrator
                    }));
                    continue;
                }
                if root.re >= 0.0 {
                    others.push(root);
                    others.extend((root.im > 0.0).then(|| root.conj()));
                    continue;
                }
                let own = if root.im > 0.0 { of_pair([root, root.conj()]) } else { vec![-root.re] };
                let leading = own.iter().take(1).map(|w| if root.im > 0.0 { w * w } else { *w });
                leading.for_each(|leading| gain = if power > 0.0 { gain * leading } else { gain / leading });
                parts.push(part(power, &own, free)?);
                numbers.extend(own);
            }
        }
        let other = TransferFunction::from_factors(1.0, other_zeros, other_poles).ok()?;
        let other = other.with_dead_time(function.dead_time_s()).ok()?;
        if other != TransferFunction::gain_only(1.0) {
            parts.push(StructureFactor::Fixed(Element::General(other)));
        }
        let structure = Structure { sign: gain.signum(), gain: free(gain.abs()), parts };
        let x = std::iter::once(gain.abs()).chain(numbers).map(portable::ln).collect();
        Some((structure, x))
    }

    /// The free numbers of each factor of this power, in turn, from the roots.
    fn assigned(&self, power: f64, roots: &[Complex64]) -> Option<Vec<Vec<f64>>> {
        let single = |part: &&StructureFactor| matches!(part.factors(), [own] if own.power == power);
        let ranges = self.parts.iter().filter(single);
        let ranges: Vec<Vec<[f64; 2]>> = ranges.map(|part| part.ranges().collect()).collect();
        let upper: Vec<Complex64> = roots.iter().copied().filter(|root| root.im >= 0.0).collect();
        assigned(&ranges, &upper)
    }
}

/// Assigns to each list of ranges a real root, or a pair of roots, within them, such that all roots
/// are used: the first choice that works, in the order of the roots' magnitude. Of complex roots
/// only the upper ones are given.
fn assigned(ranges: &[Vec<[f64; 2]>], roots: &[Complex64]) -> Option<Vec<Vec<f64>>> {
    let Some((own, others)) = ranges.split_first() else { return roots.is_empty().then(Vec::new) };
    let left = |taken: &[usize]| -> Vec<Complex64> {
        let left = roots.iter().enumerate().filter(|(index, _)| !taken.contains(index));
        left.map(|(_, root)| *root).collect()
    };
    let of = |taken: &[usize], numbers: Vec<f64>| {
        let inside = |(value, [low, high]): (&f64, &[f64; 2])| {
            low * (1.0 - SAME) <= *value && *value <= high * (1.0 + SAME)
        };
        let fits = numbers.iter().zip(own).all(inside);
        fits.then(|| assigned(others, &left(taken))).flatten().map(|rest| [vec![numbers], rest].concat())
    };
    roots.iter().enumerate().find_map(|(index, &root)| match (own.len(), root.im > 0.0) {
        (1, false) => of(&[index], vec![-root.re]),
        (2, true) => of(&[index], of_pair([root, root.conj()])),
        (2, false) => roots.iter().enumerate().skip(index + 1).find_map(|(second, &other)| {
            (other.im == 0.0).then(|| of(&[index, second], of_pair([root, other]))).flatten()
        }),
        _ => None,
    })
}

/// Natural frequency, damping ratio and depth of a notch within the ranges of this part, and its
/// roots taken from the zeros and poles: the deepest one whose pairs have one natural frequency.
fn taken_notch(part: &StructureFactor, [zeros, poles]: &mut [Vec<Complex64>; 2]) -> Option<[f64; 3]> {
    let ranges: Vec<[f64; 2]> = part.ranges().collect();
    let mut best: Option<([f64; 3], [[usize; 2]; 2])> = None;
    for (of_zeros, zero_numbers) in pairs(zeros) {
        for (of_poles, pole_numbers) in pairs(poles) {
            let [frequency, damping] = pole_numbers;
            let numbers = [frequency, damping, zero_numbers[1] / damping];
            let same = (zero_numbers[0] / frequency - 1.0).abs() <= SAME;
            let inside = |(value, [low, high]): (&f64, &[f64; 2])| {
                low * (1.0 - SAME) <= *value && *value <= high * (1.0 + SAME)
            };
            if same
                && numbers.iter().zip(&ranges).all(inside)
                && best.is_none_or(|(known, _)| numbers[2] < known[2])
            {
                best = Some((numbers, [of_zeros, of_poles]));
            }
        }
    }
    let (numbers, taken) = best?;
    for (roots, taken) in [zeros, poles].into_iter().zip(taken) {
        let cache = roots.iter().enumerate().filter(|(index, _)| !taken.contains(index));
        *roots = cache.map(|(_, root)| *root).collect();
    }
    Some(numbers)
}

/// Every two roots that may form a pair, with their natural frequency and damping ratio.
fn pairs(roots: &[Complex64]) -> Vec<([usize; 2], [f64; 2])> {
    let mut found = Vec::new();
    for (first, &one) in roots.iter().enumerate() {
        for (second, &other) in roots.iter().enumerate().skip(first + 1) {
            if (one.im == 0.0 && other.im == 0.0) || one == other.conj() {
                let numbers = of_pair([one, other]);
                found.push(([first, second], [numbers[0], numbers[1]]));
            }
        }
    }
    found
}

/// Natural frequency and damping ratio of a pair of roots.
///
/// ```text
/// (s - r)(s - t) = s^2 + 2 zeta w s + w^2:    w = sqrt(r t),    zeta = -(r + t)/(2 w)
/// ```
fn of_pair([one, other]: [Complex64; 2]) -> Vec<f64> {
    let natural_frequency = (one * other).re.sqrt();
    vec![natural_frequency, -0.5 * (one + other).re / natural_frequency]
}

/// The part of this power with these numbers in the middle of their ranges.
fn part(power: f64, numbers: &[f64], free: impl Fn(f64) -> [f64; 2]) -> Option<StructureFactor> {
    match (numbers, power > 0.0) {
        (&[w], true) => Some(StructureFactor::RealZero { frequency: free(w) }),
        (&[w], false) => Some(StructureFactor::RealPole { frequency: free(w) }),
        (&[w, zeta], true) => {
            Some(StructureFactor::ZeroPair { natural_frequency: free(w), damping_ratio: free(zeta) })
        }
        (&[w, zeta], false) => {
            Some(StructureFactor::PolePair { natural_frequency: free(w), damping_ratio: free(zeta) })
        }
        _ => None,
    }
}

/// The roots that remain when those have been removed; `None` if one of them is missing.
fn without(roots: &[Complex64], taken: &[Complex64]) -> Option<Vec<Complex64>> {
    let mut left = roots.to_vec();
    for root in taken {
        let same = |other: &Complex64| portable::magnitude(other - root) <= SAME * portable::magnitude(*root);
        let place = left.iter().position(same)?;
        left.remove(place);
    }
    Some(left)
}
