//! Reading of catalogue files.

use std::sync::{Arc, OnceLock};

use super::built_in::BUILT_IN;
use super::{Catalogue, CatalogueEntry, CatalogueKind};
use crate::source::Source;
use crate::{
    DeclaredCylinder, DeclaredPipe, Findings, HoseProperties, RawFinding, Reader, Refusal, TreeNode,
    TreeValue, Valve, Visitor, key, plain, read_tree,
};
use phea_quantity::RATIO;

/// Keys of a file that describe the entry rather than the product.
const HEAD: [&str; 7] = ["schema", "kind", "name", "title", "manufacturer", "source", "sources"];

/// Built-in catalogue with the additions and replacements of the given files and folders.
///
/// # Errors
/// [`Refusal`] with all errors in the given files.
pub fn load(source: &dyn Source, paths: &[String]) -> Result<Catalogue, Refusal> {
    let mut findings = Findings::default();
    let catalogue = Catalogue::gather(source, paths, &mut findings);
    if findings.has_errors() { Err(findings.report()) } else { Ok(catalogue) }
}

impl Catalogue {
    /// Catalogue as in [`load`], with the errors among other findings.
    pub(crate) fn gather(source: &dyn Source, paths: &[String], findings: &mut Findings) -> Catalogue {
        let mut catalogue = Catalogue { built_in: Some(built_in), own: vec![] };
        for path in paths {
            let files = match source.list(path) {
                Ok(None) => vec![path.clone()],
                Ok(Some(mut files)) => {
                    files.retain(|file| file.ends_with(".toml"));
                    files.sort();
                    files
                }
                Err(error) => {
                    findings.unreadable(path, &error.to_string());
                    continue;
                }
            };
            for file in files {
                match source.read(&file) {
                    Ok(bytes) => catalogue.take(&file, &bytes, findings),
                    Err(error) => findings.unreadable(&file, &error.to_string()),
                }
            }
        }
        catalogue
    }

    fn take(&mut self, file: &str, bytes: &[u8], findings: &mut Findings) {
        let Some(root) = read_tree(file, bytes, findings) else { return };
        if let Some(entry) = entry(file, root, findings).map(Arc::new) {
            match self.own.iter_mut().find(|known| known.kind == entry.kind && known.name == entry.name) {
                Some(known) => *known = entry,
                None => self.own.push(entry),
            }
        }
    }
}

/// Built-in entries of a kind. Tests check their files, so that they cause no findings here.
fn built_in(kind: CatalogueKind) -> &'static [CatalogueEntry] {
    static READ: [OnceLock<Vec<CatalogueEntry>>; CatalogueKind::ALL.len()] =
        [const { OnceLock::new() }; CatalogueKind::ALL.len()];
    let Some(read) = CatalogueKind::ALL.iter().position(|one| *one == kind).and_then(|place| READ.get(place))
    else {
        return &[];
    };
    read.get_or_init(|| {
        let folder = format!("{}s/", kind.name());
        let files = BUILT_IN.iter().filter(|(name, _)| name.starts_with(&folder));
        let mut findings = Findings::default();
        let read = |(name, content): &(&str, &str)| {
            let file = format!("built-in:{name}");
            let root = read_tree(&file, content.as_bytes(), &mut findings)?;
            entry(&file, root, &mut findings)
        };
        files.filter_map(read).collect()
    })
}

/// Description of a product in a file.
#[derive(Default)]
struct Head {
    kind: CatalogueKind,
    name: Option<String>,
    title: Option<String>,
    manufacturer: Option<String>,
    source: Option<String>,
}

impl Head {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut schema = 1;
        v.count(key("schema", &RATIO, "Version of this format: 1.").at_least(1.0).at_most(1.0), &mut schema);
        let words = &[
            ("hose", CatalogueKind::Hose),
            ("valve", CatalogueKind::Valve),
            ("pipe", CatalogueKind::Pipe),
            ("cylinder", CatalogueKind::Cylinder),
        ];
        v.choice(plain("kind", "What the product is."), words, &mut self.kind, true);
        v.text(plain("name", "The name projects use."), &mut self.name, true);
        v.text(plain("title", "The name people use."), &mut self.title, true);
        v.text(plain("manufacturer", "Who makes it."), &mut self.manufacturer, false);
        v.text(plain("source", "Source of every number without its own."), &mut self.source, false);
    }
}

fn entry(file: &str, root: TreeNode, findings: &mut Findings) -> Option<CatalogueEntry> {
    let nothing = Catalogue::default();
    let mut head = Head::default();
    let mut hose = None;
    let text = findings.last_text();
    let mut reader = Reader::new(&root, text, &nothing, findings);
    head.visit(&mut reader);
    reader.know("sources");
    let mut reader = reader.partial();
    match head.kind {
        CatalogueKind::Hose => {
            let mut properties = HoseProperties::default();
            properties.visit(&mut reader);
            hose = Some(properties).filter(|_| !reader.incomplete);
        }
        CatalogueKind::Valve => Valve::default().visit(&mut reader),
        CatalogueKind::Pipe => DeclaredPipe::default().visit(&mut reader),
        CatalogueKind::Cylinder => DeclaredCylinder::default().visit(&mut reader),
    }
    reader.close();
    let sources = sources(&root, &head, findings);
    Some(CatalogueEntry {
        kind: head.kind,
        name: head.name?,
        title: head.title?,
        manufacturer: head.manufacturer.unwrap_or_default(),
        file: file.to_string(),
        hose,
        source: head.source,
        sources,
        values: root,
    })
}

/// Sources of single numbers. A number without any source is rejected.
fn sources(root: &TreeNode, head: &Head, findings: &mut Findings) -> Vec<(String, String)> {
    let mut sources = Vec::new();
    for entry in root.get("sources").map(|entry| entry.node.entries()).unwrap_or_default() {
        match &entry.node.value {
            TreeValue::Text(text) if root.get(&entry.key).is_some() => {
                sources.push((entry.key.clone(), text.clone()));
            }
            TreeValue::Text(_) => {
                let message = format!("the source of `{}`, which this file does not have", entry.key);
                findings.push(RawFinding::error(entry.key_place, message));
            }
            _ => findings.push(RawFinding::error(entry.node.place, "a source is a text")),
        }
    }
    for entry in root.entries().iter().filter(|entry| !HEAD.contains(&entry.key.as_str())) {
        let sourced = head.source.is_some() || sources.iter().any(|(name, _)| *name == entry.key);
        if !sourced {
            let place = entry.key_place;
            let found = RawFinding::error(place, format!("`{}` has no source", entry.key));
            findings.push(found.help("add `source` for the whole file, or name it under [sources]"));
        }
    }
    sources
}
