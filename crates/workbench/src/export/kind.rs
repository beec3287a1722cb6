//! Languages of exported files.

use super::{ExportedController, c, ros2, script, structured_text};
use crate::answer::OutputFile;

/// Language of exported files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportKind {
    /// C99.
    C,
    /// Structured Text of IEC 61131-3.
    StructuredText,
    /// A package of ros2_control.
    Ros2,
    /// A script for MATLAB and Octave.
    Matlab,
    /// A module for Python.
    Python,
}

impl ExportKind {
    /// All of them.
    pub const ALL: [ExportKind; 5] =
        [ExportKind::C, ExportKind::StructuredText, ExportKind::Ros2, ExportKind::Matlab, ExportKind::Python];

    /// Name on the command line.
    ///
    /// # Example
    /// ```
    /// use phea_workbench::export::ExportKind;
    /// assert_eq!(ExportKind::ALL.map(ExportKind::name)[0], "c");
    /// assert_eq!(ExportKind::named("c"), Some(ExportKind::C));
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            ExportKind::C => "c",
            ExportKind::StructuredText => "st",
            ExportKind::Ros2 => "ros2",
            ExportKind::Matlab => "matlab",
            ExportKind::Python => "python",
        }
    }

    /// The language of this name.
    pub fn named(name: &str) -> Option<ExportKind> {
        ExportKind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Names of the files of a controller with this identifier.
    pub fn file_names(self, name: &str) -> Vec<String> {
        let own = |endings: &[&str]| endings.iter().map(|ending| format!("{name}{ending}")).collect();
        match self {
            ExportKind::C => [own(&c::ENDINGS), vec![c::EXAMPLE.to_string()]].concat(),
            ExportKind::StructuredText => {
                let [controller, test] = structured_text::OF_TWINCAT;
                own(&[structured_text::PORTABLE, controller, test])
            }
            ExportKind::Ros2 => [ExportKind::C.file_names(name), ros2::file_names(name)].concat(),
            ExportKind::Matlab => own(&[".m"]),
            ExportKind::Python => own(&[".py"]),
        }
    }

    /// Files of a controller.
    pub fn files(self, exported: &ExportedController) -> Vec<OutputFile> {
        match self {
            ExportKind::C => c::files(exported),
            ExportKind::StructuredText => structured_text::files(exported),
            ExportKind::Ros2 => ros2::files(exported),
            ExportKind::Matlab => script::matlab(exported),
            ExportKind::Python => script::python(exported),
        }
    }
}
