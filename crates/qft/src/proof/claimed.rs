//! A claim as two polynomials: |V| <= |U| on the whole stability boundary and for all plants, or U
//! without a zero there.
//!
//! ```text
//! P = N/D E, E = e^(-s tau), G = Gn/Gd, H = Hn/Hd, F = Fn/Fd, limit W = Wn/Wd, c = D Gd Hd, n = N Gn Hn, ratio r
//!
//! stable           U = n E + c                     V = 0
//! |L S| <= r W     U = r Wn (n E + c)              V = Wd n
//! |S| <= r W       U = r Wn (n E + c)              V = Wd c
//! |P S| <= r W     U = r Wn (n E + c)              V = Wd N Gd Hd
//! |G S| <= r W     U = r Wn (n E + c)              V = Wd Gn D Hd
//! |Pd S| <= r W    U = r Wn (n E + c) Dd           V = Wd Nd c          with one denominator: V = Wd Nd Gd Hd, U without Dd
//! |F T| <= r W     U = r Wn (n E + c) Fd           V = Wd Fn N Gn Hd
//! |F T| >= W/r     U = r Wd Fn N Gn Hd             V = Wn Fd (n E + c)
//! ```
//!
//! |E| = 1 on the stability boundary, so that it is dropped if it is a factor. Powers of s that
//! divide both are dropped.
//!
//! In a sampled loop G and F are functions of z, and P is the plant after its hold, the sum of its
//! images:
//!
//! ```text
//! P = hold E (N/D + R),   R = sum over k != 0 of w/w_k e^(-j (w_k - w) tau) N/D(j w_k),   w_k = w + 2 pi k/T
//! ```
//!
//! with R' for N Hn/(D Hd). N includes the hold, and N E the addition R' D or, for the plant
//! without sensor, R D: see `images`.

use phea_dynamics::portable;

use super::certificate::{
    Certificate, CertificateMember, CertificateSide, LimitOf, LimitedLoop, ParameterSegment,
};
use super::dead_time::{DeadTime, ends};
use super::images::{PlantImages, Which};
use super::model::{modelled, parameters_over};
use super::over_panel::{Complex, product, sum};
use super::part::{OfFrequency, PolynomialProduct, Straight, law, number, quotient};
use super::polynomial::{BoxPolynomial, Decimal, InS, expanded};
use crate::specification::ClosedLoop;

/// Greatest exponent of a variable in a dead time, whose powers are needed.
const DEAD_TIME_EXPONENT_MAXIMUM: u8 = 4;

/// Distance that the panels of a sampled loop extend beyond pi/T, as a fraction of it.
const BEYOND: f64 = 1e-9;

/// A loop in polynomials of s and functions of the frequency, over the box or at one plant.
#[derive(Clone, Debug)]
pub(crate) struct Loop<S> {
    numerator: PolynomialProduct<S>,
    denominator: PolynomialProduct<S>,
    disturbance: Option<[PolynomialProduct<S>; 2]>,
    /// True if P and Pd have one denominator: the same operations.
    has_one_denominator: bool,
    feedback: [PolynomialProduct<S>; 2],
    prefilter: [PolynomialProduct<S>; 2],
    sensor: [PolynomialProduct<S>; 2],
    dead_time: DeadTime<S>,
    images: Option<PlantImages<S>>,
}

/// True if the dead time has no remainder, a low power in each variable, and no negative values.
fn is_dead_time<S: Decimal>(value: &BoxPolynomial<S>) -> bool {
    let least = ends(&DeadTime { value: value.clone(), terms: 1 })[0].least();
    let is_low = value.clone().up_to(DEAD_TIME_EXPONENT_MAXIMUM).is_some();
    is_low && value.rest().most() == 0.0 && least >= 0.0
}

/// The values of the parameters at one plant.
fn at_member<S: Decimal>(segments: &[ParameterSegment], variables: &[f64]) -> Vec<BoxPolynomial<S>> {
    let value = |one: &ParameterSegment| {
        let (low, high) = (S::decimal(one.low), S::decimal(one.high));
        let fraction =
            one.variable.and_then(|variable| variables.get(variable)).map(|fraction| S::decimal(*fraction));
        match fraction {
            None => low,
            Some(fraction) if one.by_factors => low * (fraction * (high / low).ln()).exp(),
            Some(fraction) => low + (high - low) * fraction,
        }
    };
    segments.iter().map(|one| BoxPolynomial::constant(value(one))).collect()
}

