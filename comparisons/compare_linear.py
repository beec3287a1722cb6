"""Compares phea's linear systems with python-control and SciPy.

    python comparisons/compare_linear.py [systems.json]

`cargo run --example reference_systems`, or the program that the variable REFERENCE_SYSTEMS names, prints a hundred random
systems with everything that phea computes from them; here the same is computed by python-control 0.10 and SciPy 1.17 and must agree
to 1e-9 relative (step metrics: within one sample on the same samples).

python-control expands a factored system into polynomials, which loses small roots next to large ones, so it is given
factored systems as a series of first- and second-order state-space sections. Where a peer still differs, arithmetic
with 50 digits (mpmath) on the same input decides: phea must be within the tolerance of it, and the case is counted as
"peer inaccurate". No tolerance is loosened.
"""

import json
import os
import pathlib
import subprocess
import sys
import warnings

import control
import mpmath
import numpy as np
import scipy.optimize
import scipy.signal

TOLERANCE = 1e-9
mpmath.mp.dps = 50


def to_complex(pairs):
    return np.array([complex(re, im) for re, im in pairs])


class System:
    """One reference system, as SciPy, python-control and mpmath see it."""

    def __init__(self, entry):
        self.entry = entry
        self.found = None
        self.sample_time = entry["sample_time_s"]
        form = entry["form"]
        self.factored = "gain" in form
        if self.factored:
            self.gain = form["gain"]
            self.zeros = to_complex(form["zeros"])
            self.poles = to_complex(form["poles"])
            self.states = series_of_sections(self.zeros, self.poles, self.gain, self.sample_time)
        else:
            a, b, c, d = (np.array(form[name], dtype=float) for name in "abcd")
            self.states = control.ss(a, b, c, d, self.sample_time or 0)

    def point(self, frequency):
        if self.sample_time:
            return np.exp(1j * np.asarray(frequency) * self.sample_time)
        return 1j * np.asarray(frequency)

    def response(self, frequencies):
        """SciPy on factors, python-control on states."""
        frequencies = np.asarray(frequencies)
        if not self.factored:
            return np.asarray(self.states(self.point(frequencies))).reshape(frequencies.shape)
        if self.sample_time:
            angles = frequencies * self.sample_time
            return scipy.signal.freqz_zpk(self.zeros, self.poles, self.gain, worN=angles)[1]
        return scipy.signal.freqs_zpk(self.zeros, self.poles, self.gain, worN=frequencies)[1]

    def accurate_response(self, frequencies):
        """SciPy on factors; those of a state space are found with 50 digits, since its own response is noise where
        it is small."""
        if self.factored:
            return self.response(frequencies)
        if self.found is None:
            self.found = exact_factors(*self.exact_matrices())
        zeros, poles, gain = self.found
        if self.sample_time:
            angles = np.asarray(frequencies) * self.sample_time
            return scipy.signal.freqz_zpk(zeros, poles, gain, worN=angles)[1]
        return scipy.signal.freqs_zpk(zeros, poles, gain, worN=np.asarray(frequencies))[1]

    def at_infinity(self):
        """The end of the response of a continuous system."""
        if not self.factored:
            return float(self.states.D[0, 0])
        return self.gain if len(self.zeros) == len(self.poles) else 0.0

    def exact_matrices(self):
        if self.factored:
            return exact_companion(self.zeros, self.poles, self.gain)
        return tuple(mpmath.matrix(np.asarray(m).tolist()) for m in
                     (self.states.A, self.states.B, self.states.C, self.states.D))

    def exact(self, frequency):
        frequency = mpmath.mpf(frequency)
        if self.sample_time:
            point = mpmath.expj(frequency * mpmath.mpf(self.sample_time))
        else:
            point = mpmath.mpc(0, frequency)
        if self.factored:
            value = mpmath.mpc(self.gain)
            for zero in self.zeros:
                value *= point - mpmath.mpc(zero)
            for pole in self.poles:
                value /= point - mpmath.mpc(pole)
            return value
        return exact_response(self.exact_matrices(), point)


