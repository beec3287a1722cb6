//! The plants that are examined, each with the properties that no controller can change.

use num_complex::Complex64;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::plane::{Plane, vanishing};
use crate::closed_loop::{Compensation, Member};
use crate::family::Family;
use crate::family::corners;
use crate::verification::PlantPoint;

/// Plants that are examined: the nominal one, corners of the box, members.
const PLANTS_MAXIMUM: usize = 96;
const CORNERS_MAXIMUM: usize = 64;
/// Fraction of a root's magnitude below which its real part counts as zero.
const ON_THE_AXIS: f64 = 1e-9;

/// A plant within its loop.
#[derive(Clone, Debug)]
pub(super) struct PlantWithinLoop {
    pub(super) point: PlantPoint,
    pub(super) member: Member,
    /// Plant P, if it is rational.
    pub(super) command: Option<RationalCoefficients<f64>>,
    /// Poles of P H in the open right half plane, rad/s.
    pub(super) unstable_poles: Vec<Complex64>,
    /// Images of these poles in the plane of the loop.
    pub(super) poles: Vec<Complex64>,
    /// Images of the zeros of P H that are in the open half plane.
    pub(super) zeros: Vec<Complex64>,
    /// Number of zeros at z = infinity: samples of delay.
    pub(super) delays: usize,
    /// Dead time of plant, sensor and loop, s; in a sampled loop it is included in `delays`.
    pub(super) dead_time_s: f64,
    /// Frequencies of the poles of P H on the axis, rad/s.
    pub(super) axis_poles: Vec<f64>,
    /// Frequencies of the zeros of P on the axis, rad/s.
    pub(super) axis_zeros: Vec<f64>,
    /// Magnitudes of all roots, rad/s.
    pub(super) features: Vec<f64>,
}

/// Plants of a family, each of which the loop must control.
pub(super) fn candidates(family: &Family, compensation: &Compensation) -> Vec<PlantWithinLoop> {
    match family {
        Family::Uncertain(uncertain) => {
            let mut chosen: Vec<&Vec<f64>> = uncertain.members().iter().take(1).collect();
            let corners = corners(uncertain);
            for values in strided(&corners, CORNERS_MAXIMUM) {
                if !chosen.contains(&values) {
                    chosen.push(values);
                }
            }
            for values in strided(uncertain.members(), PLANTS_MAXIMUM - chosen.len()) {
                if !chosen.contains(&values) {
                    chosen.push(values);
                }
            }
            let seen = |values: &Vec<f64>| {
                let point = PlantPoint::Parameters(values.clone());
                let member = compensation.member_of(uncertain.plant(), values).ok()?;
                match uncertain.plant().coefficients(values) {
                    Some(plant) => PlantWithinLoop::rational(point, plant.command, member, compensation),
                    None => Some(PlantWithinLoop::without_roots(point, member, compensation)),
                }
            };
            chosen.into_iter().filter_map(seen).collect()
        }
        Family::Measured(measured) => {
            let plants = measured.plants().iter().enumerate().take(PLANTS_MAXIMUM);
            plants
                .map(|(index, plant)| {
                    let member = compensation.measured(plant);
                    PlantWithinLoop::without_roots(PlantPoint::Measured(index), member, compensation)
                })
                .collect()
        }
    }
}

/// Evenly spaced choices, including the first and the last.
fn strided<T>(all: &[T], most: usize) -> impl Iterator<Item = &T> {
    let count = all.len().min(most);
    let last = all.len().saturating_sub(1);
    (0..count).filter_map(move |index| all.get(index * last / count.saturating_sub(1).max(1)))
}

impl PlantWithinLoop {
    /// Candidate for a plant without polynomials: its roots are unknown; conclusions that need no
    /// roots still hold.
    fn without_roots(point: PlantPoint, member: Member, compensation: &Compensation) -> PlantWithinLoop {
        let dead_time_s = compensation.delay_s() + compensation.sensor().dead_time_s();
        let sample = compensation.sample_time_s();
        PlantWithinLoop {
            point,
            member,
            command: None,
            unstable_poles: Vec::new(),
            poles: Vec::new(),
            zeros: Vec::new(),
            delays: sample.map_or(0, |sample| (dead_time_s / sample + ON_THE_AXIS).floor() as usize),
            dead_time_s: if sample.is_some() { 0.0 } else { dead_time_s },
            axis_poles: Vec::new(),
            axis_zeros: Vec::new(),
            features: Vec::new(),
        }
    }

