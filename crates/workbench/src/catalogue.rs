//! Components with the source of every number.

/// What a catalogue entry describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A hose, for `line.hose`.
    Hose,
    /// A servovalve, for `valve.model`.
    Valve,
}
