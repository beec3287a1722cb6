//! Control points: the coefficients of U and V over a box and a panel of frequencies, in the
//! Bernstein basis.
//!
//! ```text
//! U = sum over k of U_k B_k(t),     B_k >= 0,   sum over k of B_k = 1        t in [0, 1]^n
//! ```
//!
//! Every pair (U, V) on the box is a weighted mean of the pairs (U_k, V_k), with equal weights for
//! both. The remainder of dead time has the magnitude e, at most the mean of e_k with these
//! weights.

use super::certificate::Late;
use super::claimed::Claimed;
use super::dead_time::{InFrequency, remainder, turned};
use super::images::ImageDisc;
use super::over_panel::{Middle, product, size};
use super::part::PolynomialProduct;
use super::polynomial::{BoxPolynomial, Decimal, InS};

/// Real and imaginary parts of U and of V, and e.
pub(crate) type PanelPoint<S> = [S; 5];

/// A panel of frequencies, rad/s, and the treatment of dead time over it; the panel may end at
/// infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PanelRange {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) late: Late,
}

/// Coefficients over all axes, that of the frequency first, the last axis varying fastest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Points<S> {
    degrees: Vec<usize>,
    values: Vec<PanelPoint<S>>,
}

/// Largest number of control points: more than any practical claim needs.
const POINTS_MAXIMUM: usize = 1 << 21;

/// U and V over a panel as polynomials, each with a bound on its remainder.
struct PanelTerms<S> {
    whole: [InFrequency<S>; 2],
    rests: Vec<(InFrequency<S>, S)>,
    /// Polynomials of which only the degrees matter.
    unused: Vec<InFrequency<S>>,
}

impl<S: Decimal> PanelTerms<S> {
    fn of(claimed: &Claimed<S>, pair: [[&[PolynomialProduct<S>]; 2]; 2], range: PanelRange) -> PanelTerms<S> {
        let none = InFrequency::none;
        let mut out = PanelTerms { whole: [none(), none()], rests: vec![], unused: vec![] };
        for (place, [own, late]) in pair.into_iter().enumerate() {
            let mut add = |parts: &[PolynomialProduct<S>]| {
                let mut sum = none();
                for part in parts {
                    let (of_part, rests) = over_panel(claimed, part, range);
                    sum = sum.plus(&of_part);
                    out.rests.extend(rests);
                }
                sum
            };
            let (own, late) = (add(own), add(late));
            let remains = |of: InFrequency<S>, rest: S| (of, rest);
            match range.late {
                Late::Not => {
                    out.whole[place] = own;
                    out.unused.push(late);
                }
                Late::Less => {
                    out.whole[place] = own;
                    out.rests.push(remains(late, S::from(1.0)));
                }
                Late::More => {
                    out.whole[place] = late;
                    out.rests.push(remains(own, S::from(1.0)));
                }
                Late::Turns(angle) => {
                    out.whole[place] = own.plus(&late.times(&turned(&claimed.dead_time, range, angle)));
                    out.unused.push(own);
                    out.rests.push(remains(late, remainder(&claimed.dead_time, range, angle)));
                }
            }
        }
        out
    }

    fn raise_degrees(&self, degrees: &mut [usize]) {
        let rests = self.rests.iter().map(|(of, _)| of);
        self.whole.iter().chain(rests).chain(&self.unused).for_each(|one| one.raise_degrees(degrees));
    }
}

/// A part over a panel, and the remainders of its functions of the frequency and of its polynomial.
fn over_panel<S: Decimal>(
    claimed: &Claimed<S>,
    part: &PolynomialProduct<S>,
    range: PanelRange,
) -> (InFrequency<S>, Vec<(InFrequency<S>, S)>) {
    let own = InFrequency::of(&part.of_s);
    let rests = InFrequency::of_rests(&part.of_s);
    if range.to.is_infinite() {
        return (own, rests.into_iter().map(|rests| (rests, S::from(1.0))).collect());
    }
    let [from, to] = [range.from, range.to].map(S::decimal);
    let own = own.along(from, to - from);
    let rests = rests.map(|rests| rests.along(from, to - from));
    match part.over(Middle::of([from, to], claimed.dead_time.terms), claimed.sample_time_s()) {
        None => (own, rests.into_iter().map(|rests| (rests, S::from(1.0))).collect()),
        Some(factor) => {
            let most = factor.size() + factor.rest();
            let whole = own.times(&factor.along());
            (whole, std::iter::once((own, factor.rest())).chain(rests.map(|rests| (rests, most))).collect())
        }
    }
}

