//! Components with the source of every number: one TOML file for each product.
//!
//! The built-in files contain only data found in print. A user adds a file or a folder; an entry of
//! the same name is replaced by the later file.
//!
//! # Example
//! ```
//! use phea_project::catalogue::{self, CatalogueKind};
//! use phea_project::source::Memory;
//! let catalogue = catalogue::load(&Memory::default(), &[])?;
//! let hose = catalogue.find(CatalogueKind::Hose, "eaton_synflex_3130_08").expect("built in");
//! assert_eq!(hose.hose.as_ref().map(|hose| hose.bore), Some(0.0127));
//! assert_eq!(hose.source_of("bore"), "Ledezma (2019), section 6.4.1 and Table A.1");
//! # Ok::<(), phea_project::Refusal>(())
//! ```

mod built_in;
mod dash_size;
mod read;

pub use dash_size::DASH_SIZES;
pub use read::load;

use std::sync::Arc;

use crate::{HoseProperties, TreeNode};

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

/// Components by name.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    /// Whether the built-in files are part of it.
    has_built_in: bool,
    /// Entries of the user's files.
    own: Vec<Arc<CatalogueEntry>>,
}

/// One product.
#[derive(Clone, Debug)]
pub struct CatalogueEntry {
    /// What it is.
    pub kind: CatalogueKind,
    /// The name projects use.
    pub name: String,
    /// The name people use.
    pub title: String,
    /// Who makes it.
    pub manufacturer: String,
    /// The file it was read from; `built-in:` and a path for those that come with the workbench.
    pub file: String,
    /// For a hose that is complete by itself.
    pub hose: Option<HoseProperties>,
    /// Source of every number that has none of its own.
    source: Option<String>,
    /// Key and source.
    sources: Vec<(String, String)>,
    /// The whole file.
    pub(crate) values: TreeNode,
}

impl CatalogueEntry {
    /// Author, title and table a number comes from.
    pub fn source_of(&self, key: &str) -> String {
        let own = self.sources.iter().find(|(name, _)| name == key).map(|(_, source)| source);
        own.or(self.source.as_ref()).cloned().unwrap_or_default()
    }
}

impl Catalogue {
    /// The entry of that kind and name.
    pub fn find(&self, kind: CatalogueKind, name: &str) -> Option<&CatalogueEntry> {
        self.entries(kind).find(|entry| entry.name == name)
    }

    /// The entries of that kind, built-in ones first, each group by name; an entry of the user's
    /// takes the place of the built-in one of its name. The built-in files of a kind are read when
    /// it is first asked for.
    pub fn entries(&self, kind: CatalogueKind) -> impl Iterator<Item = &CatalogueEntry> {
        let built_in = if self.has_built_in { read::built_in(kind) } else { &[] };
        let own = move || self.own.iter().map(Arc::as_ref).filter(move |entry| entry.kind == kind);
        let replaced =
            move |entry: &'static CatalogueEntry| own().find(|one| one.name == entry.name).unwrap_or(entry);
        let is_new = move |entry: &&CatalogueEntry| built_in.iter().all(|one| one.name != entry.name);
        built_in.iter().map(replaced).chain(own().filter(is_new))
    }

    /// The names of that kind.
    pub fn names(&self, kind: CatalogueKind) -> Vec<&str> {
        self.entries(kind).map(|entry| entry.name.as_str()).collect()
    }
}