def series_of_sections(zeros, poles, gain, sample_time):
    """A cascade in python-control: slow poles first, each section with the zeros nearest to it."""
    def groups(roots):
        pairs = [[r, r.conjugate()] for r in roots if r.imag > 0]
        return pairs + [[r] for r in roots if r.imag == 0]

    sections = [[group, []] for group in sorted(groups(poles), key=lambda g: abs(g[0]))]
    needy = sorted(groups(zeros), key=len, reverse=True)
    for group in needy:
        room = [s for s in sections if len(s[1]) + len(group) <= len(s[0])]
        if not room:
            # a complex pair of zeros over two real poles
            singles = [s for s in sections if len(s[0]) == 1 and not s[1]][:2]
            sections = [s for s in sections if not any(s is single for single in singles)]
            joined = [singles[0][0] + singles[1][0], []]
            sections.append(joined)
            room = [joined]
        nearest = min(room, key=lambda s: min(abs(p - group[0]) / (abs(p) + abs(group[0])) for p in s[0]))
        nearest[1].extend(group)
    result = control.ss([], [], [], [[1.0]], sample_time or 0)
    for section_poles, section_zeros in sections:
        size = max(abs(p) for p in section_poles) or 1.0
        scale = size ** (len(section_poles) - len(section_zeros))
        gain /= scale
        numerator = scale * np.real(np.poly(section_zeros)) if section_zeros else [scale]
        section = control.tf2ss(numerator, np.real(np.poly(section_poles)))
        result = control.series(result, control.ss(section.A, section.B, section.C, section.D, sample_time or 0))
    return control.ss(result.A, result.B, result.C * gain, result.D * gain, sample_time or 0)


def exact_companion(zeros, poles, gain):
    def expanded(roots):
        coefficients = [mpmath.mpc(1)]
        for root in roots:
            shifted = coefficients + [mpmath.mpc(0)]
            for index, c in enumerate(coefficients):
                shifted[index + 1] -= mpmath.mpc(root) * c
            coefficients = shifted
        return [c.real for c in coefficients]

    order = len(poles)
    denominator = expanded(poles)
    numerator = [mpmath.mpf(gain) * c for c in expanded(zeros)]
    numerator = [mpmath.mpf(0)] * (order + 1 - len(numerator)) + numerator
    a = mpmath.zeros(order, order)
    for column in range(order):
        a[0, column] = -denominator[column + 1]
    for row in range(1, order):
        a[row, row - 1] = 1
    b = mpmath.zeros(order, 1)
    b[0] = 1
    c = mpmath.matrix([[numerator[k + 1] - numerator[0] * denominator[k + 1] for k in range(order)]])
    return a, b, c, mpmath.matrix([[numerator[0]]])


def exact_factors(a, b, c, d):
    """Zeros, poles and gain from the characteristic polynomials of A and A - B C (Faddeev and LeVerrier)."""
    def characteristic(matrix):
        coefficients, power = [mpmath.mpf(1)], mpmath.zeros(matrix.rows, matrix.rows)
        for k in range(1, matrix.rows + 1):
            power = matrix * power + coefficients[-1] * mpmath.eye(matrix.rows)
            product = matrix * power
            coefficients.append(-sum(product[i, i] for i in range(matrix.rows)) / k)
        return coefficients

    denominator = characteristic(a)
    closed = characteristic(a - b * c)
    numerator = [n - p + d[0] * p for n, p in zip(closed, denominator)]
    while abs(numerator[0]) < 1e-45 * max(abs(x) for x in numerator):
        numerator = numerator[1:]
    roots = lambda p: np.array([complex(r) for r in mpmath.polyroots(p, maxsteps=500, extraprec=400)])
    return roots(numerator), roots(denominator), float(numerator[0])


def exact_response(matrices, point):
    a, b, c, d = matrices
    states = mpmath.lu_solve(mpmath.eye(a.rows) * point - a, b)
    return (c * states)[0] + d[0]


def exact_sampled(system, method, step):
    a, b, c, d = system.exact_matrices()
    step, order = mpmath.mpf(step), a.rows
    if method == "tustin":
        kappa = 2 / step
        resolvent = mpmath.inverse(mpmath.eye(order) * kappa - a)
        return (2 * kappa * resolvent - mpmath.eye(order), resolvent * b, 2 * kappa * c * resolvent,
                d + c * resolvent * b)
    return *exact_step(a, b, step), c, d


def exact_step(a, b, step):
    order = a.rows
    block = mpmath.zeros(order + 1, order + 1)
    block[:order, :order] = a * step
    block[:order, order] = b * step
    exponential = exact_exponential(block)
    return exponential[:order, :order], exponential[:order, order]