impl<S: Decimal> Points<S> {
    /// The control points of a claim over a panel and the whole box, and of the factors of its
    /// images, with common degrees; `None` if there are too many.
    pub(crate) fn over(
        claimed: &Claimed<S>,
        variables: usize,
        range: PanelRange,
    ) -> Option<(Points<S>, Option<Points<S>>)> {
        let Claimed { u, v, .. } = claimed;
        let own = PanelTerms::of(claimed, [[&u[0], &u[1]], [&v[0], &v[1]]], range);
        let images = match range.late {
            // the images are delayed as well
            Late::Not => PanelTerms::of(claimed, [[&u[2], &[]], [&v[2], &[]]], range),
            _ => PanelTerms::of(claimed, [[&[], &u[2]], [&[], &v[2]]], range),
        };
        let mut degrees = vec![0; variables + 1];
        own.raise_degrees(&mut degrees);
        images.raise_degrees(&mut degrees);
        let own = Points::of(&own, &degrees, range)?;
        match &claimed.images {
            None => Some((own, None)),
            Some(_) => Some((own, Some(Points::of(&images, &degrees, range)?))),
        }
    }

    /// The control points of two polynomials on a finite panel, with the remainders of both.
    pub(super) fn of_pair(
        pair: [InFrequency<S>; 2],
        rests: impl Iterator<Item = InFrequency<S>>,
        variables: usize,
        range: PanelRange,
    ) -> Option<Points<S>> {
        let rests = rests.map(|rests| (rests, S::from(1.0))).collect();
        let terms = PanelTerms { whole: pair, rests, unused: vec![] };
        let mut degrees = vec![0; variables + 1];
        terms.raise_degrees(&mut degrees);
        Points::of(&terms, &degrees, range)
    }

    fn of(terms: &PanelTerms<S>, degrees: &[usize], range: PanelRange) -> Option<Points<S>> {
        let [u, v] = &terms.whole;
        let mut points = Points::powers([u, v], degrees)?;
        points.bring_to(range);
        // two at a time, in place of U and V
        for both in terms.rests.chunks(2) {
            let (one, nothing) = (&both[0].0, InFrequency::none());
            let other = both.get(1).map_or(&nothing, |(other, _)| other);
            let mut left = Points::powers([one, other], degrees)?;
            left.bring_to(range);
            for (point, left) in points.values.iter_mut().zip(&left.values) {
                for ((_, rest), parts) in both.iter().zip(left.chunks(2)) {
                    point[4] = point[4] + *rest * (parts[0].abs() + parts[1].abs());
                }
            }
        }
        Some(points)
    }

    /// Control points with images whose sum is in this disc, for U and for V; the remainder of the
    /// images is added to e.
    pub(super) fn with_images(&self, images: &Points<S>, [of_u, of_v]: [ImageDisc<S>; 2]) -> Points<S> {
        let greatest = |disc: &ImageDisc<S>| size(disc.center) + disc.radius;
        let most = greatest(&of_u).maximum(greatest(&of_v));
        // nothing is proven if a denominator of an image may vanish, even if the image is
        // multiplied by zero
        let is_known = [of_u, of_v].iter().all(|disc| disc.radius.most().is_finite());
        let unknown = S::from(if is_known { 0.0 } else { f64::INFINITY });
        let mut out = self.clone();
        for (point, image) in out.values.iter_mut().zip(&images.values) {
            let [ur, ui, vr, vi, rest] = *image;
            let u = product([ur, ui], of_u.center);
            let v = product([vr, vi], of_v.center);
            let beside = of_u.radius * size([ur, ui]) + of_v.radius * size([vr, vi]) + most * rest + unknown;
            let [known_ur, known_ui, known_vr, known_vi, known] = *point;
            *point = [known_ur + u[0], known_ui + u[1], known_vr + v[0], known_vi + v[1], known + beside];
        }
        out
    }

    /// U and V as powers of the frequency and of the variables, with these degrees.
    fn powers(pair: [&InFrequency<S>; 2], degrees: &[usize]) -> Option<Points<S>> {
        let count = degrees.iter().try_fold(1_usize, |count, degree| count.checked_mul(degree + 1))?;
        if count > POINTS_MAXIMUM {
            return None;
        }
        let mut out = Points { degrees: degrees.to_vec(), values: vec![[S::from(0.0); 5]; count] };
        for (place, one) in pair.into_iter().enumerate() {
            for (part, polynomials) in one.parts().into_iter().enumerate() {
                for (power, coefficient) in polynomials.iter().enumerate() {
                    for (exponents, value) in coefficient.terms() {
                        let index = out.index(power, exponents);
                        if let Some(slot) = out.values.get_mut(index) {
                            slot[2 * place + part] = value;
                        }
                    }
                }
            }
        }
        Some(out)
    }

    fn index(&self, power: usize, exponents: &[u8]) -> usize {
        let others =
            (0..self.degrees.len() - 1).map(|axis| exponents.get(axis).copied().map_or(0, usize::from));
        let digits = std::iter::once(power).chain(others);
        digits.zip(&self.degrees).fold(0, |index, (digit, degree)| index * (degree + 1) + digit)
    }

    /// Converts powers to control points. Towards infinity both are divided by one power of the
    /// frequency, whose inverse is the variable.
    fn bring_to(&mut self, range: PanelRange) {
        if range.to.is_infinite() {
            self.reverse_frequency();
            self.scale_frequency(S::from(1.0) / S::decimal(range.from));
        }
        self.bring_to_bernstein_all();
    }

