"""The search for the numbers of a controller by a sequence of linear programs. Read by recompute_design.py.

Independent of phea. Each step solves a linear program over the least margins inside a trust region, and rejects any step that makes a
plant of the sample unstable. Worst points of the box that are found afterwards join the sample, until nothing is found.
"""

import numpy as np
from scipy.optimize import linprog

from loop_design import DISTANT, Problem, db, polynomials


def search(problem, x, aim, margin=0.0, window_db=None, target=np.inf, radius=0.5, steps=120):
    """Greatest least margin (aim "margin") or least high-frequency gain with all margins at least `margin` (aim "gain").

    Returns x, the least margin over rate, and the high-frequency gain in dB.
    """
    size, penalty = problem.feedback.size, 30.0

    def judge(x):
        found = problem.rows(x, window_db)
        if found is None:
            return None
        least = (found[0][0] / found[0][1]).min()
        gain = problem.feedback.high_frequency_gain(x[:size])[0]
        return found, least, gain, -least if aim == "margin" else gain + penalty * max(0.0, margin - least)

    low, high = problem.bounds.T
    found, least, gain, merit = judge(x)
    for _ in range(steps):
        if aim == "margin" and least >= target:
            break
        q, slopes = problem.slopes(x, *found)
        cost = np.zeros(len(x) + 1)
        if aim == "margin":
            cost[-1], last, right, limits = -1.0, 1.0, q, (None, None)
        else:
            cost[:size], cost[-1] = problem.feedback.high_frequency_gain(x[:size])[1], 1e3
            last, right, limits = -1.0, q - margin, (0, None)
        within = np.stack([np.minimum(np.maximum(low - x, -radius), 0), np.maximum(np.minimum(high - x, radius), 0)], axis=1)
        table = np.concatenate([-slopes, np.full((len(q), 1), last)], axis=1)
        step = linprog(cost, table, right, bounds=[*map(tuple, within), limits], method="highs").x
        if step is None:
            radius *= 0.3
            continue
        move, extra = step[:-1], step[-1]
        promised = merit - (-extra if aim == "margin" else gain + cost[:size] @ move[:size] + penalty * extra)
        if promised < 1e-5:
            break
        tried = judge(x + move)
        kept = merit - tried[3] if tried else -np.inf
        if kept > 0.1 * promised:
            x = x + move
            found, least, gain, merit = tried
        radius = min(1.5, 2 * radius) if kept > 0.7 * promised else radius if kept > 0.1 * promised else 0.4 * radius
        if radius < 1e-6:
            break
    return x, least, gain


def worst_over_box(problem, x, rng, count=600):
    """Worst points of the whole box, refined from the worst of many: (margin over rate, kind, shares, w), least first.

    Unstable plants come with a margin of minus infinity.
    """
    plants, size = problem.plants, problem.feedback.size
    shares = np.concatenate([plants.vertices(), plants.draw(rng, count)])
    wide = Problem(plants, problem.specifications, problem.frequencies, problem.feedback, problem.prefilter, problem.scale, shares)
    growing = wide.roots(x[:size]).real.max(axis=1)
    if growing.max() >= 0:
        return [(-np.inf, "unstable", shares[index], np.nan) for index in np.argsort(-growing)[:5] if growing[index] >= 0]
    w, s, p, t, sensitivity, limits = wide.closed(x[:size])

    def value(kind, shares, logarithm):
        values, w = plants.values(shares), np.exp(logarithm)[:, None]
        s = plants.variable(w)
        if plants.responses:
            p = plants.responses(values, w)
        else:
            over, under = plants.rational(values)
            p = polynomials(over, s) / polynomials(under, s)
        g = problem.feedback.response(x[:size], s)[0]
        level = {"T": p * g, "track": p * g, "S": 1.0, "PS": p}[kind] / (1 + p * g)
        if kind == "track" and problem.prefilter is not None:
            level = level * problem.prefilter.response(x[size:], s)[0]
        return db(level)[:, 0]

    found = []
    for spec, (upper, *_) in zip(problem.specifications, limits):
        kind, limit, *band = spec
        if kind != "track":
            margin = upper - db({"T": t, "S": sensitivity, "PS": p * sensitivity}[kind])
            plant = margin.argmin(axis=0)
            columns = np.argsort(margin.min(axis=0))[:24]
            start = shares[plant[columns]], np.log(w[plant[columns], columns])
            level = lambda shares, logarithm: db(limit(1j * np.exp(logarithm))) - value(kind, shares, logarithm)
            margins, points, logarithms = refine(level, *start, band)
            best = np.argsort(margins)[:6]
            found += [(margins[i], kind, points[i], np.exp(logarithms[i])) for i in best]
            found += resonances(problem, x, spec, *distinct(margin, shares, w))
            continue
        columns = np.flatnonzero(upper[0, : len(problem.frequencies)] < DISTANT)
        tracked = db(t[:, columns])
        sides = []
        for which, sign in ((tracked.argmax(axis=0), 1), (tracked.argmin(axis=0), -1)):
            border = limit[0 if sign > 0 else 1]
            level = lambda shares, logarithm: sign * (db(border(1j * np.exp(logarithm))) - value(kind, shares, logarithm))
            start = shares[which], np.log(problem.frequencies[columns])
            sides.append(refine(level, *start, band, move_frequency=problem.prefilter is not None))
        if problem.prefilter is None:
            both = (sides[0][0] + sides[1][0]) / 2
            found += [(both[i], "spread", side[1][i], np.exp(side[2][i])) for side in sides for i in range(len(both))]
        else:
            found += [(m, "track", u, np.exp(v)) for side in sides for m, u, v in zip(*side)]
    return sorted(found, key=lambda point: point[0])


