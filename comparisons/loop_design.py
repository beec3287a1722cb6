"""The closed loops of a family of plants with a controller and prefilter with free parameters. Read by loop_search.py and recompute_design.py.

Independent of phea. The free numbers are natural logarithms of gain, corner frequencies and damping ratios; every margin in dB has an analytic
slope (d ln T = S d ln G, d ln S = -T d ln G). Every margin is looked at beside the imaginary parts of the closed-loop roots too, for a grid
alone does not see instability coming.
"""

import itertools

import numpy as np

DB = 20 / np.log(10)
DISTANT = 1e9  # margin of what is outside of a specification's band, dB


def db(ratio):
    return 20 * np.log10(np.abs(ratio))


def polynomials(coefficients, s):
    """One polynomial per row of coefficients, highest power first, at one row of s for each."""
    value = np.zeros(s.shape, dtype=complex)
    for column in coefficients.T:
        value = value * s + column[:, None]
    return value


def products(rows, others):
    """The polynomial of each row times that of the other's row, or times the only one."""
    found = np.zeros((len(rows), rows.shape[1] + others.shape[1] - 1), dtype=np.result_type(rows, others))
    for shift, coefficient in enumerate(others.T):
        found[:, shift : shift + rows.shape[1]] += coefficient[:, None] * rows
    return found


class Structure:
    """Factors in series: I integrator, Z and P real zero and pole, ZZ and PP pairs, each 1 at s = 0; and a gain.

    x = ln of the gain, then of each factor's corner frequency and, for a pair, damping ratio.
    """

    def __init__(self, text, frequency=(0.5, 3e4), damping=(0.1, 2.5), gain=(1e-12, 1e12), start=(2.0, 3e3)):
        self.text, self.parts, self.start = text, text.split(), start
        bounds = [gain]
        for part in self.parts:
            bounds += {"I": [], "Z": [frequency], "P": [frequency]}.get(part, [frequency, damping])
        self.bounds = np.log(bounds)
        self.size = len(bounds)

    def factors(self, x):
        """Sign of the exponent, corner frequency, damping ratio or None; frequency None is an integrator."""
        numbers = iter(np.exp(x[1:]))
        for part in self.parts:
            corner = None if part == "I" else next(numbers)
            yield 1 if part[0] == "Z" else -1, corner, next(numbers) if len(part) == 2 else None

    def response(self, x, s):
        value, slopes = np.exp(x[0]) * np.ones_like(s), [np.ones_like(s)]
        for sign, corner, damping in self.factors(x):
            if corner is None:
                value = value / s
                continue
            v = s / corner
            factor = v + 1 if damping is None else v * v + 2 * damping * v + 1
            slopes.append(-sign * (v if damping is None else 2 * v * v + 2 * damping * v) / factor)
            if damping is not None:
                slopes.append(sign * 2 * damping * v / factor)
            value = value * factor if sign > 0 else value / factor
        return value, np.array(slopes)

    def polynomials(self, x):
        over, under = np.array([np.exp(x[0])]), np.ones(1)
        for sign, corner, damping in self.factors(x):
            factor = [1, 0] if corner is None else [1 / corner, 1] if damping is None else [corner**-2, 2 * damping / corner, 1]
            over, under = (np.convolve(over, factor), under) if sign > 0 else (over, np.convolve(under, factor))
        return over, under

    def high_frequency_gain(self, x):
        """lim s^r G in dB and its slopes, r the relative degree."""
        slopes, index = np.zeros(self.size), 1
        slopes[0] = 1
        for sign, corner, damping in self.factors(x):
            if corner is not None:
                order = 1 if damping is None else 2
                slopes[index] = -sign * order
                index += order
        return DB * slopes @ x, DB * slopes

    def draw(self, rng):
        x, index = np.zeros(self.size), 1
        low, high = self.bounds.T
        for part in self.parts:
            if part == "I":
                continue
            x[index] = rng.uniform(*np.clip(np.log(self.start), low[index], high[index]))
            index += 1
            if len(part) == 2:
                x[index] = np.clip(np.log(rng.uniform(0.5, 1.3)), low[index], high[index])
                index += 1
        return np.clip(x, low, high)