def exact_exponential(matrix):
    with mpmath.workdps(150):
        halvings = max(0, int(mpmath.ceil(mpmath.log(mpmath.mnorm(matrix, 1) + 1, 2)))) + 4
        scaled = matrix / mpmath.mpf(2) ** halvings
        result = term = mpmath.eye(matrix.rows)
        for k in range(1, 80):
            term = term * scaled / k
            result = result + term
        for _ in range(halvings):
            result = result * result
    return result


class Tally:
    def __init__(self):
        self.passed, self.failed, self.inaccurate, self.polynomial = 0, [], {}, {}
        self.worst = {}

    def check(self, what, index, found, peer, exact, scale=None, tolerance=TOLERANCE):
        """`found` agrees with `peer`, or with `exact()` where the peer does not."""
        size = abs(peer) if scale is None else scale
        deviation = abs(found - peer) / size if size else abs(found - peer)
        if not deviation <= tolerance:
            truth = complex(exact()) if exact else complex("nan")
            size = abs(truth) if scale is None else scale
            deviation = abs(found - truth) / size if size else abs(found - truth)
            if not deviation <= tolerance:
                self.fail(what, index, f"phea {found}, peer {peer}, exact {truth}")
                return
            self.inaccurate.setdefault(what, set()).add(index)
        self.worst[what] = max(self.worst.get(what, 0.0), float(deviation))
        self.passed += 1

    def expect(self, what, index, truth, detail):
        if truth:
            self.passed += 1
        else:
            self.fail(what, index, detail)

    def fail(self, what, index, detail):
        self.failed.append(f"system {index}, {what}: {detail}")


def compare_response(tally, system, index, what, response, peer, exact):
    frequencies = response["frequencies_rad_per_s"]
    found = to_complex(response["values"])
    for frequency, value, other in zip(frequencies, found, peer(frequencies)):
        tally.check(what, index, value, complex(other), lambda: exact(frequency))


def compare_sampled(tally, system, index, method, described):
    step = described["sample_time_s"]
    if method == "tustin" and system.factored:
        zeros, poles, gain = scipy.signal.bilinear_zpk(system.zeros, system.poles, system.gain, fs=1 / step)
        peer = lambda w: scipy.signal.freqz_zpk(zeros, poles, gain, worN=np.asarray(w) * step)[1]
    else:
        name = {"tustin": "bilinear", "zero_order_hold": "zoh"}[method]
        sampled = control.sample_system(system.states, step, method=name)
        poles = np.linalg.eigvals(sampled.A)
        peer = lambda w: np.asarray(sampled(np.exp(1j * np.asarray(w) * step))).reshape(len(w))
    matrices = []

    def exact_matrices():
        if not matrices:
            matrices.append(exact_sampled(system, method, step))
        return matrices[0]

    exact = lambda w: exact_response(exact_matrices(), mpmath.expj(mpmath.mpf(w) * mpmath.mpf(step)))
    compare_response(tally, system, index, f"{method} response", described["response"], peer, exact)

    def exact_pole(found):
        values = mpmath.eig(exact_matrices()[0], left=False, right=False)
        return min(values, key=lambda value: abs(value - mpmath.mpc(found)))

    for found in to_complex(described["poles"]):
        nearest = poles[np.argmin(np.abs(poles - found))]
        tally.check(f"{method} poles", index, found, complex(nearest), lambda: exact_pole(found))


def scan(system):
    """A dense grid of frequencies around every feature of the system."""
    roots = np.concatenate([to_complex(system.entry["factors_found"][name]) for name in ("zeros", "poles")])
    if system.sample_time:
        nyquist = np.pi / system.sample_time
        roots = np.log(roots[np.abs(roots) > 0].astype(complex)) / system.sample_time
        low, high = 1e-9 * nyquist, nyquist * (1 - 1e-12)
        extra = np.linspace(low, high, 20000)
    else:
        sizes = np.abs(roots[roots != 0])
        low, high = (1e-8 * sizes.min(), 1e3 * sizes.max()) if len(sizes) else (1e-5, 1e5)
        extra = np.array([])
    around = [r.imag + k * abs(r.real) for r in roots for k in np.linspace(-5, 5, 401)]
    grid = np.concatenate([np.geomspace(low, high, 20000), extra, around])
    grid = np.unique(grid)
    return grid[(grid >= low) & (grid <= high)]


