//! Signals: Ctrl-C during a command that can return its result so far, and a file that grows beyond
//! the largest permitted size.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of a command that was interrupted twice, in the convention of shells: 128 plus the
/// number of the signal.
const INTERRUPTED: i32 = 130;

/// Flag that is set if the command was requested to stop.
pub(crate) struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Installs the handler. The first Ctrl-C requests the command to stop with its result so far,
    /// the second ends it at once.
    pub(crate) fn listen() -> Interruption {
        let request = Arc::new(AtomicBool::new(false));
        let handled = Arc::clone(&request);
        // if no handler can be installed, Ctrl-C ends the command as usual
        let _ = ctrlc::set_handler(move || {
            if handled.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
        });
        Interruption(request)
    }

    pub(crate) fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Turns a write beyond the largest permitted size of a file (`ulimit -f`) into an error of that
/// write, which would otherwise end the process.
#[cfg(unix)]
pub(crate) fn survive_large_files() {
    let unread = Arc::new(AtomicBool::new(false));
    // if no handler can be installed, such a write ends the command as usual
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, unread);
}

#[cfg(not(unix))]
pub(crate) fn survive_large_files() {}
