//! The completions of the shells and the manual pages name every command and option that the help
//! names, and the tools that read them accept them.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Standard output of a program that succeeds and prints no error, given this standard input.
fn output(program: &str, arguments: &[&str], input: &str) -> String {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    // a program that reads nothing may have ended already
    let _ = child.stdin.take().expect("a pipe").write_all(input.as_bytes());
    let ended = child.wait_with_output().expect("the program ends");
    let errors = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success() && errors.is_empty(), "{program} {arguments:?}: {errors}");
    String::from_utf8_lossy(&ended.stdout).into_owned()
}

fn phea(arguments: &[&str]) -> String {
    output(env!("CARGO_BIN_EXE_phea"), arguments, "")
}

/// The commands that the help lists, except the help itself.
fn commands() -> Vec<String> {
    let help = phea(&["--help"]);
    let listed = help.split("Commands:").nth(1).and_then(|rest| rest.split("Options:").next());
    let lines = listed.expect("a list of commands").lines().filter_map(|line| line.strip_prefix("  "));
    let names = lines.filter(|line| !line.starts_with(' ')).filter_map(|line| line.split(' ').next());
    names.filter(|name| *name != "help").map(String::from).collect()
}

/// The long options that a text names.
fn options(text: &str) -> BTreeSet<&str> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
    words.filter(|word| word.starts_with("--") && word.len() > 2).collect()
}

fn has_program(name: &str) -> bool {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&paths).any(|folder| folder.join(name).is_file())
}

/// An empty folder for this test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn every_shell_completes_every_command_and_option() {
    let commands = commands();
    assert!(commands.len() >= 18, "{commands:?}");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = phea(&["completions", shell]);
        for command in &commands {
            assert!(script.contains(command.as_str()), "{shell} lacks {command}");
            for option in options(&phea(&[command, "--help"])) {
                // fish names an option without its hyphens
                let name = option.trim_start_matches('-');
                assert!(script.contains(name), "{shell} lacks {command} {option}");
            }
        }
    }
}

/// Bash is on every computer that builds phea, except on Windows.
#[cfg(unix)]
#[test]
fn bash_reads_and_runs_its_completions() {
    let script = phea(&["completions", "bash"]);
    assert_eq!(output("bash", &["-n"], &script), "");
    for (typed, completed) in [("ver", "verify"), ("check-c", "check-certificate"), ("sim", "simulate")] {
        let run = format!(
            "{script}\nCOMP_WORDS=(phea {typed}); COMP_CWORD=1; _phea phea {typed} phea; echo \"${{COMPREPLY[@]}}\""
        );
        assert_eq!(output("bash", &["--norc"], &run).trim(), completed);
    }
}

/// A page of the manual is read without an error, and shows every option that the help of its
/// command shows.
#[cfg(unix)]
#[test]
fn manual_pages_are_rendered() {
    let folder = folder("manual");
    phea(&["man", "--out", &folder.to_string_lossy()]);
    let page = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a page");
    let mut pages = vec![("phea.1".to_string(), phea(&["--help"]))];
    pages.extend(commands().iter().map(|name| (format!("phea-{name}.1"), phea(&[name, "--help"]))));
    let written = std::fs::read_dir(&folder).expect("the folder").count();
    assert_eq!(written, pages.len(), "a page for each command, and no other");
    for (name, help) in &pages {
        let rendered = rendered(&page(name));
        // hyphenation and justification are the reader's
        let text: String = rendered.chars().filter(|c| !c.is_whitespace()).collect();
        for option in options(help).into_iter().chain(["NAME", "SYNOPSIS", "DESCRIPTION"]) {
            assert!(text.contains(option), "{name} lacks {option}:\n{rendered}");
        }
    }
    assert_eq!(phea(&["man"]), page("phea.1"));
}

/// A page as a terminal shows it.
///
/// `man` of Debian uses groff, that of macOS and Alpine mandoc, which also lists what is wrong in a
/// page; one of the two is needed.
#[cfg(unix)]
fn rendered(page: &str) -> String {
    let has_mandoc = has_program("mandoc");
    assert!(has_mandoc || has_program("groff"), "install mandoc or groff: no program reads a manual page");
    if has_mandoc {
        output("mandoc", &["-T", "lint", "-W", "error"], page);
        let struck_over = output("mandoc", &["-T", "ascii", "-O", "width=200"], page);
        let letters: Vec<char> = struck_over.chars().collect();
        let is_struck =
            |index: &usize| letters[*index] == '\u{8}' || letters.get(index + 1) == Some(&'\u{8}');
        return (0..letters.len()).filter(|index| !is_struck(index)).map(|index| letters[index]).collect();
    }
    output("groff", &["-man", "-Tascii", "-ww", "-rLL=200n", "-P-cbou"], page)
}

#[test]
fn no_other_file_is_replaced_by_a_page() {
    let folder = folder("not_a_manual");
    let file = folder.join("phea-check.1");
    std::fs::write(&file, "my notes\n").expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    let ended = command.args(["man", "--out"]).arg(&folder).output().expect("phea starts");
    assert_eq!(ended.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), "my notes\n");
    assert_eq!(std::fs::read_dir(&folder).expect("the folder").count(), 1, "nothing is written");
    std::fs::remove_file(&file).expect("the file");
    let out = folder.to_string_lossy().into_owned();
    let twice = [phea(&["man", "--out", &out]), phea(&["man", "--out", &out])];
    assert_eq!(twice[0], twice[1], "a page is replaced by its successor");
}
