//! The kinds of parts that the catalogue has.

/// What a catalogue entry describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum CatalogueKind {
    /// A hose, for `line.hose`.
    #[default]
    Hose,
    /// A servovalve, for `valve.model`.
    Valve,
    /// A pipe, for `line.pipe.model`.
    Pipe,
    /// Piston and rod of a cylinder, for `cylinder.model`.
    Cylinder,
}

impl CatalogueKind {
    /// All of them.
    pub const ALL: [CatalogueKind; 4] =
        [CatalogueKind::Hose, CatalogueKind::Valve, CatalogueKind::Pipe, CatalogueKind::Cylinder];

    /// As it is written in a catalogue file.
    pub fn name(self) -> &'static str {
        match self {
            CatalogueKind::Hose => "hose",
            CatalogueKind::Valve => "valve",
            CatalogueKind::Pipe => "pipe",
            CatalogueKind::Cylinder => "cylinder",
        }
    }
}
