//! Progress of a long procedure, and its cancellation.

/// Progress of a long procedure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Current stage.
    pub stage: &'static str,
    /// Completed fraction, 0 to 1.
    pub fraction: f64,
}

/// Progress callback; return `false` to cancel.
pub type Watch<'a> = &'a mut dyn FnMut(Progress) -> bool;

/// Error of a procedure that its watch stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

/// Reports progress to the watch: `done` steps of `all`.
///
/// # Errors
/// [`Stopped`] if the watch returns `false`.
///
/// # Example
/// ```
/// use phea_dynamics::watch::{Progress, Stopped, Watch, report_progress, unwatched};
/// fn sum(numbers: &[f64], watch: Watch<'_>) -> Result<f64, Stopped> {
///     let mut sum = 0.0;
///     for (done, number) in numbers.iter().enumerate() {
///         report_progress(watch, "adding", done, numbers.len())?;
///         sum += number;
///     }
///     Ok(sum)
/// }
/// assert_eq!(sum(&[1.0, 2.0], &mut unwatched), Ok(3.0));
/// let mut until_half = |progress: Progress| progress.fraction < 0.5;
/// assert_eq!(sum(&[1.0, 2.0], &mut until_half), Err(Stopped));
/// ```
pub fn report_progress(
    watch: Watch<'_>,
    stage: &'static str,
    done: usize,
    all: usize,
) -> Result<(), Stopped> {
    let fraction = done as f64 / all.max(1) as f64;
    if watch(Progress { stage, fraction }) { Ok(()) } else { Err(Stopped) }
}

/// Watch of a part of a procedure, which covers a given interval of the whole; the stage is that of
/// the whole.
pub fn part<'a>(
    watch: Watch<'a>,
    stage: &'static str,
    [from, to]: [f64; 2],
) -> impl FnMut(Progress) -> bool + use<'a> {
    move |progress| watch(Progress { stage, fraction: from + (to - from) * progress.fraction })
}

/// Watch of a part of a procedure, which covers a given interval of the whole and names its own
/// stages.
pub fn within<'a>(watch: Watch<'a>, [from, to]: [f64; 2]) -> impl FnMut(Progress) -> bool + use<'a> {
    move |progress| watch(Progress { fraction: from + (to - from) * progress.fraction, ..progress })
}

/// Watch whose fraction never decreases, since the number of steps of a search is only estimated.
///
/// # Example
/// ```
/// use phea_dynamics::watch::{Progress, rising};
/// let mut fractions = Vec::new();
/// let mut show = |progress: Progress| {
///     fractions.push(progress.fraction);
///     true
/// };
/// let mut watched = rising(&mut show);
/// for fraction in [0.1, 0.4, 0.2, 0.5, f64::NAN] {
///     watched(Progress { stage: "searching", fraction });
/// }
/// drop(watched);
/// assert_eq!(fractions, [0.1, 0.4, 0.4, 0.5, 0.5]);
/// ```
pub fn rising<'a>(watch: Watch<'a>) -> impl FnMut(Progress) -> bool + use<'a> {
    let mut most = 0.0_f64;
    move |progress| {
        most = most.max(progress.fraction).min(1.0);
        watch(Progress { fraction: most, ..progress })
    }
}

/// Watch that never cancels.
pub fn unwatched(_: Progress) -> bool {
    true
}
