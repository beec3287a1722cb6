//! The largest gains of both loops, in closed form at each frequency.

use std::f64::consts::TAU;

use num_complex::Complex64;
use phea_dynamics::controller::InnerFeedback;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;

use super::{InnerLoopLimits, InnerLoopProblem, InnerLoopReach, InnerPoint};

/// A plant within an inner feedback of gain one.
struct FedBackPlant {
    index: usize,
    /// Points of the plant with H Q in place of Q.
    points: Vec<InnerPoint>,
    /// Magnitudes |H| at the points.
    sizes: Vec<f64>,
    /// Reference point likewise.
    reference: InnerPoint,
    /// Signal Q at the reference.
    reference_signal: Complex64,
}

/// Plants within an inner feedback of gain one.
pub(super) struct FedBackPlants {
    limits: InnerLoopLimits,
    sample_time_s: Option<f64>,
    plants: Vec<FedBackPlant>,
}

impl FedBackPlants {
    /// Plants of a problem within a feedback.
    pub(super) fn new(
        problem: &InnerLoopProblem,
        unit: &InnerFeedback,
        plants: &[usize],
    ) -> Result<FedBackPlants, LinearError> {
        let function = problem.deployed(unit)?;
        let at = |point: &InnerPoint| function.at_frequency(point.frequency_rad_per_s);
        let behind = |point: &InnerPoint| InnerPoint { signal: point.signal * at(point), ..*point };
        let shaped = |&index: &usize| {
            let plant = problem.plants.get(index)?;
            Some(FedBackPlant {
                index,
                points: plant.points.iter().map(behind).collect(),
                sizes: plant.points.iter().map(|point| portable::magnitude(at(point))).collect(),
                reference: behind(&plant.reference),
                reference_signal: plant.reference.signal,
            })
        };
        Ok(FedBackPlants {
            limits: problem.limits,
            sample_time_s: problem.timing.sample_time_s,
            plants: plants.iter().filter_map(shaped).collect(),
        })
    }

    /// The largest gain of the inner loop, infinite if nothing limits it.
    pub(super) fn largest_inner_gain(&self) -> f64 {
        let each = self.plants.iter().map(|plant| self.inner_gain_of(plant));
        each.fold(f64::INFINITY, f64::min)
    }

    fn inner_gain_of(&self, plant: &FedBackPlant) -> f64 {
        let limits = self.limits;
        let gain = |point: &InnerPoint| {
            let delayed = (Complex64::ZERO, point.signal);
            let delay = delay_gain(delayed, point.frequency_rad_per_s, limits.delay_margin_s);
            modulus_gain(point.signal, limits.modulus_margin).min(delay)
        };
        plant.points.iter().map(gain).fold(f64::INFINITY, f64::min)
    }

    /// The least |Q| at the reference; `None` without plants.
    pub(super) fn least_reference_signal(&self) -> Option<f64> {
        let each = self.plants.iter().map(|plant| portable::magnitude(plant.reference_signal));
        each.min_by(f64::total_cmp)
    }

    /// Performance of the plants with a gain of the inner loop; `None` without plants, and if a
    /// plant violates a limit of the inner loop.
    pub(super) fn reach(&self, gain: f64) -> Option<InnerLoopReach> {
        let keeps = |plant: &FedBackPlant| self.keeps(plant, gain);
        if !self.plants.iter().all(keeps) {
            return None;
        }
        let outer = self.plants.iter().filter_map(|plant| self.outer_reach(plant, gain));
        let tightest = outer.min_by(|one, other| one.outer_gain.total_cmp(&other.outer_gain))?;
        let closed = self.plants.iter().map(|plant| closed_reference(plant, gain));
        let least = closed.fold(f64::INFINITY, f64::min);
        Some(InnerLoopReach { loop_gain: tightest.outer_gain * least, ..tightest })
    }

