//! The file system for applications: the source of projects and data, complete files in folders,
//! inputs that no output replaces, and the growing table of a campaign.

mod file_system;
mod inputs;
mod output;
mod table;

pub use file_system::{FileSystem, reason};
pub use inputs::Inputs;
pub use output::{Folder, expect_folder, unwritten, write, write_as};
pub use table::LockedTable;
