//! The images of a sampled plant: the contribution of its response at w + 2 pi k/T to that at w.
//!
//! ```text
//! R = sum over k != 0 of q_k,    q_k = w/w_k e^(-j k W tau) N/D(j w_k),      w_k = w + k W,   W = 2 pi/T,   0 <= w <= 0.51 W
//! ```
//!
//! The first `count` on either side are enclosed individually, each by a disc: over a part of the
//! box, with control points n_i of j w N and d_i of s D at s = j w_k, and any number c,
//!
//! ```text
//! |q_k - c e^(-j k W tau)| <= greatest |n_i - c d_i|/least |d_i|
//! ```
//!
//! The others are bounded together. If |N/D| <= C/w^m from 0.49 + count images on, with m >= 1,
//! they add at most
//!
//! ```text
//! 2 w C W^-(m+1) sum over k > count of (k - 0.51)^-(m+1)  <=  2 w C W^-(m+1) (count - 0.01)^-m/m
//! ```

use super::certificate::{Quotient, Sampling};
use super::claimed::Claimed;
use super::dead_time::InFrequency;
use super::over_panel::{Complex, product, size, sum};
use super::part::{quotient, value};
use super::points::{PanelPoint, PanelRange, Points};
use super::polynomial::{BoxPolynomial, Decimal, InS};

/// Fraction of W up to which the band extends at most, slightly beyond pi/T.
pub(super) const BAND_END: f64 = 0.51;
/// Constants of the bound on the images that are not enclosed individually: its start, and the
/// start of its integral.
const BOUND_BEGIN: f64 = 0.49;
const INTEGRAL_BEGIN: f64 = -0.01;

/// Choice of the plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    /// Plant with sensor N Hn/(D Hd), in the loop.
    WithSensor,
    /// Plant N/D, on the way to the output.
    Alone,
}

/// The images of a plant over a box.
#[derive(Clone, Debug)]
pub(crate) struct PlantImages<S> {
    /// Sample time T, s.
    pub(super) sample_time_s: S,
    count: usize,
    /// The dead time up to the sensor's output, if no variable changes it.
    dead_time_s: Option<S>,
    /// The part of that dead time that belongs to the sensor.
    sensor_delay_s: S,
    with_sensor: ImagedQuotient<S>,
    alone: ImagedQuotient<S>,
}

/// N and D, with the bound on the images that are not enclosed individually.
#[derive(Clone, Debug)]
struct ImagedQuotient<S> {
    over: InS<S>,
    under: InS<S>,
    /// Bound C, as a decimal.
    ratio: f64,
    /// Order m.
    order: usize,
}

impl<S: Decimal> PlantImages<S> {
    pub(super) fn of(
        sampling: &Sampling,
        of_box: usize,
        dead_time_s: Option<S>,
        [n, d]: [&InS<S>; 2],
        sensor: &Quotient,
    ) -> Option<PlantImages<S>> {
        let bounds = sampling.bounds.get(of_box)?;
        let last = bounds.last()?;
        let alone =
            ImagedQuotient { over: n.clone(), under: d.clone(), ratio: last.ratio, order: last.order };
        let with_sensor = match (sensor.is_one(), bounds.as_slice()) {
            (true, [_]) => alone.clone(),
            (false, [bound, _]) => {
                let [hn, hd] = quotient(sensor);
                ImagedQuotient {
                    over: n.times(&hn),
                    under: d.times(&hd),
                    ratio: bound.ratio,
                    order: bound.order,
                }
            }
            _ => return None,
        };
        let sample_time_s = S::decimal(sampling.sample_time_s);
        let sensor_delay_s = S::decimal(sampling.sensor_delay_s);
        let count = sampling.images;
        Some(PlantImages { sample_time_s, count, dead_time_s, sensor_delay_s, with_sensor, alone })
    }

    fn imaged(&self, which: Which) -> &ImagedQuotient<S> {
        match which {
            Which::WithSensor => &self.with_sensor,
            Which::Alone => &self.alone,
        }
    }

    /// The dead time of this plant, if no variable changes it.
    fn late(&self, which: Which) -> Option<S> {
        let whole = self.dead_time_s?;
        Some(match which {
            Which::WithSensor => whole,
            Which::Alone => whole - self.sensor_delay_s,
        })
    }

