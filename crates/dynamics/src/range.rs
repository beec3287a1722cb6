//! Ranges that a method requires of its numbers.

/// Range that a number must be in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RequiredRange {
    /// Any finite number.
    #[error("finite")]
    Finite,
    /// Positive numbers.
    #[error("positive")]
    Positive,
    /// Positive finite numbers.
    #[error("positive and finite")]
    PositiveAndFinite,
    /// Numbers that are not negative.
    #[error("zero or positive")]
    ZeroOrPositive,
    /// Numbers other than zero.
    #[error("different from zero")]
    NotZero,
    /// Fractions, both ends excluded.
    #[error("above 0 and below 1")]
    BetweenZeroAndOne,
    /// Finite numbers above one.
    #[error("above 1 and finite")]
    AboveOne,
    /// Percentages, both ends excluded.
    #[error("between 0 and 100")]
    BetweenZeroAndHundred,
    /// Percentages, the upper end excluded.
    #[error("from 0 up to but not 100")]
    BelowHundred,
    /// Angles in rad up to half a turn.
    #[error("above 0 and at most pi")]
    UpToPi,
    /// Numbers with a finite inverse.
    #[error("large enough that its inverse is finite")]
    FiniteInverse,
    /// Ends of a band.
    #[error("zero or positive, and increasing")]
    IncreasingFromZero,
    /// Durations of a sine response.
    #[error("at least one period and two windows, of a positive frequency")]
    OnePeriodAndTwoWindows,
}
