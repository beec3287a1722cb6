//! Files of a project and those that it names, so that a command can refuse to replace one of them.

use super::read::print;
use super::text::Findings;
use super::tree::{self, TreeNode, Value};
use super::{Loaded, Project};
use crate::source::Source;

impl Loaded {
    /// Paths of the project file, of its catalogues, and of every file that a text of the project
    /// may name: in the file as written, and with the settings applied. Not all of them exist,
    /// since a text such as `70 bar` is among them.
    ///
    /// # Example
    /// ```
    /// use phea_project::{self as project, source::Memory};
    /// let text = "schema = 1\n[family]\nmeasured = [\"drive.csv\"]\n";
    /// let source = Memory::default().with("rigs/drive.toml", text).with("parts/hose.toml", "");
    /// let read = project::read(&source, "rigs/drive.toml", &[], &[])?;
    /// let named = project::Loaded { catalogues: vec!["parts".to_string()], ..read }.named_files(&source);
    /// assert_eq!(named, ["rigs/drive.toml", "parts/hose.toml", "rigs/drive.csv"]);
    /// # Ok::<(), project::Refusal>(())
    /// ```
    pub fn named_files(&self, source: &dyn Source) -> Vec<String> {
        let mut files = vec![self.path.clone()];
        for catalogue in &self.catalogues {
            match source.list(catalogue) {
                Ok(Some(inside)) => files.extend(inside.into_iter().filter(|file| file.ends_with(".toml"))),
                Ok(None) | Err(_) => files.push(catalogue.clone()),
            }
        }
        let declared = texts_of(&self.project, &self.bytes);
        files.extend(declared.iter().map(|text| self.project.path_of(text)));
        let mut seen = Vec::with_capacity(files.len());
        for file in files {
            if !seen.contains(&file) {
                seen.push(file);
            }
        }
        seen
    }
}

/// All texts of the file and of the project that was read from it.
fn texts_of(project: &Project, bytes: &[u8]) -> Vec<String> {
    let mut texts = Vec::new();
    for content in [bytes, print(project).as_bytes()] {
        if let Some(root) = tree::read("", content, &mut Findings::default()) {
            collect(&root, &mut texts);
        }
    }
    texts
}

fn collect(node: &TreeNode, texts: &mut Vec<String>) {
    match &node.value {
        Value::Text(text) => texts.push(text.clone()),
        Value::List(nodes) => nodes.iter().for_each(|node| collect(node, texts)),
        Value::Table(entries) => entries.iter().for_each(|entry| collect(&entry.node, texts)),
        Value::Number(_) | Value::Flag(_) | Value::Date => {}
    }
}
