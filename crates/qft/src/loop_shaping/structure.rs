//! A controller with free numbers.

mod fit;
mod response;
mod shorter;

use phea_dynamics::controller::{Compensator, Element};
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;

pub use response::StructureResponse;

/// Decibels per neper, 20/ln 10: the effect of a change of ln|G| by one.
pub(super) const DECIBELS_PER_NEPER: f64 = 20.0 / std::f64::consts::LN_10;

/// One factor of a structure. Every number is given by its least and greatest value; frequencies in
/// rad/s.
#[derive(Clone, Debug, PartialEq)]
pub enum StructureFactor {
    /// An element without free numbers, such as an integrator.
    Fixed(Element),
    /// Zero s/z + 1.
    RealZero {
        /// Corner z.
        frequency: [f64; 2],
    },
    /// Pole 1/(s/p + 1).
    RealPole {
        /// Corner p.
        frequency: [f64; 2],
    },
    /// Pair of zeros s^2/w^2 + 2 zeta s/w + 1; two real zeros if zeta is 1 or more.
    ZeroPair {
        /// Natural frequency w.
        natural_frequency: [f64; 2],
        /// Damping ratio zeta.
        damping_ratio: [f64; 2],
    },
    /// Pair of poles 1/(s^2/w^2 + 2 zeta s/w + 1); two real poles if zeta is 1 or more.
    PolePair {
        /// Natural frequency w.
        natural_frequency: [f64; 2],
        /// Damping ratio zeta.
        damping_ratio: [f64; 2],
    },
    /// Notch (s^2/w^2 + 2 d zeta s/w + 1)/(s^2/w^2 + 2 zeta s/w + 1); two real poles if zeta is 1
    /// or more.
    Notch {
        /// Natural frequency w.
        natural_frequency: [f64; 2],
        /// Damping ratio zeta of the poles.
        damping_ratio: [f64; 2],
        /// Depth d, the magnitude at w.
        depth: [f64; 2],
    },
}

/// A controller with free numbers: a gain of known sign and factors in series.
///
/// ```text
/// G(s; x) = sign k part_1(s) part_2(s) ...,      x = (ln k, ln of each free number in turn)
/// ```
///
/// The numbers of a pair are its natural frequency, then its damping ratio; for a notch, its depth
/// follows. A number whose least and greatest values are equal, including the gain, is not free: it
/// has no x.
///
/// # Example
/// Integral control with a lead whose two corners are free:
/// ```
/// use phea_dynamics::controller::Element;
/// use phea_dynamics::portable::ln;
/// use phea_qft::loop_shaping::{StructureFactor, Structure};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let corner = [0.1, 1000.0];
/// let parts = vec![
///     StructureFactor::Fixed(Element::Integrator),
///     StructureFactor::RealZero { frequency: corner },
///     StructureFactor::RealPole { frequency: corner },
/// ];
/// let structure = Structure { sign: 1.0, gain: [1e-3, 1e3], parts };
/// let x = [2.0, 5.0, 50.0].map(ln); // k, z, p
/// let g = structure.compensator(&x).transfer_function()?;
/// assert!((g.gain() - 20.0).abs() < 1e-12); // 2 (s/5 + 1)/(s (s/50 + 1))
/// assert_eq!((structure.order()?, structure.relative_degree()?, structure.dimension()), (2, 1, 3));
/// assert_eq!(structure.integrators(), 1);
/// assert!((structure.high_frequency_gain_db(&x)? - 26.0206).abs() < 1e-4); // of 20
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Sign of the gain: 1 or -1.
    pub sign: f64,
    /// Least and greatest magnitude of the gain k.
    pub gain: [f64; 2],
    /// The factors.
    pub parts: Vec<StructureFactor>,
}

/// Factor s/w + 1, or s^2/w^2 + 2 zeta s/w + 1, to the power of 1 or -1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Factor {
    power: f64,
    pair: bool,
}

/// A factor with its natural frequency and its damping ratio, 0 for a single root.
type NumberedFactor = (Factor, [f64; 2]);