def distinct(margin, shares, w, width=0.04, most=48):
    """The worst plant of every twenty-fifth of an e-fold of frequency, the worst of them first, each with that frequency."""
    bins = np.floor(np.log(w) / width).ravel()
    order = np.lexsort((margin.ravel(), bins))
    first = order[np.flatnonzero(np.diff(bins[order], prepend=-np.inf))]  # least margin of each bin
    first = first[np.argsort(margin.ravel()[first])[:most]]
    plant, column = np.unravel_index(first, margin.shape)
    return shares[plant], w[plant, column]


def resonances(problem, x, spec, shares, near):
    """Worst plants around some, each judged at those roots of its own closed loop that are near a frequency: a light resonance moves with
    every parameter, and a search that moves the frequency apart from the plant loses it."""

    def own(shares):
        few = Problem(problem.plants, [spec], problem.frequencies[:1], problem.feedback, None, problem.scale, shares)
        closed = few.closed(x[: problem.feedback.size])
        if closed is None:
            return np.full((2, len(shares)), DISTANT)
        w, s, p, t, sensitivity, ((upper, *_),) = closed
        margin = upper - db({"T": t, "S": sensitivity, "PS": p * sensitivity}[spec[0]])
        margin = np.where(np.abs(np.log(w / near[:, None])) < 0.3, margin, DISTANT)
        column = margin.argmin(axis=1)[:, None]
        return np.concatenate([np.take_along_axis(margin, column, 1), np.take_along_axis(w, column, 1)], axis=1).T

    _, points, _ = refine(lambda shares, _: own(shares)[0], shares, np.zeros(len(shares)), (1, 1), move_frequency=False)
    margin, w = own(points)
    return [(m, spec[0], u, frequency) for m, u, frequency in zip(margin, points, w) if m < DISTANT]


def refine(margin, shares, logarithm, band, move_frequency=True, rounds=30):
    """Pattern search downhill from every start at once, in the shares and in the logarithm of frequency."""
    low, high = np.log(max(band[0], 1e-3)), np.log(min(band[1], 1e9))
    least, step = margin(shares, logarithm), np.full(len(shares), 0.15)
    for _ in range(rounds):
        before = least
        for axis in range(shares.shape[1] + move_frequency):
            for sign in (1, -1):
                points, logs = shares, logarithm
                if axis < shares.shape[1]:
                    points = shares.copy()
                    points[:, axis] = np.clip(points[:, axis] + sign * step, 0, 1)
                else:
                    logs = np.clip(logs + sign * step, low, high)
                tried = margin(points, logs)
                better = tried < least - 1e-9
                shares = np.where(better[:, None], points, shares)
                logarithm = np.where(better, logs, logarithm)
                least = np.where(better, tried, least)
        step = np.where(least < before, step, 0.4 * step)
        if step.max() < 1e-5:
            break
    return least, shares, logarithm


