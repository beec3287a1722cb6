"""Several projects, recordings and certificates."""

from __future__ import annotations

from pathlib import Path

import pytest

import phea
from conftest import EXAMPLES, Command

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")


@pytest.mark.usefixtures("in_examples")
def test_projects_are_compared_as_by_the_command(run: Command) -> None:
    paths = ["ybitu/hose.toml", "ybitu/pipe.toml"]
    compared = phea.compare(*(phea.read(path) for path in paths))
    assert compared.json_text == run.json("compare", *paths)
    assert compared.files == run.written("compare", *paths)


@pytest.mark.usefixtures("in_examples")
def test_a_certificate_is_checked(run: Command, tmp_path: Path) -> None:
    project = phea.read("qft/servo.toml")
    proven = project.verify(prove=True)
    certificate = proven.files["certificate.json"]
    path = tmp_path / "certificate.json"
    path.write_bytes(certificate)
    checked = phea.check_certificate(certificate, project)
    assert checked.json_text == run.json("check-certificate", str(path), "qft/servo.toml")
    with pytest.raises(phea.ProjectError) as caught:
        phea.check_certificate("{}")
    assert not isinstance(caught.value, phea.NoAnswer)


@pytest.mark.usefixtures("in_examples")
def test_a_valve_is_identified_as_by_the_command(run: Command, tmp_path: Path) -> None:
    files = []
    for name, data in phea.read("ybitu/bench.toml").bench().files.items():
        if name.endswith(".csv") and ("leakage" in name or "flow" in name or "pressure" in name):
            (tmp_path / name).write_bytes(data)
            files.append(str(tmp_path / name))
    assert files
    project = phea.read("ybitu/bench.toml")
    words = ["identify", *files, "--project", "ybitu/bench.toml"]
    found = phea.identify(files, project=project)
    assert found.json_text == run.json(*words)
    assert sorted(found.files) == sorted(run.written(*words))


def test_nothing_to_compare_is_a_type_error() -> None:
    with pytest.raises(TypeError):
        phea.compare()
    with pytest.raises(ValueError, match="valve"):
        phea.identify([], of="hose")  # type: ignore[arg-type]
    assert EXAMPLES.is_dir()