    /// Candidate for a rational plant; `None` if the plant is zero, or its roots are not found.
    fn rational(
        point: PlantPoint,
        command: RationalCoefficients<f64>,
        member: Member,
        compensation: &Compensation,
    ) -> Option<PlantWithinLoop> {
        let plane = Plane { sample_time_s: compensation.sample_time_s() };
        let sensor = compensation.sensor();
        let roots = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec()).roots().ok();
        let mut poles = roots(&command.denominator)?;
        let plant_zeros = roots(&command.numerator)?;
        poles.extend(sensor.poles());
        let zeros: Vec<Complex64> = plant_zeros.iter().chain(sensor.zeros()).copied().collect();
        let unstable_poles: Vec<Complex64> = poles.iter().copied().filter(is_right).collect();
        let (zeros_right, delays, dead_time_s) = match &member {
            Member::Sampled { with_sensor, .. } => {
                let excess = with_sensor.poles().len().saturating_sub(with_sensor.zeros().len());
                let sample = plane.sample_time_s.unwrap_or(1.0);
                let samples = (with_sensor.dead_time_s() / sample).round() as usize;
                (images_of_z(plane, with_sensor.zeros()), excess + samples, 0.0)
            }
            Member::Continuous { plant, sensor, .. } => {
                let right = zeros.iter().copied().filter(is_right).collect();
                (right, 0, plant.dead_time_s + sensor.dead_time_s())
            }
            Member::Responding { .. } | Member::Measured { .. } => return None,
        };
        let size = |root: &Complex64| portable::magnitude(*root);
        Some(PlantWithinLoop {
            point,
            member,
            command: Some(command),
            poles: unstable_poles.iter().map(|pole| plane.image(*pole)).collect(),
            unstable_poles,
            zeros: zeros_right,
            delays,
            dead_time_s,
            axis_poles: on_the_axis(&poles, &zeros),
            axis_zeros: on_the_axis(&plant_zeros, &poles),
            features: poles.iter().chain(&zeros).map(size).collect(),
        })
    }

    /// Magnitude |S| at a point of the half plane over its mean on the boundary; the zeros are the
    /// unstable poles.
    pub(super) fn sensitivity_factor(&self, point: Complex64) -> f64 {
        vanishing(point, &self.poles)
    }

    /// Likewise for |T|: its zeros are those of P H, and dead time has magnitude 1 on the boundary.
    pub(super) fn complementary_factor(&self, plane: Plane, point: Complex64) -> f64 {
        let delays = plane.image_of_delay().map_or(1.0, |delay| {
            let one = vanishing(point, &[Complex64::new(delay, 0.0)]);
            (0..self.delays).map(|_| one).product()
        });
        vanishing(point, &self.zeros) * delays * portable::exp(-point.re * self.dead_time_s)
    }

    /// Dead time of the loop including its samples of delay, s.
    pub(super) fn delay_s(&self, plane: Plane) -> f64 {
        self.dead_time_s + plane.sample_time_s.unwrap_or(0.0) * self.delays as f64
    }
}

fn is_right(root: &Complex64) -> bool {
    root.re > ON_THE_AXIS * portable::magnitude(*root)
}

/// Zeros outside the unit circle. Zeros next to z = 1 are omitted: rounding may have moved them
/// outside.
fn images_of_z(plane: Plane, zeros: &[Complex64]) -> Vec<Complex64> {
    const NEXT_TO: f64 = 1e-6;
    let scale = plane.image_of_delay().unwrap_or(1.0);
    let outside = |z: &&Complex64| {
        portable::magnitude(**z) > 1.0 + NEXT_TO && portable::magnitude(**z - 1.0) > 10.0 * NEXT_TO
    };
    zeros.iter().filter(outside).map(|z| (z - 1.0) / (z + 1.0) * scale).collect()
}

/// Frequencies of the roots on the axis that no other root cancels.
fn on_the_axis(roots: &[Complex64], others: &[Complex64]) -> Vec<f64> {
    let lies =
        |root: &&Complex64| root.im >= 0.0 && root.re.abs() <= ON_THE_AXIS * portable::magnitude(**root);
    let apart = |root: &&Complex64| {
        let near =
            |other: &Complex64| portable::magnitude(other - **root) <= 1e-6 * portable::magnitude(**root);
        !others.iter().any(near)
    };
    roots.iter().filter(lies).filter(apart).map(|root| root.im).collect()
}
