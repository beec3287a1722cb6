"""Compares the worst steps that `phea verify` finds over a box with those of plants drawn from it at random.

    python comparisons/compare_steps.py [--all] [PHEA]           # or the variable PHEA; without either, what cargo builds

Loops are made at random: plants with real poles, an integrator, a resonance, a zero on either side, the rig of
loop_model.py, dead time where the loop is sampled; P, PI, PI with notch; prefilters or none. Each is stated as a project
with a required step, and verified. Then plants are drawn uniformly over the box, and the step of each is computed here,
from the poles of its closed loop (continuous) or its difference equation (sampled, at its samples). None may
overshoot or settle worse than what phea found by more than 2 % of what is required. Without `--all` 6 loops and
2,000 plants of each, with it 60 and 20,000: its last lines stand in the book. A design is asked for too, whose steps
are drawn likewise: none may miss what was required.
"""

import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import scipy.signal

from loop_model import RIG, RIG_NUMBERS, Project, product

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEED = 5
BAND_PERCENT = 2.0
ALLOWED = 0.02  # of what is required
ROWS = 1000  # plants whose responses are held in memory at once


def text(value):
    return repr(float(value))


def uncertain(generator, nominal, spread):
    """Minimum, nominal and maximum of a number that varies by up to a factor."""
    factor = 1 + spread * generator.uniform(0.3, 1.0)
    return nominal / factor, nominal, nominal * factor


def plant_of(generator, kind):
    """Numerator, denominator and uncertain numbers of a plant whose frequencies lie around 10 rad/s."""
    w = 10 ** generator.uniform(0.5, 1.5)
    numbers = {"k": uncertain(generator, 1.0, 0.8)}
    if kind == "lags":
        numbers |= {"a": uncertain(generator, w, 0.8), "b": uncertain(generator, 4 * w, 0.6)}
        return "k*a*b", "(s + a)*(s + b)", numbers, w
    if kind == "resonance":
        numbers |= {"w": uncertain(generator, 3 * w, 0.4), "d": uncertain(generator, generator.uniform(0.05, 0.4), 0.5)}
        return "k*w^2", "s^2 + 2*d*w*s + w^2", numbers, w
    if kind == "actuator":
        numbers |= {"w": uncertain(generator, 4 * w, 0.5), "d": uncertain(generator, generator.uniform(0.05, 0.3), 0.5)}
        numbers |= {"v": uncertain(generator, 8 * w, 0.2)}
        return f"{text(w)}*k*w^2*v^2", "s*(s^2 + 2*d*w*s + w^2)*(s^2 + 1.4*v*s + v^2)", numbers, w
    if kind == "zero":
        numbers |= {"a": uncertain(generator, w, 0.8), "z": uncertain(generator, generator.uniform(0.5, 3) * w, 0.5)}
        return "k*a^2*(s/z + 1)", "(s + a)^2", numbers, w
    numbers |= {"a": uncertain(generator, w, 0.8), "z": uncertain(generator, generator.uniform(3, 8) * w, 0.5)}
    return "k*a^2*(1 - s/z)", "(s + a)^2", numbers, w


KINDS = ["lags", "resonance", "actuator", "zero", "right_half_plane_zero", "rig"]
RIG_KNOWN = {
    "flow_gain": 8e-5, "hydraulic_stiffness": 6e6, "flow_pressure_coefficient": 1.5e-12,
    "valve_natural_frequency": 600.0, "valve_damping_ratio": 0.8, "viscous_friction": 800.0,
}  # fmt: skip


def rig_of(generator):
    """The rig as formulae, its fixed numbers put in; scaled so that its rate gain is about one."""
    numbers = {name: uncertain(generator, RIG_KNOWN[name], 0.5) for name in generator.permutation(list(RIG_KNOWN))[:4]}
    numerator, denominator = RIG["numerator"], RIG["denominator"]
    fixed = RIG_NUMBERS | {name: value for name, value in RIG_KNOWN.items() if name not in numbers}
    for name in sorted(fixed, key=len, reverse=True):
        numerator, denominator = (part.replace(name, f"({text(fixed[name])})") for part in (numerator, denominator))
    return f"1e-6*({numerator})", denominator, numbers, 150.0


