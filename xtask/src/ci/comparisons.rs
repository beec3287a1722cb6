//! Comparisons with other tools and recomputed numbers, in Python, in their own virtual
//! environment.

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
    environment(runner)?;
    python(runner, "debug", &format!("comparisons/together.py {}", scripts.join(" ")))
}

/// Runs the scripts that are otherwise left out, with the phea of the release profile.
pub(super) fn soak(runner: &Runner) -> Outcome {
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    environment(runner)?;
    python(runner, "release", "comparisons/recompute_design.py")?;
    // fifty valves, identified by phea and by SciPy
    python(runner, "release", "comparisons/compare_identify.py --sets 50")?;
    // four hundred recordings, made in Python, of each valve
    let valves = "comparisons/compare_valves.py --seeds 400 --verified 20 --jobs";
    python(runner, "release", &format!("{valves} {jobs}"))
}

/// Runs Python with the programs of this profile.
fn python(runner: &Runner, profile: &str, arguments: &str) -> Outcome {
    let program = |name: &str| runner.path(&format!("{profile}/{name}"));
    // The libraries below NumPy would use every core for matrices of a few rows, and the system
    // would clear the memory of each large array again.
    let variables = [
        ("OPENBLAS_NUM_THREADS", "1".to_string()),
        ("MALLOC_MMAP_THRESHOLD_", "1000000000".to_string()),
        ("MALLOC_TRIM_THRESHOLD_", "1000000000".to_string()),
        ("PYTHONPYCACHEPREFIX", runner.path("pycache")),
        ("PHEA", program("phea")),
        ("REFERENCE_SYSTEMS", program("examples/reference_systems")),
        ("SCHEMA_CASES", program("examples/schema_cases")),
    ];
    let variables = variables.each_ref().map(|(name, value)| (*name, value.as_str()));
    runner.steps(&[format!("{PYTHON} {arguments}")], &variables)
}

/// Creates the virtual environment with the packages that the scripts need.
fn environment(runner: &Runner) -> Outcome {
    tools::python()?;
    if !runner.root.join(PYTHON).exists() {
        runner.steps(&["python3 -m venv --clear target/venv".to_string()], &[])?;
    }
    let install = "-m pip install --quiet --no-compile -r comparisons/requirements.txt";
    runner.steps(&[format!("{PYTHON} {install}")], &[])
}