class Plants:
    """A family: rational in s, or in w = 2/T (z - 1)/(z + 1) where it is sampled."""

    def __init__(self, rational, box=None, logarithmic=(), listed=None, sample_time=None, responses=None):
        self.rational, self.box, self.listed, self.sample_time = rational, box, listed, sample_time
        self.logarithmic = np.array(logarithmic, dtype=bool)
        # a sampled plant's response from its modes is closer to the truth than from its polynomials
        self.responses = responses

    def values(self, shares):
        if self.box is None:
            return self.listed
        low, high = self.box.T
        return np.where(self.logarithmic, low * (high / low) ** shares, low + shares * (high - low))

    def variable(self, w):
        return 1j * w if self.sample_time is None else 2j / self.sample_time * np.tan(w * self.sample_time / 2)

    def frequency(self, v):
        return v if self.sample_time is None else 2 / self.sample_time * np.arctan(v * self.sample_time / 2)

    def vertices(self):
        return np.array(list(itertools.product((0.0, 1.0), repeat=len(self.box))))

    def draw(self, rng, count):
        """Points inside, on faces and on edges of the box."""
        shares = rng.random((count, len(self.box)))
        on_faces = rng.choice([0.0, 0.5, 0.8, 0.9], size=(count, 1))
        return np.where(rng.random(shares.shape) < on_faces, np.round(shares), shares)