/// Relative distance from the end of its range within which a number counts as being at that end.
const TOUCHED: f64 = 1e-6;
const ZERO: Factor = Factor { power: 1.0, pair: false };
const POLE: Factor = Factor { power: -1.0, pair: false };
const ZERO_PAIR: Factor = Factor { power: 1.0, pair: true };
const POLE_PAIR: Factor = Factor { power: -1.0, pair: true };

impl StructureFactor {
    /// The factors of the part's transfer function; none for an element without free numbers.
    fn factors(&self) -> &'static [Factor] {
        match self {
            StructureFactor::Fixed(_) => &[],
            StructureFactor::RealZero { .. } => &[ZERO],
            StructureFactor::RealPole { .. } => &[POLE],
            StructureFactor::ZeroPair { .. } => &[ZERO_PAIR],
            StructureFactor::PolePair { .. } => &[POLE_PAIR],
            StructureFactor::Notch { .. } => &[POLE_PAIR, ZERO_PAIR],
        }
    }

    /// The factors with these numbers.
    fn numbered(
        &self,
        numbers: &mut std::vec::IntoIter<f64>,
    ) -> impl Iterator<Item = NumberedFactor> + use<> {
        let mut next = || numbers.next().unwrap_or(f64::NAN);
        let two = match self {
            StructureFactor::Fixed(_) => [None, None],
            StructureFactor::RealZero { .. } => [Some((ZERO, [next(), 0.0])), None],
            StructureFactor::RealPole { .. } => [Some((POLE, [next(), 0.0])), None],
            StructureFactor::ZeroPair { .. } => [Some((ZERO_PAIR, [next(), next()])), None],
            StructureFactor::PolePair { .. } => [Some((POLE_PAIR, [next(), next()])), None],
            StructureFactor::Notch { .. } => {
                let [frequency, damping, depth] = [next(), next(), next()];
                [Some((POLE_PAIR, [frequency, damping])), Some((ZERO_PAIR, [frequency, damping * depth]))]
            }
        };
        two.into_iter().flatten()
    }

    /// Least and greatest value of each number.
    fn ranges(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let ranges = match *self {
            StructureFactor::Fixed(_) => [None; 3],
            StructureFactor::RealZero { frequency } | StructureFactor::RealPole { frequency } => {
                [Some(frequency), None, None]
            }
            StructureFactor::ZeroPair { natural_frequency, damping_ratio }
            | StructureFactor::PolePair { natural_frequency, damping_ratio } => {
                [Some(natural_frequency), Some(damping_ratio), None]
            }
            StructureFactor::Notch { natural_frequency, damping_ratio, depth } => {
                [Some(natural_frequency), Some(damping_ratio), Some(depth)]
            }
        };
        ranges.into_iter().flatten()
    }

    /// The element with these numbers.
    fn element(&self, mut numbers: impl Iterator<Item = f64>) -> Element {
        let mut next = || numbers.next().unwrap_or(f64::NAN);
        match self {
            StructureFactor::Fixed(element) => element.clone(),
            StructureFactor::RealZero { .. } => Element::RealZero { frequency: next() },
            StructureFactor::RealPole { .. } => Element::RealPole { frequency: next() },
            StructureFactor::ZeroPair { .. } => {
                Element::ComplexZeros { natural_frequency: next(), damping_ratio: next() }
            }
            StructureFactor::PolePair { .. } => {
                Element::ComplexPoles { natural_frequency: next(), damping_ratio: next() }
            }
            StructureFactor::Notch { .. } => {
                let [natural_frequency, pole_damping_ratio, depth] = [next(), next(), next()];
                let zero_damping_ratio = depth * pole_damping_ratio;
                Element::Notch { natural_frequency, zero_damping_ratio, pole_damping_ratio }
            }
        }
    }

    /// Nepers of high-frequency gain per unit of the logarithm of each number.
    fn high_frequency_slopes(&self) -> &'static [f64] {
        match self {
            StructureFactor::Fixed(_) => &[],
            StructureFactor::RealZero { .. } => &[-1.0],
            StructureFactor::RealPole { .. } => &[1.0],
            StructureFactor::ZeroPair { .. } => &[-2.0, 0.0],
            StructureFactor::PolePair { .. } => &[2.0, 0.0],
            StructureFactor::Notch { .. } => &[0.0, 0.0, 0.0],
        }
    }
}

