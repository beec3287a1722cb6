//! Controllers that stabilise a nominal plant by placing its poles: starting points of a search for
//! plants with unstable or undamped poles, which few random controllers stabilise.
//!
//! ```text
//! P ~ n(s)/d(s), simplified        s^q d(s) x(s) + n(s) y(s) = target(s)        G = y(s)/(s^q x(s))
//! ```
//!
//! The target mirrors the poles of the plant into the left half plane and moves them out by a
//! factor, which is scanned. Source: Åström and Murray, Feedback Systems (2008), chapter 7;
//! Goodwin, Graebe and Salgado, Control System Design (2001), chapter 7.

mod placement;

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use self::placement::{by_need, has_to_move, mirror, observer_poles, placed};
use crate::family::{Extent, Family, UncertainFamily};
use crate::loop_shaping::DesignProblem;

/// Factors by which the mirrored poles are moved outwards.
const SPEEDS: [f64; 7] = [0.7, 1.0, 1.5, 2.2, 3.3, 5.0, 8.0];
/// Factors by which the observer poles are faster than those.
const OBSERVER: [f64; 2] = [1.0, 4.0];
/// Fraction of the slowest other pole to which a pole at the origin is moved.
const SLOW: f64 = 0.3;

/// Fraction of the fastest pole to be moved below which a pole stays slow, and multiples of its
/// magnitude at which it is placed.
const MUCH_SLOWER: f64 = 0.1;
const SLOW_SPEEDS: [f64; 3] = [0.3, 1.0, 3.0];

/// Factors by which the mirrored poles are moved outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Speeds {
    control: f64,
    observer: f64,
    /// Factor for poles that are much slower than others that have to move.
    slow: f64,
}

/// Zeros, poles and gain of a plant, including those of its dead time.
#[derive(Clone, Debug, PartialEq)]
struct PlantRoots {
    gain: f64,
    zeros: Vec<Complex64>,
    poles: Vec<Complex64>,
}

/// True if the nominal plant, or that in the middle of the box, has a pole that the loop has to
/// move; false for plants without polynomials.
pub(super) fn has_poles_to_move(problem: &DesignProblem) -> bool {
    let Family::Uncertain(family) = &problem.family else { return false };
    let polynomial = |plant: PlantCoefficients<f64>| Polynomial::new(plant.command.denominator).roots().ok();
    central_plants(family).into_iter().filter_map(polynomial).flatten().any(has_to_move)
}

/// Controllers of at most this order, with this number of integrators, that stabilise
/// simplifications of the nominal plant and of the middle of the box; empty if no pole of the plant
/// is unstable or undamped, and for plants without polynomials.
pub(super) fn stabilising(
    problem: &DesignProblem,
    integrators: usize,
    order: usize,
) -> Vec<TransferFunction> {
    let Family::Uncertain(family) = &problem.family else { return vec![] };
    let delay_s = problem.timing.delay_s + 0.5 * problem.timing.sample_time_s.unwrap_or(0.0);
    let mut found = Vec::new();
    for plant in central_plants(family) {
        let Some(roots) = PlantRoots::of(&plant, &problem.sensor, delay_s) else { continue };
        let kept_least = roots.poles.iter().filter(|pole| has_to_move(**pole)).count();
        if kept_least == 0 {
            continue;
        }
        // for a plant of n poles G has n - 1 + q poles in addition to its q integrators
        let kept_most = (order + 1).saturating_sub(2 * integrators).min(roots.poles.len());
        for cache in kept_least..=kept_most {
            let simple = roots.simplified(cache);
            for (speed, observer) in
                SPEEDS.iter().flat_map(|speed| OBSERVER.map(|observer| (*speed, observer)))
            {
                for slow in simple.slow_speeds() {
                    let speeds = Speeds { control: speed, observer: observer * speed, slow: *slow };
                    found.extend(simple.controller(integrators, speeds));
                }
            }
        }
    }
    found
}

fn central_plants(family: &UncertainFamily) -> Vec<PlantCoefficients<f64>> {
    let plant = family.plant();
    let mut values = vec![plant.nominal()];
    if family.extent() == Extent::Box {
        let middle = plant.parameters().iter().map(|one| 0.5 * (one.minimum + one.maximum)).collect();
        if !values.contains(&middle) {
            values.push(middle);
        }
    }
    values.iter().filter_map(|values| plant.coefficients(values)).collect()
}

impl PlantRoots {
    fn of(plant: &PlantCoefficients<f64>, sensor: &TransferFunction, delay_s: f64) -> Option<PlantRoots> {
        let own = plant.command.transfer_function();
        let rational = own.ok()?.series(&sensor.clone().with_dead_time(0.0).ok()?).ok()?;
        let mut roots = PlantRoots {
            gain: rational.gain(),
            zeros: rational.zeros().to_vec(),
            poles: rational.poles().to_vec(),
        };
        let delay_s = delay_s + plant.dead_time_s + sensor.dead_time_s();
        if delay_s > 0.0 {
            // e^(-sT) ~ (2/T - s)/(2/T + s)
            roots.gain = -roots.gain;
            roots.zeros.push(Complex64::new(2.0 / delay_s, 0.0));
            roots.poles.push(Complex64::new(-2.0 / delay_s, 0.0));
        }
        by_need(&mut roots.poles);
        // the upper pole of each pair first, as `simplified` takes it
        roots.zeros.sort_by(|one, other| {
            one.norm_sqr().total_cmp(&other.norm_sqr()).then(other.im.total_cmp(&one.im))
        });
        let finite = roots.gain.is_finite() && roots.gain != 0.0;
        (finite && roots.poles.len() > roots.zeros.len()).then_some(roots)
    }