    /// Sampling frequency W.
    pub(super) fn turn(&self) -> S {
        S::pi().times(2.0) / self.sample_time_s
    }

    /// Ends of the band: the circle is covered from zero to the first, and the images are enclosed
    /// up to the second.
    pub(super) fn band_ends(&self) -> [f64; 2] {
        let half = S::pi() / self.sample_time_s;
        [half.most(), (self.turn() * S::from(BAND_END)).least()]
    }

    /// The claims about the bounds, with and without the sensor: |s^m N| <= C |D|.
    pub(super) fn bounded(&self) -> [Claimed<S>; 2] {
        [&self.with_sensor, &self.alone].map(|imaged| {
            let s_to_m = [vec![BoxPolynomial::zero(); imaged.order], vec![BoxPolynomial::number(1.0)]];
            let v = InS(s_to_m.concat()).times(&imaged.over);
            Claimed::polynomials(imaged.under.scaled(S::decimal(imaged.ratio)), v)
        })
    }

    /// The degree of the denominator less that of the numerator, with and without the sensor;
    /// `None` if it is not positive.
    pub(super) fn relative_degrees(&self) -> Option<[usize; 2]> {
        Some([self.with_sensor.relative_degree()?, self.alone.relative_degree()?])
    }

    /// Frequency above which the bounds are needed.
    pub(super) fn bound_begin(&self) -> S {
        self.turn() * S::from(self.count as f64 + BOUND_BEGIN)
    }

    /// Control points of the images enclosed individually, over a panel and the whole box.
    pub(super) fn over(&self, which: Which, variables: usize, range: PanelRange) -> Option<ImagePoints<S>> {
        let imaged = self.imaged(which);
        let turn = self.turn();
        let (from, width) = (S::decimal(range.from), S::decimal(range.to) - S::decimal(range.from));
        let j_w = [BoxPolynomial::constant(from), BoxPolynomial::constant(width)];
        let j_w = InFrequency { real: InS(vec![]), imaginary: InS(j_w.to_vec()) };
        let s = InS(vec![BoxPolynomial::zero(), BoxPolynomial::number(1.0)]);
        let under = InFrequency::of(&imaged.under.times(&s));
        let over = InFrequency::of(&imaged.over);
        // w is less than |w_k|
        let rests = [&imaged.under, &imaged.over].map(|of| InFrequency::of_rests(&of.times(&s)));
        let sides = (1..=self.count).flat_map(|k| [k as f64, -(k as f64)]);
        let each = sides.map(|k| {
            let begin = from + turn * S::from(k);
            let pair = [under.along(begin, width), over.along(begin, width).times(&j_w)];
            // at the greatest |w_k|
            let farthest = if k > 0.0 { begin + width } else { -begin };
            let rests = rests.iter().flatten().map(|rests| rests.along(farthest, S::from(0.0)));
            let points = Points::of_pair(pair, rests, variables, range)?;
            let phase = self.late(which).map(|dead_time_s| {
                let [cosine, sine] = S::cosine_and_sine(turn * S::from(k) * dead_time_s);
                [cosine, -sine]
            });
            Some((points, phase))
        });
        Some(ImagePoints {
            each: each.collect::<Option<_>>()?,
            rest: self.rest(imaged, S::decimal(range.to)),
        })
    }

    /// A set that contains R at a frequency, for a plant with numbers as coefficients.
    pub(super) fn at(&self, which: Which, frequency: S) -> Option<Complex<S>> {
        let dead_time_s = self.late(which)?;
        let imaged = self.imaged(which);
        let rest = S::uncertain(self.rest(imaged, frequency).most());
        let sides = (1..=self.count).flat_map(|k| [k as f64, -(k as f64)]);
        let each = sides.map(|k| {
            let turn = self.turn() * S::from(k);
            let [n, d] = [&imaged.over, &imaged.under].map(|of| value(of, frequency + turn));
            let size = d[0] * d[0] + d[1] * d[1];
            let conjugate = [d[0] / size, -(d[1] / size)];
            let [cosine, sine] = S::cosine_and_sine(turn * dead_time_s);
            let fraction = frequency / (frequency + turn);
            let [re, im] = product(product(n, conjugate), [cosine, -sine]);
            [re * fraction, im * fraction]
        });
        Some(each.fold([rest; 2], sum))
    }

