//! Inputs are never replaced: a command that would write over a file that it reads or that its
//! project names, by any route, is rejected before any work, with both names.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");

/// A loop that is audited, shaped and designed quickly.
const LOOP: &str = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n[controller]\nnumerator = \"1\"\n\
     denominator = \"s\"\n[[specification]]\nkind = \"robust_stability\"\nlimit = 1.2\nfrequencies = [1]\n\
     band = [0, inf]\n";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inputs_protected").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    let driven = fs::read_to_string(format!("{EXAMPLES}/benchmark/closed_loop.toml")).expect("the example");
    let hose = fs::read_to_string(format!("{EXAMPLES}/ybitu/hose.toml")).expect("the example");
    let (verified, _) = hose.split_once("[design]").expect("it has a [design]");
    let alternative = "[[alternative]]\nname = \"b\"\nset = { \"plant.denominator\" = \"s + 2\" }\n";
    let measured = "schema = 1\n[family]\nmeasured = [\"drive.csv\"]\n";
    let moved = driven.replace(
        "reference = [",
        "measured = { force = { file = \"drive.csv\", column = \"force\" } }\nreference = [",
    );
    let own = "schema = 1\nkind = \"hose\"\nname = \"own\"\ntitle = \"own\"\nmanufacturer = \"own\"\nsource = \"own\"\nbore = \"12.7 mm\"\n\
               volumetric_expansion = \"1.56e-5 m3/m\"\nvolumetric_expansion_pressure = \"70 bar\"\n";
    let named = format!("{LOOP}{}", alternative.replace("\"s + 2\" }", "\"s + 2\", title = \"drive.csv\" }"));
    let files: [(&str, &str); 9] = [
        ("rig.toml", &driven),
        ("hose.toml", verified),
        ("loop.toml", LOOP),
        ("two.toml", &format!("{LOOP}{alternative}")),
        ("named.toml", &named),
        ("measured.toml", measured),
        ("moved.toml", &moved),
        ("drive.csv", "frequency_hz,magnitude_db,phase_deg\n1,0,0\n2,0,0\n"),
        ("own.toml", own),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).expect("a file");
    }
    folder
}

fn phea(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_phea"));
    command.current_dir(folder).args(arguments).output().expect("phea starts")
}

/// Every file below a folder with its content.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match entry.is_dir() {
            true => found.extend(contents(&entry)),
            false => {
                found.insert(entry.clone(), fs::read(&entry).unwrap());
            }
        }
    }
    found
}

/// Expects that a command is rejected with both names, and changes nothing at all.
#[track_caller]
fn refused(folder: &Path, arguments: &[&str], names: [&str; 2]) {
    let before = contents(folder);
    let output = phea(folder, arguments);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {complaint}");
    for name in names {
        assert!(complaint.contains(name), "{arguments:?} does not name {name}: {complaint}");
    }
    assert!(complaint.contains("would replace"), "{arguments:?}: {complaint}");
    assert!(contents(folder) == before, "{arguments:?} changed a file");
}

/// Commands, and a name that each writes into its folder.
const WRITTEN: &[(&[&str], &str)] = &[
    (&["check", "hose.toml"], "derived.csv"),
    (&["size", "hose.toml"], "sizing.csv"),
    (&["linearize", "hose.toml"], "poles.csv"),
    (&["linearize", "hose.toml", "--sweep", "line.length=1 m..2 m", "--points", "2"], "sweep.csv"),
    (&["verify", "loop.toml"], "margins.csv"),
    (&["verify", "loop.toml", "--prove"], "certificate.json"),
    (&["shape", "loop.toml"], "shaped.toml"),
    (&["design", "loop.toml"], "designed.toml"),
    (&["design", "loop.toml"], "verification.json"),
    (&["simulate", "rig.toml"], "step and load motion.csv"),
    (&["simulate", "rig.toml"], "step and load motion.state.toml"),
    (&["simulate", "rig.toml", "--table", "parquet"], "step and load motion.parquet"),
    (&["simulate", "rig.toml", "--frequency-response"], "frequency_response_open_loop.csv"),
    (&["compare", "rig.toml", "rig.toml"], "step and load motion-force.svg"),
    (&["alternatives", "two.toml"], "alternatives.csv"),
    (&["alternatives", "two.toml"], "b.toml"),
    (&["campaign", "rig.toml", "--runs", "2"], "runs.csv"),
    (&["campaign", "rig.toml", "--run", "1"], "step and load motion.csv"),
    (&["bench", "rig.toml"], "leakage.csv"),
    (&["report", "loop.toml"], "report.html"),
    (&["report", "loop.toml"], "designed.toml"),
    (&["identify", "--project", "rig.toml", "drive.csv"], "valve.toml"),
    (&["identify", "--of", "response", "drive.csv"], "drive.response.csv"),
];

/// The file that a command reads as its project, or as its record.
fn input<'a>(arguments: &[&'a str]) -> &'a str {
    arguments.iter().copied().find(|one| one.ends_with(".toml")).unwrap_or("drive.csv")
}