/// A sum of parts.
pub(crate) type PartSum<S> = Vec<PolynomialProduct<S>>;

/// U and V, each in three parts: without dead time, multiplied by E, and multiplied by E and the
/// images of the plant.
#[derive(Clone, Debug)]
pub(crate) struct Claimed<S> {
    pub(crate) u: [PartSum<S>; 3],
    pub(crate) v: [PartSum<S>; 3],
    /// Dead time tau without the constant part included in the functions of the frequency; `None`
    /// without dead time.
    pub(crate) dead_time: DeadTime<S>,
    pub(crate) images: Option<PlantImages<S>>,
    /// The images to which U and V refer.
    pub(crate) which: [Which; 2],
}

/// A claim about a part of a band.
#[derive(Clone, Debug)]
pub(crate) struct BandClaim<S> {
    /// Ends of the band, rad/s.
    pub(crate) band: [f64; 2],
    pub(crate) claimed: Claimed<S>,
}

impl<S: Decimal> BandClaim<S> {
    /// True if the loop has a response at a frequency, and a limit.
    pub(super) fn holds(&self, frequency_rad_per_s: f64) -> bool {
        let [from, to] = self.claimed.band(self.band);
        from <= frequency_rad_per_s && frequency_rad_per_s <= to
    }
}

/// The three parts: without dead time, multiplied by E, and multiplied by the images.
type Three<S> = [PartSum<S>; 3];

fn alone<S>(one: PolynomialProduct<S>) -> Three<S> {
    [vec![one], vec![], vec![]]
}

fn each<S: Decimal>(
    of: Three<S>,
    change: impl Fn(&PolynomialProduct<S>) -> PolynomialProduct<S>,
) -> Three<S> {
    of.map(|sum| sum.iter().map(&change).collect())
}

impl<S: Decimal> Claimed<S> {
    /// Claim of two polynomials.
    pub(super) fn polynomials(u: InS<S>, v: InS<S>) -> Claimed<S> {
        let alone = |of| alone(PolynomialProduct::of(of));
        let dead_time = DeadTime { value: BoxPolynomial::zero(), terms: 1 };
        Claimed { u: alone(u), v: alone(v), dead_time, images: None, which: [Which::WithSensor; 2] }
    }

    /// Claim without the powers of s that divide all parts.
    fn without_powers_of_s(self) -> Claimed<S> {
        let all = self.u.iter().chain(&self.v).flatten();
        let common = all.filter_map(|part| part.of_s.powers_of_s()).min().unwrap_or(0);
        let without = |of: Three<S>| {
            each(of, |part| PolynomialProduct { of_s: part.of_s.without_powers_of_s(common), ..part.clone() })
        };
        Claimed { u: without(self.u), v: without(self.v), ..self }
    }

    /// Claim with E = 1 if there is no dead time.
    fn joined(mut self) -> Claimed<S> {
        if self.dead_time.value.is_zero() {
            for one in [&mut self.u, &mut self.v] {
                let late = std::mem::take(&mut one[1]);
                one[0] = added(std::mem::take(&mut one[0]), late);
            }
        }
        self
    }

    /// Claim with U multiplied by a number.
    pub(crate) fn raised(&self, ratio: S) -> Claimed<S> {
        Claimed { u: each(self.u.clone(), |part| part.scaled(ratio)), ..self.clone() }
    }

    /// Value of U at a frequency, for a loop with numbers as coefficients.
    pub(super) fn value_of_u(&self, frequency: S) -> Option<Complex<S>> {
        self.value(&self.u, self.which[0], frequency)
    }

    /// Value of V at a frequency, for a loop with numbers as coefficients.
    pub(super) fn value_of_v(&self, frequency: S) -> Option<Complex<S>> {
        self.value(&self.v, self.which[1], frequency)
    }

    fn value(&self, [own, late, imaged]: &Three<S>, which: Which, frequency: S) -> Option<Complex<S>> {
        let values = |parts: &[PolynomialProduct<S>]| {
            let each = parts.iter().map(|part| part.value(frequency, self.sample_time_s()));
            each.fold([S::from(0.0); 2], sum)
        };
        let mut behind = values(late);
        if !imaged.is_empty() {
            behind = sum(behind, product(self.images.as_ref()?.at(which, frequency)?, values(imaged)));
        }
        if !self.dead_time.value.is_zero() {
            let [cosine, sine] = S::cosine_and_sine(frequency * self.dead_time.value.as_constant()?);
            behind = product([cosine, -sine], behind);
        }
        Some(sum(values(own), behind))
    }

