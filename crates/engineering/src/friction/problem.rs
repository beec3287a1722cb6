//! Problem of explaining all recordings by one friction: residuals with derivatives.

mod shake;
mod variables;

pub(super) use shake::ShapeCache;
pub(super) use variables::{DAMPING, EXTENDING, LevelVariables, RETRACTING, SHARED, ZERO};

use phea_dynamics::least_squares::{Ending, Linearised, Minimum, Settings, minimise};
use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_hydraulics::friction::{FRICTION_COEFFICIENTS, KnottedForce, LuGre, PressedMass, Stribeck};

use super::FrictionRecording;
use super::directions::DirectionModel;
use super::motion::ConstantVelocity;
use super::pressing::PressedRows;
use super::shaking::ShakenRows;
use phea_dynamics::order::median;

/// Largest number of evaluations of a search.
const EVALUATIONS: usize = 60;

/// Angle by which the mass oscillates on its bristles in an integration step, rad.
const STEP_ANGLE: f64 = 0.3;

/// Largest number of steps between two rows.
const MOST_STEPS: f64 = 20.0;

/// Least scale of the force during sliding, relative to the force at breakaway.
const FINEST_SLIDING: f64 = 1e-9;

/// Least scale of a force that presses or shakes, and of the position, relative to force and
/// deflection at breakaway: finer than that of instruments. The values of the force are variables
/// too, and a force without noise would outweigh the position by so much that rounding would spoil
/// it.
const FINEST: f64 = 1e-5;

/// First scale of the position of a shaken piston, relative to its swing: from an initial estimate
/// with residuals much larger than the noise, a robust search would take all rows for outliers.
const FIRST_SCALE: f64 = 0.1;

/// Ratios of static friction to its initial estimate from which a search is repeated if it does not
/// start.
const RAISED: [f64; 5] = [1.05, 1.1, 1.2, 1.5, 2.0];

/// Friction around which the search is made, and the scales of the variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Around {
    /// Friction with F_S at least F_C.
    pub(super) lugre: LuGre,
    /// Scale of force, N.
    pub(super) force: f64,
    /// Scales of sigma_2 and of sigma_1, N·s/m.
    pub(super) damping: [f64; 2],
    /// Scale of length, m.
    pub(super) length: f64,
    /// Zero error of the force, N.
    pub(super) zero: f64,
    /// Least stiffness of the bristles, N/m: softer ones would not have settled in the sliding
    /// runs.
    pub(super) softest: f64,
}

/// A signal of one recording, and the scale of its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrictionChannel {
    /// Scale of each row.
    pub(super) scale: f64,
    /// Indices of the first residual, and of the one after the last.
    pub(super) residuals: [usize; 2],
    /// Fraction of the residuals that are independent.
    pub(super) independent: f64,
    /// Noise of each row, from its differences.
    pub(super) noise: f64,
    /// Least scale of each row: finer weights would hide all others in rounding.
    pub(super) finest: f64,
}

/// Recordings to be explained, and the model.
#[derive(Clone, Debug)]
pub(super) struct FrictionProblem<'a> {
    pub(super) recordings: &'a [FrictionRecording],
    pub(super) slides: &'a [ConstantVelocity],
    pub(super) presses: &'a [PressedRows],
    pub(super) shakes: &'a [ShakenRows],
    pub(super) mass: f64,
    pub(super) around: Around,
    /// True if friction acts in both directions, which a zero error of the force does not.
    pub(super) goes_both_ways: bool,
    /// Model of the two directions.
    pub(super) directions: DirectionModel,
    /// One channel for each sliding recording; then force and position of each press, and of each
    /// shake.
    pub(super) channels: Vec<FrictionChannel>,
}