class Problem:
    """Margins of a sample of plants at a sample of frequencies, for the numbers of controller and prefilter together.

    A specification is (kind, limit, from, to) with limit a function of s, a pair of them for "track". Without a prefilter
    "track" is judged by its spread, one margin for two plants: twice the relaxation of one limit.
    """

    def __init__(self, plants, specifications, frequencies, feedback, prefilter=None, scale=300.0, shares=None):
        self.plants, self.specifications, self.scale = plants, specifications, scale
        self.feedback, self.prefilter = feedback, prefilter
        both = [feedback.bounds] + ([] if prefilter is None else [prefilter.bounds])
        self.bounds = np.concatenate(both)
        self.frequencies = np.unique(frequencies)
        self.take(plants.vertices() if shares is None and plants.box is not None else shares)

    def take(self, shares):
        self.shares = shares
        self.values = self.plants.values(shares)
        self.over, self.under = self.plants.rational(self.values)
        w = np.broadcast_to(self.frequencies, (len(self.values), len(self.frequencies)))
        self.w, self.p = w, self.response(w)
        self.limits = [self.limit(spec, w) for spec in self.specifications]

    def response(self, w):
        if self.plants.responses:
            return self.plants.responses(self.values, w)
        s = self.plants.variable(w)
        return polynomials(self.over, s) / polynomials(self.under, s)

    @staticmethod
    def limit(spec, w):
        kind, limit, low, high = spec
        inside = (w >= low * (1 - 1e-12)) & (w <= high * (1 + 1e-12))
        with np.errstate(all="ignore"):
            levels = [db(f(1j * w)) for f in (limit if kind == "track" else (limit,))]
        return [np.where(inside, level, sign * DISTANT) for level, sign in zip(levels, (1, -1))]

    def roots(self, x):
        """Roots of 1 + L of every plant, by companion matrices on a scaled s."""
        over, under = self.feedback.polynomials(x)
        rows, numerators = products(self.under, under[None]), products(self.over, over[None])
        rows[:, rows.shape[1] - numerators.shape[1] :] += numerators
        order = rows.shape[1] - 1
        rows = rows * self.scale ** np.arange(order, -1, -1.0)
        matrices = np.zeros((len(rows), order, order))
        matrices[:, 0] = -rows[:, 1:] / rows[:, :1]
        matrices[:, np.arange(1, order), np.arange(order - 1)] = 1
        return np.linalg.eigvals(matrices) * self.scale

    def closed(self, x):
        """w, s, T, S and their limits, with the frequencies of the closed loop's own roots; None where a plant is unstable."""
        roots = self.roots(x)
        if roots.real.max() >= 0:
            return None
        # one root of each pair
        order = np.argsort(-roots.imag, axis=1)[:, : roots.shape[1] // 2]
        pole = np.take_along_axis(roots, order, axis=1)
        width = np.minimum(-pole.real, 0.2 * pole.imag)
        own = self.plants.frequency(np.concatenate([pole.imag, pole.imag - 0.6 * width, pole.imag + 0.6 * width], axis=1))
        own = np.where(own > 1e-3 * self.scale, own, self.frequencies[len(self.frequencies) // 2])
        w = np.concatenate([self.w, own], axis=1)
        s = self.plants.variable(w)
        p = np.concatenate([self.p, self.response(own)], axis=1)
        count = len(self.frequencies)
        g = np.empty(w.shape, dtype=complex)
        g[:, :count] = self.feedback.response(x, s[0, :count])[0]
        g[:, count:] = self.feedback.response(x, s[:, count:])[0]
        limits = [
            [np.concatenate(pair, axis=1) for pair in zip(near, self.limit(spec, own))]
            for near, spec in zip(self.limits, self.specifications)
        ]
        sensitivity = 1 / (1 + p * g)
        return w, s, p, p * g * sensitivity, sensitivity, limits

    def rows(self, x, window_db=None):
        """Margins with their rates, or None. Each row: margin, rate, kind, plant, column, second plant.

        `window_db`: where the window of a tracking limit is narrower than this, its rate shrinks with it, so that the least margin
        over rate can be positive although both limits meet at w = 0.
        """
        closed = self.closed(x[: self.feedback.size])
        if closed is None:
            return None
        w, s, p, t, sensitivity, limits = closed
        parts = []

        def add(margin, rate, kind, plant, column, second=None):
            parts.append((margin, rate, np.full(len(margin), kind), plant, column, plant if second is None else second))

        for (kind, *_), levels in zip(self.specifications, limits):
            if kind != "track":
                value = db({"T": t, "S": sensitivity, "PS": p * sensitivity}[kind])
                plant, column = np.nonzero(levels[0] < DISTANT)
                at = plant, column
                add((levels[0] - value)[at], np.ones(len(plant)), {"T": 0, "S": 1, "PS": 1}[kind], plant, column)
                continue
            columns = np.flatnonzero(levels[0][0, : len(self.frequencies)] < DISTANT)
            upper, lower = (level[0, columns] for level in levels)
            rate = np.ones(len(columns)) if window_db is None else np.minimum(1, (upper - lower) / window_db)
            value = db(t[:, columns])
            if self.prefilter is None:
                order = np.argsort(value, axis=0)
                each = np.arange(len(columns))
                for most, least in itertools.product(order[-3:], order[:3]):
                    margin = upper - lower - value[most, each] + value[least, each]
                    add(margin, 2 * rate, 2, most, columns, least)
                continue
            value = value + db(self.prefilter.response(x[self.feedback.size :], s[0, columns])[0])
            plant, index = (a.ravel() for a in np.indices(value.shape))
            add((upper - value).ravel(), rate[index], 3, plant, columns[index])
            add((value - lower).ravel(), rate[index], 4, plant, columns[index])
        return [np.concatenate(column) for column in zip(*parts)], (w, s, t, sensitivity)

    def slopes(self, x, rows, closed, span=6.0, most=1200):
        """Least margins over rate with their slopes; all others are `span` dB better."""
        ratio = rows[0] / rows[1]
        keep = np.flatnonzero(ratio < ratio.min() + span)
        if len(keep) > most:
            keep = keep[np.argpartition(ratio[keep], most)[:most]]
        margin, rate, kind, plant, column, second = (part[keep] for part in rows)
        _, s, t, sensitivity = closed
        size, here = self.feedback.size, (plant, column)
        change = self.feedback.response(x[:size], s[here])[1]
        of_t, of_s = DB * (sensitivity[here] * change).real, -DB * (t[here] * change).real
        other = DB * (sensitivity[second, column] * change).real
        slopes = np.zeros((len(x), len(keep)))
        slopes[:size] = np.select([kind == 0, kind == 1, kind == 2, kind == 3], [-of_t, -of_s, other - of_t, -of_t], of_t)
        if self.prefilter is not None:
            level = DB * self.prefilter.response(x[size:], s[here])[1].real
            slopes[size:] = np.select([kind == 3, kind == 4], [-level, level], 0.0)
        return margin / rate, (slopes / rate).T

    def draw(self, rng, gains=np.arange(-80, 41, 5.0)):
        """Numbers at random, the gain the best of a scan; None where no gain keeps every plant stable."""
        x = np.concatenate([part.draw(rng) for part in (self.feedback, self.prefilter) if part is not None])
        best, low_high = (-np.inf, None), self.bounds[0]
        middle, x[0] = len(self.frequencies) // 2, 0.0
        there = self.plants.variable(self.frequencies[middle : middle + 1])
        unit = np.abs(self.p[0, middle] * self.feedback.response(x[: self.feedback.size], there)[0][0])
        for level in gains:
            x[0] = np.clip(level / DB - np.log(unit), *low_high)
            found = self.rows(x)
            if found and (least := (found[0][0] / found[0][1]).min()) > best[0]:
                best = least, x.copy()
        return best[1]