def agree(problem, x, improve, rng, enough, rounds=16):
    """Improves and searches the box in turn, until no point of the box has a margin below `enough(least margin of the sample)`."""
    for _ in range(rounds):
        x, least, gain = improve(x)
        found = worst_over_box(problem, x, rng)
        bad = [point for point in found if point[0] < enough(least)][:60]
        if not bad:
            break
        extend(problem, bad)
        while problem.rows(x) is None:  # a plant that was not looked at before is unstable
            x = x.copy()
            x[0] -= 0.1
    return x, least, gain, found


def extend(problem, points):
    """The plants and frequencies of these points join the sample, unless they are there already."""
    shares, frequencies = list(problem.shares), list(problem.frequencies)
    for _, kind, point, w in points:
        if np.abs(np.array(shares) - point).max(axis=1).min() > 0.01:
            shares.append(point)
        if np.isfinite(w) and np.abs(np.log(np.array(frequencies) / w)).min() > 3e-4:
            frequencies.append(w)
    problem.frequencies = np.unique(frequencies)
    problem.take(np.array(shares))


def greatest_margin(problem, rng, starts=8, window_db=None):
    """Greatest least margin over rate on the sample from every start, best first: pairs of margin and x."""
    found = []
    for _ in range(starts):
        x = problem.draw(rng)
        if x is not None:
            x, least, _ = search(problem, x, "margin", target=np.inf if window_db is None else -0.02)
            if window_db is not None and least > -1:
                x, least, _ = search(problem, x, "margin", window_db=window_db)
            found.append((least, x))
    return sorted(found, key=lambda pair: -pair[0])


def least_gain(problem, rng, starts=8, margin=1e-3, fits=3, window_db=1.0):
    """Least high-frequency gain over the whole box: x, its gain in dB, worst points of the box, gains of all starts on the sample.

    A prefilter waits until the controller alone keeps to the spread.
    """
    prefilter, problem.prefilter = problem.prefilter, None
    bounds, problem.bounds = problem.bounds, problem.feedback.bounds
    met = [x for least, x in greatest_margin(problem, rng, starts, window_db) if least > margin]
    problem.prefilter, problem.bounds = prefilter, bounds
    found = []
    for x in met:
        if prefilter is not None:
            draws = [np.concatenate([x, prefilter.draw(rng)]) for _ in range(fits)]
            fitted = [search(problem, y, "margin", window_db=window_db, target=2 * margin)[:2] for y in draws]
            x = max(fitted, key=lambda pair: pair[1])[0]
        x, least, gain = search(problem, x, "gain", margin=margin, window_db=window_db)
        if least > 0.5 * margin:
            found.append((gain, x))
    found.sort(key=lambda pair: pair[0])
    x, gain, worst = found[0][1], found[0][0], []
    if problem.plants.box is not None:
        improve = lambda x: search(problem, x, "gain", margin=margin, window_db=window_db)
        x, _, gain, worst = agree(problem, x, improve, rng, lambda least: 0.0)
    return x, gain, worst, [pair[0] for pair in found]


def relaxation(problem, rng, starts=8):
    """The smallest relaxation of every limit over the whole box, dB: x, relaxation, worst points."""
    x = greatest_margin(problem, rng, starts)[0][1]
    improve = lambda x: search(problem, x, "margin")
    x, least, _, worst = agree(problem, x, improve, rng, lambda least: least - 3e-4)
    return x, -min(least, worst[0][0]), worst


def in_conflict(problem, x, window_db=None):
    """Multipliers of the rows that stand against one another at the greatest margin: (share, kind, w, plants), largest first."""
    rows, closed = problem.rows(x, window_db)
    margin, rate, kind, plant, column, second = rows
    q, slopes = problem.slopes(x, rows, closed, span=0.3, most=10**9)
    keep = np.flatnonzero(margin / rate < (margin / rate).min() + 0.3)
    low, high = problem.bounds.T
    reach = [(min(0, max(a, -0.01)), max(0, min(b, 0.01))) for a, b in zip(low - x, high - x)]
    cost = np.append(np.zeros(len(x)), -1)
    table = np.concatenate([-slopes, np.ones((len(q), 1))], axis=1)
    shares = -linprog(cost, table, q, bounds=[*reach, (None, None)], method="highs").ineqlin.marginals
    found = []
    for index in np.argsort(-shares):
        if shares[index] < 1e-3:
            break
        row = keep[index]
        members = sorted({plant[row], second[row]})
        name = ("T", "S", "spread", "upper", "lower")[kind[row]]
        found.append((shares[index], name, closed[0][plant[row], column[row]], problem.shares[members]))
    return found