impl Structure {
    /// A given element, without free numbers.
    pub fn fixed_to(function: &TransferFunction) -> Structure {
        let parts = vec![StructureFactor::Fixed(Element::General(function.clone()))];
        Structure { sign: 1.0, gain: [1.0, 1.0], parts }
    }

    /// Number of free numbers.
    pub fn dimension(&self) -> usize {
        self.ranges().filter(is_free).count()
    }

    /// Least and greatest value of each x, natural logarithms.
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        let free = self.ranges().filter(is_free);
        free.map(|range| range.map(portable::ln)).collect()
    }

    /// The controller at x: its gain, and an element for each part. A number missing in x is NaN.
    pub fn compensator(&self, x: &[f64]) -> Compensator {
        let mut numbers = self.numbers(x).into_iter();
        let gain = Element::Gain(self.sign * numbers.next().unwrap_or(f64::NAN));
        let elements = self.parts.iter().map(|part| part.element(&mut numbers));
        Compensator::new(std::iter::once(gain).chain(elements).collect())
    }

    /// The lowest permitted frequency of a zero, if a zero has it at x, rad/s.
    ///
    /// # Example
    /// ```
    /// # use phea_qft::loop_shaping::{Structure, StructureFactor};
    /// let parts = vec![StructureFactor::RealZero { frequency: [0.5, 100.0] }];
    /// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts };
    /// let at = |zero: f64| structure.slowest_zero_touched(&[0.0, zero.ln()]);
    /// assert_eq!([at(0.5), at(0.6), at(100.0)], [Some(0.5), None, None]);
    /// ```
    pub fn slowest_zero_touched(&self, x: &[f64]) -> Option<f64> {
        let numbers = self.numbers(x);
        let mut place = 1;
        self.parts.iter().find_map(|part| {
            let own = numbers.get(place).copied();
            place += part.ranges().count();
            let [least, greatest] = match part {
                StructureFactor::RealZero { frequency } => *frequency,
                StructureFactor::ZeroPair { natural_frequency, .. } => *natural_frequency,
                _ => return None,
            };
            (least < greatest && own? <= least * (1.0 + TOUCHED)).then_some(least)
        })
    }

    /// The index in x of the frequency of the first free pole, or pair of poles.
    ///
    /// # Example
    /// ```
    /// # use phea_qft::loop_shaping::{Structure, StructureFactor};
    /// let parts = [10.0, 20.0].map(|least| StructureFactor::RealPole { frequency: [least, 20.0] });
    /// let of = |parts: &[StructureFactor]| {
    ///     Structure { sign: 1.0, gain: [0.1, 10.0], parts: parts.to_vec() }.free_pole()
    /// };
    /// // behind the gain, which is free; a pole without a range has no place
    /// assert_eq!([of(&parts), of(&parts[1..])], [Some(1), None]);
    /// ```
    pub fn free_pole(&self) -> Option<usize> {
        let mut place = usize::from(is_free(&self.gain));
        for part in &self.parts {
            let ranges: Vec<[f64; 2]> = part.ranges().collect();
            let is_pole = matches!(part, StructureFactor::RealPole { .. } | StructureFactor::PolePair { .. });
            if is_pole && ranges.first().is_some_and(is_free) {
                return Some(place);
            }
            place += ranges.iter().filter(|range| is_free(range)).count();
        }
        None
    }

    /// Least and greatest value of every number, that of the gain first.
    fn ranges(&self) -> impl Iterator<Item = [f64; 2]> {
        std::iter::once(self.gain).chain(self.parts.iter().flat_map(StructureFactor::ranges))
    }

    /// Every number at x, the gain first.
    fn numbers(&self, x: &[f64]) -> Vec<f64> {
        let mut free = x.iter().map(|&x| portable::exp(x));
        let number = |range: [f64; 2]| {
            if is_free(&range) { free.next().unwrap_or(f64::NAN) } else { range[0] }
        };
        self.ranges().map(number).collect()
    }

    /// The entries of the free numbers, from a list for all numbers.
    fn of_free<T>(&self, all: impl IntoIterator<Item = T>) -> Vec<T> {
        let all = all.into_iter();
        let mut free = Vec::with_capacity(all.size_hint().0);
        free.extend(all.zip(self.ranges()).filter(|(_, range)| is_free(range)).map(|(one, _)| one));
        free
    }

    /// Number of integrators, s = 0 among the poles.
    #[must_use]
    pub fn integrators(&self) -> usize {
        let is_integrator =
            |part: &&StructureFactor| matches!(part, StructureFactor::Fixed(Element::Integrator));
        self.parts.iter().filter(is_integrator).count()
    }

    /// Number of poles.
    ///
    /// # Errors
    /// A fixed element that is not a transfer function.
    pub fn order(&self) -> Result<usize, LinearError> {
        Ok(self.degrees()?[1])
    }

    /// Relative degree r: poles less zeros.
    ///
    /// # Errors
    /// A fixed element that is not a transfer function.
    pub fn relative_degree(&self) -> Result<i32, LinearError> {
        let [zeros, poles] = self.degrees()?;
        Ok(poles as i32 - zeros as i32)
    }

    /// The high-frequency gain, dB.
    ///
    /// ```text
    /// 20 log10 |lim s^r G(s)|,      r the relative degree
    /// ```
    ///
    /// In a sampled loop it applies to the elements before sampling: by Tustin's rule s = (2/T)
    /// (z - 1)/(z + 1) goes to infinity as the frequency goes to pi/T, where G has its r zeros; the
    /// remaining factor there is this limit.
    ///
    /// # Errors
    /// A fixed element that is not a transfer function.
    pub fn high_frequency_gain_db(&self, x: &[f64]) -> Result<f64, LinearError> {
        let numbers = self.numbers(x).into_iter().map(portable::ln);
        let free: f64 =
            self.all_high_frequency_slopes_db().iter().zip(numbers).map(|(slope, x)| slope * x).sum();
        Ok(free + decibels(self.fixed()?.gain().abs()))
    }

    /// Slopes of the high-frequency gain, dB per unit of x; equal at every x.
    pub fn high_frequency_slopes_db(&self) -> Vec<f64> {
        self.of_free(self.all_high_frequency_slopes_db())
    }

    fn all_high_frequency_slopes_db(&self) -> Vec<f64> {
        let slopes = self.parts.iter().flat_map(StructureFactor::high_frequency_slopes).copied();
        std::iter::once(1.0).chain(slopes).map(|slope| DECIBELS_PER_NEPER * slope).collect()
    }

    /// Number of zeros (power 1) or poles (power -1).
    pub(crate) fn roots(&self, power: f64) -> usize {
        let degrees = self.degrees().unwrap_or_default();
        if power > 0.0 { degrees[0] } else { degrees[1] }
    }

    /// The factors of the parts with free numbers, in turn.
    fn factors(&self) -> impl Iterator<Item = Factor> {
        self.parts.iter().flat_map(StructureFactor::factors).copied()
    }

    /// The product of the parts without free numbers.
    fn fixed(&self) -> Result<TransferFunction, LinearError> {
        let elements = self.parts.iter().filter_map(|part| match part {
            StructureFactor::Fixed(element) => Some(element.clone()),
            _ => None,
        });
        Compensator::new(elements.collect()).transfer_function()
    }

    /// Numbers of zeros and poles.
    fn degrees(&self) -> Result<[usize; 2], LinearError> {
        let fixed = self.fixed()?;
        let mut degrees = [fixed.zeros().len(), fixed.poles().len()];
        for factor in self.factors() {
            degrees[usize::from(factor.power < 0.0)] += if factor.pair { 2 } else { 1 };
        }
        Ok(degrees)
    }
}

fn is_free(range: &[f64; 2]) -> bool {
    range[0] < range[1]
}
