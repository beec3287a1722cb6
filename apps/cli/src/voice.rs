//! What the command says, and where.

use std::io::{self, ErrorKind, Write};

/// Says it on standard output. A reader that has gone away (`phea check rig.toml | head`) has what it wanted.
pub(crate) fn say(text: &str) -> Result<(), String> {
    let mut stream = io::stdout().lock();
    match stream.write_all(text.as_bytes()).and_then(|()| stream.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("error: cannot write to standard output: {error}"))
        }
        _ => Ok(()),
    }
}

/// Says it on standard error; nobody is left to be told if that fails.
pub(crate) fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}
