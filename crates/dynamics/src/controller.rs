//! Controllers as values.
