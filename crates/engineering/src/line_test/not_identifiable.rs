/// Reason for which recordings do not determine a number of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotIdentifiableLine {
    /// There is no slow pressure rise among the recordings.
    NoRise,
    /// There is no slow pressure rise, and a hose yields less in motion than at rest.
    NoRiseOfHose,
    /// There is no frequency response among the recordings.
    NoResponse,
    /// The estimate is wider than a factor of one and a half.
    Wide {
        /// The number that is estimated.
        quantity: WideQuantity,
        /// Standard deviation of its logarithm.
        deviation: f64,
    },
    /// The pressure does not rise with the volume.
    PressureDoesNotRise {
        /// m3/Pa, slope of the volume over the pressure.
        slope: f64,
    },
    /// The declared oil without air explains the pressure rise as well.
    NoAir,
    /// The compliance does not change with the pressure beyond its noise.
    ConstantCompliance,
    /// No hose, which alone has a wall that stiffens.
    NoHose,
    /// No wall stiffening, because the line yields less than the declared oil alone.
    StifferThanOil {
        /// m3/Pa in fast motion and at rest, less that of the oil.
        wall: [f64; 2],
    },
    /// No relaxation, because the line yields less than the declared oil alone.
    NoWallCompliance,
    /// The declared model of the line has no creep.
    NoCreep,
    /// The frequencies of the response are not around the corner of the creep.
    AwayFromCreep {
        /// Standard deviation of the logarithm of the relaxation time.
        deviation: f64,
    },
    /// A plain volume has no length.
    NoLength,
    /// Two waves travel in the declared model.
    TwoWaves,
    /// The response shows no wave.
    NoWave {
        /// rad/s, highest frequency of the response.
        highest: f64,
    },
    /// The frequencies end too far below the quarter wave.
    BelowQuarterWave {
        /// rad/s, highest frequency of the response.
        highest: f64,
        /// Hz, estimate of the quarter wave.
        quarter_wave: f64,
    },
}

/// A number of a line whose estimate may be too wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WideQuantity {
    /// Effective bulk modulus at rest.
    ModulusAtRest,
    /// Effective bulk modulus in fast motion.
    DynamicModulus,
    /// Secant bulk modulus of the pressure rise.
    SecantModulus,
    /// Dynamic stiffening of the wall.
    DynamicStiffening,
}
