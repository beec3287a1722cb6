//! Where commands print: at once, or kept until their turn where several run at the same time.

use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};

use super::Outcome;

/// What becomes of what is printed.
#[derive(Clone)]
pub(super) enum Console {
    /// It is shown at once.
    Shown,
    /// It is kept.
    Kept(Arc<Mutex<String>>),
}

impl Console {
    /// One that keeps what is printed.
    pub(super) fn kept() -> Console {
        Console::Kept(Arc::default())
    }

    /// What was kept, which is kept no longer.
    pub(super) fn taken(&self) -> String {
        match self {
            Console::Shown => String::new(),
            Console::Kept(told) => std::mem::take(&mut told.lock().unwrap_or_else(PoisonError::into_inner)),
        }
    }

    /// Prints a line.
    pub(super) fn print(&self, line: &str) {
        match self {
            Console::Shown => println!("{line}"),
            Console::Kept(told) => {
                let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
                told.push_str(line);
                told.push('\n');
            }
        }
    }

    /// Runs one command in the root.
    pub(super) fn execute(
        &self,
        root: &Path,
        program: &str,
        arguments: &[&str],
        variables: &[(&str, &str)],
    ) -> Outcome {
        let line = format!("{program} {}", arguments.join(" "));
        self.print(&format!("$ {line}"));
        let mut command = Command::new(program);
        command.args(arguments).envs(variables.iter().copied()).current_dir(root);
        match self.ended(&mut command) {
            Ok(status) if status.success() => Outcome::Passed,
            Ok(status) => Outcome::Failed(format!("`{line}`: {status}")),
            Err(error) => Outcome::Failed(format!("`{line}`: {error}")),
        }
    }

    fn ended(&self, command: &mut Command) -> std::io::Result<ExitStatus> {
        if matches!(self, Console::Shown) {
            return command.status();
        }
        let ran = command.stdin(Stdio::null()).output()?;
        self.print(String::from_utf8_lossy(&[ran.stderr, ran.stdout].concat()).trim_end());
        Ok(ran.status)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_taken_once() {
        let console = Console::kept();
        let outcome = console.execute(Path::new("."), "cargo", &["--version"], &[]);
        assert!(matches!(outcome, Outcome::Passed));
        let told = console.taken();
        assert!(told.starts_with("$ cargo --version\ncargo "), "{told}");
        assert_eq!(console.taken(), "");
        let missing = console.execute(Path::new("."), "no-such-program", &[], &[]);
        assert!(matches!(missing, Outcome::Failed(remark) if remark.contains("no-such-program")));
    }
}