def crossings(function, grid, values):
    """Sign changes of a function, refined by Brent's method."""
    signs = np.signbit(values)
    where = np.nonzero(signs[1:] != signs[:-1])[0]
    return [scipy.optimize.brentq(function, grid[i], grid[i + 1], xtol=1e-300, rtol=4e-16 * 4) for i in where]


def compare_margins(tally, system, index):
    described = system.entry["margins"]
    grid = scan(system)
    values = system.accurate_response(grid)
    one = lambda w: complex(system.accurate_response(np.array([w]))[0])

    gains = crossings(lambda w: abs(one(w)) - 1, grid, np.abs(values) - 1)
    phases = [p for p in described["phase"]]
    tally.expect("number of gain crossovers", index, len(gains) == len(phases), f"{gains} against {phases}")
    for margin, frequency in zip(phases, gains):
        exact_frequency = lambda: mpmath.findroot(
            lambda w: mpmath.log(abs(system.exact(w))), mpmath.mpf(margin["frequency_rad_per_s"]), tol=1e-40)
        tally.check("gain crossover", index, margin["frequency_rad_per_s"], frequency, exact_frequency)
        angle = np.angle(-one(frequency), deg=True)
        exact_angle = lambda: mpmath.arg(-system.exact(exact_frequency())) * 180 / mpmath.pi
        tally.check("phase margin", index, margin["phase_deg"], angle, exact_angle)
        delay = np.radians(angle % 360) / frequency
        exact_delay = lambda: (mpmath.arg(-system.exact(exact_frequency())) % (2 * mpmath.pi)) / exact_frequency()
        tally.check("delay margin", index, margin["delay_s"], delay, exact_delay)

    def imaginary(w):
        return one(w).imag

    # beyond a gain margin of 1e9 the roundings of a state space decide where the phase goes
    found = [(w, f) for w, f in described["gain"] if w not in (0.0, "inf") and f < 1e9]
    if system.sample_time:
        found = [(w, f) for w, f in found if w < np.pi / system.sample_time * (1 - 1e-9)]
    real = [w for w in crossings(imaginary, grid, values.imag) if one(w).real < 0 and 1e-9 < abs(one(w)) < 1e12]
    real = [w for w in real if abs(one(w).imag) < 1e-6 * abs(one(w).real)]
    tally.expect("number of phase crossovers", index, len(real) == len(found), f"{real} against {found}")
    for (w, factor), frequency in zip(found, real):
        exact_frequency = lambda: mpmath.findroot(
            lambda w: mpmath.im(system.exact(w)) / mpmath.re(system.exact(w)), mpmath.mpf(w), tol=1e-40)
        tally.check("phase crossover", index, w, frequency, exact_frequency)
        tally.check("gain margin", index, factor, 1 / abs(one(frequency)),
                    lambda: 1 / abs(system.exact(exact_frequency())))

    distance = np.abs(1 + values)
    best = int(np.argmin(distance))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    nearest = scipy.optimize.minimize_scalar(lambda w: abs(1 + one(w)), bounds=(low, high), method="bounded",
                                             options={"xatol": 1e-12 * high})
    smallest = min(nearest.fun, distance[best])
    with np.errstate(all="ignore"):
        ends = [one(0.0), one(np.pi / system.sample_time) if system.sample_time else system.at_infinity()]
    smallest = min([smallest] + [abs(1 + end) for end in ends if np.isfinite(end)])
    frequency = system.entry["margins"]["modulus_frequency_rad_per_s"]
    exact = None if frequency == "inf" else lambda: exact_modulus(system, frequency)
    tally.check("modulus margin", index, described["modulus"], smallest, exact)
    compare_stability_margins(tally, system, index, gains, real)


def exact_modulus(system, frequency):
    """The minimum near a frequency, by golden section."""
    function = lambda w: abs(1 + system.exact(w))
    low, high = mpmath.mpf(frequency) * mpmath.mpf("0.9999"), mpmath.mpf(frequency) * mpmath.mpf("1.0001")
    ratio = (mpmath.sqrt(5) - 1) / 2
    for _ in range(100):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if function(left) < function(right):
            high = right
        else:
            low = left
    return function((low + high) / 2)


