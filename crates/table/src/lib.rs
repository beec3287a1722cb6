//! Tables of keys: how a type that is written in a file names its fields.
//!
//! A component of a rig, and every other part of a project file, states each of its keys once,
//! next to its field: name, dimension, accepted range, default and meaning. Reading and writing
//! files is left to `phea_project`.

mod catalogue_kind;
mod cost;
mod formula;
mod key;
mod misfit;
mod open_table;
mod table_check;
mod visitor;

pub use catalogue_kind::CatalogueKind;
pub use cost::{LineCost, PartCost};
pub use formula::{Formula, FormulaError, Ratio, Variable};
pub use key::{AcceptedRange, Key, Motions, UsualRange, key, plain};
pub use misfit::DeclaredMisfit;
pub use open_table::{OpenTable, OpenTableReader, OpenTableWriter};
pub use table_check::{TableCheck, TableFinding};
pub use visitor::{
    FormulaShape, Kinds, NamedNumber, TableNumber, ValueForm, Variants, Visitor, once_read, word_of,
};