def problem(generator, index, trial):
    """The tables of a project without its required step, as text, and a frequency of its plant; later trials are slower."""
    kind = KINDS[index % len(KINDS)]
    numerator, denominator, numbers, w = rig_of(generator) if kind == "rig" else plant_of(generator, kind)
    integrates = kind in ("actuator", "rig")
    gain = 10 ** generator.uniform(-0.5, 0.7) * 0.9**trial * (0.5 * w if kind == "rig" else 1.0)
    if kind == "actuator" and generator.uniform() < 0.5:
        controller = text(gain), "1"
    elif kind == "resonance" and generator.uniform() < 0.5:
        notch = 3 * w
        controller = (
            f"{text(0.5 * gain * w)}*(s/{text(2 * w)} + 1)*(s^2/{text(notch**2)} + {text(0.4 / notch)}*s + 1)",
            f"s*(s^2/{text(notch**2)} + {text(2 / notch)}*s + 1)",
        )
    else:
        slow = w * generator.uniform(0.02, 0.1) if integrates else w * generator.uniform(0.5, 2.0)
        controller = f"{text(gain * slow)}*(s/{text(slow)} + 1)", "s"
    lines = ["schema = 1", f'title = "{kind} {index}"', "[plant]", f'numerator = "{numerator}"', f'denominator = "{denominator}"']
    sampled = index % 3 == 2
    sample_time = 0.1 / w if sampled else None
    if sampled and generator.uniform() < 0.5:
        lines.append(f'delay = "{text(sample_time * generator.uniform(0.3, 2.0))} s"')
    lines.append("[uncertainty]")
    for name, (low, nominal, high) in numbers.items():
        lines.append(f"{name} = {{ nominal = {text(nominal)}, minimum = {text(low)}, maximum = {text(high)} }}")
    lines += ["[controller]", f'numerator = "{controller[0]}"', f'denominator = "{controller[1]}"']
    if sampled:
        lines.append(f'sample_time = "{text(sample_time)} s"')
    if generator.uniform() < 0.5:
        lines += ["[prefilter]", 'numerator = "1"', f'denominator = "s/{text(w * generator.uniform(0.3, 2.0))} + 1"']
    return lines, w


def drawn(project, generator, plants):
    """Parameters drawn over the box as project.values spaces it, beside all of its corners."""
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * project.directions)).reshape(project.directions, -1).T
    return project.values(np.vstack([corners, generator.uniform(size=(plants, project.directions))]))


def padded_sum(one, other):
    length = max(one.shape[-1], other.shape[-1])
    pad = lambda part: np.pad(part, [(0, 0)] * (part.ndim - 1) + [(length - part.shape[-1], 0)])
    return pad(one) + pad(other)


def rows_of(coefficients, count):
    return np.broadcast_to(coefficients, (count, coefficients.shape[-1])) if coefficients.ndim == 1 else coefficients


def continuous_modes(project, values, scale):
    """Poles and residues of the closed loop's step, each plant in a row: y(t) = rest + sum r e^(p t); time is t scale."""
    over, under = project.many_loop_polynomials(values)
    over, under = rows_of(over, len(values)), rows_of(under, len(values))
    before, behind = project.prefilter.numerator.coeffs, project.prefilter.denominator.coeffs
    numerator = rows_of(product(over, before), len(values))
    denominator = rows_of(product(padded_sum(over, under), behind), len(values))
    powers = lambda part: scale ** np.arange(part.shape[-1] - 1, -1, -1.0)
    numerator, denominator = numerator * powers(numerator), denominator * powers(denominator)
    order = denominator.shape[-1] - 1
    matrices = np.zeros((len(values), order, order))
    matrices[:, 0] = -denominator[:, 1:] / denominator[:, :1]
    matrices[:, 1:, :-1] = np.eye(order - 1)
    poles = np.linalg.eigvals(matrices).astype(complex)
    at = lambda part: np.stack([np.polyval(row, point) for row, point in zip(part, poles)])
    slope = denominator[:, :-1] * np.arange(order, 0, -1)
    return poles, at(numerator) / (poles * at(slope)), numerator[:, -1] / denominator[:, -1]


