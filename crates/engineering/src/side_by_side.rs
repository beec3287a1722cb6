//! Independent pieces of work on all cores.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use phea_dynamics::watch::{Progress, Stopped, Watch, tell};

/// How often the watch is told while pieces of work go on.
const ROUND: Duration = Duration::from_millis(20);

/// The results of `count` pieces of work in their order, worked on by as many threads as there are
/// cores; by this one alone where there is one core. The pieces take their index and a watch that
/// answers `false` once this one did, and give no result then.
///
/// # Errors
/// [`Stopped`] where the watch answers `false`, or a piece gives no result.
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
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(count);
    if threads <= 1 {
        let alone = |index: usize| {
            let mut told = |progress: Progress| {
                watch(Progress { stage, share: (index as f64 + progress.share) / count as f64 })
            };
            piece(index, &mut told).ok_or(Stopped)
        };
        return (0..count).map(alone).collect();
    }
    let (next, goes_on) = (AtomicUsize::new(0), AtomicBool::new(true));
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let (sender, next, goes_on, piece) = (sender.clone(), &next, &goes_on, &piece);
            scope.spawn(move || {
                let mut told = |_: Progress| goes_on.load(Ordering::Relaxed);
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count || !goes_on.load(Ordering::Relaxed) {
                        return;
                    }
                    // where no one receives, the work was stopped
                    drop(sender.send((index, piece(index, &mut told))));
                }
            });
        }
        drop(sender);
        let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
        let mut done = 0;
        let told = loop {
            match receiver.recv_timeout(ROUND) {
                Ok((index, result)) => {
                    done += 1;
                    if result.is_none() {
                        break Err(Stopped);
                    }
                    results[index] = result;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break Ok(()),
            }
            if let Err(stopped) = tell(&mut *watch, stage, done, count) {
                break Err(stopped);
            }
        };
        goes_on.store(false, Ordering::Relaxed);
        told.and_then(|()| results.into_iter().collect::<Option<Vec<T>>>().ok_or(Stopped))
    })
}

#[cfg(test)]
mod tests {
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

    /// Pieces that look at their watch end soon after it is stopped, those behind them do not
    /// begin, and progress never falls.
    #[test]
    fn the_watch_stops_all_pieces() {
        let begun = AtomicUsize::new(0);
        let until_stopped = |_: usize, watch: Watch<'_>| {
            begun.fetch_add(1, Ordering::Relaxed);
            while watch(Progress { stage: "", share: 0.0 }) {
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
        let mut shares = vec![];
        let mut told = |progress: Progress| {
            shares.push(progress.share);
            true
        };
        assert!(side_by_side(20, "", &mut told, |index, _| Some(index)).is_ok());
        assert!(shares.is_sorted());
    }
}