    /// The plant reduced to this number of its poles, or one more if a pair would be split: the
    /// poles that have to move and the slowest. The static gain is preserved.
    fn simplified(&self, cache: usize) -> PlantRoots {
        let parts = |at: usize| self.poles.get(at).is_some_and(|pole| pole.im < 0.0);
        let cache = if parts(cache) { cache + 1 } else { cache };
        let (poles, dropped) = self.poles.split_at(cache.min(self.poles.len()));
        let fastest = dropped.iter().map(Complex64::norm_sqr).fold(f64::INFINITY, f64::min);
        let mut most = self.zeros.partition_point(|zero| zero.norm_sqr() < fastest);
        most = most.min(poles.len().saturating_sub(1));
        if self.zeros.get(most).is_some_and(|zero| zero.im < 0.0) {
            most = most.saturating_sub(1);
        }
        let (zeros, left_out) = self.zeros.split_at(most.min(self.zeros.len()));
        let at_rest = |roots: &[Complex64]| {
            roots.iter().fold(Complex64::new(1.0, 0.0), |product, root| product * -root)
        };
        let gain = self.gain * (at_rest(left_out) / at_rest(dropped)).re;
        PlantRoots { gain, zeros: zeros.to_vec(), poles: poles.to_vec() }
    }

    /// The controller that places the poles of the loop; `None` if it has roots in the right half
    /// plane, which structures cannot have.
    fn controller(&self, integrators: usize, speeds: Speeds) -> Option<TransferFunction> {
        let scale = self.scale()?;
        let scaled = |roots: &[Complex64]| roots.iter().map(|root| root / scale).collect::<Vec<_>>();
        let origin = vec![Complex64::new(0.0, 0.0); integrators];
        let slowest = self.poles.iter().map(|pole| portable::magnitude(*pole)).filter(|size| *size > 0.0);
        let slow = SLOW * slowest.fold(f64::INFINITY, f64::min) / scale;
        let poles = [origin, scaled(&self.poles)].concat();
        let power = (self.zeros.len() as i32) - (self.poles.len() as i32);
        let gain = self.gain * portable::exp(f64::from(power) * portable::ln(scale));
        let denominator = Polynomial::from_roots(1.0, &poles).ok()?;
        let numerator = Polynomial::from_roots(gain, &scaled(&self.zeros)).ok()?;
        let much_slower = self.much_slower() / scale;
        let mirrored = |speed: f64| -> Vec<Complex64> {
            let own = |pole: &Complex64| {
                if portable::magnitude(*pole) < much_slower { speeds.slow } else { speed }
            };
            poles.iter().rev().map(|pole| own(pole) * mirror(*pole, slow)).collect()
        };
        let target = [mirrored(speeds.control), observer_poles(&mirrored(speeds.observer))].concat();
        let target = Polynomial::from_roots(1.0, &target).ok()?;
        let (x, y) = placed(&denominator, &numerator, &target)?;
        let back = |roots: Vec<Complex64>| roots.into_iter().map(|root| root * scale).collect::<Vec<_>>();
        let (zeros, own) = (back(y.roots().ok()?), back(x.roots().ok()?));
        if zeros.iter().chain(&own).any(|root| root.re >= 0.0) {
            return None;
        }
        let poles = [vec![Complex64::new(0.0, 0.0); integrators], own].concat();
        let excess = poles.len() as f64 - zeros.len() as f64;
        let gain =
            y.leading_coefficient() / x.leading_coefficient() * portable::exp(excess * portable::ln(scale));
        TransferFunction::from_factors(gain, zeros, poles).ok()
    }

    /// The magnitude below which poles stay slow.
    fn much_slower(&self) -> f64 {
        let moved = self.poles.iter().filter(|pole| has_to_move(**pole));
        MUCH_SLOWER * moved.map(|pole| portable::magnitude(*pole)).fold(0.0, f64::max)
    }

    /// Candidate factors for poles that stay slow; a single one if there is no such pole.
    fn slow_speeds(&self) -> &'static [f64] {
        let below = self.much_slower();
        let any = self.poles.iter().any(|pole| portable::magnitude(*pole) < below && pole.norm_sqr() > 0.0);
        if any { &SLOW_SPEEDS } else { &SLOW_SPEEDS[..1] }
    }

    /// The geometric mean of the magnitudes of the poles away from the origin.
    fn scale(&self) -> Option<f64> {
        let sizes = self.poles.iter().map(|pole| portable::magnitude(*pole)).filter(|size| *size > 0.0);
        let logarithms: Vec<f64> = sizes.map(portable::ln).collect();
        let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
        (!logarithms.is_empty()).then(|| portable::exp(mean))
    }
}
