use crate::portable;

/// Smooth piece of a [`super::Profile`]: an analytic function, also defined beyond its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfilePiece {
    /// Terms added to the offset; a piece without terms is constant.
    terms: Vec<PieceShape>,
    offset: f64,
}

/// Values of a function at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Value.
    pub value: f64,
    /// First derivative, per second.
    pub rate: f64,
    /// Second derivative, per second squared.
    pub acceleration: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PieceShape {
    /// Constant value.
    Constant { value: f64 },
    /// Polynomial: sum over k of c_k s^k, s = (t - origin)/span; lowest power first.
    Polynomial { origin_s: f64, span_s: f64, coefficients: [f64; 6] },
    /// Exponential d (1 - exp(-(t - origin)/tau)).
    Exponential { origin_s: f64, time_constant_s: f64, distance: f64 },
    /// Sine a sin(omega tau + r tau^2/2 + phi), tau = t - origin; the frequency omega + r tau
    /// applies up to the span.
    Sine {
        origin_s: f64,
        amplitude: f64,
        frequency_rad_per_s: f64,
        sweep_rad_per_s2: f64,
        span_s: f64,
        phase_rad: f64,
    },
}

impl ProfilePiece {
    pub(super) fn new(shape: PieceShape) -> ProfilePiece {
        match shape {
            PieceShape::Constant { value } => ProfilePiece { terms: Vec::new(), offset: value },
            _ => ProfilePiece { terms: vec![shape], offset: 0.0 },
        }
    }

    /// Piece that is the sum of these shapes.
    pub(super) fn of(terms: Vec<PieceShape>) -> ProfilePiece {
        ProfilePiece { terms, offset: 0.0 }
    }

    /// Piece with a number added to its values.
    pub(super) fn shifted(self, by: f64) -> ProfilePiece {
        ProfilePiece { offset: self.offset + by, ..self }
    }

    /// Sum of two pieces.
    pub(super) fn plus(mut self, other: &ProfilePiece) -> ProfilePiece {
        self.terms.extend_from_slice(&other.terms);
        self.shifted(other.offset)
    }

    /// Value, rate and acceleration at a time.
    #[inline(always)]
    pub fn at(&self, time_s: f64) -> Moment {
        let [mut value, mut rate, mut acceleration] = [0.0; 3];
        for moment in self.terms.iter().map(|shape| shape.at(time_s)) {
            value += moment.value;
            rate += moment.rate;
            acceleration += moment.acceleration;
        }
        Moment { value: value + self.offset, rate, acceleration }
    }
}

impl PieceShape {
    #[inline(always)]
    fn at(&self, time_s: f64) -> Moment {
        match *self {
            PieceShape::Constant { value } => Moment { value, rate: 0.0, acceleration: 0.0 },
            PieceShape::Polynomial { origin_s, span_s, coefficients } => {
                polynomial(coefficients, (time_s - origin_s) / span_s, span_s)
            }
            PieceShape::Exponential { origin_s, time_constant_s, distance } => {
                let approached = portable::expm1(-(time_s - origin_s) / time_constant_s);
                let rate = distance * (1.0 + approached) / time_constant_s;
                Moment { value: -distance * approached, rate, acceleration: -rate / time_constant_s }
            }
            PieceShape::Sine {
                origin_s,
                amplitude,
                frequency_rad_per_s,
                sweep_rad_per_s2,
                phase_rad,
                ..
            } => {
                let tau = time_s - origin_s;
                let phase = (frequency_rad_per_s + 0.5 * sweep_rad_per_s2 * tau) * tau + phase_rad;
                let frequency = frequency_rad_per_s + sweep_rad_per_s2 * tau;
                let (sine, cosine) = (portable::sin(phase), portable::cos(phase));
                Moment {
                    value: amplitude * sine,
                    rate: amplitude * frequency * cosine,
                    acceleration: amplitude * (sweep_rad_per_s2 * cosine - frequency * frequency * sine),
                }
            }
        }
    }
}

impl ProfilePiece {
    /// Value of a constant piece.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::simulation::Profile;
    /// let sine = Profile::sine(1.0, 2.0, 5.0)?;
    /// assert_eq!((sine.piece(0.5).constant(), sine.piece(1.5).constant()), (Some(0.0), None));
    /// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
    /// ```
    pub fn constant(&self) -> Option<f64> {
        self.terms.is_empty().then_some(self.offset)
    }

    /// Quarter of the shortest period within the piece, in s; `None` without oscillation.
    pub(super) fn quarter_period_s(&self) -> Option<f64> {
        let quarter = |shape: &PieceShape| match *shape {
            PieceShape::Sine { frequency_rad_per_s, sweep_rad_per_s2, span_s, .. } => {
                let highest = frequency_rad_per_s.max(frequency_rad_per_s + sweep_rad_per_s2 * span_s);
                Some(0.5 * std::f64::consts::PI / highest)
            }
            _ => None,
        };
        self.terms.iter().filter_map(quarter).reduce(f64::min)
    }
}

/// Polynomial and both derivatives by Horner's scheme.
#[inline(always)]
fn polynomial(coefficients: [f64; 6], s: f64, span_s: f64) -> Moment {
    let (mut value, mut first, mut half_second) = (0.0, 0.0, 0.0);
    for coefficient in coefficients.into_iter().rev() {
        half_second = half_second * s + first;
        first = first * s + value;
        value = value * s + coefficient;
    }
    Moment { value, rate: first / span_s, acceleration: 2.0 * half_second / (span_s * span_s) }
}