def sampled_responses(project, values, count):
    """The steps of a sampled loop at its samples, by its difference equation; None where one is not stable."""
    before, behind = project.prefilter.sampled(project.sample_time)
    responses = np.empty((len(values), count))
    for row, one in enumerate(values):
        over, under = sampled_closed(project, one)
        if np.max(np.abs(np.roots(under))) >= 1:
            return None
        responses[row] = scipy.signal.lfilter(np.convolve(over, before.coeffs), np.convolve(under, behind.coeffs), np.ones(count))
    return responses


def sampled_closed(project, values):
    """Numerator and denominator in z of the closed loop without its prefilter."""
    a, b, c, d = project.held_plant(values)
    whole = int(np.floor(project.delay(values) / project.sample_time + 1e-9))
    under = np.poly(a)
    over = np.poly(a - b @ c) - under + float(d) * under
    feedback, behind = (part.coeffs for part in project.controller.sampled(project.sample_time))
    over, under = np.convolve(over, feedback), np.convolve(np.convolve(under, behind), np.r_[1.0, np.zeros(whole)])
    return over, padded_sum(over, under)


def metrics(times, responses):
    """Overshoot in percent of the step and settling time, infinite where the last value lies outside of the band."""
    overshoot = 100 * np.maximum(np.max(responses, axis=1) - 1, 0)
    outside = np.abs(responses - 1) > BAND_PERCENT / 100
    last = responses.shape[1] - 1 - np.argmax(outside[:, ::-1], axis=1)
    last = np.where(outside.any(axis=1), last, -1)
    settling = np.zeros(len(responses))
    for row, index in enumerate(last):
        if index == responses.shape[1] - 1:
            settling[row] = np.inf
        elif index >= 0:
            here, there = np.abs(responses[row, index : index + 2] - 1)
            settling[row] = times[index] + (times[index + 1] - times[index]) * (here - BAND_PERCENT / 100) / (here - there)
    return overshoot, settling


def worst_steps(project, plants, horizon):
    """The most overshoot and the longest settling time of these plants; None where one is not stable."""
    worst = np.zeros(2)
    for start in range(0, len(plants), ROWS):
        values = plants[start : start + ROWS]
        if project.sample_time:
            times = project.sample_time * np.arange(int(30 * horizon / project.sample_time) + 2)
            responses = sampled_responses(project, values, len(times))
            if responses is None:
                return None
        else:
            poles, residues, rest = continuous_modes(project, values, 1 / horizon)
            if np.max(poles.real) >= 0:
                return None
            # finely where it settles, coarsely behind
            times = np.concatenate([np.arange(0, 3, 0.002), np.arange(3, 30, 0.02)]) * horizon
            responses, now = np.empty((len(values), len(times))), residues
            for sample in range(len(times)):
                responses[:, sample] = rest + now.sum(axis=1).real
                now = now * np.exp(poles * (0.002 if sample < 1500 else 0.02))
        worst = np.maximum(worst, [np.max(part) for part in metrics(times, responses)])
    return worst


def required_of(step):
    overshoot, settling = step
    return ["[[specification]]", 'kind = "step"', f"overshoot_percent = {overshoot}", f'settling_time = "{settling} s"',
            f"settling_band_percent = {BAND_PERCENT}"]  # fmt: skip