    /// Upper bound on the contribution of the images not enclosed individually, up to a frequency.
    fn rest(&self, imaged: &ImagedQuotient<S>, frequency: S) -> S {
        let order = imaged.order;
        let own = S::from(self.count as f64 + INTEGRAL_BEGIN);
        let power = |of: S, exponent: usize| (0..exponent).fold(S::from(1.0), |product, _| product * of);
        let under = power(self.turn(), order + 1) * power(own, order) * S::from(order as f64);
        frequency * S::decimal(imaged.ratio).times(2.0) / under
    }
}

impl<S: Decimal> ImagedQuotient<S> {
    /// The degree of D less that of N, if it is positive.
    fn relative_degree(&self) -> Option<usize> {
        self.under.degree()?.checked_sub(self.over.degree()?).filter(|degree| *degree > 0)
    }
}

/// Control points of the images over a part of a panel and of the box: of each d_i and n_i, with
/// its phase if that is known.
#[derive(Clone, Debug)]
pub(crate) struct ImagePoints<S> {
    each: Vec<(Points<S>, Option<Complex<S>>)>,
    rest: S,
}

/// A disc of complex numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageDisc<S> {
    pub(crate) center: Complex<S>,
    pub(crate) radius: S,
}

impl<S: Decimal> ImagePoints<S> {
    /// Number of control points.
    pub(super) fn size(&self) -> usize {
        self.each.iter().map(|(points, _)| points.points().len()).sum()
    }

    /// Both halves of the box across an axis.
    pub(super) fn halves(self, axis: usize) -> [ImagePoints<S>; 2] {
        let rest = self.rest;
        let (low, high) = self
            .each
            .into_iter()
            .map(|(points, phase)| {
                let [low, high] = points.halves(axis);
                ((low, phase), (high, phase))
            })
            .unzip();
        [low, high].map(|each| ImagePoints { each, rest })
    }

    /// A set that contains R everywhere in this part.
    pub(super) fn disc(&self) -> ImageDisc<S> {
        let whole = ImageDisc { center: [S::from(0.0); 2], radius: self.rest };
        self.each.iter().fold(whole, |known, (points, phase)| {
            let ImageDisc { center, radius } = disc(points.points());
            let (center, radius) = match phase {
                Some(phase) => (product(center, *phase), radius),
                None => ([S::from(0.0); 2], radius + size(center)),
            };
            ImageDisc { center: sum(known.center, center), radius: known.radius + radius }
        })
    }

    /// The points of the image known least accurately.
    pub(super) fn least_known(&self) -> Option<&Points<S>> {
        let radius = |points: &Points<S>| disc(points.points()).radius.most();
        let all = self.each.iter().map(|(points, _)| points);
        all.max_by(|one, other| radius(one).total_cmp(&radius(other)))
    }
}

/// A set that contains n/d, from the control points of both.
fn disc<S: Decimal>(points: &[PanelPoint<S>]) -> ImageDisc<S> {
    let middle = points.iter().fold([0.0; 4], |[dr, di, nr, ni], point| {
        [dr + point[0].middle(), di + point[1].middle(), nr + point[2].middle(), ni + point[3].middle()]
    });
    let [dr, di, nr, ni] = middle;
    let square = dr * dr + di * di;
    // its value is arbitrary, but exact
    let center = [(nr * dr + ni * di) / square, (ni * dr - nr * di) / square].map(S::from);
    let squared = |part: f64| S::from(part) * S::from(part);
    let length = (squared(dr) + squared(di)).sqrt();
    let mut greatest = S::from(0.0);
    let mut least = f64::INFINITY;
    for [dr_i, di_i, nr_i, ni_i, rest] in points {
        let from = product(center, [*dr_i, *di_i]);
        let [re, im] = [(*nr_i - from[0]).abs(), (*ni_i - from[1]).abs()];
        greatest = greatest.maximum((re * re + im * im).sqrt() + *rest * (S::from(1.0) + size(center)));
        least = least.min((dr_i.times(dr) + di_i.times(di) - *rest * length).least());
    }
    // d does not enclose zero
    let radius = if least > 0.0 { greatest * length / S::from(least) } else { S::from(f64::INFINITY) };
    ImageDisc { center, radius }
}
