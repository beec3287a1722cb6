//! What a command says of a project, before it is printed.

use crate::answer::{Answer, OutputFile};
use crate::document::Document;
use crate::identify::in_use_above;
use crate::motion;
use crate::project::Loaded;

/// An [`Answer`] whose text is not printed yet.
pub(super) struct Told {
    pub(super) document: Document,
    pub(super) json: String,
    pub(super) files: Vec<OutputFile>,
    pub(super) affirmative: bool,
}

impl Told {
    /// Below what recordings gave, in the words of the motion.
    pub(super) fn print(self, loaded: &Loaded) -> Answer {
        self.print_of(std::slice::from_ref(loaded))
    }

    /// The same of projects of one motion.
    pub(super) fn print_of(self, projects: &[Loaded]) -> Answer {
        let Told { document, json, files, affirmative } = self;
        let mut out = Document::default();
        projects.iter().for_each(|loaded| out.append(in_use_above(loaded)));
        out.append(document);
        motion::said(Answer { text: out.text(), json, files, affirmative }, projects)
    }
}
