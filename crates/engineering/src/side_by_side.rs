//! Independent pieces of work on all cores.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::watch::{Progress, Stopped, Watch, report_progress, unwatched, within};

/// Interval between calls of `watch` while pieces of work are in progress.
const ROUND: Duration = Duration::from_millis(20);
/// Interval between calls of `watch` while another thread works and the calling thread is idle.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// Results of `count` pieces of work in their order, computed by as many threads as there are
/// cores; by the calling thread if there is one core. The pieces receive their index and a watch
/// that returns `false` once this one has; they give no result then.
///
/// # Errors
/// [`Stopped`] if `watch` returns `false`, or a piece gives no result.
///
/// # Example
/// ```
/// use phea_dynamics::watch::unwatched;
/// use phea_engineering::side_by_side::side_by_side;
/// let squares = side_by_side(4, "squaring", &mut unwatched, |index, _| Some(index * index));
/// assert_eq!(squares, Ok(vec![0, 1, 4, 9]));
/// ```
pub fn side_by_side<T: Send>(
    count: usize,
    stage: &'static str,
    watch: Watch<'_>,
    piece: impl Fn(usize, Watch<'_>) -> Option<T> + Sync,
) -> Result<Vec<T>, Stopped> {
    let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let pieces = results.iter_mut().enumerate().map(|(index, place)| {
        let piece = &piece;
        let own: WorkPiece<'_> = Box::new(move |watch: Watch<'_>| {
            *place = Some(piece(index, watch).ok_or(Stopped)?);
            Ok(())
        });
        own
    });
    all_cores().work(pieces.collect(), stage, watch)?;
    results.into_iter().collect::<Option<Vec<T>>>().ok_or(Stopped)
}

/// The result for each item in its order, computed on all cores.
pub(crate) fn of_each<One: Sync, Found: Send>(all: &[One], of: impl Fn(&One) -> Found + Sync) -> Vec<Found> {
    let found = side_by_side(all.len(), "", &mut unwatched, |index, _| all.get(index).map(&of));
    // this watch never cancels
    found.unwrap_or_default()
}

/// As many threads as cores; the calling thread if there is one core.
pub fn all_cores() -> Workers {
    match std::thread::available_parallelism().map_or(1, usize::from) {
        0 | 1 => Workers::CALLER,
        at_once => Workers { at_once, work: on_all_cores },
    }
}

