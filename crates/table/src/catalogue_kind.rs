//! Kinds of parts in the catalogue.

/// Kind of a catalogue entry.
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
    /// All kinds.
    pub const ALL: [CatalogueKind; 4] =
        [CatalogueKind::Hose, CatalogueKind::Valve, CatalogueKind::Pipe, CatalogueKind::Cylinder];

    /// Word in a catalogue file.
    pub fn name(self) -> &'static str {
        match self {
            CatalogueKind::Hose => "hose",
            CatalogueKind::Valve => "valve",
            CatalogueKind::Pipe => "pipe",
            CatalogueKind::Cylinder => "cylinder",
        }
    }
}
