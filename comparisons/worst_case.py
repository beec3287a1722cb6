"""Worst cases of a loop by brute force: dense grids over plants and frequencies, then local and global searches of SciPy.

Everything here is a search, so a margin found is an upper bound of the true one. Read by compare_verify.py.
"""

import itertools
import typing

import numpy as np
import scipy.optimize

from loop_model import Powers, evaluate, number

DENSE = 900  # frequencies of a grid, beside the resonances of each plant
PLANTS = 800  # of a grid over the box, about


def magnitude_of(limit, frequency):
    """A limit over frequency: a number, a text, a ratio of texts, or a table that is log-log linear."""
    if not isinstance(limit, dict) and (not isinstance(limit, str) or "s" not in limit):
        return number(limit) + 0.0 * frequency
    s = 1j * frequency
    if isinstance(limit, str):
        return np.abs(evaluate(limit, s=s))
    if "frequencies" in limit:
        logarithms = np.log(limit["frequencies"]), np.log([number(v) for v in limit["values"]])
        return np.exp(np.interp(np.log(frequency), *logarithms))
    return np.abs(evaluate(limit["numerator"], s=s) / evaluate(limit["denominator"], s=s))


def decibel(ratio):
    return 20 * np.log10(np.abs(ratio))


def closed_loop(kind, responses):
    plant, motion, feedback, prefilter, sensor = responses
    sensitivity = 1 / (1 + plant * feedback * sensor)
    return {
        "robust_stability": lambda: plant * feedback * sensor * sensitivity,
        "sensitivity": lambda: sensitivity,
        "plant_input_disturbance": lambda: plant * sensitivity,
        "control_effort": lambda: feedback * sensitivity,
        "load_motion": lambda: motion * sensitivity,
        "tracking": lambda: prefilter * plant * feedback * sensitivity,
    }[kind]()


class Side(typing.NamedTuple):
    """A margin in dB of parameters and frequency; `paired` where the parameters are those of two plants."""

    margin: typing.Callable
    paired: bool


def sides(project, specification):
    """The margins in dB that a specification is made of, as functions of parameters and frequency; whether of two plants."""
    kind = specification["kind"]

    def value(values, frequency):
        return decibel(closed_loop(kind, project.responses(values, frequency)))

    if kind != "tracking":
        return [Side(lambda v, w: decibel(magnitude_of(specification["limit"], w)) - value(v, w), False)]
    upper, lower = (lambda w, name=name: decibel(magnitude_of(specification[name], w)) for name in ("upper", "lower"))
    if project.has_prefilter:
        return [Side(lambda v, w: upper(w) - value(v, w), False), Side(lambda v, w: value(v, w) - lower(w), False)]
    half = len(project.names)
    # two plants in one row: the greater and the lesser of the spread
    return [Side(lambda v, w: upper(w) - lower(w) - value(v[..., :half], w) + value(v[..., half:], w), True)]


