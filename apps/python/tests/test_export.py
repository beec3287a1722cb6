"""Exported controllers: the module for Python, and the script for MATLAB in Octave."""

from __future__ import annotations

import math
import shutil
import subprocess
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import phea

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

CONTROLLERS: dict[str, tuple[str, dict[str, Any]]] = {
    "servo": ("qft/servo_shaped", {"controller.sample_time": "1 ms"}),
    "hose": ("ybitu/hose", {"controller.sample_time": "1 ms"}),
    "rounded": (
        "ybitu/hose",
        {
            "controller.sample_time": "2 ms",
            "controller.quantization": '{command_bits=12,command_range=["-10 V","10 V"]}',
        },
    ),
}


@pytest.fixture(scope="module", params=CONTROLLERS)
def project(request: pytest.FixtureRequest) -> phea.Project:
    name, settings = CONTROLLERS[request.param]
    return phea.example(name).set(settings)


def only_text(answer: phea.answers.ExportAnswer) -> str:
    [data] = answer.files.values()
    return data.decode()


def module(project: phea.Project) -> dict[str, Any]:
    """Names of the exported module."""
    names: dict[str, Any] = {"__name__": "exported"}
    exec(compile(only_text(project.export("python")), "exported.py", "exec"), names)
    return names


def frequencies(sample_time_s: float) -> list[float]:
    """200 frequencies from 1 rad/s to 0.9 of that of Nyquist."""
    last = math.log10(0.9 * math.pi / sample_time_s)
    return [10 ** (last * place / 199) for place in range(200)]


def exact(sections: list[Any], frequency: float, sample_time_s: float) -> Any:
    """Response of sections with 50 digits."""
    with mpmath.workdps(50):
        back = mpmath.exp(-1j * mpmath.mpf(frequency) * mpmath.mpf(sample_time_s))
        product = mpmath.mpc(1)
        for row in sections:
            b0, b1, b2, a0, a1, a2 = map(mpmath.mpf, row[:6])
            product *= (b0 + b1 * back + b2 * back**2) / (a0 + a1 * back + a2 * back**2)
        return product


def test_the_module_gives_the_bits_of_its_test_vectors(project: phea.Project) -> None:
    exported = module(project)
    assert len(exported["VECTORS"]) == 256
    assert exported["self_test"]() == 0
    exported["FEEDBACK"][0] = (2 * exported["FEEDBACK"][0][0], *exported["FEEDBACK"][0][1:])
    assert exported["self_test"]() > 100


def test_responses_of_the_module(project: phea.Project) -> None:
    exported = module(project)
    sample_time_s = exported["SAMPLE_TIME_S"]
    for frequency in frequencies(sample_time_s):
        for name in ("PREFILTER", "FEEDBACK"):
            expected = exact(exported[name], frequency, sample_time_s)
            assert abs(exported["response"](exported[name], frequency) / expected - 1) < 1e-12


def test_transfer_functions_of_python_control(project: phea.Project) -> None:
    exported = module(project)
    sample_time_s = exported["SAMPLE_TIME_S"]
    for name in ("PREFILTER", "FEEDBACK"):
        function = exported["transfer_function"](exported[name])
        assert function.dt == sample_time_s
        # polynomials in z cancel at low frequencies
        for frequency in frequencies(sample_time_s)[150:]:
            expected = exact(exported[name], frequency, sample_time_s)
            found = function(np.exp(1j * frequency * sample_time_s))
            assert abs(found / complex(expected) - 1) < 1e-8


def test_plants_are_those_of_the_family(project: phea.Project) -> None:
    exported = module(project)
    family = project.family
    assert exported["PARAMETERS"] == list(family.parameters)
    assert len(exported["PLANTS"]) == len(family)
    values, zeros, poles, gain, _ = exported["PLANTS"][-1]
    last = len(family) - 1
    assert values == list(family.values_of(last))
    for frequency in (1.0, 30.0):
        found = gain * np.prod([1j * frequency - root for root in zeros])
        found /= np.prod([1j * frequency - root for root in poles])
        assert abs(found) == pytest.approx(abs(family.response([frequency], last)[0]), rel=1e-9)


OCTAVE = shutil.which("octave-cli")


@pytest.mark.skipif(OCTAVE is None, reason="there is no Octave with its control package")
def test_the_script_in_octave(project: phea.Project, tmp_path: Path) -> None:
    exported = module(project)
    answer = project.export("matlab")
    name, sample_time_s = answer.name, exported["SAMPLE_TIME_S"]
    (tmp_path / f"{name}.m").write_text(only_text(answer), encoding="utf-8")
    asked = ", ".join(f"{one:.17g}" for one in frequencies(sample_time_s))
    (tmp_path / "asked.m").write_text(
        f"run('{name}.m');\nfor series = {{'prefilter', 'feedback'}}\n"
        f"  sections = {name}.(series{{1}}).sections;\n"
        f"  printf('%.17g ', sections'); printf('\\n');\n  for frequency = [{asked}]\n"
        f"    found = {name}.response(sections, frequency);\n"
        "    printf('%.17g %.17g ', real(found), imag(found));\n  end\n  printf('\\n');\nend\n"
        f"printf('%d %d\\n', numel({name}.plants), isct({name}.feedback.tf));\n",
        encoding="ascii",
    )
    command = [str(OCTAVE), "--quiet", "--norc", "asked.m"]
    lines = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stdout.splitlines()
    assert len(lines) == 5
    assert lines[4].split() == [str(len(exported["PLANTS"])), "0"]
    for place, series in enumerate(("PREFILTER", "FEEDBACK")):
        sections = [number for row in exported[series] for number in row[:6]]
        assert [float(word) for word in lines[2 * place].split()] == sections
        parts = [float(word) for word in lines[2 * place + 1].split()]
        found = [complex(*pair) for pair in zip(parts[::2], parts[1::2], strict=True)]
        for frequency, response in zip(frequencies(sample_time_s), found, strict=True):
            assert abs(response / exact(exported[series], frequency, sample_time_s) - 1) < 1e-12


def test_unknown_kinds_are_refused() -> None:
    with pytest.raises(ValueError, match="c, st"):
        phea.example("qft/servo_shaped").export("pascal")  # type: ignore[arg-type]
