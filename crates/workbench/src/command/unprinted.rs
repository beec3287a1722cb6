//! Output of a command on a project, before it is printed.

use crate::answer::{Answer, Object, OutputFile, envelope};
use crate::document::Document;
use crate::identify::in_use_above;
use crate::line_choice::chosen_above;
use crate::project::Loaded;

/// An [`Answer`] before its text and JSON are printed.
pub(super) struct Unprinted {
    pub(super) document: Document,
    pub(super) body: Object,
    pub(super) files: Vec<OutputFile>,
    pub(super) affirmative: bool,
}

impl Unprinted {
    /// Adds warnings above the text; the body has its own.
    pub(super) fn with_warnings(mut self, warnings: Vec<String>) -> Unprinted {
        self.document.warnings(warnings);
        self
    }

    /// Prints the output below the values from recordings, in the envelope of the first project,
    /// with the names of its motion.
    pub(super) fn print(self, command: &'static str, projects: &[Loaded]) -> Answer {
        let mut document = Document::default();
        for loaded in projects {
            document.append(in_use_above(loaded));
            document.append(chosen_above(loaded));
        }
        document.append(self.document);
        let envelope = projects.first().map_or(Object::new(), |first| envelope(command, first));
        // projects with different motions are not printed together
        let motion = projects.first().map(|loaded| loaded.project.motion()).unwrap_or_default();
        Answer {
            document,
            json: envelope.and(self.body).print(motion),
            files: self.files,
            affirmative: self.affirmative,
        }
    }
}
