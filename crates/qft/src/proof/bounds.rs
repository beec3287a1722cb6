//! Bounds on the images of a sampled plant that are not enclosed individually.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch};

use super::certificate::{Certificate, FrequencyPanel};
use super::claimed::{Claimed, Loop};
use super::images::PlantImages;
use super::panels::walk_band;
use super::walk::{ProofEffort, WalkOutcome};

/// Number of images on either side that are enclosed individually, by the relative degree of the
/// plant: the slower the decay, the more images.
const IMAGES: [usize; 3] = [0, 12, 4];
/// Number of images for greater relative degrees.
const FAR_IMAGES: usize = 3;
/// Factor by which a bound is raised above the value reached.
const ABOVE: f64 = 1.3;
/// Largest number of times that a bound is raised.
const RAISES_MAXIMUM: usize = 40;

/// The certificate with bounds on images, if its loop is sampled; `None` if there are none.
pub(super) fn with_bounds(
    mut certificate: Certificate,
    effort: ProofEffort<'_>,
    watch: Watch<'_>,
) -> Result<Option<Certificate>, Stopped> {
    let Some(mut sampling) = certificate.sampling.take() else { return Ok(Some(certificate)) };
    let mut least = usize::MAX;
    certificate.sampling = Some(sampling.clone());
    for (of_box, bounds) in sampling.bounds.iter_mut().enumerate() {
        let around = Loop::<f64>::over_box(&certificate, of_box);
        let orders = around.as_ref().and_then(Loop::images).and_then(PlantImages::relative_degrees);
        let Some(orders) = orders else { return Ok(None) };
        for (bound, order) in bounds.iter_mut().rev().zip(orders.into_iter().rev()) {
            bound.order = order;
            least = least.min(order);
        }
    }
    sampling.images = IMAGES.get(least).copied().unwrap_or(FAR_IMAGES);
    certificate.sampling = Some(sampling.clone());
    for (of_box, bounds) in sampling.bounds.iter_mut().enumerate() {
        let around = Loop::<f64>::over_box(&certificate, of_box);
        let Some(images) = around.as_ref().and_then(Loop::images) else { return Ok(None) };
        let claims = images.bounded();
        let begin = rounded(images.bound_begin());
        let variables = certificate.plant.variables;
        for (claimed, bound) in claims.iter().zip(bounds) {
            match bounded(claimed, variables, begin, effort, watch)? {
                Some(found) => (bound.ratio, bound.panels) = found,
                None => return Ok(None),
            }
        }
    }
    certificate.sampling = Some(sampling);
    Ok(Some(certificate))
}

/// A claim with a bound of one, raised until it holds: the bound and its proof.
fn bounded(
    claimed: &Claimed<f64>,
    variables: usize,
    begin: f64,
    effort: ProofEffort<'_>,
    watch: Watch<'_>,
) -> Result<Option<(f64, Vec<FrequencyPanel>)>, Stopped> {
    // at the start of the band, with all variables at one
    let [u, v] = [claimed.value_of_u(begin), claimed.value_of_v(begin)]
        .map(|value| value.map_or(f64::NAN, |[re, im]| portable::magnitude(Complex64::new(re, im))));
    let mut ratio = rounded_up(ABOVE * v / u);
    for _ in 0..RAISES_MAXIMUM {
        match walk_band(&claimed.raised(ratio), variables, [begin, f64::INFINITY], effort, watch)? {
            WalkOutcome::Shown(panels) => return Ok(Some((ratio, panels))),
            WalkOutcome::Wrong { ratio: by, .. } => ratio = rounded_up(ratio * by * ABOVE),
            WalkOutcome::Open(_) | WalkOutcome::TooLarge => return Ok(None),
        }
    }
    Ok(None)
}

/// The number rounded down to few digits.
fn rounded(value: f64) -> f64 {
    portable::rounded(value * (1.0 - 1e-4), 6)
}

fn rounded_up(value: f64) -> f64 {
    portable::rounded(value, 4)
}
