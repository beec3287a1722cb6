//! Components with the source of every number: one TOML file for each product.
//!
//! The built-in files contain only data found in print. A user adds a file or a folder; an entry of
//! the same name is replaced by the later file.
//!
//! # Example
//! ```
//! use phea_project::catalogue::{self, CatalogueKind};
//! use phea_project::source::Memory;
//! let catalogue = catalogue::load(&Memory::default(), &[])?;
//! let hose = catalogue.find(CatalogueKind::Hose, "eaton_synflex_3130_08").expect("built in");
//! assert_eq!(hose.hose.as_ref().map(|hose| hose.bore), Some(0.0127));
//! assert_eq!(hose.source_of("bore"), "Ledezma (2019), section 6.4.1 and Table A.1");
//! # Ok::<(), phea_project::Refusal>(())
//! ```

mod built_in;
mod dash_size;
mod read;

pub use dash_size::DASH_SIZES;
pub use read::load;

pub use crate::catalogue_entry::{Catalogue, CatalogueEntry};
pub use phea_table::CatalogueKind;
