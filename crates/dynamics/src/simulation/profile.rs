//! Known functions of time: references and load motions, smooth between breaks.

mod combination;
mod interpolation;
mod multisine;
mod number;
mod piece;

pub use multisine::{Harmonic, schroeder_phases};
pub use number::ProfileNumber;
pub use piece::{Moment, ProfilePiece};

use piece::PieceShape;

use crate::range::RequiredRange;

/// Known function of time w(t), in the unit of its user: consecutive smooth pieces.
///
/// ```text
/// w(t) = p_k(t)     for b_k <= t < b_{k+1},      b_0 = -inf          p_k smooth, b_1, b_2 ... the breaks
/// ```
///
/// At a break the later piece applies. To integrate across a break, use the [`ProfilePiece`] of
/// each side: a piece is an analytic function that can be evaluated beyond its ends.
///
/// # Example
/// A load that moves by 5 mm in 0.1 s, three seconds after the start
/// ```
/// use phea_dynamics::simulation::Profile;
/// let motion = Profile::smooth_step(3.0, 0.1, 5e-3)?;
/// assert_eq!((motion.value(2.9), motion.value(3.2)), (0.0, 5e-3));
/// assert!((motion.value(3.05) - 2.5e-3).abs() < 1e-15);
/// assert!((motion.rate(3.05) - 15.0 / 8.0 * 5e-3 / 0.1).abs() < 1e-12);
/// assert_eq!(motion.breaks(), [3.0, 3.1]);
/// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    first: ProfilePiece,
    later: Vec<(f64, ProfilePiece)>,
}

/// Error for an invalid function of time.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// A number outside the range in which the function has a meaning.
    #[error("{what} is {value}; it must be {expected}")]
    OutOfRange {
        /// Name of the number.
        what: ProfileNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        expected: RequiredRange,
    },
    /// Times that do not strictly increase, or are not finite.
    #[error("time number {index} ({time_s} s) does not come after the one before it")]
    TimeOrder {
        /// Position in the list, from zero.
        index: usize,
        /// The time, s.
        time_s: f64,
    },
    /// Too few points to interpolate between, or a missing value.
    #[error("{values} values at {times} times; the same number of each is needed, and at least two")]
    Count {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
}

impl Profile {
    /// Constant function.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// assert_eq!((Profile::constant(4.0).value(1e3), Profile::constant(4.0).rate(0.0)), (4.0, 0.0));
    /// ```
    pub fn constant(value: f64) -> Profile {
        Profile { first: ProfilePiece::new(PieceShape::Constant { value }), later: Vec::new() }
    }

    /// Piecewise constant function: `initial` at first, and from each time on the value paired with
    /// it.
    ///
    /// # Errors
    /// [`ProfileError::TimeOrder`] unless the times rise strictly, [`ProfileError::OutOfRange`] for
    /// a value that is not finite.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let reference = Profile::steps(0.0, &[(2.0, 4000.0), (4.0, 1000.0)])?;
    /// assert_eq!([1.0, 2.0, 3.9, 4.0].map(|time_s| reference.value(time_s)), [0.0, 4000.0, 4000.0, 1000.0]);
    /// assert_eq!(reference.breaks(), [2.0, 4.0]);
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn steps(initial: f64, steps: &[(f64, f64)]) -> Result<Profile, ProfileError> {
        rising(steps.iter().map(|step| step.0))?;
        for value in steps.iter().map(|step| step.1).chain([initial]) {
            finite(ProfileNumber::StepValue, value)?;
        }
        let piece =
            |&(time_s, value): &(f64, f64)| (time_s, ProfilePiece::new(PieceShape::Constant { value }));
        Ok(Profile { later: steps.iter().map(piece).collect(), ..Profile::constant(initial) })
    }

