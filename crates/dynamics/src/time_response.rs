//! Responses in time and their metrics.