impl<'a> FrictionProblem<'a> {
    pub(super) fn new(
        recordings: &'a [FrictionRecording],
        slides: &'a [ConstantVelocity],
        (presses, shakes): (&'a [PressedRows], &'a [ShakenRows]),
        (mass, around): (f64, Around),
        goes_both_ways: bool,
    ) -> FrictionProblem<'a> {
        let mut channels = Vec::new();
        let mut first = 0;
        let mut channel = |noise: f64, finest: f64, count: usize| {
            let residuals = [first, first + count];
            first += count;
            let scale = noise.max(finest);
            channels.push(FrictionChannel { scale, residuals, independent: 1.0, noise: scale, finest });
        };
        for group in slides.chunk_by(|one, next| one.recording == next.recording) {
            let recording = group.first().and_then(|slide| recordings.get(slide.recording));
            let noise = recording.map_or(1.0, |recording| super::motion::noise(&recording.forces));
            channel(noise, FINEST_SLIDING * around.force, group.iter().map(|slide| slide.blocks.len()).sum());
        }
        let pressed = presses.iter().map(|press| (press.noise, press.rows));
        for (noise, rows) in pressed.chain(shakes.iter().map(|shake| (shake.noise, shake.force.rows))) {
            for (noise, size) in noise.iter().zip([around.force, around.length]) {
                channel(*noise, FINEST * size, rows);
            }
        }
        let positions = channels.iter_mut().rev().step_by(2);
        for (position, shake) in positions.zip(shakes.iter().rev()) {
            position.scale = position.scale.max(FIRST_SCALE * shake.swing());
        }
        let directions = DirectionModel::SameBothWays;
        FrictionProblem {
            recordings,
            slides,
            presses,
            shakes,
            mass,
            around,
            goes_both_ways,
            directions,
            channels,
        }
    }

    /// Number of channels of sliding; force and position of each press and shake follow.
    pub(super) fn sliding_channels(&self) -> usize {
        self.channels.len() - 2 * (self.presses.len() + self.shakes.len())
    }

    /// Index of the first residual that is not of sliding.
    pub(super) fn first_row_of_others(&self) -> usize {
        let mut sliding = self.channels.iter().take(self.sliding_channels());
        sliding.next_back().map_or(0, |channel| channel.residuals[1])
    }

    /// Residuals divided by their scales, with derivatives; `None` if there is no such friction, or
    /// the simulation does not reach its end.
    fn linearised(&self, variables: &[f64], cache: &mut ShapeCache) -> Option<Linearised> {
        let (lugre, zero) = self.friction(variables);
        if !slides_at_all(&lugre) {
            return None;
        }
        let all = self.channels.last().map_or(0, |channel| channel.residuals[1]);
        let mut rows = ResidualRows::with_room_for(all, self.count());
        self.slid_rows(variables, (&lugre, zero), &mut rows)?;
        let mut channels = self.channels.iter().skip(self.sliding_channels());
        let mut first = SHARED + self.slides.len();
        for press in self.presses {
            let scales = [channels.next()?, channels.next()?].map(FrictionChannel::effective_scale);
            let knots = press.force.knots.len();
            let own = variables.get(first..=first + knots)?;
            self.press(press, (&lugre, zero), (first, own), scales, &mut rows)?;
            first += 1 + knots;
        }
        for shake in self.shakes {
            let scales = [channels.next()?, channels.next()?].map(FrictionChannel::effective_scale);
            let count = shake.variable_count();
            let own = variables.get(first..first + count)?;
            self.shake(shake, (&lugre, zero), (first, own), scales, (cache, &mut rows))?;
            first += count;
        }
        Some(rows.found)
    }

    /// Linearisation of only the sliding rows, with respect to the shared variables and those of
    /// the slides.
    pub(super) fn slides_linearised(&self, variables: &[f64]) -> Option<Linearised> {
        let friction = self.friction(variables);
        if !slides_at_all(&friction.0) {
            return None;
        }
        let mut rows = ResidualRows::with_room_for(self.first_row_of_others(), variables.len());
        self.slid_rows(variables, (&friction.0, friction.1), &mut rows)?;
        Some(rows.found)
    }

    fn slid_rows(&self, variables: &[f64], friction: (&LuGre, f64), rows: &mut ResidualRows) -> Option<()> {
        let mut channels = self.channels.iter();
        let mut recording = None;
        let mut scale = 1.0;
        for (index, slide) in self.slides.iter().enumerate() {
            if recording != Some(slide.recording) {
                recording = Some(slide.recording);
                scale = channels.next()?.effective_scale();
            }
            let place = SHARED + index;
            self.slide(slide, friction, (place, *variables.get(place)?), scale, rows);
        }
        Some(())
    }

    fn slide(
        &self,
        slide: &ConstantVelocity,
        (lugre, zero): (&LuGre, f64),
        (place, left): (usize, f64),
        scale: f64,
        rows: &mut ResidualRows,
    ) {
        let force = self.around.force;
        for block in &slide.blocks {
            let (shown, gradient) = block.slid.sensitive_force(lugre, left * force);
            let scale = scale / (block.rows as f64).sqrt();
            let row = rows.next((shown + zero - block.force) / scale);
            let slopes = self.shared_slopes(lugre, &gradient);
            for (to, slope) in row.iter_mut().zip(slopes) {
                *to = slope / scale;
            }
            let own = [(ZERO, 1.0), (place, gradient[FRICTION_COEFFICIENTS])];
            for (index, slope) in own {
                if let Some(to) = row.get_mut(index) {
                    *to = slope * force / scale;
                }
            }
        }
    }

    fn press(
        &self,
        press: &PressedRows,
        (lugre, zero): (&LuGre, f64),
        (first, own): (usize, &[f64]),
        [force_scale, position_scale]: [f64; 2],
        rows: &mut ResidualRows,
    ) -> Option<()> {
        let Around { force, length, .. } = self.around;
        let recording = self.recordings.get(press.recording)?;
        let (begins, knots) = own.split_first()?;
        // the pressures show the acting force plus the zero error
        let measured: Vec<f64> = knots.iter().map(|value| value * force).collect();
        let acting = measured.iter().map(|value| value - zero).collect();
        let acting = KnottedForce { knots: press.force.knots.clone(), forces: acting };
        let fractions = acting.fractions();
        for ((knot, fraction), shown) in fractions.iter().zip(&recording.forces) {
            let at = |index: usize| measured.get(index).copied().unwrap_or(0.0);
            let modelled = at(*knot) * (1.0 - fraction) + at(knot + 1) * fraction;
            let row = rows.next((modelled - shown) / force_scale);
            for (index, weight) in [(*knot, 1.0 - fraction), (knot + 1, *fraction)] {
                if let Some(to) = row.get_mut(first + 1 + index) {
                    *to += weight * force / force_scale;
                }
            }
        }
        let moved =
            pressed_mass(self.mass, lugre, recording.time_step).sensitive_displacements(lugre, &acting);
        let start = *recording.positions.first()?;
        let count = FRICTION_COEFFICIENTS + knots.len();
        let both = moved.displacements.iter().zip(moved.gradients.chunks_exact(count));
        for ((moved, gradient), shown) in both.zip(&recording.positions) {
            if !moved.is_finite() {
                return None;
            }
            let row = rows.next((start + begins * length + moved - shown) / position_scale);
            let (coefficients, by_knot) = gradient.split_at(FRICTION_COEFFICIENTS);
            for (to, slope) in row.iter_mut().zip(self.shared_slopes(lugre, coefficients)) {
                *to = slope / position_scale;
            }
            let all: f64 = by_knot.iter().sum();
            let own = [(ZERO, -all * force), (first, length)].into_iter();
            let knots = by_knot.iter().enumerate().map(|(knot, slope)| (first + 1 + knot, slope * force));
            for (index, slope) in own.chain(knots) {
                if let Some(to) = row.get_mut(index) {
                    *to = slope / position_scale;
                }
            }
        }
        Some(())
    }

    /// Minimum of a search from these variables.
    pub(super) fn searched(
        &self,
        start: &[f64],
        tolerance: f64,
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let settings = Settings { maximum_evaluations: EVALUATIONS, tolerance, ..Settings::default() };
        let mut done = 0;
        minimise(start, &self.bounds(), settings, &mut |variables| {
            done += 1;
            report_progress(watch, "fitting", done, EVALUATIONS)?;
            Ok(self.linearised(variables, cache))
        })
    }

    /// Minimum from the initial estimate. If all rows slide, the best from other curves too: few
    /// speeds leave several minima.
    pub(super) fn first_minimum(
        &self,
        others: &[(Stribeck, f64)],
        tolerance: f64,
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let guess = (self.around.lugre.curve, self.around.zero);
        let mut minimum = self.minimum_from(&guess, tolerance, cache, watch)?;
        let all_slides = self.presses.is_empty() && self.shakes.is_empty();
        for other in others.iter().filter(|_| all_slides) {
            let found = self.searched(&self.start(other), tolerance, cache, watch)?;
            if found.cost < minimum.cost {
                minimum = found;
            }
        }
        Ok(minimum)
    }

    /// Minimum from a curve and a zero error of the force; static friction is raised if the piston
    /// would run away under the recorded forces.
    pub(super) fn minimum_from(
        &self,
        guess: &(Stribeck, f64),
        tolerance: f64,
        cache: &mut ShapeCache,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let start = self.start(guess);
        let mut minimum = self.searched(&start, tolerance, cache, watch)?;
        for factor in RAISED {
            if minimum.ending != Ending::NoStart {
                break;
            }
            let mut raised = start.clone();
            // static friction and its fall, so that Coulomb friction is unchanged
            let both = [EXTENDING, RETRACTING].map(|levels| [levels.static_friction, levels.fall]);
            let known = self.known_variables();
            for index in both.into_iter().flatten().filter(|index| !known.contains(index)) {
                raised.iter_mut().skip(index).take(1).for_each(|value| *value += factor - 1.0);
            }
            minimum = self.searched(&raised, tolerance, cache, watch)?;
        }
        Ok(minimum)
    }

    /// Takes the scale of each signal from its residuals: 1.4826 times their median magnitude; and
    /// the number of independent ones from the correlation of neighbours (Bayley and Hammersley
    /// 1946). Returns the largest relative change.
    pub(super) fn rescale(&mut self, residuals: &[f64]) -> f64 {
        let mut change = 0.0_f64;
        let all = residuals.len() as f64;
        let freedom = (all / (all - self.count() as f64).max(1.0)).sqrt();
        for channel in &mut self.channels {
            let [from, to] = channel.residuals;
            let own = residuals.get(from..to).unwrap_or_default();
            let typical = 1.4826 * median(own.iter().map(|residual| residual.abs()).collect());
            let before = channel.effective_scale();
            channel.independent = independent(own, typical);
            channel.scale = (typical * freedom * before).max(channel.finest);
            change = change.max((channel.effective_scale() / before - 1.0).abs());
        }
        change
    }
}

