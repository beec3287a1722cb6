//! How far a long procedure is, and whether it goes on.

/// How far a long procedure is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Share of it that is done, 0 to 1.
    pub share: f64,
}

/// Told the progress of a long procedure from time to time; it stops where the answer is `false`.
pub type Watch<'a> = &'a mut dyn FnMut(Progress) -> bool;