    /// The plants that set a limit on a feedback: those that violate a limit of the inner loop
    /// most, or that limit the outer one and its gain.
    pub(super) fn worst(&self, gain: f64) -> Vec<usize> {
        let least = |measure: &dyn Fn(&FedBackPlant) -> f64| {
            let of = |one: &&FedBackPlant, other: &&FedBackPlant| measure(one).total_cmp(&measure(other));
            self.plants.iter().min_by(of).map(|plant| plant.index)
        };
        let outer = |plant: &FedBackPlant| {
            self.outer_reach(plant, gain).map_or(f64::INFINITY, |reach| reach.outer_gain)
        };
        let noise = |plant: &FedBackPlant| -self.command_noise(plant, gain).unwrap_or(0.0);
        let inner = |plant: &FedBackPlant| self.inner_gain_of(plant);
        let reference = |plant: &FedBackPlant| closed_reference(plant, gain);
        let measures: [&dyn Fn(&FedBackPlant) -> f64; 4] = [&inner, &outer, &reference, &noise];
        let mut found: Vec<usize> = measures.into_iter().filter_map(least).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    fn keeps(&self, plant: &FedBackPlant, gain: f64) -> bool {
        let most = self.limits.noise.map_or(f64::INFINITY, |[_, most]| most);
        gain <= self.inner_gain_of(plant) * (1.0 + ROUNDING)
            && self.command_noise(plant, gain).is_none_or(|noise| noise <= most)
    }

    /// The point of a plant that limits the outer loop, with its gain.
    fn outer_reach(&self, plant: &FedBackPlant, gain: f64) -> Option<InnerLoopReach> {
        let reach = |point: &InnerPoint| InnerLoopReach {
            loop_gain: 0.0,
            outer_gain: outer_gain(point, gain, &self.limits),
            plant: plant.index,
            frequency_rad_per_s: point.frequency_rad_per_s,
        };
        let each = plant.points.iter().map(reach);
        each.min_by(|one, other| one.outer_gain.total_cmp(&other.outer_gain))
    }

    /// Rms command that the noise of the signal causes in the inner loop, without the outer one;
    /// `None` if it is not limited.
    fn command_noise(&self, plant: &FedBackPlant, gain: f64) -> Option<f64> {
        let [rms, _] = self.limits.noise?;
        let end = std::f64::consts::PI / self.sample_time_s?;
        let square = |(point, size): (&InnerPoint, &f64)| {
            let amplified = gain * size / portable::magnitude(1.0 + gain * point.signal);
            [point.frequency_rad_per_s, amplified * amplified]
        };
        Some(mean(plant.points.iter().zip(&plant.sizes).map(square), end).sqrt() * rms)
    }
}

/// Magnitude |P'| at the reference.
fn closed_reference(plant: &FedBackPlant, gain: f64) -> f64 {
    let reference = &plant.reference;
    portable::magnitude(reference.plant / (1.0 + gain * reference.signal))
}

/// Relative excess of a gain that counts as rounding error.
const ROUNDING: f64 = 1e-9;

/// The largest gain of a proportional loop around P' at one frequency.
fn outer_gain(point: &InnerPoint, gain: f64, limits: &InnerLoopLimits) -> f64 {
    let inner = gain * point.signal;
    let plant = point.plant / (1.0 + inner);
    let modulus = modulus_gain(plant, limits.modulus_margin);
    let frequency = point.frequency_rad_per_s;
    let fallen =
        if frequency >= limits.highest_bandwidth_rad_per_s { fallen_gain(plant) } else { f64::INFINITY };
    modulus.min(fallen).min(delay_gain((inner, point.plant), frequency, limits.delay_margin_s))
}

/// The least K > 0 with |1 + K L| < m beyond it.
///
/// ```text
/// |L|^2 K^2 + 2 Re(L) K + 1 - m^2 = 0
/// ```
fn modulus_gain(open: Complex64, margin: f64) -> f64 {
    let square = open.norm_sqr();
    let discriminant = open.re * open.re - square * (1.0 - margin * margin);
    if open.re >= 0.0 || discriminant < 0.0 {
        return f64::INFINITY;
    }
    (-open.re - discriminant.sqrt()) / square
}

/// Gain K beyond which |K L/(1 + K L)| exceeds 1/sqrt(2): |L|^2 K^2 - 2 Re(L) K - 1 = 0.
fn fallen_gain(open: Complex64) -> f64 {
    let square = open.norm_sqr();
    (open.re + (open.re * open.re + square).sqrt()) / square
}

/// The least K > 0 for which some delay up to this one makes I + K L reach -1.
///
/// ```text
/// |I + K L| = 1   and   arg(-(I + K L)) <= w T_m, counted from 0 to 2 pi
/// ```
fn delay_gain((inner, open): (Complex64, Complex64), frequency: f64, delay_s: f64) -> f64 {
    let square = open.norm_sqr();
    let half = inner.re * open.re + inner.im * open.im;
    let discriminant = half * half - square * (inner.norm_sqr() - 1.0);
    if delay_s == 0.0 || discriminant < 0.0 || square == 0.0 {
        return f64::INFINITY;
    }
    let root = discriminant.sqrt();
    let reaches = |gain: &f64| {
        let whole = -(inner + *gain * open);
        let turned = portable::argument(whole);
        let lag = if turned < 0.0 { turned + TAU } else { turned };
        *gain > 0.0 && lag <= frequency * delay_s
    };
    let gains = [(-half - root) / square, (-half + root) / square];
    gains.into_iter().filter(reaches).fold(f64::INFINITY, f64::min)
}

/// Mean over frequency from zero to an end, of values at increasing frequencies.
fn mean(values: impl Iterator<Item = [f64; 2]>, end: f64) -> f64 {
    let mut before: Option<[f64; 2]> = None;
    let mut sum = 0.0;
    for [frequency, value] in values {
        let [from, first] = before.unwrap_or([0.0, value]);
        sum += (frequency - from) * (first + value) / 2.0;
        before = Some([frequency, value]);
    }
    let rest = before.map_or(0.0, |[last, value]| (end - last).max(0.0) * value);
    (sum + rest) / end
}
