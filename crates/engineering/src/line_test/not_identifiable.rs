/// Reason why recordings do not determine a number of a line.
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
        /// Estimated number.
        quantity: WideQuantity,
        /// Standard deviation of its logarithm.
        deviation: f64,
    },
    /// The pressure does not rise with the volume.
    PressureDoesNotRise {
        /// Slope of the volume as a function of the pressure, m3/Pa.
        slope: f64,
    },
    /// The declared oil without air explains the pressure rise as well.
    NoAir,
    /// The compliance does not change with the pressure beyond its noise.
    ConstantCompliance,
    /// The line is not a hose, and only a hose has a wall that stiffens.
    NoHose,
    /// There is no wall stiffening, because the line yields less than the declared oil would.
    StifferThanOil {
        /// Compliance in fast motion and at rest, minus that of the oil, m3/Pa.
        wall: [f64; 2],
    },
    /// There is no relaxation, because the line yields less than the declared oil would.
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
        /// Highest frequency of the response, rad/s.
        highest: f64,
    },
    /// The frequencies end too far below the quarter wave.
    BelowQuarterWave {
        /// Highest frequency of the response, rad/s.
        highest: f64,
        /// Estimate of the quarter-wave frequency, Hz.
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