    /// The part of a band in which the loop has a response.
    pub(super) fn band(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        [from, self.images.as_ref().map_or(to, |images| to.min(images.band_ends()[0]))]
    }

    /// The range that panels cover for a band: slightly more at pi/T, where a sampled loop ends.
    pub(super) fn band_covered(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let [_, end] = self.band([from, to]);
        let beyond = end * (1.0 + BEYOND);
        let is_cut = self.images.is_some() && end < to;
        [from, if is_cut { portable::rounded(beyond, 10) } else { to }]
    }

    /// The direction of U, a polynomial with numbers as coefficients, towards infinity.
    pub(super) fn direction_at_infinity(&self) -> Option<Complex<S>> {
        let of = &self.u[0].first()?.of_s;
        let degree = of.degree()?;
        let (leading, zero) = (number(of.0.get(degree)?), S::from(0.0));
        Some(match degree % 4 {
            0 => [leading, zero],
            1 => [zero, leading],
            2 => [-leading, zero],
            _ => [zero, -leading],
        })
    }

    /// Polynomials in s of all parts.
    pub(crate) fn of_s(&self) -> impl Iterator<Item = &InS<S>> {
        self.u.iter().chain(&self.v).flatten().map(|part| &part.of_s)
    }

    /// Angle by which the functions of the frequency turn, approximately, per unit of frequency, s.
    pub(crate) fn turn_s(&self) -> f64 {
        let late = self.u.iter().chain(&self.v).flatten().flat_map(|part| &part.of_frequency);
        let late = late.map(|one| if let OfFrequency::Late(time_s) = one { time_s.middle() } else { 0.0 });
        self.sample_time_s().middle() + late.fold(0.0, f64::max)
    }

    /// True if a power of the frequency is among its functions, which allows only narrow panels.
    pub(crate) fn has_powers(&self) -> bool {
        let all = self.u.iter().chain(&self.v).flatten().flat_map(|part| &part.of_frequency);
        all.into_iter().any(|one| matches!(one, OfFrequency::Straight(_)))
    }

    /// Sample time, s; 0 for a continuous loop.
    pub(crate) fn sample_time_s(&self) -> S {
        self.images.as_ref().map_or(S::from(0.0), |images| images.sample_time_s)
    }
}

/// One sum, in which parts with equal functions of the frequency are combined.
fn added<S: Decimal>(mut sum: PartSum<S>, other: PartSum<S>) -> PartSum<S> {
    for part in other {
        match sum.iter_mut().find(|known| known.of_frequency == part.of_frequency) {
            Some(known) => known.of_s = known.of_s.plus(&part.of_s),
            None => sum.push(part),
        }
    }
    sum
}

impl<S: Decimal> Loop<S> {
    /// Loop over a whole box; `None` if the plant is not polynomial, or there is no such box.
    pub(crate) fn over_box(certificate: &Certificate, of_box: usize) -> Option<Loop<S>> {
        Loop::of(certificate, of_box, &parameters_over(certificate, of_box)?)
    }

    /// Loop with one plant.
    pub(crate) fn at(certificate: &Certificate, member: &CertificateMember) -> Option<Loop<S>> {
        let segments = certificate.plant.boxes.get(member.of_box)?;
        Loop::of(certificate, member.of_box, &at_member(segments, &member.variables))
    }