def compare_stability_margins(tally, system, index, gains, real):
    """python-control's own margins go through polynomials: how often do they agree with the crossings found above? This
    is told, not judged."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            _, _, _, w180, wc, _ = control.stability_margins(system.states, returnall=True, method="poly")
        except Exception:  # polynomials beyond its reach
            w180 = wc = np.array([np.nan])
    for what, theirs, ours in [("gain crossovers", wc, gains), ("phase crossovers", w180, real)]:
        theirs = np.sort([w for w in theirs if w > 0])
        ours = np.sort(ours)
        same = len(theirs) == len(ours) and np.allclose(theirs, ours, rtol=TOLERANCE, atol=0)
        if not same:
            tally.polynomial.setdefault(what, set()).add(index)


def compare_step(tally, system, index):
    step = system.entry["step"]
    if step is None:
        return
    times, found = np.array(step["times_s"]), np.array(step["values"])
    peer = control.forced_response(system.states, timepts=times, inputs=np.ones_like(times)).outputs
    size = np.max(np.abs(found))
    worst = int(np.argmax(np.abs(found - peer)))
    tally.check("step response", index, found[worst], peer[worst],
                lambda: exact_step_value(system, times, worst), scale=size)
    try:
        info = control.step_info(found, timepts=times, final_output=step["final_value"],
                                 SettlingTimeThreshold=step["settling_band_percent"] / 100)
    except IndexError:  # python-control has no answer for a response that never rises
        tally.expect("rise time", index, step["rise_time_10_90_s"] is None, f"phea {step['rise_time_10_90_s']}")
        return
    sample = times[1] - times[0]
    sign = np.sign(step["final_value"])
    peak = times[int(np.argmax(sign * found))]
    pairs = [("rise time", step["rise_time_10_90_s"], info["RiseTime"]),
             ("settling time", step["settling_time_s"], info["SettlingTime"]),
             ("peak time", step["peak_time_s"], peak)]
    for what, ours, theirs in pairs:
        none = ours is None and (theirs is None or np.isnan(theirs))
        near = ours is not None and abs(ours - theirs) <= sample * (1 + 1e-9)
        tally.expect(what, index, none or near, f"phea {ours}, peer {theirs}, sample {sample}")
    overshoot = info["Overshoot"]
    tally.expect("overshoot", index, abs(step["overshoot_percent"] - overshoot) <= 1e-9 * max(1, overshoot),
                 f"phea {step['overshoot_percent']}, peer {overshoot}")


def exact_step_value(system, times, position):
    a, b, c, d = system.exact_matrices()
    if not system.sample_time:
        with mpmath.workdps(100):
            transition, gain = exact_step(a, b, mpmath.mpf(times[position]))
            return (c * gain)[0] + d[0]
    state = mpmath.zeros(a.rows, 1)
    for _ in range(position):
        state = a * state + b
    return (c * state)[0] + d[0]


def reference_systems():
    if len(sys.argv) > 1:
        return json.loads(pathlib.Path(sys.argv[1]).read_text())
    root = pathlib.Path(__file__).resolve().parent.parent
    built = os.environ.get("REFERENCE_SYSTEMS")
    command = [built] if built else ["cargo", "run", "--quiet", "--example", "reference_systems"]
    return json.loads(subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout)


def main():
    tally = Tally()
    systems = [System(entry) for entry in reference_systems()]
    for system in systems:
        index = system.entry["index"]
        compare_response(tally, system, index, "response", system.entry["response"], system.response, system.exact)
        compare_margins(tally, system, index)
        compare_step(tally, system, index)
        for method in ("tustin", "zero_order_hold"):
            if method in system.entry:
                compare_sampled(tally, system, index, method, system.entry[method])
    print(f"{len(systems)} systems against python-control {control.__version__} and SciPy {scipy.__version__}")
    for what, deviation in tally.worst.items():
        print(f"  {what}: worst deviation {deviation:.1e}")
    for what, indices in tally.inaccurate.items():
        print(f"  {what}: peer inaccurate in {len(indices)} systems, phea confirmed with 50 digits")
    for what, indices in tally.polynomial.items():
        print(f"  control.stability_margins, {what}: its polynomials lose 1e-9 in {len(indices)} systems")
    for line in tally.failed:
        print("FAILED", line)
    print(f"{tally.passed} passed, {len(tally.failed)} failed")
    return 1 if tally.failed else 0


if __name__ == "__main__":
    sys.exit(main())
