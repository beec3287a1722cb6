//! Key of the project file: its name, dimension, range, default and meaning, in one place.

use std::fmt;

use phea_quantity::{Dimension, MotionKind, RATIO, significant};

/// Key of the project file. Built at the description of its field, in the `visit` function of its
/// table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// Dimension of its numbers.
    pub dimension: &'static Dimension,
    /// Accepted range of its numbers.
    pub range: AcceptedRange,
    /// Value of an absent key; `None` if the key is required or its absence has another meaning.
    pub default: Option<f64>,
    /// True if its numbers measure the motion of the rig or its drive, so that a motor has another
    /// dimension: a torque for a force, an angle for a length.
    pub of_motion: bool,
    /// True if they measure the motion of the load or its drive, which may turn although the rig
    /// does not: behind a linkage.
    pub of_load: bool,
    /// Usual numbers, if a number far from them was hardly intended.
    pub usual: Option<UsualRange>,
    /// Meaning, in one sentence.
    pub doc: &'static str,
}

/// Usual numbers of a kind of part, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UsualRange {
    /// Least.
    pub minimum: f64,
    /// Greatest.
    pub maximum: f64,
    /// Parts that have them, in the plural.
    pub of: &'static str,
}

/// Motion of a rig and of its load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Motions {
    /// Motion of the rod or the shaft.
    pub rig: MotionKind,
    /// Motion of the load.
    pub load: MotionKind,
}

impl Motions {
    /// Motion of a load that moves with its rig.
    pub const fn both(motion: MotionKind) -> Motions {
        Motions { rig: motion, load: motion }
    }
}

/// Accepted numbers, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedRange {
    /// Lowest number.
    pub minimum: f64,
    /// Highest number.
    pub maximum: f64,
    /// True if the lowest number is excluded.
    pub above_minimum: bool,
    /// True if the highest number is excluded.
    pub below_maximum: bool,
    /// True if `inf` is accepted.
    pub infinity: bool,
}

impl AcceptedRange {
    /// Range of all finite numbers.
    pub const ANY: AcceptedRange = AcceptedRange {
        minimum: f64::MIN,
        maximum: f64::MAX,
        above_minimum: false,
        below_maximum: false,
        infinity: false,
    };

    /// Range of the positive numbers.
    pub const POSITIVE: AcceptedRange =
        AcceptedRange { minimum: 0.0, above_minimum: true, ..AcceptedRange::ANY };
    /// Range of the numbers that are not negative.
    pub const NOT_NEGATIVE: AcceptedRange = AcceptedRange { minimum: 0.0, ..AcceptedRange::ANY };

    /// True if the number is accepted; never true for NaN.
    pub fn contains(&self, value: f64) -> bool {
        if value == f64::INFINITY {
            return self.infinity;
        }
        let low = if self.above_minimum { value > self.minimum } else { value >= self.minimum };
        let high = if self.below_maximum { value < self.maximum } else { value <= self.maximum };
        low && high
    }
}

/// The range in words that follow "must be": `positive`, `from 0 to below 0.5`. The numbers are SI.
impl fmt::Display for AcceptedRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let AcceptedRange { minimum, maximum, above_minimum, below_maximum, .. } = *self;
        let [low, high] = [minimum, maximum].map(short);
        let below = if below_maximum { "below " } else { "" };
        match (minimum == f64::MIN, maximum == f64::MAX, above_minimum) {
            (true, true, _) => write!(f, "a finite number"),
            (true, false, _) if below_maximum => write!(f, "below {high}"),
            (true, false, _) => write!(f, "at most {high}"),
            (false, true, true) if minimum == 0.0 => write!(f, "positive"),
            (false, true, false) if minimum == 0.0 => write!(f, "zero or positive"),
            (false, true, true) => write!(f, "above {low}"),
            (false, true, false) => write!(f, "at least {low}"),
            (false, false, true) => write!(f, "from above {low} to {below}{high}"),
            (false, false, false) => write!(f, "from {low} to {below}{high}"),
        }
    }
}

/// A number as it is, or with four digits if it has more.
fn short(value: f64) -> String {
    let exact = value.to_string();
    if exact.len() <= 6 { exact } else { significant(value, 4) }
}

/// Key whose numbers have a dimension.
pub const fn key(name: &'static str, dimension: &'static Dimension, doc: &'static str) -> Key {
    let range = AcceptedRange::ANY;
    Key { name, dimension, range, default: None, of_motion: false, of_load: false, usual: None, doc }
}

/// Key without a dimension: a table, a list, a text or a choice.
pub const fn plain(name: &'static str, doc: &'static str) -> Key {
    key(name, &RATIO, doc)
}

impl Key {
    /// Key whose numbers measure the motion of the rig: `dimension` is that of a cylinder.
    pub const fn of_motion(mut self) -> Key {
        self.of_motion = true;
        self
    }

    /// Key whose numbers measure the motion of the load: `dimension` is that of a cylinder without
    /// a linkage.
    pub const fn of_load(mut self) -> Key {
        self.of_load = true;
        self
    }

    /// Key in a rig of these motions.
    pub fn in_motion(mut self, Motions { rig, load }: Motions) -> Key {
        if self.of_motion {
            self.dimension = rig.dimension(self.dimension);
        }
        if self.of_load {
            self.dimension = load.dimension(self.dimension);
        }
        self
    }

    /// Accepts numbers above zero.
    pub const fn positive(self) -> Key {
        self.above(0.0)
    }

    /// Accepts zero and above.
    pub const fn not_negative(self) -> Key {
        self.at_least(0.0)
    }

    /// Accepts numbers above `minimum`.
    pub const fn above(mut self, minimum: f64) -> Key {
        self.range.minimum = minimum;
        self.range.above_minimum = true;
        self
    }

    /// Accepts `minimum` and above.
    pub const fn at_least(mut self, minimum: f64) -> Key {
        self.range.minimum = minimum;
        self.range.above_minimum = false;
        self
    }

    /// Accepts `maximum` and below.
    pub const fn at_most(mut self, maximum: f64) -> Key {
        self.range.maximum = maximum;
        self.range.below_maximum = false;
        self
    }

    /// Accepts numbers below `maximum`.
    pub const fn below(mut self, maximum: f64) -> Key {
        self.range.maximum = maximum;
        self.range.below_maximum = true;
        self
    }

    /// Accepts `inf` too.
    pub const fn or_infinite(mut self) -> Key {
        self.range.infinity = true;
        self
    }

    /// States the usual numbers, SI, of parts of this kind; of a rig that moves along a line where
    /// they measure its motion.
    pub const fn usual(mut self, minimum: f64, maximum: f64, of: &'static str) -> Key {
        self.usual = Some(UsualRange { minimum, maximum, of });
        self
    }

    /// Sets the value of an absent key, SI.
    pub const fn or(mut self, default: f64) -> Key {
        self.default = Some(default);
        self
    }
}
