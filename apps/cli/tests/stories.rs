//! The stories of `examples/` and `examples/qft/` and the README are run: each `console` block is
//! executed and must print the output that it shows.
//!
//! Each story has its own folder, with a copy of the example projects in it, so that its files
//! disturb neither the repository nor another story. `phea` in a story is the binary that was just
//! built.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

#[test]
fn stories() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let sandbox = Path::new(env!("CARGO_TARGET_TMPDIR")).join("stories");
    let stories = laid_out(&examples, &sandbox).expect("the stories are copied");
    assert!(stories.len() >= 10, "{stories:?}");
    let cases = trycmd::TestCases::new();
    cases.register_bin("phea", trycmd::schema::Bin::Path(env!("CARGO_BIN_EXE_phea").into()));
    // one story changes a digit of a file
    if let Some(sed) = program("sed") {
        cases.register_bin("sed", trycmd::schema::Bin::Path(sed));
    }
    cases.env("NO_COLOR", "1");
    cases.env("PHEA_PROGRESS", "never");
    for story in stories {
        cases.case(story);
    }
}

/// The lines that the README quotes of the example are lines of that file, in their order.
#[test]
fn the_readme_quotes_the_example() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| fs::read_to_string(repository.join(path)).expect("the file is there");
    let (readme, example) = (read("README.md"), read("examples/ybitu/hose.toml"));
    let quoted = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block");
    let mut lines = example.lines();
    for quote in quoted.lines() {
        assert!(lines.any(|line| line.starts_with(quote)), "{quote} is not in the example, or elsewhere");
    }
}

/// Path of a program of the system.
fn program(name: &str) -> Option<PathBuf> {
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}

/// Every story with the folder in which it runs: `NAME.in` has its initial files, and with
/// `NAME.out` it runs in a copy of them.
fn laid_out(examples: &Path, sandbox: &Path) -> io::Result<Vec<PathBuf>> {
    if sandbox.exists() {
        fs::remove_dir_all(sandbox)?;
    }
    let mut stories = Vec::new();
    let (rig, robust) = (fs::read_dir(examples)?, fs::read_dir(examples.join("qft"))?);
    let listed = rig.chain(robust).map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<PathBuf>>>()?;
    for source in listed.into_iter().chain([examples.join("../README.md")]) {
        if source.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let story = sandbox.join(source.file_name().unwrap_or_default());
        copy_folder(examples, &story.with_extension("in").join("examples"))?;
        fs::create_dir_all(story.with_extension("out"))?;
        fs::copy(&source, &story)?;
        stories.push(story);
    }
    stories.sort();
    Ok(stories)
}

fn copy_folder(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy_folder(&path, &target)?;
        } else {
            fs::copy(&path, &target)?;
        }
    }
    Ok(())
}
