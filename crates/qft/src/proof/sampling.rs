//! Additional checks for a sampled loop: the controller is sampled, the prefilter is stable, and
//! the images beyond those enclosed individually are bounded.

use phea_dynamics::scalar::{Interval, Scalar};

use super::certificate::{Certificate, ControlLaw, FrequencyPanel, RollOffBound, Sections};
use super::checker::{CertificateNumber, Rejection, check_panels};
use super::claimed::Loop;
use super::hurwitz::{RootLocation, roots_of};
use super::polynomial::Decimal;

/// Largest number of images on either side.
const IMAGES_MAXIMUM: usize = 64;
/// Largest order of a bound.
const ORDER_MAXIMUM: usize = 64;
/// Largest degree of a section.
const SECTION_DEGREE_MAXIMUM: usize = 2;

/// Checks that controller and prefilter fit the loop.
pub(super) fn check_sampling(certificate: &Certificate) -> Result<(), Rejection> {
    let Certificate { feedback, prefilter, sampling, plant, .. } = certificate;
    let Some(sampling) = sampling else {
        let is_continuous = [feedback, prefilter].iter().all(|law| matches!(law, ControlLaw::Continuous(_)));
        return if is_continuous { Ok(()) } else { Err(Rejection::NoSuchLoop) };
    };
    let ControlLaw::Sampled(_) = feedback else { return Err(Rejection::NoSuchLoop) };
    let laws_fit = [feedback, prefilter].iter().all(|law| match law {
        ControlLaw::Continuous(_) => true,
        ControlLaw::Sampled(sections) => is_causal(sections),
    });
    let numbers = sampling.sample_time_s.is_finite() && sampling.sample_time_s > 0.0;
    let images = (1..=IMAGES_MAXIMUM).contains(&sampling.images);
    let bounded = sampling.bounds.len() == plant.boxes.len()
        && sampling.bounds.iter().flatten().all(is_bound)
        && (0.0..=plant.delay_s).contains(&sampling.sensor_delay_s);
    if laws_fit && numbers && images && bounded {
        Ok(())
    } else {
        Err(Rejection::Number(CertificateNumber::Sampling))
    }
}

fn is_bound(bound: &RollOffBound) -> bool {
    bound.ratio.is_finite() && bound.ratio > 0.0 && (1..=ORDER_MAXIMUM).contains(&bound.order)
}

/// Checks for nonzero gain and leading coefficients, and no more zeros than poles.
fn is_causal(Sections { gain, numerator, denominator }: &Sections) -> bool {
    let fits = |section: &Vec<f64>| {
        let leading = section.first().is_some_and(|leading| *leading != 0.0);
        leading && section.len() <= SECTION_DEGREE_MAXIMUM + 1 && section.iter().all(|one| one.is_finite())
    };
    let degree = |sections: &[Vec<f64>]| -> usize { sections.iter().map(|section| section.len() - 1).sum() };
    gain.is_finite()
        && *gain != 0.0
        && numerator.iter().chain(denominator).all(fits)
        && degree(numerator) <= degree(denominator)
}

/// End of the band, pi/T.
pub(super) fn pi_over_t(certificate: &Certificate) -> Option<Interval> {
    let sampling = certificate.sampling.as_ref()?;
    Some(Interval::pi() / Interval::decimal(sampling.sample_time_s))
}

/// Number of poles of a sampled controller.
pub(super) fn poles_of_law(law: &ControlLaw) -> usize {
    match law {
        ControlLaw::Continuous(_) => 0,
        ControlLaw::Sampled(sections) => sections.denominator.iter().map(|section| section.len() - 1).sum(),
    }
}

/// True if all poles of the prefilter are within the unit circle, or to the left of the imaginary
/// axis.
pub(super) fn prefilter_is_stable(certificate: &Certificate, around: &Loop<Interval>) -> bool {
    match &certificate.prefilter {
        ControlLaw::Continuous(_) => roots_of(around.prefilter_denominator()) == RootLocation::AllLeft,
        ControlLaw::Sampled(sections) => sections.denominator.iter().all(|section| is_within_circle(section)),
    }
}

/// True if the roots of a polynomial in zeta = z - 1, of degree two at most, have |z| < 1.
///
/// ```text
/// p = zeta^2 + b1 zeta + b0:    p(z = 1) = b0 > 0,    p(z = -1) = 4 - 2 b1 + b0 > 0,    p(z = 0) = 1 - b1 + b0 < 1
/// ```
fn is_within_circle(section: &[f64]) -> bool {
    let number = |value: f64| if value == 0.0 { Interval::from(0.0) } else { Interval::decimal(value) };
    let is_positive = |value: Interval| value.low() > 0.0;
    match *section {
        [_] => true,
        [leading, b0] => {
            let b0 = number(b0) / number(leading);
            is_positive(b0) && is_positive(Interval::from(2.0) - b0)
        }
        [leading, b1, b0] => {
            let [b1, b0] = [b1, b0].map(|value| number(value) / number(leading));
            is_positive(b0) && is_positive(b1 - b0) && is_positive(Interval::from(4.0) - b1.times(2.0) + b0)
        }
        _ => false,
    }
}

/// Checks the bounds on the images of a box.
pub(super) fn check_bounds(
    certificate: &Certificate,
    of_box: usize,
    around: &Loop<Interval>,
) -> Result<(), Rejection> {
    let Some((sampling, images)) = certificate.sampling.as_ref().zip(around.images()) else { return Ok(()) };
    let claims = images.bounded();
    let bounds = sampling.bounds.get(of_box).ok_or(Rejection::Boxes)?;
    for (claimed, bound) in claims.iter().zip(bounds) {
        let panels: &[FrequencyPanel] = &bound.panels;
        let begin = panels.first().map_or(f64::INFINITY, |panel| panel.from);
        if begin > images.bound_begin().low() {
            return Err(Rejection::Gap(images.bound_begin().low()));
        }
        check_panels(claimed, certificate.plant.variables, [begin, f64::INFINITY], panels)?;
    }
    Ok(())
}
