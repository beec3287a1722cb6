//! The project and its alternatives under its declared load and under each of its load cases.

use super::prepared::prepared;
use super::{AlternativesError, PreparedAlternative};
use crate::parts::PartsCounted;
use crate::project::{Loaded, read_load_case};
use crate::source::Source;

/// Load under which alternatives are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JudgedLoad {
    /// The declared load.
    Declared,
    /// The load case at this index of the file.
    Case(usize),
}

/// The project with its alternatives under one load, ready to be judged.
#[derive(Clone, Debug)]
pub struct PreparedLoad {
    /// The load.
    pub load: JudgedLoad,
    /// The declared project first, then its alternatives in file order.
    pub all: Vec<PreparedAlternative>,
    /// Attributes of parts that are counted.
    pub counted: PartsCounted,
}

/// The project with its alternatives under this load.
///
/// # Errors
/// The errors of [`prepared()`], with the name of the load case.
pub fn prepared_load(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    load: JudgedLoad,
) -> Result<PreparedLoad, AlternativesError> {
    let (all, counted) = match load {
        JudgedLoad::Declared => prepared(source, loaded, catalogues)?,
        JudgedLoad::Case(index) => {
            let there =
                read_load_case(source, loaded, catalogues, index).map_err(AlternativesError::Refused)?;
            let case = loaded.project.load_cases.get(index).map_or("", |case| case.name.as_str());
            let named = |error: AlternativesError| match error {
                AlternativesError::Alternative { name, reason } => {
                    AlternativesError::Alternative { name: format!("{name}, {case}"), reason }
                }
                other => other,
            };
            prepared(source, &there, catalogues).map_err(named)?
        }
    };
    Ok(PreparedLoad { load, all, counted })
}