    fn of(certificate: &Certificate, of_box: usize, parameters: &[BoxPolynomial<S>]) -> Option<Loop<S>> {
        let plant = &certificate.plant;
        let coefficients = match plant.model_degree {
            0 => expanded(&plant.coefficients, parameters)?,
            degree => modelled(&plant.coefficients, parameters, degree)?,
        };
        let mut left = coefficients.into_iter();
        let mut parts = vec![];
        for &length in &plant.lengths {
            let mut highest_first: Vec<BoxPolynomial<S>> = left.by_ref().take(length).collect();
            highest_first.reverse();
            parts.push(PolynomialProduct::of(InS(highest_first)));
        }
        let sampling = certificate.sampling.as_ref();
        let mut dead_time = BoxPolynomial::number(plant.delay_s);
        if plant.has_dead_time {
            dead_time = dead_time.plus(&left.next()?);
        }
        if !is_dead_time(&dead_time) {
            return None;
        }
        // in a sampled loop, a constant dead time is a function of the frequency
        let late = dead_time.as_constant().filter(|_| sampling.is_some());
        if late.is_some() {
            dead_time = BoxPolynomial::zero();
        }
        let mut parts = parts.into_iter();
        let (numerator, denominator) = (parts.next()?, parts.next()?);
        let results = plant.coefficients.results();
        let of_part = |part: usize| {
            let before: usize = plant.lengths.iter().take(part).sum();
            results.iter().skip(before).take(plant.lengths.get(part).copied().unwrap_or(0))
        };
        let sample_time_s = sampling.map(|sampling| sampling.sample_time_s);
        let sensor = quotient(&certificate.sensor);
        let of_plant = [&numerator.of_s, &denominator.of_s];
        let images = match sampling {
            Some(sampling) => Some(PlantImages::of(sampling, of_box, late, of_plant, &certificate.sensor)?),
            None => None,
        };
        let mut held = numerator;
        if sampling.is_some() {
            held.of_frequency =
                std::iter::once(OfFrequency::Hold).chain(late.map(OfFrequency::Late)).collect();
        }
        Some(Loop {
            numerator: held,
            denominator,
            has_one_denominator: of_part(1).eq(of_part(3)),
            disturbance: parts
                .next()
                .zip(parts.next())
                .map(|(numerator, denominator)| [numerator, denominator]),
            feedback: law(&certificate.feedback, sample_time_s),
            prefilter: law(&certificate.prefilter, sample_time_s),
            sensor: sensor.map(PolynomialProduct::of),
            dead_time: DeadTime { value: dead_time, terms: plant.dead_time_terms },
            images,
        })
    }

    /// The greatest remainder of a coefficient of the plant, relative to its size.
    pub(super) fn remainder_fraction(&self) -> f64 {
        let own = [&self.numerator, &self.denominator].into_iter().chain(self.disturbance.iter().flatten());
        let coefficients = own.flat_map(|part| &part.of_s.0).filter(|one| one.rest().most() != 0.0);
        coefficients.map(|one| one.rest().most() / one.size().most()).fold(0.0, f64::max)
    }

    pub(super) fn images(&self) -> Option<&PlantImages<S>> {
        self.images.as_ref()
    }

    /// True if nothing is divided by zero.
    pub(crate) fn has_denominators(&self) -> bool {
        let quotients = [&self.feedback, &self.prefilter, &self.sensor].map(|[_, under]| under);
        let own = self.disturbance.iter().map(|[_, under]| under).chain([&self.denominator]);
        quotients.into_iter().chain(own).all(|under| under.of_s.degree().is_some())
    }

    /// Claim that D Hd without its zeros at s = 0 is not zero on the imaginary axis, and the number
    /// of these zeros.
    pub(crate) fn denominator_claimed(&self) -> (Claimed<S>, usize) {
        let whole = self.denominator.of_s.times(&self.sensor[1].of_s);
        let zeros = whole.powers_of_s().unwrap_or(0);
        (Claimed::polynomials(whole.without_powers_of_s(zeros), InS(vec![])), zeros)
    }

    /// Polynomials c and n.
    fn open(&self) -> [PolynomialProduct<S>; 2] {
        let [[gn, gd], [hn, hd]] = [&self.feedback, &self.sensor];
        [self.denominator.times(gd).times(hd), self.numerator.times(gn).times(hn)]
    }

    /// The factor of the images in place of n: with N Hn replaced by D Hd.
    fn image(&self) -> PolynomialProduct<S> {
        let hold = PolynomialProduct { of_s: self.denominator.of_s.clone(), ..self.numerator.clone() };
        hold.times(&self.feedback[0]).times(&self.sensor[1])
    }

    /// Characteristic function n E + c, with its images.
    fn characteristic(&self) -> Three<S> {
        let [c, n] = self.open();
        [vec![c], vec![n], self.images.iter().map(|_| self.image()).collect()]
    }

    /// Characteristic polynomial n + c, without dead time.
    pub(crate) fn without_dead_time(&self) -> InS<S> {
        let [c, n] = self.open();
        c.of_s.plus(&n.of_s)
    }

    fn claim(&self, u: Three<S>, v: Three<S>, which: [Which; 2]) -> Claimed<S> {
        Claimed { u, v, dead_time: self.dead_time.clone(), images: self.images.clone(), which }
    }

    /// Claim that no pole is on the stability boundary.
    pub(crate) fn stability(&self) -> Claimed<S> {
        self.claim(self.characteristic(), Default::default(), [Which::WithSensor; 2]).joined()
    }

