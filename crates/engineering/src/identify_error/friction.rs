use crate::quantity::{VELOCITY, display};

/// Reason why recorded runs determine no friction.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrictionFitError {
    /// The project has a motor.
    #[error("friction is identified for a [cylinder]: recordings of a [motor] are not read yet")]
    OfMotor,
    /// The areas of the piston change.
    #[error(
        "friction is identified for one pair of areas, and those of a telescopic piston change: identify each stage by itself, without [[cylinder.stage]]"
    )]
    Telescopic,
    /// Positions and forces contradict each other.
    #[error(
        "no friction near the recorded forces lets the piston stay where it is recorded: look for a position or a pressure that is wrong by a factor, or for rows of two tests in one file"
    )]
    NoStart,
    /// There are fewer rows than coefficients.
    #[error("the recordings have too few rows to fit a friction")]
    TooFewRows,
    /// There is neither a constant velocity nor a press from rest, with the omitted runs.
    #[error(
        "no recording determines the friction: there is neither a constant velocity for 20 rows or more, nor a force that presses the piston from rest or shakes it while its position is recorded{}",
        in_brackets(.0)
    )]
    NothingDetermined(Vec<UnsteadyRun>),
}

/// A run whose velocity is constant only on average, m/s.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{file} goes from {} to {} where it moves by {} on average",
    display(range[0], &VELOCITY, 3),
    display(range[1], &VELOCITY, 3),
    display(*mean, &VELOCITY, 3)
)]
pub struct UnsteadyRun {
    /// Path of the file.
    pub file: String,
    /// Mean velocity.
    pub mean: f64,
    /// Least and greatest velocity.
    pub range: [f64; 2],
}

fn in_brackets(runs: &[UnsteadyRun]) -> String {
    match runs {
        [] => String::new(),
        runs => format!(" ({})", runs.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")),
    }
}