/// Works on pieces with this thread, which reports the progress, and one more for each further
/// core.
fn on_all_cores(pieces: Vec<WorkPiece<'_>>, stage: &'static str, watch: Watch<'_>) -> Result<(), Stopped> {
    let count = pieces.len();
    let threads = all_cores().at_once.min(count);
    if threads <= 1 {
        return Workers::CALLER.work(pieces, stage, watch);
    }
    let (left, continues) = (Mutex::new(pieces.into_iter()), AtomicBool::new(true));
    let next = || left.lock().unwrap_or_else(PoisonError::into_inner).next();
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        for _ in 1..threads {
            let (sender, next, continues) = (sender.clone(), &next, &continues);
            scope.spawn(move || {
                let mut watched = |_: Progress| continues.load(Ordering::Relaxed);
                while continues.load(Ordering::Relaxed)
                    && let Some(piece) = next()
                {
                    // without a receiver, the work was cancelled
                    if sender.send(piece(&mut watched)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let ended = own_pieces(&next, &receiver, (stage, count), watch);
        continues.store(false, Ordering::Relaxed);
        ended
    })
}

/// Takes pieces until none remain, then receives the ends of those of the other threads.
fn own_pieces<'p>(
    next: &dyn Fn() -> Option<WorkPiece<'p>>,
    others: &Receiver<Result<(), Stopped>>,
    (stage, count): (&'static str, usize),
    watch: Watch<'_>,
) -> Result<(), Stopped> {
    let mut done = 0;
    while let Some(piece) = next() {
        piece(&mut |_: Progress| report_progress(&mut *watch, stage, done, count).is_ok())?;
        done += 1;
        for other in others.try_iter() {
            other?;
            done += 1;
        }
    }
    loop {
        report_progress(&mut *watch, stage, done, count)?;
        match others.recv_timeout(ROUND) {
            Ok(other) => other?,
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        done += 1;
    }
}

/// Result of work that may run for long without calling its watch, on a separate thread if there is
/// more than one core: the calling thread calls the watch instead. Cancelled work is abandoned; it
/// ends at its next call of the watch, or with the program.
///
/// # Errors
/// [`Stopped`] if `watch` returns `false`.
pub(crate) fn left_behind<T: Send + 'static>(
    watch: Watch<'_>,
    stage: &'static str,
    work: impl FnOnce(Watch<'_>) -> Result<T, Stopped> + Send + 'static,
) -> Result<T, Stopped> {
    if all_cores().at_once == 1 {
        return work(watch);
    }
    let (sender, receiver) = channel();
    let shared = Arc::new((AtomicBool::new(true), AtomicU64::new(0)));
    let of_work = Arc::clone(&shared);
    std::thread::spawn(move || {
        let (continues, fraction) = &*of_work;
        let found = work(&mut |progress: Progress| {
            fraction.store(progress.fraction.to_bits(), Ordering::Relaxed);
            continues.load(Ordering::Relaxed)
        });
        // without a receiver, the work was cancelled
        let _ = sender.send(found);
    });
    let (continues, fraction) = &*shared;
    loop {
        if !watch(Progress { stage, fraction: f64::from_bits(fraction.load(Ordering::Relaxed)) }) {
            continues.store(false, Ordering::Relaxed);
            return Err(Stopped);
        }
        match receiver.recv_timeout(ROUND) {
            Ok(found) => return found,
            Err(RecvTimeoutError::Timeout) => {}
            // the work panicked and has printed its message
            Err(RecvTimeoutError::Disconnected) => return Err(Stopped),
        }
    }
}

/// Results of two pieces of work: `first`, on a separate thread if there is more than one core, and
/// `second`, whose progress is reported meanwhile; then the stage of `first` is reported until it
/// ends. Without a separate thread, `first` runs before `second` and has this fraction of the
/// progress.
pub(crate) fn both<A: Send, B>(
    watch: Watch<'_>,
    first_fraction: f64,
    first: impl FnOnce(Watch<'_>) -> A + Send,
    second: impl FnOnce(Watch<'_>) -> B,
) -> (A, B) {
    if all_cores().at_once == 1 {
        let first = first(&mut within(&mut *watch, [0.0, first_fraction]));
        return (first, second(&mut within(watch, [first_fraction, 1.0])));
    }
    let (continues, stage) = (AtomicBool::new(true), Mutex::new(None));
    let of_first = || stage.lock().unwrap_or_else(PoisonError::into_inner);
    std::thread::scope(|scope| {
        let beside = scope.spawn(|| {
            first(&mut |progress: Progress| {
                *of_first() = Some(progress.stage);
                continues.load(Ordering::Relaxed)
            })
        });
        let mut fraction = first_fraction;
        let mut watched = |progress: Progress| {
            fraction = progress.fraction;
            let answer = watch(progress);
            continues.fetch_and(answer, Ordering::Relaxed);
            answer
        };
        let second = second(&mut within(&mut watched, [first_fraction, 1.0]));
        while !beside.is_finished() {
            // a piece that has not called its watch yet would not notice a cancellation either
            let stage = *of_first();
            if let Some(stage) = stage {
                continues.fetch_and(watch(Progress { stage, fraction }), Ordering::Relaxed);
            }
            std::thread::sleep(POLL_INTERVAL);
        }
        match beside.join() {
            Ok(first) => (first, second),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use super::*;

    /// Results are in the order of the pieces, whichever ends first.
    #[test]
    fn results_keep_their_order() {
        let slow_first = |index: usize, _: Watch<'_>| {
            std::thread::sleep(Duration::from_millis(5 * (8 - index as u64)));
            Some(index)
        };
        let found = side_by_side(8, "", &mut |_| true, slow_first);
        assert_eq!(found, Ok((0..8).collect()));
    }

    /// Work that never calls its watch does not prevent cancellation by the caller.
    #[test]
    fn work_that_does_not_ask_is_left_behind() {
        let (release, wait) = channel::<()>();
        let work = move |_: Watch<'_>| {
            // as long as the other end exists
            let _ = wait.recv();
            Ok(1)
        };
        let several = all_cores().at_once > 1;
        if several {
            assert_eq!(left_behind(&mut |_| false, "", work), Err(Stopped));
        }
        drop(release);
        assert_eq!(left_behind(&mut |_| true, "", |_| Ok(2)), Ok(2));
    }

    /// The stage of the first piece is reported while it is pending.
    #[test]
    fn what_is_waited_for_is_named() {
        let mut seen = vec![];
        let mut watch = |progress: Progress| {
            seen.push(progress.stage);
            seen.len() < 3
        };
        let first = |watch: Watch<'_>| {
            while watch(Progress { stage: "first", fraction: 0.5 }) {
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        both(&mut watch, 0.1, first, |_| ());
        assert!(seen.len() >= 3 && seen.iter().all(|stage| *stage == "first"), "{seen:?}");
    }

    /// Cancellation by the watch of the second piece reaches the first piece, and both return their
    /// results.
    #[test]
    fn a_stop_reaches_both() {
        let begun = AtomicBool::new(false);
        let first = |watch: Watch<'_>| {
            begun.store(true, Ordering::Relaxed);
            while watch(Progress { stage: "", fraction: 0.5 }) {
                std::thread::sleep(Duration::from_millis(1));
            }
            1
        };
        let mut fractions = vec![];
        let mut watch = |progress: Progress| {
            fractions.push(progress.fraction);
            fractions.len() < 3
        };
        // on one core the first piece is cancelled before the second begins
        let second = |watch: Watch<'_>| {
            while all_cores().at_once > 1 && !begun.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            if watch(Progress { stage: "", fraction: 0.0 }) { 2 } else { 3 }
        };
        let found = both(&mut watch, 0.1, first, second);
        assert!(found == (1, 2) || found == (1, 3), "{found:?}");
        assert!(fractions.is_sorted());
    }

    /// Pieces that call their watch end soon after cancellation, later ones do not begin, and
    /// progress never decreases.
    #[test]
    fn the_watch_stops_all_pieces() {
        let begun = AtomicUsize::new(0);
        let until_stopped = |_: usize, watch: Watch<'_>| {
            begun.fetch_add(1, Ordering::Relaxed);
            while watch(Progress { stage: "", fraction: 0.0 }) {
                std::thread::sleep(Duration::from_millis(1));
            }
            None::<()>
        };
        let mut rounds = 0;
        let found = side_by_side(
            100,
            "",
            &mut |_| {
                rounds += 1;
                rounds < 3
            },
            until_stopped,
        );
        assert_eq!(found, Err(Stopped));
        assert!(begun.load(Ordering::Relaxed) <= std::thread::available_parallelism().map_or(1, usize::from));
        let mut fractions = vec![];
        let mut watched = |progress: Progress| {
            fractions.push(progress.fraction);
            true
        };
        assert!(side_by_side(20, "", &mut watched, |index, _| Some(index)).is_ok());
        assert!(fractions.is_sorted());
    }
}
