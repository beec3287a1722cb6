//! Quantitative Feedback Theory.