def made(generator, index, folder):
    """A project whose loop is stable at the corners of its box and settles, and what is required of it."""
    path = folder / f"loop_{index}.toml"
    for trial in itertools.count():
        lines, w = problem(generator, index, trial)
        path.write_text("\n".join([*lines, *required_of((1.0, 1.0))]))
        project = Project(path)
        found = worst_steps(project, drawn(project, generator, 30), 3 / w)
        if found is None or not np.isfinite(found[1]) or found[0] > 150:
            continue
        # close to what is reached, on either side
        step = float(f"{max(found[0], 0.5) * generator.uniform(0.8, 1.3):.3g}"), float(f"{found[1] * generator.uniform(0.8, 1.3):.3g}")
        path.write_text("\n".join([*lines, *required_of(step)]))
        return path, step


def verified(phea, path):
    """The worst overshoot in percent and settling time that phea finds, and how many plants it computed."""
    run = subprocess.run([phea, "verify", path, "--json"], capture_output=True, text=True)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"{path}: {run.stderr}")
    found = next(one for one in json.loads(run.stdout)["specifications"] if one["kind"] == "step")
    if "worst_overshoot_percent" not in found:
        raise RuntimeError(f"{path}: no steps: {found}")
    number = lambda value: float(value) if value is not None else np.inf
    return np.array([number(found["worst_overshoot_percent"]), number(found["worst_settling_time_s"])]), found["plants"]


DESIGNED = """schema = 1
title = "design"
[plant]
numerator = "k*a"
denominator = "(s + 0.5)*(s + a)"
[uncertainty]
k = { nominal = 1.0, minimum = 1.0, maximum = 6.0, spacing = "log" }
a = { nominal = 8.0, minimum = 5.0, maximum = 10.0 }
[design]
structure = "free"
[[specification]]
kind = "step"
overshoot_percent = 1.0
settling_time = "1.5 s"
settling_band_percent = 2.0
[[specification]]
kind = "robust_stability"
limit = 1.3
frequencies = [0.1, 1, 3, 10, 30, 100]
band = [0, inf]
"""


def designed(phea, folder, plants):
    """The worst steps of a controller that phea designs for 1 % and 1.5 s."""
    path = folder / "design.toml"
    path.write_text(DESIGNED)
    subprocess.run([phea, "design", path, "--out", folder / "designed"], check=True, capture_output=True)
    project = Project(folder / "designed" / "designed.toml")
    return worst_steps(project, drawn(project, np.random.default_rng(SEED), plants), 1.5)


def main(arguments):
    everything = "--all" in arguments
    paths = [argument for argument in arguments if not argument.startswith("-")]
    phea = pathlib.Path(paths[0] if paths else os.environ.get("PHEA", ROOT / "target" / "debug" / "phea")).resolve()
    loops, plants = (60, 20_000) if everything else (6, 2_000)
    beyond, searched, worse = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for index in range(loops):
            generator = np.random.default_rng([SEED, index])
            path, step = made(generator, index, pathlib.Path(folder))
            project = Project(path)
            found, visited = verified(phea, path)
            random = worst_steps(project, drawn(project, generator, plants), step[1])
            if random is None:
                raise RuntimeError(f"{path.read_text()}\na plant is not stable, and phea computed steps")
            share = np.max((random - found) / step)
            beyond.append(share)
            searched.append(visited)
            if share > ALLOWED:
                worse.append(index)
                print(path.read_text(), file=sys.stderr)
            numbers = [f"{value:.4g} {unit}" for pair in (step, found, random) for value, unit in zip(pair, ("%", "s"))]
            print("{}: required {}, {}; found {}, {}; random {}, {}: {:+.3%}".format(index, *numbers, share), flush=True)
        overshoot, settling = designed(phea, pathlib.Path(folder), plants)
    print(f"designed for 1 % and 1.5 s: {overshoot:.3g} % and {settling:.3g} s")
    if overshoot > 1.0 or settling > 1.5:
        worse.append("design")
    print(f"{loops} loops, {plants} random plants and all corners of each; phea visited {np.mean(searched):.0f} in the mean")
    print(f"worse than found by {np.max(beyond):.3%} of what is required at most; by more than {ALLOWED:.0%}: {worse or 'none'}")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