    /// Claim of stability for one plant while its dead time grows from zero with the first
    /// variable.
    pub(crate) fn stability_while_delayed(&self) -> Claimed<S> {
        let value = self.dead_time.value.times(&BoxPolynomial::between(0.0, 1.0, Some(0)));
        Claimed { dead_time: DeadTime { value, ..self.dead_time }, ..self.stability() }
    }

    /// The denominator of the prefilter, if it is a function of s.
    pub(crate) fn prefilter_denominator(&self) -> &InS<S> {
        &self.prefilter[1].of_s
    }

    /// A limit as claims, one for each part of its band; `None` for a plant without the limited
    /// path.
    pub(crate) fn claimed(&self, limited: &LimitedLoop, ratio: f64) -> Option<Vec<BandClaim<S>>> {
        let [from, to] = limited.band_rad_per_s;
        match &limited.limit {
            LimitOf::Quotient(limit) => {
                let claimed = self.within(limited, quotient(limit).map(PolynomialProduct::of), ratio)?;
                Some(vec![BandClaim { band: [from, to], claimed }])
            }
            LimitOf::Table(points) => {
                let highest = self.images.as_ref().map_or(f64::INFINITY, |images| images.band_ends()[0]);
                let pieces = Straight::of_table(points).filter_map(|straight| {
                    let band = [from.max(straight.from.0), to.min(straight.to.0)];
                    (band[0] < band[1].min(highest)).then_some((band, straight))
                });
                let one = |of_frequency| PolynomialProduct {
                    of_s: InS(vec![BoxPolynomial::number(1.0)]),
                    of_frequency,
                };
                let claimed = pieces.map(|(band, straight)| {
                    let limit = [one(vec![OfFrequency::Straight(straight)]), one(vec![])];
                    Some(BandClaim { band, claimed: self.within(limited, limit, ratio)? })
                });
                claimed.collect()
            }
        }
    }

    /// A claim with a limit Wn/Wd.
    fn within(
        &self,
        limited: &LimitedLoop,
        [wn, wd]: [PolynomialProduct<S>; 2],
        ratio: f64,
    ) -> Option<Claimed<S>> {
        let [[gn, gd], [fn_, fd], [_, hd]] = [&self.feedback, &self.prefilter, &self.sensor];
        let ratio = S::decimal(ratio);
        let d = &self.denominator;
        // the plant without sensor, and its images
        let plant = || {
            let own = self.numerator.times(hd);
            let image = PolynomialProduct { of_s: d.of_s.clone(), ..self.numerator.clone() }.times(hd);
            [vec![], vec![own], self.images.iter().map(|_| image.clone()).collect()]
        };
        // the numerator over n E + c, and the additional denominator
        let (over, beside, which) = match limited.closed_loop {
            ClosedLoop::RobustStability => {
                let [_, n, images] = self.characteristic();
                ([vec![], n, images], None, Which::WithSensor)
            }
            ClosedLoop::Sensitivity => (alone(self.open()[0].clone()), None, Which::WithSensor),
            ClosedLoop::PlantInputDisturbance => (each(plant(), |one| one.times(gd)), None, Which::Alone),
            ClosedLoop::ControlEffort => (alone(gn.times(d).times(hd)), None, Which::WithSensor),
            ClosedLoop::LoadMotion => {
                let [own, under] = self.disturbance.as_ref()?;
                let (over, under) = match self.has_one_denominator {
                    true => (own.times(gd).times(hd), None),
                    false => (own.times(d).times(gd).times(hd), Some(under)),
                };
                (alone(over), under, Which::WithSensor)
            }
            ClosedLoop::Tracking => (each(plant(), |one| fn_.times(one).times(gn)), Some(fd), Which::Alone),
        };
        // a factor E of the whole numerator does not change a magnitude
        let over = match over {
            [own, late, images] if own.is_empty() && images.is_empty() => [late, vec![], vec![]],
            other => other,
        };
        let under =
            each(self.characteristic(), |part| beside.map_or(part.clone(), |beside| part.times(beside)));
        let raised = |of, by: &PolynomialProduct<S>| each(of, |part| by.times(part).scaled(ratio));
        let claimed = match limited.side {
            CertificateSide::Upper => {
                let v = each(over, |part| wd.times(part));
                self.claim(raised(under, &wn), v, [Which::WithSensor, which])
            }
            CertificateSide::Lower => {
                let v = each(under, |part| wn.times(part));
                self.claim(raised(over, &wd), v, [which, Which::WithSensor])
            }
        };
        Some(claimed.without_powers_of_s().joined())
    }
}
