//! Results of tasks that cannot be joined.

/// Reason why results of tasks cannot be joined.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TaskResultError {
    /// The result cannot be encoded.
    #[error("the result of an alternative cannot be encoded: {0}")]
    NotEncoded(postcard::Error),
    /// The bytes are not those of a result.
    #[error("no result of an alternative, or one of another version of phea: {0}")]
    NotDecoded(postcard::Error),
    /// The plan has no such task.
    #[error("the alternatives are {count} tasks, from 0: there is no task {place}")]
    NoTask {
        /// Place of the task.
        place: usize,
        /// Number of tasks.
        count: usize,
    },
    /// The result of a task is that of another project or request.
    #[error("the result of task {0} is one of other alternatives")]
    OfOthers(usize),
    /// A result is missing.
    #[error("the result of task {0} is missing")]
    Missing(usize),
}
