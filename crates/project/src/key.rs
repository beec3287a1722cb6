//! A key of the project file: its name, dimension, range, default and meaning, written once.

use phea_quantity::{Dimension, MotionKind, RATIO};

/// One key of the project file. Built at the place where its field is described, in the `visit`
/// function of its table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As written in the file.
    pub name: &'static str,
    /// What its numbers measure.
    pub dimension: &'static Dimension,
    /// Which of its numbers are accepted.
    pub range: AcceptedRange,
    /// The value of an absent key; `None` where the key is required or its absence has a meaning of
    /// its own.
    pub default: Option<f64>,
    /// True if its numbers measure the motion of the rig or what drives it, so that a motor has
    /// another dimension in its place: a torque for a force, an angle for a length.
    pub of_motion: bool,
    /// True if they measure the motion of the load or what drives it, which may turn where the rig
    /// does not: behind a linkage.
    pub of_load: bool,
    /// What it means, in one sentence.
    pub doc: &'static str,
}

/// How a rig moves, and how its load does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Motions {
    /// Motion of the rod or the shaft.
    pub rig: MotionKind,
    /// Motion of what it drives.
    pub load: MotionKind,
}

impl Motions {
    /// A load that moves with its rig.
    pub(crate) const fn both(motion: MotionKind) -> Motions {
        Motions { rig: motion, load: motion }
    }
}

/// Which numbers are accepted, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceptedRange {
    /// The lowest number.
    pub minimum: f64,
    /// The highest number.
    pub maximum: f64,
    /// True if the lowest number itself is excluded.
    pub above_minimum: bool,
    /// True if the highest number itself is excluded.
    pub below_maximum: bool,
    /// True if `inf` is accepted.
    pub infinity: bool,
}

impl AcceptedRange {
    /// Every finite number.
    pub const ANY: AcceptedRange = AcceptedRange {
        minimum: f64::MIN,
        maximum: f64::MAX,
        above_minimum: false,
        below_maximum: false,
        infinity: false,
    };

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

/// A key whose numbers have a dimension.
pub(crate) const fn key(name: &'static str, dimension: &'static Dimension, doc: &'static str) -> Key {
    Key { name, dimension, range: AcceptedRange::ANY, default: None, of_motion: false, of_load: false, doc }
}

/// A key without a dimension: a table, a list, a text or a choice.
pub(crate) const fn plain(name: &'static str, doc: &'static str) -> Key {
    key(name, &RATIO, doc)
}

impl Key {
    /// Its numbers measure the motion of the rig: `dimension` is that of a cylinder.
    pub(crate) const fn of_motion(mut self) -> Key {
        self.of_motion = true;
        self
    }

    /// Its numbers measure the motion of the load: `dimension` is that of a cylinder without a
    /// linkage.
    pub(crate) const fn of_load(mut self) -> Key {
        self.of_load = true;
        self
    }

    /// The key in a rig of these motions.
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
    pub(crate) const fn positive(self) -> Key {
        self.above(0.0)
    }

    /// Accepts zero and above.
    pub(crate) const fn not_negative(self) -> Key {
        self.at_least(0.0)
    }

    /// Accepts numbers above `minimum`.
    pub(crate) const fn above(mut self, minimum: f64) -> Key {
        self.range.minimum = minimum;
        self.range.above_minimum = true;
        self
    }

    /// Accepts `minimum` and above.
    pub(crate) const fn at_least(mut self, minimum: f64) -> Key {
        self.range.minimum = minimum;
        self.range.above_minimum = false;
        self
    }

    /// Accepts `maximum` and below.
    pub(crate) const fn at_most(mut self, maximum: f64) -> Key {
        self.range.maximum = maximum;
        self.range.below_maximum = false;
        self
    }

    /// Accepts numbers below `maximum`.
    pub(crate) const fn below(mut self, maximum: f64) -> Key {
        self.range.maximum = maximum;
        self.range.below_maximum = true;
        self
    }

    /// Accepts `inf` too.
    pub(crate) const fn or_infinite(mut self) -> Key {
        self.range.infinity = true;
        self
    }

    /// The value of an absent key, in SI.
    pub(crate) const fn or(mut self, default: f64) -> Key {
        self.default = Some(default);
        self
    }
}
