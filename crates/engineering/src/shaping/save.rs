//! Elements written back into their file, and read again for verification.

use super::{Shaped, ShapingError};
use crate::project::{self, DeclaredElement, Loaded, with_elements};
use crate::source::{Source, SourceError};

/// Bytes of the project file with these elements; settings of the command line are not written.
pub(super) fn saved(
    source: &dyn Source,
    loaded: &Loaded,
    shaped: Shaped,
    elements: &[DeclaredElement],
) -> Result<Vec<u8>, ShapingError> {
    let saved = with_elements(&loaded.path, &loaded.bytes, shaped.table(), elements)?;
    read_back(source, loaded, shaped, elements, &saved)?;
    Ok(saved)
}

/// Checks that the written text has the intended meaning.
fn read_back(
    source: &dyn Source,
    loaded: &Loaded,
    shaped: Shaped,
    elements: &[DeclaredElement],
    saved: &[u8],
) -> Result<(), ShapingError> {
    if !loaded.settings.is_empty() {
        return Ok(()); // the file alone need not be a valid project
    }
    let over = OverriddenSource { source, path: &loaded.path, bytes: saved };
    let again = match project::read(&over, &loaded.path, &[], &[]) {
        Ok(again) => again,
        // only the command line knows the names of the user's own catalogue
        Err(_) if !loaded.catalogue_files.iter().all(|file| file.starts_with("built-in:")) => return Ok(()),
        Err(report) => return Err(ShapingError::Refused(report)),
    };
    let transfer = match shaped {
        Shaped::Controller => again.project.controller.map(|controller| controller.transfer),
        Shaped::Prefilter => again.project.prefilter.map(|prefilter| prefilter.transfer),
    };
    let is_same = transfer.map(|transfer| transfer.as_elements()).unwrap_or_default() == elements;
    if is_same { Ok(()) } else { Err(ShapingError::NotWritten) }
}

/// A source in which one file has other bytes.
struct OverriddenSource<'a> {
    source: &'a dyn Source,
    path: &'a str,
    bytes: &'a [u8],
}

impl Source for OverriddenSource<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, SourceError> {
        if path == self.path { Ok(self.bytes.to_vec()) } else { self.source.read(path) }
    }

    fn list(&self, path: &str) -> Result<Option<Vec<String>>, SourceError> {
        self.source.list(path)
    }
}
