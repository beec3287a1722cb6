//! Behaviour of the identified friction, compared with the recordings.

use phea_dynamics::least_squares::Minimum;
use phea_hydraulics::friction::KnottedForce;

use super::FrictionIdentification;
use super::motion::ConstantVelocity;
use super::pressing::PressedRows;
use super::problem::{FrictionProblem, SHARED, ShapeCache};
use super::shaking::ShakenRows;

/// Friction force at a constant velocity. Units: m/s, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyPoint {
    /// Index of the recording.
    pub recording: usize,
    /// Velocity v.
    pub velocity: f64,
    /// Recorded force over the second half of the rows, without the zero error.
    pub force: f64,
    /// Force of the identified curve.
    pub modelled: f64,
}

/// Position as a function of force for a piston that is pressed or shaken. Units: N, m.
#[derive(Clone, Debug, PartialEq)]
pub struct PressedCurve {
    /// Recorded force without the zero error.
    pub forces: Vec<f64>,
    /// Recorded position, relative to its beginning.
    pub positions: Vec<f64>,
    /// Explained force.
    pub modelled_forces: Vec<f64>,
    /// Explained position.
    pub modelled_positions: Vec<f64>,
}

impl ConstantVelocity {
    /// Mean of the recorded force over the second half, N.
    pub fn settled_force(&self) -> f64 {
        let half = self.blocks.get(self.blocks.len() / 2..).unwrap_or_default();
        let rows: f64 = half.iter().map(|block| block.rows as f64).sum();
        half.iter().map(|block| block.rows as f64 * block.force).sum::<f64>() / rows.max(1.0)
    }
}

impl PressedRows {
    /// A number with the sign of the change of the force, which is that of the direction of
    /// breakaway.
    pub(super) fn way(&self) -> f64 {
        let ends = self.force.forces.last().zip(self.force.forces.first());
        ends.map_or(0.0, |(last, first)| last - first)
    }
}

impl FrictionIdentification {
    /// Recorded friction map, and the curve at its velocities.
    pub fn steady_points(&self) -> Vec<SteadyPoint> {
        let zero = self.zero.as_ref().map_or(0.0, |zero| zero.value);
        let point = |slide: &ConstantVelocity| SteadyPoint {
            recording: slide.recording,
            velocity: slide.velocity,
            force: slide.settled_force() - zero,
            modelled: self.lugre.curve.steady_force(slide.velocity),
        };
        self.slides.iter().map(point).collect()
    }

    /// Recorded and explained curve of a shake.
    pub fn shaken_curve(&self, index: usize) -> Option<&PressedCurve> {
        self.shaken.get(index)
    }

    /// Recorded and explained position of a press.
    pub fn pressed_curve(&self, index: usize) -> Option<PressedCurve> {
        let zero = self.zero.as_ref().map_or(0.0, |zero| zero.value);
        let press = self.presses.get(index)?;
        let (knots, begins) = self.pressed.get(index)?;
        let recording = self.recordings.get(press.recording)?;
        let acting = knots.iter().map(|force| force - zero).collect();
        let acting = KnottedForce { knots: press.force.knots.clone(), forces: acting };
        let pressed = super::problem::pressed_mass(self.moving_mass, &self.lugre, recording.time_step);
        let moved = pressed.sensitive_displacements(&self.lugre, &acting).displacements;
        let start = recording.positions.first()? + begins;
        let at = |index: usize| acting.forces.get(index).copied().unwrap_or(0.0);
        let along = |(knot, fraction): (usize, f64)| at(knot) * (1.0 - fraction) + at(knot + 1) * fraction;
        Some(PressedCurve {
            forces: recording.forces.iter().take(press.rows).map(|force| force - zero).collect(),
            positions: recording.positions.iter().take(press.rows).map(|at| at - start).collect(),
            modelled_forces: acting.fractions().into_iter().map(along).collect(),
            modelled_positions: moved,
        })
    }
}

/// Force and position of each shake.
pub(super) fn shaken(
    problem: &FrictionProblem<'_>,
    minimum: &Minimum,
    cache: &mut ShapeCache,
) -> Vec<PressedCurve> {
    let (lugre, zero) = problem.friction(&minimum.variables);
    let mut first = problem.first_of_shakes();
    let of = |shake: &ShakenRows| {
        let own = minimum.variables.get(first..first + shake.variable_count())?;
        first += shake.variable_count();
        let recording = problem.recordings.get(shake.recording)?;
        let found = problem.shake_of(own)?;
        let start = recording.positions.first()? + found.begins;
        let modelled = cache.at_rows(shake, recording.time_step).times(&found.sizes);
        let moved = found.moved((problem.mass, recording.time_step), &lugre, zero, (shake, cache));
        Some(PressedCurve {
            forces: recording.forces.iter().map(|force| force - zero).collect(),
            positions: recording.positions.iter().map(|at| at - start).collect(),
            modelled_forces: modelled.into_iter().map(|force| force - zero).collect(),
            modelled_positions: moved.displacements,
        })
    };
    problem.shakes.iter().filter_map(of).collect()
}

/// Root mean square of the residual forces, N, and positions, m.
pub(super) fn residual_rms(problem: &FrictionProblem<'_>, minimum: &Minimum) -> [Option<f64>; 2] {
    let groups = problem.sliding_channels();
    let mut sums = [(0.0, 0.0); 2];
    for (index, channel) in problem.channels.iter().enumerate() {
        let is_position = index >= groups && (index - groups) % 2 == 1;
        let [from, to] = channel.residuals;
        let own = minimum.linearised.residuals.get(from..to).unwrap_or_default();
        let scale = channel.effective_scale();
        let (sum, count) = if is_position { &mut sums[1] } else { &mut sums[0] };
        *sum += own.iter().map(|residual| residual * residual * scale * scale).sum::<f64>();
        *count += own.len() as f64;
    }
    sums.map(|(sum, count)| (count > 0.0).then(|| f64::sqrt(sum / count)))
}

/// Measured force of each press at its knots, N, and initial position, m.
pub(super) fn pressed(problem: &FrictionProblem<'_>, minimum: &Minimum) -> Vec<(Vec<f64>, f64)> {
    let mut first = SHARED + problem.slides.len();
    let of = |press: &PressedRows| {
        let knots = press.force.knots.len();
        let own = minimum.variables.get(first..=first + knots).unwrap_or_default();
        first += 1 + knots;
        let (begins, forces) = own.split_first().unwrap_or((&0.0, &[]));
        let forces = forces.iter().map(|value| value * problem.around.force).collect();
        (forces, begins * problem.around.length)
    };
    problem.presses.iter().map(of).collect()
}
