//! Embeds the example projects of the repository, with the files that they name.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folder of the examples, from this package.
const EXAMPLES: &str = "../../examples";
/// Folders with projects that are wrong on purpose, and with scripts.
const OTHERS: [&str; 2] = ["errors", "python"];
/// Endings of projects and of what they name.
const ENDINGS: [&str; 3] = ["toml", "csv", "parquet"];

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed={EXAMPLES}");
    let folder = fs::canonicalize(EXAMPLES)?;
    let mut files = Vec::new();
    collect(&folder, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for path in files {
        let name = path.strip_prefix(&folder).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let _ = writeln!(table, "    ({name:?}, include_bytes!({:?})),", path.to_string_lossy());
    }
    table.push(']');
    let out = env::var_os("OUT_DIR").unwrap_or_default();
    fs::write(Path::new(&out).join("examples.rs"), table)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !OTHERS.contains(&name.as_str()) {
            collect(&path, files)?;
        } else if ENDINGS.contains(&ending.as_str()) {
            files.push(path);
        }
    }
    Ok(())
}
