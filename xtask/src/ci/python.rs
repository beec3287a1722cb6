//! The Python package: its wheel, installed into a fresh environment, types and tests.

use super::{Outcome, Runner, tools};

/// Builds the wheel, installs it and tests it.
pub(super) fn run(runner: &Runner) -> Outcome {
    tools::python()?;
    let [environment, wheels, phea] = ["python", "wheels", "debug/phea"].map(|name| runner.path(name));
    let [python, maturin] = ["python", "maturin"].map(|name| format!("{environment}/bin/{name}"));
    let wheel = format!("build --quiet --profile dev -m apps/python/Cargo.toml --out {wheels}");
    let steps = [
        format!("python3 -m venv --clear {environment}"),
        format!("{python} -m pip install --quiet -r apps/python/tests/requirements.txt"),
        format!("{python} apps/python/generate_answers.py --check"),
        format!("{maturin} {wheel}"),
        format!("{python} -m pip install --quiet --no-index --find-links {wheels} phea"),
        format!("{python} -m mypy --config-file pyproject.toml -p phea"),
        format!("{python} -m mypy --config-file pyproject.toml apps/python/tests"),
        format!(
            "{python} -m pytest --quiet -c pyproject.toml apps/python/tests \
             --ignore apps/python/tests/clusters"
        ),
    ];
    // an older wheel would be installed again
    let _ = std::fs::remove_dir_all(&wheels);
    let bin = format!("{environment}/bin:{}", std::env::var("PATH").unwrap_or_default());
    let variables = [("PHEA_COMMAND", phea.as_str()), ("VIRTUAL_ENV", &environment), ("PATH", &bin)];
    runner.steps(&steps, &variables)
}

/// Runs campaigns on Dask and on Ray, in the environment that [`run`] leaves.
pub(super) fn clusters(runner: &Runner) -> Outcome {
    let python = runner.path("python/bin/python");
    let steps = [
        format!("{python} -m pip install --quiet distributed==2026.8.0 ray==2.60.0"),
        format!("{python} -m pytest --quiet --doctest-modules --pyargs phea"),
        format!("{python} -m pytest --quiet -c pyproject.toml apps/python/tests/clusters"),
    ];
    runner.steps(&steps, &[])
}
