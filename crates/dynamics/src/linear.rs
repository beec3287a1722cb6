//! Linear time-invariant systems.
