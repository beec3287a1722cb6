//! A part of a panel and of the box, with the control points of a claim on it and, for a sampled
//! loop, the images of its plant.

use std::borrow::Cow;

use super::certificate::Late;
use super::claimed::Claimed;
use super::dead_time::ends;
use super::images::{ImageDisc, ImagePoints, Which};
use super::points::{PanelRange, Points};
use super::polynomial::Decimal;

/// Part of a panel and of the box.
#[derive(Clone, Debug)]
pub(crate) struct Patch<S> {
    /// Control points without the images.
    own: Points<S>,
    images: Option<ImagedPlant<S>>,
}

/// The factors of the images of a plant, and the images: for U, and for V if they differ.
#[derive(Clone, Debug)]
struct ImagedPlant<S> {
    multiplied: Points<S>,
    of_u: ImagePoints<S>,
    of_v: Option<ImagePoints<S>>,
}

impl<S: Decimal> Patch<S> {
    /// Patch of a whole panel and the whole box; `None` if there are too many points.
    pub(crate) fn over(claimed: &Claimed<S>, variables: usize, range: PanelRange) -> Option<Patch<S>> {
        let (own, multiplied) = Points::over(claimed, variables, range)?;
        let images = match claimed.images.as_ref().zip(multiplied) {
            None => None,
            Some((images, multiplied)) => {
                let [u, v] = claimed.which;
                // images with a factor of zero are not needed
                let of = |sum: &[_], which: Which| match sum.is_empty() {
                    true => Ok(None),
                    false => images.over(which, variables, range).map(Some).ok_or(()),
                };
                let of_u = of(&claimed.u[2], u).ok()?;
                let of_v = if u == v && of_u.is_some() { None } else { of(&claimed.v[2], v).ok()? };
                match (of_u, of_v) {
                    (Some(of_u), of_v) => Some(ImagedPlant { multiplied, of_u, of_v }),
                    (None, Some(of_v)) => Some(ImagedPlant { multiplied, of_u: of_v, of_v: None }),
                    (None, None) => None,
                }
            }
        };
        Some(Patch { own, images })
    }

    /// Number of its control points, including those of the images.
    pub(crate) fn size(&self) -> usize {
        let of_images = self.images.as_ref().map_or(0, |images| {
            let own = images.multiplied.points().len() + images.of_u.size();
            own + images.of_v.as_ref().map_or(0, ImagePoints::size)
        });
        self.own.points().len() + of_images
    }

    pub(crate) fn axes(&self) -> usize {
        self.own.axes()
    }

    /// Both halves across an axis.
    pub(crate) fn halves(self, axis: usize) -> [Patch<S>; 2] {
        let [low, high] = self.own.halves(axis);
        let Some(ImagedPlant { multiplied, of_u, of_v }) = self.images else {
            return [low, high].map(|own| Patch { own, images: None });
        };
        let [low_multiplied, high_multiplied] = multiplied.halves(axis);
        let [low_u, high_u] = of_u.halves(axis);
        let [low_v, high_v] = match of_v.map(|of_v| of_v.halves(axis)) {
            Some(halves) => halves.map(Some),
            None => [None, None],
        };
        let one =
            |own, multiplied, of_u, of_v| Patch { own, images: Some(ImagedPlant { multiplied, of_u, of_v }) };
        [one(low, low_multiplied, low_u, low_v), one(high, high_multiplied, high_u, high_v)]
    }

    /// Control points, including those of the images.
    pub(crate) fn points(&self) -> Cow<'_, Points<S>> {
        match &self.images {
            None => Cow::Borrowed(&self.own),
            Some(images) => Cow::Owned(self.own.with_images(&images.multiplied, images.discs())),
        }
    }

    /// Control points as if the images were known exactly, and the image known least accurately;
    /// `None` without images.
    pub(crate) fn with_known_images(&self) -> Option<(Points<S>, &Points<S>)> {
        let images = self.images.as_ref()?;
        let known = images.discs().map(|disc| ImageDisc { radius: S::from(0.0), ..disc });
        Some((self.own.with_images(&images.multiplied, known), images.of_u.least_known()?))
    }
}

impl<S: Decimal> ImagedPlant<S> {
    fn discs(&self) -> [ImageDisc<S>; 2] {
        let of_u = self.of_u.disc();
        [of_u, self.of_v.as_ref().map_or(of_u, ImagePoints::disc)]
    }
}

/// Upper bound of |U| and lower bound of |V|, at a frequency or in the limit towards infinity;
/// coefficients are numbers.
pub(super) fn at_point<S: Decimal>(claimed: &Claimed<S>, frequency_rad_per_s: f64) -> Option<[S; 2]> {
    // the first control point over a panel is the value at its start
    let is_late = !claimed.dead_time.value.is_zero();
    let range = match frequency_rad_per_s.is_finite() {
        true => {
            let [least, most] = ends(&claimed.dead_time);
            let angle = 0.5 * frequency_rad_per_s * (least.least() + most.most());
            let late = if is_late { Late::Turns(angle) } else { Late::Not };
            PanelRange { from: frequency_rad_per_s, to: frequency_rad_per_s, late }
        }
        false => {
            PanelRange { from: 1.0, to: f64::INFINITY, late: if is_late { Late::Less } else { Late::Not } }
        }
    };
    if range.to.is_infinite() {
        // both divided by one power of the frequency
        let [ur, ui, vr, vi, rest] = Patch::over(claimed, 0, range)?.points().points().first()?.map(S::abs);
        return Some([(ur * ur + ui * ui).sqrt() + rest, (vr * vr + vi * vi).sqrt() - rest]);
    }
    let nothing = || std::array::from_fn(|_| vec![]);
    let own = [Claimed { v: nothing(), ..claimed.clone() }, Claimed { u: nothing(), ..claimed.clone() }];
    let [at_u, at_v] =
        own.map(|one| Some(Patch::over(&one, 0, range)?.points().points().first()?.map(S::abs)));
    let ([ur, ui, _, _, of_u], [_, _, vr, vi, of_v]) = (at_u?, at_v?);
    // a remainder changes |U| and |V| by at most this much
    Some([(ur * ur + ui * ui).sqrt() + of_u, (vr * vr + vi * vi).sqrt() - of_v])
}