class Search:
    """The family of a project and the frequencies worth looking at."""

    def __init__(self, project):
        self.project = project
        self.dimension = project.directions if project.cases is None else 0
        self.shares = self.grid()
        self.plants = project.cases if project.cases is not None else project.values(self.shares)
        self.characteristic = np.array(sorted(self.roots()))

    def grid(self):
        """Shares of grid, corners and centre."""
        if self.dimension == 0:
            return np.zeros((1, 0))
        points = {1: 101, 2: 15, 3: 7, 4: 5, 5: 3, 6: 3}[self.dimension]
        if self.project.sample_time:
            points = {1: 21, 2: 7, 3: 4, 4: 3, 5: 2, 6: 2}[self.dimension]
        return np.array(list(itertools.product(np.linspace(0, 1, points), repeat=self.dimension)))

    def roots(self):
        """Magnitudes of poles and zeros of plant, controller and prefilter at some plants."""
        found = set()
        if self.project.measured:
            return {np.exp(logarithm[end]) for logarithm, _, _ in self.project.measured for end in (0, -1)}
        for values in self.plants[:: max(1, len(self.plants) // 20)]:
            parts = [*self.project.plant_polynomials(values)]
            for transfer in (self.project.controller, self.project.prefilter, self.project.sensor):
                if transfer.variable == "s":
                    parts += [transfer.numerator, transfer.denominator]
            found |= {abs(root) for part in parts for root in part.roots if abs(root) > 0}
        return found or {1.0}

    def band(self, specification):
        low, high = specification.get("band", [min(specification["frequencies"]), max(specification["frequencies"])])
        low = float(low) or self.characteristic[0] * 1e-4
        high = min(float(high), np.pi / self.project.sample_time if self.project.sample_time else np.inf)
        return low, high if np.isfinite(high) else self.characteristic[-1] * 1e3

    def frequencies(self, plants, low, high, count=DENSE):
        """For each plant a grid, and the resonances of its closed loop."""
        # a sampled plant costs more
        base = np.geomspace(low, high, count // 3 if self.project.sample_time else count)
        grids = np.tile(base, (len(plants), 1))
        if self.project.measured:
            return grids
        over, under = self.project.many_loop_polynomials(plants)
        # with dead time or samples those of the plant, which neither moves
        moved = self.project.has_delay or self.project.sample_time
        roots = many_roots(under if moved else (Powers(over) + Powers(under)).coefficients)
        roots = np.broadcast_to(roots, (len(plants), roots.shape[-1]))
        steps = np.array([-2, -1, -0.5, 0, 0.5, 1, 2])
        near, widths = np.abs(roots.imag), np.abs(roots.real)
        peaks = (near[..., None] + steps * widths[..., None]).reshape(len(plants), -1)
        resonates = np.repeat(roots.imag > 0, len(steps), axis=1)
        extra = np.where(resonates, np.clip(peaks, low, high), high)
        return np.sort(np.concatenate([grids, extra], axis=1), axis=1)


def scaled_roots(polynomial):
    coefficients = polynomial.coeffs
    scale = abs(coefficients[-1] / coefficients[0]) ** (1 / max(polynomial.order, 1)) if coefficients[-1] else 1.0
    powers = scale ** np.arange(polynomial.order, -1, -1.0)
    scaled = coefficients * powers
    return np.roots(scaled / np.max(np.abs(scaled))) * scale


def many_roots(polynomials):
    """Roots of each row, as the eigenvalues of its companion matrix, the variable scaled by their geometric mean."""
    order = polynomials.shape[-1] - 1
    last, first = polynomials[..., -1], polynomials[..., 0]
    assert np.all(first != 0), "a plant of a lower order than the others"
    scale = np.where(last == 0, 1.0, np.abs(last / first) ** (1 / max(order, 1)))[..., None]
    companion = np.zeros(polynomials.shape[:-1] + (order, order))
    companion[..., range(1, order), range(order - 1)] = 1.0
    companion[..., 0, :] = -polynomials[..., 1:] / first[..., None] * scale ** -np.arange(1.0, order + 1)
    return np.linalg.eigvals(companion) * scale


def slopes(function, point, step=1e-7):
    """The value of a function of many points, and its forward differences within the unit cube, in one call."""
    steps = np.where(point + step > 1, -step, step)
    values = function(np.concatenate([point[None], point + np.diag(steps)]))
    return values[0], (values[1:] - values[0]) / steps


def descended(function, start):
    """The least of a function of many points on the unit cube, from here, by quasi-Newton steps."""
    bounds = [(0.0, 1.0)] * len(start)
    options = {"maxiter": 40, "ftol": 1e-15, "gtol": 1e-12}
    along = lambda point: slopes(function, np.clip(point, 0, 1))
    found = scipy.optimize.minimize(along, start, jac=True, method="L-BFGS-B", bounds=bounds, options=options)
    return float(found.fun), np.clip(found.x, 0, 1)


def polish(function, start, rounds=2):
    """The same, with a simplex by turns: it crosses creases and narrow valleys."""
    value, point = descended(function, start)
    bounds = [(0.0, 1.0)] * len(start)
    for _ in range(rounds):
        options = {"maxfev": 150 * len(point), "xatol": 1e-9, "fatol": 1e-10, "initial_simplex": simplex(point)}
        alone = lambda point: float(function(point[None])[0])
        simple = scipy.optimize.minimize(alone, point, method="Nelder-Mead", bounds=bounds, options=options)
        further = descended(function, np.clip(simple.x, 0, 1))
        if value - further[0] < 1e-9:
            break
        value, point = further
    return value, point


def simplex(point, size=0.02):
    corners = np.tile(point, (len(point) + 1, 1))
    for axis in range(len(point)):
        corners[axis + 1, axis] += size if point[axis] < 0.5 else -size
    return corners


def worst_margin(search, specification):
    """(margin in dB, frequency, parameters) over the band."""
    low, high = search.band(specification)
    return min((worst_side(search, side, low, high) for side in sides(search.project, specification)), key=lambda w: w[0])


def worst_at(search, specification, frequency):
    return min((worst_side(search, s, frequency, frequency) for s in sides(search.project, specification)), key=lambda w: w[0])


def worst_side(search, side, low, high):
    project, paired, fixed = search.project, side.paired, low == high
    side = side.margin
    starts = pair_starts(search, side, low, high) if paired else single_starts(search, side, low, high)

    def function(points, case):
        w = np.full(len(points), low) if fixed else low * (high / low) ** np.clip(points[:, -1], 0, 1)
        result = side(parameters(project, points if fixed else points[:, :-1], case, paired), w)
        return np.where(np.isfinite(result), result, 1e6)

    found = []
    for _, shares, frequency, case in starts:
        position = [] if fixed else [np.log(frequency / low) / np.log(high / low)]
        point = np.concatenate([shares, position])
        # without a coordinate there is one point
        alone = lambda: (float(function(point[None], case)[0]), point)
        descent = descended(lambda points: function(points, case), point) if len(point) else alone()
        found.append((*descent, case))
    found.sort(key=lambda entry: entry[0])
    value, at, case = found[0]
    for _, point, other in found[: 1 if fixed else 2]:
        rounds = 1 if project.sample_time else 2
        further = polish(lambda points: function(points, other), point, rounds) if len(point) else (value, at)
        if further[0] < value:
            (value, at), case = further, other
    w = low if fixed else low * (high / low) ** at[-1]
    return value, w, parameters(project, at if fixed else at[:-1], case, paired)


def parameters(project, shares, case, paired):
    if case is not None:
        return case
    if paired:
        half = shares.shape[-1] // 2
        return np.concatenate([project.values(shares[..., :half]), project.values(shares[..., half:])], axis=-1)
    return project.values(shares)


def grid_of(search, low, high):
    if low == high:
        return np.full((len(search.plants), 1), low)
    return search.frequencies(search.plants, low, high)


def single_starts(search, side, low, high, count=10):
    """The worst plants of the grid, and the worst of each part of the band, each at its worst frequency."""
    frequencies = grid_of(search, low, high)
    margins = np.concatenate(
        [
            np.atleast_2d(side(search.plants[i : i + 50, None, :], frequencies[i : i + 50]))
            for i in range(0, len(search.plants), 50)
        ]
    )
    margins = np.where(np.isfinite(margins), margins, 1e6)
    column = np.argmin(margins, axis=1)
    ranked = [(margins[row, c], row, frequencies[row, c]) for row, c in enumerate(column)]
    if low < high:
        edges = np.geomspace(low, high, 13)
        for left, right in zip(edges[:-1], edges[1:]):
            inside = np.where((frequencies >= left) & (frequencies <= right), margins, 1e6)
            row, c = np.unravel_index(np.argmin(inside), inside.shape)
            ranked.append((margins[row, c], row, frequencies[row, c]))
    ranked.sort(key=lambda entry: entry[0])
    taken, starts = set(), []
    for margin, row, frequency in ranked:
        key = (row, round(np.log(frequency), 1))
        if key in taken:
            continue
        taken.add(key)
        case = search.plants[row] if search.project.cases is not None else None
        starts.append((margin, search.shares[row] if case is None else np.zeros(0), frequency, case))
    starts = starts[: 3 if low == high or search.project.sample_time else count]
    if low < high and search.dimension >= 4 and not search.project.sample_time:
        starts.append(evolved(search, side, low, high))
    return starts


def evolved(search, side, low, high):
    """Differential evolution over parameters and frequency, in one call for a whole generation."""

    def function(points):
        w = low * (high / low) ** points[-1]
        margin = side(search.project.values(points[:-1].T), w)
        return np.where(np.isfinite(margin), margin, 1e6)

    found = scipy.optimize.differential_evolution(
        function, [(0, 1)] * (search.dimension + 1), vectorized=True, updating="deferred", popsize=20, maxiter=100,
        tol=1e-10, rng=1, polish=False,
    )
    return found.fun, found.x[:-1], low * (high / low) ** found.x[-1], None


def pair_starts(search, side, low, high, count=10):
    """The widest spreads over the grid, by frequency."""
    half = len(search.project.names)
    frequencies = np.array([low]) if low == high else np.geomspace(low, high, 300)
    # half of the side at a time: margin(v, v0) - margin(v0, v0) is minus the level of v over that of v0
    reference = np.broadcast_to(search.plants[0], search.plants.shape)
    as_high = side(np.concatenate([search.plants, reference], axis=1)[:, None, :], frequencies[None, :])
    base = side(np.concatenate([search.plants[:1], search.plants[:1]], axis=1)[:, None, :], frequencies[None, :])
    level = base - as_high
    top, bottom = np.argmax(level, axis=0), np.argmin(level, axis=0)
    margins = base[0] - level.max(axis=0) + level.min(axis=0)
    order = np.argsort(margins)[:: max(1, len(frequencies) // (count * 3))][:count]
    order = np.unique(np.concatenate([np.argsort(margins)[:3], order]))

    def two_of(source, i):
        return np.concatenate([source[top[i]], source[bottom[i]]])

    if search.project.cases is not None:
        return [(margins[i], np.zeros(0), frequencies[i], two_of(search.plants, i)) for i in order]
    return [(margins[i], two_of(search.shares, i), frequencies[i], None) for i in order]
