//! Second reading of a project: with the settings of an alternative or a load case, or to locate an
//! error found later.

use super::Loaded;
use super::diagnostic::{Diagnostic, LateError, Refusal, Severity};
use super::read::{OwnSettings, read_bytes};
use crate::source::Source;

/// Refusal with this error at the place of its key, or of the nearest table around it.
///
/// # Example
/// ```
/// use phea_project::{self as project, LateError, STARTER};
/// use phea_project::source::Memory;
/// let source = Memory::default().with("rig.toml", STARTER);
/// let loaded = project::read(&source, "rig.toml", &[], &[])?;
/// let [path, message, help] = ["supply.pressure", "too low", "raise it"].map(String::from);
/// let refusal = project::refused(&source, &loaded, &LateError { path, message, help });
/// assert!(refusal.diagnostics[0].line > 0);
/// # Ok::<(), phea_project::Refusal>(())
/// ```
pub fn refused(source: &dyn Source, loaded: &Loaded, late: &LateError) -> Refusal {
    let settings = loaded.all_settings();
    let from = (source, loaded.path.as_str());
    let read = read_bytes(from, Ok(loaded.bytes.clone()), &settings, (&loaded.catalogues, Some(late)), None);
    read.err().unwrap_or_default()
}

/// Refusal for the alternative of a project with this index, with the place in its settings.
pub fn refused_alternative(source: &dyn Source, base: &Loaded, index: usize, late: &LateError) -> Refusal {
    let name = base.project.alternatives.get(index).map_or("", |one| one.name.as_str());
    let own = (OwnSettings::Alternative(index), name);
    read_again(source, base, (&base.catalogues, Some(late)), own).err().unwrap_or_default()
}

/// Alternative of a project with this index: its bytes with its settings, and then those of the
/// alternative. The settings are listed as if they had been given to [`read`](super::read()).
///
/// # Errors
/// [`Refusal`] with all errors; those in a value of the alternative have the place of that value.
///
/// # Example
/// ```
/// use phea_project::{self as project, STARTER};
/// use phea_project::source::Memory;
/// let text = format!("{STARTER}\n[[alternative]]\nname = \"80 bar\"\nset = {{ \"supply.pressure\" = \"80 bar\" }}\n");
/// let source = Memory::default().with("rig.toml", text);
/// let base = project::read(&source, "rig.toml", &[], &[])?;
/// let other = project::read_alternative(&source, &base, &[], 0)?;
/// assert_eq!(other.project.number("supply.pressure"), Some(80e5));
/// assert_eq!(other.settings, ["supply.pressure=\"80 bar\""]);
/// # Ok::<(), phea_project::Refusal>(())
/// ```
pub fn read_alternative(
    source: &dyn Source,
    base: &Loaded,
    catalogues: &[String],
    index: usize,
) -> Result<Loaded, Refusal> {
    let name = base.project.alternatives.get(index).map_or("", |one| one.name.as_str());
    read_again(source, base, (catalogues, None), (OwnSettings::Alternative(index), name))
}

/// Load case of a project with this index, read like an alternative: its settings are listed as if
/// they had been given to [`read`](super::read()), so that alternatives of it can be read.
///
/// # Errors
/// [`Refusal`] with all errors; those in a value of the load case have the place of that value.
pub fn read_load_case(
    source: &dyn Source,
    base: &Loaded,
    catalogues: &[String],
    index: usize,
) -> Result<Loaded, Refusal> {
    let name = base.project.load_cases.get(index).map_or("", |one| one.name.as_str());
    read_again(source, base, (catalogues, None), (OwnSettings::LoadCase(index), name))
}

/// Project from its bytes with its settings, and then those of its part of that name.
fn read_again(
    source: &dyn Source,
    base: &Loaded,
    also: (&[String], Option<&LateError>),
    (own, name): (OwnSettings, &str),
) -> Result<Loaded, Refusal> {
    // values from recordings apply here, too
    let settings = base.all_settings();
    let read = read_bytes((source, &base.path), Ok(base.bytes.clone()), &settings, also, Some(own));
    read.map_err(|mut refusal| {
        // a warning on the project itself is reported only once, with the project
        let known = |found: &Diagnostic| {
            found.severity != Severity::Error
                && base.warnings.iter().any(|warning| warning.message == found.message)
        };
        refusal.diagnostics.retain(|found| !known(found));
        for found in &mut refusal.diagnostics {
            found.message = format!("{} `{name}`: {}", own.table().1, found.message);
        }
        refusal
    })
}