/// True if Coulomb friction is positive in both directions.
fn slides_at_all(lugre: &LuGre) -> bool {
    lugre.curve.both_levels().iter().all(|levels| levels.coulomb > 0.0)
}

/// Mass of a press, in steps that are short enough for its oscillation on the bristles.
pub(super) fn pressed_mass(mass: f64, lugre: &LuGre, time_step: f64) -> PressedMass {
    let angle = (lugre.bristle_stiffness / mass).sqrt() * time_step;
    let substeps = (angle / STEP_ANGLE).ceil().clamp(1.0, MOST_STEPS) as usize;
    PressedMass { mass, time_step, substeps }
}

impl FrictionChannel {
    /// Scale of residuals as if all of them were independent.
    pub(super) fn effective_scale(&self) -> f64 {
        self.scale / self.independent.sqrt()
    }
}

/// Fraction of independent residuals, if neighbours correlate by more than chance.
fn independent(residuals: &[f64], scale: f64) -> f64 {
    let inside = |residual: &f64| residual.clamp(-3.0 * scale, 3.0 * scale);
    let squares: f64 = residuals.iter().map(|residual| inside(residual) * inside(residual)).sum();
    let neighbours = residuals.iter().zip(residuals.iter().skip(1));
    let products: f64 = neighbours.map(|(one, next)| inside(one) * inside(next)).sum();
    let correlation = if squares > 0.0 { products / squares } else { 0.0 };
    let chance = 3.0 / (residuals.len().max(1) as f64).sqrt();
    if correlation <= chance { 1.0 } else { (1.0 - correlation.min(0.99)) / (1.0 + correlation.min(0.99)) }
}

/// Residuals and their derivatives, one row after the other.
struct ResidualRows {
    count: usize,
    found: Linearised,
}

impl ResidualRows {
    fn with_room_for(residuals: usize, count: usize) -> ResidualRows {
        let jacobian = Vec::with_capacity(residuals * count);
        ResidualRows { count, found: Linearised { residuals: Vec::with_capacity(residuals), jacobian } }
    }

    /// Derivatives of a further residual, initially zero.
    fn next(&mut self, residual: f64) -> &mut [f64] {
        self.found.residuals.push(residual);
        let from = self.found.jacobian.len();
        self.found.jacobian.resize(from + self.count, 0.0);
        self.found.jacobian.get_mut(from..).unwrap_or_default()
    }
}
