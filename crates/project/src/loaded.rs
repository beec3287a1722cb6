//! A project with how it was read.

use super::{ChosenLines, Diagnostic, FromRecordings, Project};

/// A project that was read, with information about the reading.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What was declared, with settings applied, catalogue values and defaults filled in.
    pub project: Project,
    /// Warnings: values that are doubtful but not wrong.
    pub warnings: Vec<Diagnostic>,
    /// Name and content of every text a warning points into.
    pub texts: Vec<(String, String)>,
    /// The path of the file, as it was given.
    pub path: String,
    /// The file's bytes.
    pub bytes: Vec<u8>,
    /// Of the file's bytes, in hexadecimal; with recordings in use, of those followed by the bytes
    /// of each recording in order.
    pub sha256: String,
    /// The `path=value` texts that were applied, as given.
    pub settings: Vec<String>,
    /// The catalogue files a value came from: those of the project's own and `built-in:NAME`.
    pub catalogue_files: Vec<String>,
    /// Where every number that is not simply declared in the file came from, in path order.
    pub provenance: Vec<Provenance>,
    /// The user's catalogue files and folders, as given.
    pub catalogues: Vec<String>,
    /// What recordings gave in place of what the project declares; absent: nothing did.
    pub recorded: Option<FromRecordings>,
    /// The model that was chosen for lines without a stated one; absent: none was chosen.
    pub lines: Option<ChosenLines>,
}

impl Loaded {
    /// Every setting that makes this project of its file: those that follow from recordings, and
    /// the user's.
    pub fn all_settings(&self) -> Vec<String> {
        let recorded = self.recorded.iter().flat_map(|recorded| &recorded.settings);
        recorded.chain(&self.settings).cloned().collect()
    }

    /// The same project with the model that was chosen for the lines of another reading of it.
    #[must_use]
    pub fn with_lines_of(mut self, other: &Loaded) -> Loaded {
        if let Some(chosen) = &other.lines {
            self.project = self.project.with_chosen_lines(chosen.with_waves);
            self.lines = Some(chosen.clone());
        }
        self
    }
}

/// Where a number came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Dotted path, such as `valve.nominal_flow`.
    pub path: String,
    /// Who said it.
    pub origin: Origin,
}

/// Who said a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The project file.
    Project,
    /// A `--set`, quoted.
    Setting(String),
    /// The catalogue, with the source of the number.
    Catalogue {
        /// Name of the entry.
        name: String,
        /// Author, title and table.
        source: String,
    },
    /// The default of the key.
    Default,
    /// Recorded tests, by identification.
    Recordings,
}