    /// Smooth step from zero to `distance` within `duration_s`, with velocity and acceleration zero
    /// at both ends.
    ///
    /// ```text
    /// w = d (10 s^3 - 15 s^4 + 6 s^5),     s = (t - t_0)/D in [0, 1];      greatest rate 15/8 d/D at s = 1/2
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless the duration is positive and all numbers are finite.
    pub fn smooth_step(start_s: f64, duration_s: f64, distance: f64) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::SmoothStepStart, start_s)?;
        positive(ProfileNumber::SmoothStepDuration, duration_s)?;
        finite(ProfileNumber::SmoothStepDistance, distance)?;
        let coefficients = [0.0, 0.0, 0.0, 10.0, -15.0, 6.0].map(|coefficient| coefficient * distance);
        let rise = PieceShape::Polynomial { origin_s: start_s, span_s: duration_s, coefficients };
        let end = PieceShape::Constant { value: distance };
        Ok(Profile::from_rest(&[(start_s, rise), (start_s + duration_s, end)]))
    }

    /// Ramp from zero to `distance` at a constant rate within `duration_s`; the rate jumps at both
    /// ends.
    ///
    /// ```text
    /// w = d (t - t_0)/D,     t - t_0 in [0, D];      w = d from then on
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless the duration is positive and all numbers are finite.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let ramp = Profile::ramp(1.0, 0.5, 4000.0)?;
    /// assert_eq!([0.9, 1.25, 1.5, 9.0].map(|time_s| ramp.value(time_s)), [0.0, 2000.0, 4000.0, 4000.0]);
    /// assert_eq!((ramp.rate(1.1), ramp.rate(1.6)), (8000.0, 0.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn ramp(start_s: f64, duration_s: f64, distance: f64) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::RampStart, start_s)?;
        positive(ProfileNumber::RampDuration, duration_s)?;
        finite(ProfileNumber::RampHeight, distance)?;
        let coefficients = [0.0, distance, 0.0, 0.0, 0.0, 0.0];
        let rise = PieceShape::Polynomial { origin_s: start_s, span_s: duration_s, coefficients };
        let end = PieceShape::Constant { value: distance };
        Ok(Profile::from_rest(&[(start_s, rise), (start_s + duration_s, end)]))
    }

    /// Step response of a first-order lag from zero towards `distance`.
    ///
    /// ```text
    /// w = d (1 - exp(-(t - t_0)/tau)),     t >= t_0;      rate d/tau at t_0
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless the time constant is positive and all numbers are
    /// finite.
    pub fn first_order(start_s: f64, time_constant_s: f64, distance: f64) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::LagStart, start_s)?;
        positive(ProfileNumber::LagTimeConstant, time_constant_s)?;
        finite(ProfileNumber::LagDistance, distance)?;
        let approach = PieceShape::Exponential { origin_s: start_s, time_constant_s, distance };
        Ok(Profile::from_rest(&[(start_s, approach)]))
    }

    /// Zero, and a sine from its start on; the rate jumps at the start.
    ///
    /// ```text
    /// w = a sin(omega (t - t_0)),     t >= t_0;      omega in rad/s
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless the frequency is positive and all numbers are finite.
    pub fn sine(start_s: f64, amplitude: f64, frequency_rad_per_s: f64) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::SineStart, start_s)?;
        finite(ProfileNumber::SineAmplitude, amplitude)?;
        positive(ProfileNumber::SineFrequency, frequency_rad_per_s)?;
        let sine = PieceShape::Sine {
            origin_s: start_s,
            amplitude,
            frequency_rad_per_s,
            sweep_rad_per_s2: 0.0,
            span_s: 0.0,
            phase_rad: 0.0,
        };
        Ok(Profile::from_rest(&[(start_s, sine)]))
    }

    /// Zero, then a sine whose frequency changes linearly from one value to the other, then its
    /// final value.
    ///
    /// ```text
    /// w = a sin(omega_0 tau + (omega_1 - omega_0) tau^2/(2 D)),     tau = t - t_0 in [0, D];      omega in rad/s
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless duration and frequencies are positive and all numbers
    /// are finite.
    pub fn chirp(
        start_s: f64,
        duration_s: f64,
        amplitude: f64,
        [initial_rad_per_s, final_rad_per_s]: [f64; 2],
    ) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::ChirpStart, start_s)?;
        positive(ProfileNumber::ChirpDuration, duration_s)?;
        finite(ProfileNumber::ChirpAmplitude, amplitude)?;
        positive(ProfileNumber::ChirpInitialFrequency, initial_rad_per_s)?;
        positive(ProfileNumber::ChirpFinalFrequency, final_rad_per_s)?;
        let sine = PieceShape::Sine {
            origin_s: start_s,
            amplitude,
            frequency_rad_per_s: initial_rad_per_s,
            sweep_rad_per_s2: (final_rad_per_s - initial_rad_per_s) / duration_s,
            span_s: duration_s,
            phase_rad: 0.0,
        };
        let end_s = start_s + duration_s;
        let end = PieceShape::Constant { value: ProfilePiece::new(sine).at(end_s).value };
        Ok(Profile::from_rest(&[(start_s, sine), (end_s, end)]))
    }

    /// Interpolation of measured points by a shape-preserving cubic, constant before the first and
    /// after the last point; each point is a break.
    ///
    /// ```text
    /// h_k = t_{k+1} - t_k,   s_k = (w_{k+1} - w_k)/h_k
    /// m_k = 0                                                                     if s_{k-1} s_k <= 0
    /// m_k = 3 (h_{k-1} + h_k)/((2 h_k + h_{k-1})/s_{k-1} + (h_k + 2 h_{k-1})/s_k)   otherwise
    /// ```
    ///
    /// with w(t_k) = w_k and w'(t_k) = m_k at both ends of each cubic. The velocity is continuous
    /// between first and last point, and no motion beyond the measured values is invented: between
    /// two points the curve stays between them. (Straight lines would make the velocity jump at
    /// each point, an ordinary spline would overshoot.) The slope at the first and the last point
    /// is the three-point slope over the two nearest intervals, limited to keep the shape. Source:
    /// Fritsch and Butland 1984, a method for constructing local monotone piecewise cubic
    /// interpolants.
    ///
    /// # Errors
    /// [`ProfileError::Count`], [`ProfileError::TimeOrder`], [`ProfileError::OutOfRange`] for a
    /// value that is not finite.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let measured = Profile::table(&[0.0, 1.0, 2.0], &[0.0, 1.0, 1.0])?;
    /// assert_eq!((measured.value(1.0), measured.value(1.5), measured.rate(1.0)), (1.0, 1.0, 0.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn table(times_s: &[f64], values: &[f64]) -> Result<Profile, ProfileError> {
        if times_s.len() != values.len() || values.len() < 2 {
            return Err(ProfileError::Count { times: times_s.len(), values: values.len() });
        }
        rising(times_s.iter().copied())?;
        for &value in values {
            finite(ProfileNumber::TableValue, value)?;
        }
        Ok(interpolation::through(times_s, values))
    }

    /// Function with a number added to its values: a motion from a start other than zero.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let motion = Profile::smooth_step(3.0, 0.1, 5e-3)?.shifted(0.25);
    /// assert_eq!((motion.value(0.0), motion.value(4.0), motion.rate(4.0)), (0.25, 0.255, 0.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    #[must_use]
    pub fn shifted(self, by: f64) -> Profile {
        let later = self.later.into_iter().map(|(start_s, piece)| (start_s, piece.shifted(by))).collect();
        Profile { first: self.first.shifted(by), later }
    }

    /// Value at a time.
    pub fn value(&self, time_s: f64) -> f64 {
        self.holding(time_s).at(time_s).value
    }

    /// First derivative, per second.
    pub fn rate(&self, time_s: f64) -> f64 {
        self.holding(time_s).at(time_s).rate
    }

    /// Second derivative, per second squared.
    pub fn acceleration(&self, time_s: f64) -> f64 {
        self.holding(time_s).at(time_s).acceleration
    }

    /// Piece in force from this time on.
    ///
    /// # Example
    /// Both sides of a break:
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let reference = Profile::steps(0.0, &[(2.0, 4000.0)])?;
    /// assert_eq!((reference.piece(1.9).at(2.0).value, reference.piece(2.0).at(2.0).value), (0.0, 4000.0));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn piece(&self, time_s: f64) -> ProfilePiece {
        self.holding(time_s).clone()
    }

    fn holding(&self, time_s: f64) -> &ProfilePiece {
        self.last_of(self.later.partition_point(|(start_s, _)| *start_s <= time_s))
    }

    /// Last of the pieces that have begun, given their number.
    fn last_of(&self, begun: usize) -> &ProfilePiece {
        begun.checked_sub(1).and_then(|last| self.later.get(last)).map_or(&self.first, |(_, piece)| piece)
    }

    /// Times at which the function or one of its derivatives jumps, rising.
    pub fn breaks(&self) -> Vec<f64> {
        self.later.iter().map(|(start_s, _)| *start_s).collect()
    }

    /// Longest step that cannot miss an oscillation, in s: a quarter of the shortest period; `None`
    /// without oscillation.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let sine = Profile::sine(0.0, 1.0, 2.0 * std::f64::consts::PI)?;
    /// assert_eq!((sine.longest_step(), Profile::constant(1.0).longest_step()), (Some(0.25), None));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn longest_step(&self) -> Option<f64> {
        let pieces = self.later.iter().map(|(_, piece)| piece).chain([&self.first]);
        pieces.filter_map(ProfilePiece::quarter_period_s).reduce(f64::min)
    }

    /// Profile of these shapes after zero.
    fn from_rest(shapes: &[(f64, PieceShape)]) -> Profile {
        let later = shapes.iter().map(|&(start_s, shape)| (start_s, ProfilePiece::new(shape))).collect();
        Profile { later, ..Profile::constant(0.0) }
    }
}

fn rising(times_s: impl Iterator<Item = f64>) -> Result<(), ProfileError> {
    let mut last = f64::NEG_INFINITY;
    for (index, time_s) in times_s.enumerate() {
        if !(time_s.is_finite() && time_s > last) {
            return Err(ProfileError::TimeOrder { index, time_s });
        }
        last = time_s;
    }
    Ok(())
}

fn finite(what: ProfileNumber, value: f64) -> Result<(), ProfileError> {
    let expected = RequiredRange::Finite;
    if value.is_finite() { Ok(()) } else { Err(ProfileError::OutOfRange { what, value, expected }) }
}

fn positive(what: ProfileNumber, value: f64) -> Result<(), ProfileError> {
    let expected = RequiredRange::PositiveAndFinite;
    let fits = value.is_finite() && value > 0.0;
    if fits { Ok(()) } else { Err(ProfileError::OutOfRange { what, value, expected }) }
}
