//! Parts of the catalogue by kind and name.

use std::sync::Arc;

use super::HoseProperties;
use super::tree::TreeNode;
use phea_table::CatalogueKind;

/// Components by name.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    /// Entries of the built-in files, if they are part of it.
    pub(crate) built_in: Option<BuiltInEntries>,
    /// Entries of the user's files.
    pub(crate) own: Vec<Arc<CatalogueEntry>>,
}

/// Built-in entries of a kind, read on first use.
pub(crate) type BuiltInEntries = fn(CatalogueKind) -> &'static [CatalogueEntry];

/// Single product.
#[derive(Clone, Debug)]
pub struct CatalogueEntry {
    /// Kind of product.
    pub kind: CatalogueKind,
    /// Name for projects.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// Manufacturer.
    pub manufacturer: String,
    /// Source file; `built-in:` and a path for the built-in ones.
    pub file: String,
    /// Properties of a complete hose.
    pub hose: Option<HoseProperties>,
    /// Default source of the numbers.
    pub(crate) source: Option<String>,
    /// Key and source.
    pub(crate) sources: Vec<(String, String)>,
    /// The whole file.
    pub(crate) values: TreeNode,
}

impl CatalogueEntry {
    /// Author, title and table from which a number is taken.
    pub fn source_of(&self, key: &str) -> String {
        let own = self.sources.iter().find(|(name, _)| name == key).map(|(_, source)| source);
        own.or(self.source.as_ref()).cloned().unwrap_or_default()
    }
}

impl Catalogue {
    /// Entry of that kind and name.
    pub fn find(&self, kind: CatalogueKind, name: &str) -> Option<&CatalogueEntry> {
        self.entries(kind).find(|entry| entry.name == name)
    }

    /// Entries of that kind, built-in ones first, each group by name; an entry of the user replaces
    /// the built-in one of its name. The built-in files of a kind are read on first use.
    pub fn entries(&self, kind: CatalogueKind) -> impl Iterator<Item = &CatalogueEntry> {
        let built_in = self.built_in.map_or(&[][..], |built_in| built_in(kind));
        let own = move || self.own.iter().map(Arc::as_ref).filter(move |entry| entry.kind == kind);
        let replaced =
            move |entry: &'static CatalogueEntry| own().find(|one| one.name == entry.name).unwrap_or(entry);
        let is_new = move |entry: &&CatalogueEntry| built_in.iter().all(|one| one.name != entry.name);
        built_in.iter().map(replaced).chain(own().filter(is_new))
    }

    /// Names of that kind.
    pub fn names(&self, kind: CatalogueKind) -> Vec<&str> {
        self.entries(kind).map(|entry| entry.name.as_str()).collect()
    }
}
