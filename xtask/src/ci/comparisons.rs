//! Comparisons with other tools and recomputed numbers, in Python, in their own virtual
//! environment.

use std::path::Path;

use super::{Outcome, Runner, tools};

/// Folders, and the beginnings of the names of the scripts to run.
const BEGINNINGS: [(&str, &str); 3] =
    [("comparisons", "compare_"), ("comparisons", "recompute_"), ("book", "recompute_")];

/// Scripts that take long, and are run by [`soak`] or by hand.
const LONG: [&str; 2] = ["comparisons/recompute_design.py", "comparisons/recompute_valve_intervals.py"];

const PYTHON: &str = "target/venv/bin/python";

/// Runs every comparison and every script that recomputes numbers.
pub(super) fn run(runner: &Runner) -> Outcome {
    let mut scripts = Vec::new();
    for (folder, beginning) in BEGINNINGS {
        for entry in std::fs::read_dir(runner.root.join(folder)).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with(beginning) && name.ends_with(".py") {
                scripts.push(format!("{folder}/{name}"));
            }
        }
    }
    scripts.retain(|script| !LONG.contains(&script.as_str()));
    scripts.sort();
    let scripts: Vec<&str> = scripts.iter().map(String::as_str).collect();
    let profile = runner.target.join("debug");
    environment(runner)
        .and(|| python(runner, &profile, &[&["comparisons/together.py"][..], &scripts].concat()))
}

/// Runs the scripts that are otherwise left out, with the phea of the release profile.
pub(super) fn soak(runner: &Runner) -> Outcome {
    let profile = runner.target.join("release");
    let jobs = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    environment(runner)
        .and(|| python(runner, &profile, &["comparisons/recompute_design.py"]))
        // fifty valves, identified by phea and by SciPy
        .and(|| python(runner, &profile, &["comparisons/compare_identify.py", "--sets", "50"]))
        // four hundred recordings, made in Python, of each valve
        .and(|| {
            let recorded = ["--seeds", "400", "--verified", "20", "--jobs", &jobs];
            python(runner, &profile, &[&["comparisons/compare_valves.py"][..], &recorded].concat())
        })
}

/// Runs Python with the programs of this profile.
fn python(runner: &Runner, profile: &Path, arguments: &[&str]) -> Outcome {
    let path = |path: &Path| path.to_string_lossy().into_owned();
    // The libraries below NumPy would use every core for matrices of a few rows, and the system
    // would clear the memory of each large array again.
    let variables = [
        ("OPENBLAS_NUM_THREADS", "1".to_string()),
        ("MALLOC_MMAP_THRESHOLD_", "1000000000".to_string()),
        ("MALLOC_TRIM_THRESHOLD_", "1000000000".to_string()),
        ("PYTHONPYCACHEPREFIX", path(&runner.target.join("pycache"))),
        ("PHEA", path(&profile.join("phea"))),
        ("REFERENCE_SYSTEMS", path(&profile.join("examples").join("reference_systems"))),
        ("SCHEMA_CASES", path(&profile.join("examples").join("schema_cases"))),
    ];
    let variables: Vec<(&str, &str)> =
        variables.iter().map(|(name, value)| (*name, value.as_str())).collect();
    runner.execute(&[&[PYTHON][..], arguments].concat(), &variables)
}

/// Creates the virtual environment with the packages that the scripts need.
fn environment(runner: &Runner) -> Outcome {
    if let Err(missing) = tools::python() {
        return Outcome::Failed(missing);
    }
    let install = "-m pip install --quiet --no-compile -r comparisons/requirements.txt";
    let make = || match runner.root.join(PYTHON).exists() {
        true => Outcome::Passed,
        false => runner.execute(&["python3", "-m", "venv", "--clear", "target/venv"], &[]),
    };
    make().and(|| runner.execute(&[&[PYTHON][..], &install.split(' ').collect::<Vec<_>>()].concat(), &[]))
}
