//! From a controller to a structure: the point at which a structure is it, and the structure around it.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Element};
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::{Factor, Part, Structure};

/// Roots nearer to one another than this share of their magnitude are the same.
const SAME: f64 = 1e-9;

impl Structure {
    /// The x at which this structure is that controller; `None` where it is no such one, or only beyond the bounds.
    ///
    /// Complex roots go to pairs, real ones to single factors and then two by two to the pairs that are left, each in the order of
    /// their magnitude, with the roots of the smallest magnitude to the factor that is written first.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::{Compensator, Element};
    /// use phea_qft::loop_shaping::{Part, Structure};
    /// let parts = vec![Part::PolePair { natural_frequency: [1.0, 100.0], damping_ratio: [0.1, 10.0] }];
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
        let mut zeros = self.assigned(1.0, without(function.zeros(), fixed.zeros())?)?.into_iter();
        let mut poles = self.assigned(-1.0, without(function.poles(), fixed.poles())?)?.into_iter();
        let mut gain = self.sign * function.gain() / fixed.gain();
        let mut numbers = Vec::new();
        for factor in self.factors() {
            let own = if factor.power > 0.0 { zeros.next()? } else { poles.next()? };
            let frequency = *own.first()?;
            let leading = if factor.pair { frequency * frequency } else { frequency };
            gain = if factor.power > 0.0 { gain * leading } else { gain / leading };
            numbers.extend(own);
        }
        let x: Vec<f64> = std::iter::once(gain).chain(numbers).map(portable::ln).collect();
        let bounds = self.bounds();
        // the ends of the range are points of it
        let inside = |(x, [low, high]): (&f64, &[f64; 2])| low - SAME <= *x && *x <= high + SAME;
        x.iter().zip(&bounds).all(inside).then(|| {
            let clamped = x.iter().zip(&bounds).map(|(x, [low, high])| x.max(*low).min(*high));
            clamped.collect()
        })
    }

    /// A structure with the poles and zeros of this controller, each number free within this factor (above 1) either way, and the
    /// point at which it is the controller. Roots at the origin, on the imaginary axis and in the right half plane stay as they
    /// are. `None` for a sampled controller, one with zero gain, and a factor that is not above 1.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::Element;
    /// use phea_qft::loop_shaping::{Part, Structure};
    /// let integral = Element::ProportionalIntegral { proportional_gain: 0.001, integral_gain: 0.008 };
    /// let published = integral.transfer_function()?; // 0.008 (s/8 + 1)/s
    /// let (structure, x) = Structure::around(&published, 10.0).ok_or("a structure")?;
    /// assert_eq!(structure.parts[0], Part::Fixed(Element::Integrator));
    /// let zero = &structure.parts[1];
    /// assert!(matches!(zero, Part::RealZero { frequency: [low, high] } if (low * high - 64.0).abs() < 1e-12));
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
                    parts.push(Part::Fixed(if power > 0.0 {
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
            parts.push(Part::Fixed(Element::General(other)));
        }
        let structure = Structure { sign: gain.signum(), gain: free(gain.abs()), parts };
        let x = std::iter::once(gain.abs()).chain(numbers).map(portable::ln).collect();
        Some((structure, x))
    }

    /// The free numbers of each factor of this power, in turn, from the roots; `None` where they do not fit.
    fn assigned(&self, power: f64, roots: Vec<Complex64>) -> Option<Vec<Vec<f64>>> {
        if roots.iter().any(|root| root.re >= 0.0) {
            return None;
        }
        let (real, complex): (Vec<Complex64>, Vec<Complex64>) =
            roots.into_iter().partition(|root| root.im == 0.0);
        let mut complex = complex.into_iter().filter(|root| root.im > 0.0);
        let mut real = real.into_iter();
        let factors: Vec<Factor> = self.factors().filter(|factor| factor.power == power).collect();
        let mut numbers: Vec<Option<Vec<f64>>> = factors
            .iter()
            .map(|factor| match factor.pair {
                true => complex.next().map(|root| of_pair([root, root.conj()])),
                false => real.next().map(|root| vec![-root.re]),
            })
            .collect();
        for (slot, _) in numbers.iter_mut().zip(&factors).filter(|(_, factor)| factor.pair) {
            if slot.is_none() {
                *slot = Some(of_pair([real.next()?, real.next()?]));
            }
        }
        if complex.next().is_some() || real.next().is_some() {
            return None;
        }
        numbers.into_iter().collect()
    }
}

/// Natural frequency and damping ratio of (s - r)(s - t) = s^2 + 2 zeta w s + w^2.
fn of_pair([one, other]: [Complex64; 2]) -> Vec<f64> {
    let natural_frequency = (one * other).re.sqrt();
    vec![natural_frequency, -0.5 * (one + other).re / natural_frequency]
}

/// The part of this power with these numbers in the middle of their ranges.
fn part(power: f64, numbers: &[f64], free: impl Fn(f64) -> [f64; 2]) -> Option<Part> {
    match (numbers, power > 0.0) {
        (&[w], true) => Some(Part::RealZero { frequency: free(w) }),
        (&[w], false) => Some(Part::RealPole { frequency: free(w) }),
        (&[w, zeta], true) => Some(Part::ZeroPair { natural_frequency: free(w), damping_ratio: free(zeta) }),
        (&[w, zeta], false) => Some(Part::PolePair { natural_frequency: free(w), damping_ratio: free(zeta) }),
        _ => None,
    }
}

/// The roots that are left when those have been taken away; `None` where one of them is not there.
fn without(roots: &[Complex64], taken: &[Complex64]) -> Option<Vec<Complex64>> {
    let mut left = roots.to_vec();
    for root in taken {
        let same = |other: &Complex64| portable::magnitude(other - root) <= SAME * portable::magnitude(*root);
        let place = left.iter().position(same)?;
        left.remove(place);
    }
    Some(left)
}
