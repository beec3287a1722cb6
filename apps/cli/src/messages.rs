//! Messages of the command and the streams they are written to.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::time::{Duration, Instant};

use phea_workbench::command::Progress;

use crate::failure::Failure;
use phea_files::reason;

/// Prints to standard output. A closed pipe (`phea check rig.toml | head`) is not an error: its
/// reader has read enough.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stream = io::stdout().lock();
    match stream.write_all(text.as_bytes()).and_then(|()| stream.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::not_written(&format!("cannot write to standard output: {}", reason(&error))))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error; a failure to do so cannot be reported.
pub(crate) fn print_error(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}

/// Time after which progress is shown, and between two updates.
const UPDATE_INTERVAL: Duration = Duration::from_millis(500);

/// Time between lines of progress without a terminal, where they remain in a log.
const UPDATE_INTERVAL_OF_LOGS: Duration = Duration::from_secs(5);

/// The environment variable that suppresses progress in logs, and its value.
const PROGRESS_OFF: (&str, &str) = ("PHEA_PROGRESS", "never");

/// Longest remaining time that is shown, s.
const LONGEST_S: f64 = 1e9;

/// Shows the progress of a long command on standard error: one line that changes on a terminal, a
/// line every few seconds elsewhere.
pub(crate) struct ProgressLine {
    begun: Instant,
    next: Option<Instant>,
    terminal: bool,
    /// The last line that was shown; empty before the first.
    shown: String,
    /// The last reported stage.
    stage: Option<&'static str>,
    /// Time and completed fraction of the first report, for work that proceeds evenly.
    even: Option<(Instant, f64)>,
}

impl Default for ProgressLine {
    fn default() -> Self {
        let (variable, never) = PROGRESS_OFF;
        let wanted = std::env::var_os(variable).is_none_or(|value| value != never);
        let terminal = io::stderr().is_terminal();
        let begun = Instant::now();
        let mut line =
            ProgressLine { begun, next: None, terminal, shown: String::new(), stage: None, even: None };
        line.next = wanted.then(|| Instant::now() + line.update_interval());
        line
    }
}

impl ProgressLine {
    /// Shows the progress and the remaining time, for work that proceeds evenly.
    pub(crate) fn show_evenly(&mut self, progress: Progress) {
        let now = Instant::now();
        let (start, fraction) = *self.even.get_or_insert((now, progress.fraction));
        let gained = progress.fraction - fraction;
        let took = now.duration_since(start);
        if gained <= 0.0 || took < UPDATE_INTERVAL {
            return self.show(progress);
        }
        let left = took.as_secs_f64() * (1.0 - progress.fraction) / gained;
        let left = Duration::from_secs_f64(left.clamp(0.0, LONGEST_S)).as_secs();
        let (hours, minutes, seconds) = (left / 3600, left / 60 % 60, left % 60);
        self.write(progress, &format!(", {hours}:{minutes:02}:{seconds:02} left"));
    }

    /// The last reported stage; `None` before the first.
    pub(crate) fn stage(&self) -> Option<&'static str> {
        self.stage
    }

    fn update_interval(&self) -> Duration {
        if self.terminal { UPDATE_INTERVAL } else { UPDATE_INTERVAL_OF_LOGS }
    }

    /// Shows the progress, but not too often.
    pub(crate) fn show(&mut self, progress: Progress) {
        self.write(progress, "");
    }

    fn write(&mut self, progress: Progress, more: &str) {
        self.stage = Some(progress.stage).filter(|stage| !stage.is_empty()).or(self.stage);
        let now = Instant::now();
        if self.next.is_some_and(|next| now >= next) {
            self.next = Some(now + self.update_interval());
            let percent = (100.0 * progress.fraction).clamp(0.0, 100.0);
            let line = format!("{}: {percent:.0} %{more}", progress.stage);
            if line == self.shown {
                return;
            }
            match self.terminal {
                true => {
                    let _ = write!(io::stderr().lock(), "\r{line}\x1b[K");
                }
                false => print_error(&line),
            }
            self.shown = line;
        }
    }

    /// Removes the line; in a log, the last line states the total time.
    pub(crate) fn clear(&mut self) {
        match self.terminal {
            _ if self.shown.is_empty() => {}
            true => {
                let _ = write!(io::stderr().lock(), "\r\x1b[K");
            }
            false => print_error(&format!("ended after {} s", self.begun.elapsed().as_secs())),
        }
    }
}
