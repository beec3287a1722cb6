//! Project with information on its reading.

use super::{ChosenLines, Diagnostic, FromRecordings, Project};

/// Project that was read, with information on the reading.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// Declared project, with settings applied, catalogue values and defaults filled in.
    pub project: Project,
    /// Warnings: values that are doubtful but not wrong.
    pub warnings: Vec<Diagnostic>,
    /// Name and content of every text to which a warning refers.
    pub texts: Vec<(String, String)>,
    /// Path of the file, as given.
    pub path: String,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// SHA-256 of the file's bytes, in hexadecimal; with recordings in use, of the file's bytes
    /// followed by the bytes of each recording in order.
    pub sha256: String,
    /// Applied `path=value` texts, as given.
    pub settings: Vec<String>,
    /// Catalogue files from which a value was taken: those of the project's own and
    /// `built-in:NAME`.
    pub catalogue_files: Vec<String>,
    /// Origin of every number that is not simply declared in the file, in path order.
    pub provenance: Vec<Provenance>,
    /// Catalogue files and folders of the user, as given.
    pub catalogues: Vec<String>,
    /// Values from recordings that replace declared ones; absent if there are none.
    pub recorded: Option<FromRecordings>,
    /// Model chosen for lines without a stated one; absent if none was chosen.
    pub lines: Option<ChosenLines>,
}

impl Loaded {
    /// All settings that turn its file into this project: those that follow from recordings, and
    /// the user's.
    pub fn all_settings(&self) -> Vec<String> {
        let recorded = self.recorded.iter().flat_map(|recorded| &recorded.settings);
        recorded.chain(&self.settings).cloned().collect()
    }

    /// Project with the model that was chosen for the lines in another reading of it.
    #[must_use]
    pub fn with_lines_of(mut self, other: &Loaded) -> Loaded {
        if let Some(chosen) = &other.lines {
            self.project = self.project.with_chosen_lines(chosen.with_waves);
            self.lines = Some(chosen.clone());
        }
        self
    }
}

/// Origin of a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Dotted path, such as `valve.nominal_flow`.
    pub path: String,
    /// Source of the number.
    pub origin: Origin,
}

/// Source of a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Project file.
    Project,
    /// Setting `--set`, quoted.
    Setting(String),
    /// Catalogue, with the source of the number.
    Catalogue {
        /// Name of the entry.
        name: String,
        /// Author, title and table.
        source: String,
    },
    /// Default of the key.
    Default,
    /// Recorded tests, by identification.
    Recordings,
}