    fn bring_to_bernstein_all(&mut self) {
        for axis in 0..self.degrees.len() {
            self.bring_to_bernstein(axis);
        }
    }

    /// Number of axes, including that of the frequency.
    pub(crate) fn axes(&self) -> usize {
        self.degrees.len()
    }

    pub(crate) fn degree(&self, axis: usize) -> usize {
        self.degrees[axis]
    }

    pub(crate) fn points(&self) -> &[PanelPoint<S>] {
        &self.values
    }

    /// Distance in memory from one point of an axis to the next.
    pub(crate) fn stride(&self, axis: usize) -> usize {
        self.degrees.iter().skip(axis + 1).map(|degree| degree + 1).product()
    }

    /// Both halves of the box across an axis, by the rule of de Casteljau.
    pub(crate) fn halves(mut self, axis: usize) -> [Points<S>; 2] {
        let degree = self.degrees[axis];
        let stride = self.stride(axis);
        let block = stride * (degree + 1);
        let mut low = self.clone();
        for step in 1..=degree {
            for line in self.lines(axis) {
                for place in 0..=degree - step {
                    let at = line + place * stride;
                    self.values[at] = each(self.values[at], self.values[at + stride], halfway);
                }
            }
            for from in (0..self.values.len()).step_by(block) {
                let to = from + step * stride;
                low.values[to..to + stride].copy_from_slice(&self.values[from..from + stride]);
            }
        }
        [low, self]
    }

    /// Substitution x -> width x in powers of the variable of the frequency.
    fn scale_frequency(&mut self, width: S) {
        let mut factor = S::from(1.0);
        for place in 1..=self.degrees[0] {
            factor = factor * width;
            self.scale(0, place, factor);
        }
    }

    /// Multiplies all points at this place of an axis.
    fn scale(&mut self, axis: usize, place: usize, factor: S) {
        let distance = place * self.stride(axis);
        for line in self.lines(axis) {
            for part in &mut self.values[line + distance] {
                *part = *part * factor;
            }
        }
    }

    fn reverse_frequency(&mut self) {
        let (degree, stride) = (self.degrees[0], self.stride(0));
        for line in self.lines(0) {
            for place in 0..=degree / 2 {
                self.values.swap(line + place * stride, line + (degree - place) * stride);
            }
        }
    }

    /// Conversion b_k = sum over i <= k of C(k, i)/C(n, i) a_i: division by C(n, i), then n
    /// summations.
    fn bring_to_bernstein(&mut self, axis: usize) {
        let (degree, stride) = (self.degrees[axis], self.stride(axis));
        // C(n, 0) = C(n, n) = 1
        let mut binomial = S::from(1.0);
        for place in 1..degree {
            binomial = binomial.times((degree - place + 1) as f64) / S::from(place as f64);
            self.scale(axis, place, S::from(1.0) / binomial);
        }
        for line in self.lines(axis) {
            for step in 0..degree {
                for place in (step + 1..=degree).rev() {
                    let at = line + place * stride;
                    self.values[at] =
                        each(self.values[at], self.values[at - stride], |here, before| here + before);
                }
            }
        }
    }

    /// The first point of every line along an axis; the next is [`Points::stride`] further.
    fn lines(&self, axis: usize) -> impl Iterator<Item = usize> + use<S> {
        let stride = self.stride(axis);
        let blocks = (0..self.values.len()).step_by(stride * (self.degrees[axis] + 1));
        blocks.flat_map(move |start| start..start + stride)
    }
}

/// Applies one operation to each number of two points.
#[inline]
fn each<S: Copy>(mut one: PanelPoint<S>, other: PanelPoint<S>, of: impl Fn(S, S) -> S) -> PanelPoint<S> {
    for (here, there) in one.iter_mut().zip(other) {
        *here = of(*here, there);
    }
    one
}

#[inline]
fn halfway<S: Decimal>(one: S, next: S) -> S {
    (one + next).times(0.5)
}

impl<S: Decimal> InFrequency<S> {
    /// Bound on the remainder of a polynomial in s = j w, as a polynomial in w; `None` if there is
    /// none.
    pub(super) fn of_rests(of: &InS<S>) -> Option<InFrequency<S>> {
        let rests = of.0.iter().map(BoxPolynomial::rest);
        let rests: Vec<BoxPolynomial<S>> = rests.map(BoxPolynomial::constant).collect();
        let remains = of.0.iter().any(|one| one.rest().most() != 0.0);
        remains.then(|| InFrequency { real: InS(rests), imaginary: InS(vec![]) })
    }

    /// Polynomial at s = j w: j^0 = 1, j, -1, -j.
    pub(super) fn of(of: &InS<S>) -> InFrequency<S> {
        let part = |own: usize| {
            let signed =
                of.0.iter().enumerate().map(|(power, coefficient)| match (power % 2 == own, power % 4 < 2) {
                    (false, _) => BoxPolynomial::zero(),
                    (true, true) => coefficient.clone(),
                    (true, false) => coefficient.scaled(S::from(-1.0)),
                });
            InS(signed.collect())
        };
        InFrequency { real: part(0), imaginary: part(1) }
    }
}