/// The written name is a link to the input, another name of the input file, or differs in case.
#[test]
fn no_command_writes_through_a_name_of_its_input() {
    for (index, (arguments, name)) in WRITTEN.iter().enumerate() {
        let folder = folder(&format!("written_{index}"));
        let input = input(arguments);
        for out in ["linked", "hard", "cased"] {
            fs::create_dir_all(folder.join(out)).unwrap();
        }
        symlink(format!("../{input}"), folder.join("linked").join(name)).unwrap();
        fs::hard_link(folder.join(input), folder.join("hard").join(name)).unwrap();
        refused(&folder, &[arguments, &["--out", "linked"][..]].concat(), [&format!("linked/{name}"), input]);
        refused(&folder, &[arguments, &["--out", "./hard"][..]].concat(), [&format!("hard/{name}"), input]);
        let upper = format!("cased/{}", name.to_uppercase());
        fs::copy(folder.join(input), folder.join(&upper)).unwrap();
        let renamed: Vec<&str> =
            arguments.iter().map(|one| if *one == input { upper.as_str() } else { one }).collect();
        // a project is identified by its ending, and a record with another name has another
        // response
        if arguments[0] != "identify" {
            refused(&folder, &[&renamed, &["--out", "cased"][..]].concat(), [&upper, "cased/"]);
        }
    }
}

/// The file that is named on the command line.
#[test]
fn no_option_writes_over_an_input() {
    let folder = folder("options");
    symlink("loop.toml", folder.join("link.toml")).unwrap();
    fs::hard_link(folder.join("loop.toml"), folder.join("hard.toml")).unwrap();
    let routes = ["loop.toml", "./loop.toml", "link.toml", "hard.toml", "LOOP.toml", "new/../loop.toml"];
    for save in routes {
        for command in ["shape", "design"] {
            refused(&folder, &[command, "loop.toml", "--save", save], [save, "loop.toml"]);
        }
        refused(&folder, &["verify", "loop.toml", "--certificate", save], [save, "loop.toml"]);
        refused(&folder, &["verify", "link.toml", "--certificate", save], [save, "link.toml"]);
    }
    assert!(!folder.join("new").exists());
    // a file that the project, a setting, an alternative or the command line names
    let certificate = ["--certificate", "drive.csv"];
    refused(&folder, &[&["verify", "measured.toml"], &certificate[..]].concat(), ["drive.csv"; 2]);
    refused(&folder, &[&["verify", "named.toml"], &certificate[..]].concat(), ["drive.csv"; 2]);
    let set = ["verify", "loop.toml", "--set", "title=drive.csv"];
    refused(&folder, &[&set[..], &certificate[..]].concat(), ["drive.csv"; 2]);
    for catalogue in ["own.toml", "catalogue"] {
        fs::create_dir_all(folder.join("catalogue")).unwrap();
        fs::copy(folder.join("own.toml"), folder.join("catalogue/own.toml")).unwrap();
        let path = if catalogue == "catalogue" { "catalogue/own.toml" } else { catalogue };
        let arguments = ["shape", "loop.toml", "--catalogue", catalogue, "--save", path];
        refused(&folder, &arguments, [path; 2]);
    }
    // the page of a report without a folder
    fs::write(folder.join("x-report.html"), LOOP).unwrap();
    symlink("x-report.html", folder.join("x.toml")).unwrap();
    refused(&folder, &["report", "x.toml"], ["x-report.html", "x.toml"]);
}

/// Files of other commands, of earlier runs and of other names are written as before.
#[test]
fn a_file_that_is_not_an_input_is_replaced() {
    let folder = folder("written");
    for _ in 0..2 {
        let output = phea(&folder, &["verify", "loop.toml", "--certificate", "proof.json", "--out", "."]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(phea(&folder, &["shape", "loop.toml", "--out", "."]).status.code(), Some(0));
        assert_eq!(phea(&folder, &["alternatives", "two.toml", "--out", "."]).status.code(), Some(0));
    }
    let names = ["proof.json", "margins.csv", "shaped.toml", "b.toml", "alternatives.csv"];
    assert!(names.iter().all(|name| folder.join(name).is_file()));
    assert_eq!(fs::read_to_string(folder.join("loop.toml")).unwrap(), LOOP);
}

/// A starter is written only into an empty folder, and a schema replaces only a schema.
#[test]
fn starter_and_schema_replace_nothing_else() {
    let folder = folder("starter");
    let before = contents(&folder);
    symlink(&folder, folder.join("itself")).unwrap();
    for there in [".", "itself", "loop.toml"] {
        assert_eq!(phea(&folder, &["new", there]).status.code(), Some(2), "{there}");
    }
    fs::remove_file(folder.join("itself")).unwrap();
    assert!(contents(&folder) == before);
    for _ in 0..2 {
        assert_eq!(phea(&folder, &["schema", "--out", "editor"]).status.code(), Some(0));
    }
    fs::create_dir(folder.join("linked")).unwrap();
    symlink("../loop.toml", folder.join("linked/phea.schema.json")).unwrap();
    let output = phea(&folder, &["schema", "--out", "linked"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read_to_string(folder.join("loop.toml")).unwrap(), LOOP);
}
