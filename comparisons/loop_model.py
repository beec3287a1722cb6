"""Project files as plain NumPy: plant, controller, prefilter and limits, evaluated by their text.

Independent of phea: the formulae of a file are evaluated as they stand, with complex numbers for responses and with
polynomials for poles; a sampled plant is held by the matrix exponential of its states. Read by compare_verify.py.
"""

import csv
import functools
import pathlib
import tomllib

import numpy as np
import scipy.linalg

UNITS = {"": 1.0, "s": 1.0, "ms": 1e-3, "N.s/m": 1.0, "rad/s": 1.0, "V": 1.0}

# The rig of Ledezma (2019), Table 6.3 and section 6.4.2, as the blocks of valve, chambers and piston: the spool follows
# the command, C s p = K_qU U - K_c p - A s x, M s^2 x = A p - f_v s x - K_S x, F = K_S x, with C = A^2/K_H.
RIG = {
    "numerator": "sensor*area*flow_gain*valve_natural_frequency^2",
    "denominator": "(s^2 + 2*valve_damping_ratio*valve_natural_frequency*s + valve_natural_frequency^2)"
    "*((mass*s^2 + viscous_friction*s + sensor)*(area^2/hydraulic_stiffness*s + flow_pressure_coefficient) + area^2*s)",
    # force by load motion x_L: F = K_S (x - x_L)
    "disturbance": {
        "numerator": "-sensor*(s^2 + 2*valve_damping_ratio*valve_natural_frequency*s + valve_natural_frequency^2)"
        "*((mass*s^2 + viscous_friction*s)*(area^2/hydraulic_stiffness*s + flow_pressure_coefficient) + area^2*s)",
    },
}
RIG_NUMBERS = {"sensor": 2e7, "mass": 13.1, "area": np.pi / 4 * (0.05**2 - 0.022**2)}


def number(value):
    """A bare number, or a text with one of the few units that these projects use."""
    if not isinstance(value, str):
        return float(value)
    digits, _, unit = value.partition(" ")
    return 10 ** (float(digits) / 20) if unit == "dB" else float(digits) * UNITS[unit]


@functools.lru_cache
def compiled(text):
    return compile(text.replace("^", "**"), text, "eval")


def evaluate(text, **names):
    return eval(compiled(text), {"__builtins__": {}}, names)


class Powers:
    """Polynomials while a formula is evaluated, one for each row of the coefficients; highest power first.

    NumPy's own looks for leading zeros after every operation, and is one at a time.
    """

    # so that a NumPy array times polynomials is polynomials, and not an array
    __array_ufunc__ = None

    def __init__(self, coefficients):
        self.coefficients = coefficients

    @staticmethod
    def of(value):
        return value if isinstance(value, Powers) else Powers(np.asarray(value, dtype=float)[..., None])

    def __add__(self, other):
        one, other = self.coefficients, Powers.of(other).coefficients
        if one.shape[-1] < other.shape[-1]:
            one, other = other, one
        total = np.broadcast_to(one, np.broadcast_shapes(one.shape[:-1], other.shape[:-1]) + one.shape[-1:]).copy()
        total[..., one.shape[-1] - other.shape[-1] :] += other
        return Powers(total)

    def __mul__(self, other):
        if isinstance(other, Powers):
            return Powers(product(self.coefficients, other.coefficients))
        return Powers(self.coefficients * np.asarray(other)[..., None])

    def __pow__(self, exponent):
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self):
        return Powers(-self.coefficients)

    def __sub__(self, other):
        return self + -Powers.of(other)

    def __rsub__(self, other):
        return -self + other

    def __truediv__(self, number):
        return Powers(self.coefficients / np.asarray(number)[..., None])

    __radd__, __rmul__ = __add__, __mul__


def product(one, other):
    """Coefficients of the products of polynomials, row by row."""
    if one.ndim == other.ndim == 1:
        return np.convolve(one, other)
    length = one.shape[-1]
    total = np.zeros(np.broadcast_shapes(one.shape[:-1], other.shape[:-1]) + (length + other.shape[-1] - 1,))
    for place in range(other.shape[-1]):
        total[..., place : place + length] += one * other[..., place : place + 1]
    return total


def coefficients(text, variable="s", **names):
    """Those of a polynomial, highest power first; a row of them for each element of the numbers that it names."""
    return Powers.of(evaluate(text, **{variable: Powers(np.array([1.0, 0.0]))}, **names)).coefficients


def polynomial(text, variable="s", **names):
    return np.poly1d(coefficients(text, variable, **names))


def value_at(one, s):
    """A polynomial at s, by Horner: NumPy's own does more than this before it begins."""
    total = one.coeffs[0] + 0.0 * s
    for coefficient in one.coeffs[1:]:
        total = total * s + coefficient
    return total


class Transfer:
    """Controller or prefilter: as text, as factors or as elements."""

    def __init__(self, table):
        table = table or {"numerator": "1", "denominator": "1"}
        if "gain" in table:
            roots = lambda name: [complex(*r) if isinstance(r, list) else complex(r) for r in table.get(name, [])]
            self.numerator = np.poly1d(np.real(np.poly(roots("zeros"))) * table["gain"])
            self.denominator = np.poly1d(np.real(np.poly(roots("poles"))))
            self.variable = "s"
        elif "elements" in table:
            raise NotImplementedError("controllers by their elements")
        else:
            both = table["numerator"] + table["denominator"]
            self.variable = "z" if "z" in both else "s"
            self.numerator = polynomial(table["numerator"], self.variable)
            self.denominator = polynomial(table["denominator"], self.variable)

    def __call__(self, s):
        """Its values at s; a constant, which is asked for very often, is not evaluated as a polynomial."""
        if self.numerator.order == self.denominator.order == 0:
            return self.numerator.coeffs[0] / self.denominator.coeffs[0] + 0.0 * s
        return value_at(self.numerator, s) / value_at(self.denominator, s)

    @functools.cache
    def sampled(self, sample_time):
        """Numerator and denominator in z by s = 2/T (z - 1)/(z + 1)."""
        if self.variable == "z":
            return self.numerator, self.denominator
        down, up = np.poly1d([2 / sample_time, -2 / sample_time]), np.poly1d([1.0, 1.0])
        order = max(self.numerator.order, self.denominator.order)

        def mapped(source):
            terms = [float(c) * down**power * up ** (order - power) for power, c in enumerate(source.coeffs[::-1])]
            return sum(terms, np.poly1d([0.0]))

        return mapped(self.numerator), mapped(self.denominator)


class Project:
    """What a loop is made of."""

    def __init__(self, path, settings=()):
        self.path = pathlib.Path(path)
        self.settings = dict(settings)
        with open(path, "rb") as file:
            self.table = tomllib.load(file)
        for place, value in self.settings.items():
            *folders, last = place.split(".")
            table = self.table
            for folder in folders:
                table = table.setdefault(folder, {})
            table[last] = value
        self.names, self.direction = [], np.zeros(0, dtype=int)
        self.read_family()
        controller = self.table["controller"]
        self.controller, self.prefilter = Transfer(controller), Transfer(self.table.get("prefilter"))
        self.has_prefilter = "prefilter" in self.table
        self.sample_time = number(controller["sample_time"]) if "sample_time" in controller else None
        self.loop_delay = number(controller.get("delay", 0.0))
        sensor = self.table.get("sensor")
        self.sensor, self.sensor_delay = Transfer(sensor), number((sensor or {}).get("delay", 0.0))
        self.specifications = self.table["specification"]
        self.limits_load_motion = any(one["kind"] == "load_motion" for one in self.specifications)

    def read_family(self):
        self.fixed, self.measured = {}, None
        files = self.table.get("family", {}).get("measured")
        if files:
            self.read_measured(files)
            return
        self.plant = self.table.get("plant")
        if self.plant is None:
            self.plant, self.fixed = RIG, RIG_NUMBERS
        uncertainty = self.table.get("uncertainty", {})
        self.names = list(uncertainty)
        self.low = np.array([number(uncertainty[name]["minimum"]) for name in self.names])
        self.high = np.array([number(uncertainty[name]["maximum"]) for name in self.names])
        self.nominal = np.array([number(uncertainty[name]["nominal"]) for name in self.names])
        cases = self.table.get("family", {}).get("cases")
        self.cases = None
        if cases:
            self.names = self.names or list(cases[0])
            listed = [[number(case[name]) for name in self.names] for case in cases]
            self.cases = np.unique(np.array(listed + ([list(self.nominal)] if len(self.nominal) else [])), axis=0)
        self.correlate(self.table.get("family", {}).get("correlation", []))

    def correlate(self, groups):
        """Which share each parameter follows, and whether it falls while the share rises."""
        leaders = {name: name for name in self.names}
        for group in groups:
            leaders |= {name: group["parameters"][0] for name in group["parameters"]}
        directions = list(dict.fromkeys(leaders[name] for name in self.names))
        self.direction = np.array([directions.index(leaders[name]) for name in self.names], dtype=int)
        opposed = {name for group in groups for name in group.get("opposed", [])}
        self.falling = np.array([name in opposed for name in self.names], dtype=bool)
        # equal factors only where a file asks for them: along a correlated direction it matters
        spacing = self.table.get("uncertainty", {})
        asked = np.array([spacing.get(name, {}).get("spacing") == "log" for name in self.names], dtype=bool)
        self.logarithmic = asked if groups else self.low > 0

    def read_measured(self, files):
        """Each plant as logarithms of frequency and magnitude, and its phase in radians; its one parameter is its number."""
        self.measured, self.plant = [], {}
        for name in files:
            with open(self.path.parent / name, newline="") as file:
                rows = [list(map(float, row)) for row in list(csv.reader(file))[1:]]
            frequency, magnitude, phase = np.array(rows).T
            self.measured.append((np.log(frequency), magnitude * np.log(10) / 20, np.unwrap(np.radians(phase))))
        self.names, self.low, self.high, self.nominal = ["plant"], np.zeros(1), np.zeros(1), np.zeros(1)
        self.cases = np.arange(len(files), dtype=float)[:, None]

    def measured_responses(self, values, frequency):
        """Straight between the points, in the logarithm of magnitude and in phase over the logarithm of frequency."""
        which = np.broadcast_to(values[..., 0], np.broadcast_shapes(values.shape[:-1], frequency.shape))
        logarithm = np.log(np.broadcast_to(frequency, which.shape))
        answer = np.zeros(which.shape, dtype=complex)
        for index, (points, magnitude, phase) in enumerate(self.measured):
            value = np.exp(np.interp(logarithm, points, magnitude) + 1j * np.interp(logarithm, points, phase))
            answer = np.where(which == index, value, answer)
        return answer

    def values(self, shares):
        """Parameters at shares of the box in [0, 1], along the last axis."""
        shares = np.clip(np.asarray(shares, dtype=float), 0.0, 1.0)[..., self.direction]
        shares = np.where(self.falling, 1 - shares, shares)
        positive = np.where(self.logarithmic, self.low, 1.0)
        ratio = np.where(self.logarithmic, self.high / np.where(self.logarithmic, self.low, 1.0), 1.0)
        linear = self.low + shares * (self.high - self.low)
        return np.where(self.logarithmic, positive * ratio**shares, linear)

    def named(self, values):
        """Each parameter by its name, from an array with the parameters along its first axis."""
        return self.fixed | {name: values[index] for index, name in enumerate(self.names)}

    @property
    def directions(self):
        """Number of shares that span the box."""
        return int(self.direction.max()) + 1 if len(self.direction) else 0

    @property
    def has_delay(self):
        return bool(self.loop_delay or self.sensor_delay or self.plant.get("delay"))

    def delay(self, values):
        """Dead time of plant and loop, without the sensor's, s."""
        text = self.plant.get("delay", 0.0)
        if isinstance(text, str) and not text[0].isdigit():
            return self.loop_delay + evaluate(text, **self.named(values))
        return self.loop_delay + number(text)

    def plant_polynomials(self, values):
        # plain floats: a NumPy scalar times a polynomial is an array
        named = {name: float(value) for name, value in self.named(values).items()}
        return polynomial(self.plant["numerator"], **named), polynomial(self.plant["denominator"], **named)

    def many_loop_polynomials(self, values):
        """As loop_polynomials, of many plants: rows of coefficients."""
        named = self.named(np.moveaxis(values, -1, 0))
        over, under = (coefficients(self.plant[part], **named) for part in ("numerator", "denominator"))
        if self.sample_time:
            return over, under
        for part in (self.controller, self.sensor):
            over, under = product(over, part.numerator.coeffs), product(under, part.denominator.coeffs)
        return over, under

    def responses(self, values, frequency):
        """P, Pd, G, F, H for arrays of parameters (parameters along the last axis) and frequencies that broadcast."""
        values, frequency = np.asarray(values), np.asarray(frequency, dtype=float)
        if self.sample_time:
            return self.sampled_responses(values, frequency)
        s = 1j * frequency
        feedback, prefilter = self.controller(s), self.prefilter(s)
        sensor = self.sensor(s)
        if self.sensor_delay:
            sensor = sensor * np.exp(-s * self.sensor_delay)
        if self.measured:
            plant = self.measured_responses(values, frequency) * np.exp(-s * self.loop_delay)
            return plant, 0.0, feedback, prefilter, sensor
        each = np.moveaxis(values, -1, 0)
        named = self.named(each)
        denominator = evaluate(self.plant["denominator"], s=s, **named)
        plant = evaluate(self.plant["numerator"], s=s, **named) / denominator * np.exp(-s * self.delay(each))
        second = self.plant.get("disturbance")
        motion = 0.0
        if second and self.limits_load_motion:
            under = evaluate(second["denominator"], s=s, **named) if "denominator" in second else denominator
            motion = evaluate(second["numerator"], s=s, **named) / under
        return plant, motion, feedback, prefilter, sensor

    def sampled_responses(self, values, frequency):
        shape = np.broadcast_shapes(values.shape[:-1], frequency.shape)
        rows = np.broadcast_to(values, shape + values.shape[-1:]).reshape(-1, values.shape[-1])
        z = np.broadcast_to(np.exp(1j * frequency * self.sample_time), shape).reshape(-1)
        plant = np.empty(z.size, dtype=complex)
        # Plants that follow each other at many frequencies are held once.
        first = np.flatnonzero(np.concatenate([[True], np.any(rows[1:] != rows[:-1], axis=1)])) if z.size else []
        for start, end in zip(first, [*first[1:], z.size]):
            a, b, c, d = self.held_plant(rows[start])
            states = np.linalg.solve(z[start:end, None, None] * np.eye(len(a)) - a, np.broadcast_to(b, (end - start, *b.shape)))
            whole = np.floor(self.delay(rows[start]) / self.sample_time + 1e-9)
            plant[start:end] = ((c @ states)[:, 0, 0] + d) * z[start:end] ** -whole
        feedback, prefilter = (t.sampled(self.sample_time) for t in (self.controller, self.prefilter))
        z = z.reshape(shape)
        return plant.reshape(shape), 0.0, feedback[0](z) / feedback[1](z), prefilter[0](z) / prefilter[1](z), 1.0

    def held_plant(self, values):
        """States of the plant between hold and sampler, with the part of a sample of its dead time."""
        return self.held_behind(tuple(values), self.loop_delay)

    @functools.lru_cache(maxsize=64)
    def held_behind(self, values, _loop_delay):
        """The same, kept: a search over the frequency asks for one plant again and again."""
        over, under = self.plant_polynomials(values)
        a, b, c, d = companion(over, under)
        fraction = self.delay(values) % self.sample_time
        if min(fraction, self.sample_time - fraction) < 1e-9 * self.sample_time:
            fraction = 0.0
        return held(a, b, c, d, self.sample_time, fraction)

    def loop_polynomials(self, values):
        """n and c with 1 + L = (n + c)/c of a continuous loop, its dead time left out; of a sampled one the plant's."""
        over, under = self.plant_polynomials(values)
        if self.sample_time:
            return over, under  # the plant alone: the controller may be one in z
        parts = self.controller, self.sensor
        return over * parts[0].numerator * parts[1].numerator, under * parts[0].denominator * parts[1].denominator

    def sampled_loop_matrix(self, values):
        """State matrix of the closed sampled loop: plant, whole samples of delay, controller."""
        a, b, c, d = self.held_plant(values)
        for _ in range(int(np.floor(self.delay(values) / self.sample_time + 1e-9))):
            # the plant's input is what the controller gave a sample ago
            a = np.block([[a, b], [np.zeros((1, len(a) + 1))]])
            b = np.vstack([np.zeros((len(a) - 1, 1)), [[1.0]]])
            c, d = np.hstack([c, [[d]]]), 0.0
        over, under = self.controller.sampled(self.sample_time)
        f, g, h, k = companion(over, under, scale=1.0)
        # e = -(c x + d u), u = h y + k e
        share = 1.0 / (1.0 + k * d)
        return np.block([[a - b @ c * k * share, b @ h * share], [-g @ c * share, f - g @ h * d * share]])


def companion(over, under, scale=None):
    """States of over/under; time is scaled by the fastest pole, which keeps the matrix balanced."""
    order = under.order
    if scale is None:
        scale = max(1e-3, np.max(np.abs(under.roots))) if order else 1.0
    powers = scale ** np.arange(order, -1, -1.0)
    top = np.zeros(order + 1)
    top[order - over.order :] = over.coeffs
    top, bottom = top * powers, under.coeffs * powers
    top, bottom = top / bottom[0], bottom / bottom[0]
    a, b = np.zeros((order, order)), np.zeros((order, 1))
    if order:
        a[0], a[1:, :-1], b[0] = -bottom[1:], np.eye(order - 1), scale
    return a * scale, b, (top[1:] - top[0] * bottom[1:])[None, :], top[0]


def held(a, b, c, d, sample_time, fraction):
    """Zero-order hold of x' = a x + b u, y = c x + d u, whose input arrives a part of a sample late."""
    order = len(a)

    def step(time):
        block = scipy.linalg.expm(np.block([[a, b], [np.zeros((1, order + 1))]]) * time)
        return block[:order, :order], block[:order, order:]

    full, whole = step(sample_time)
    if fraction == 0.0:
        return full, whole, c, d
    late, new = step(sample_time - fraction)
    old = late @ (new if 2 * fraction == sample_time else step(fraction)[1])
    # x+ = full x + old u_before + new u; at the sample itself the plant still sees the older command
    state = np.block([[full, old], [np.zeros((1, order + 1))]])
    return state, np.vstack([new, [[1.0]]]), np.hstack([c, [[d]]]), 0.0
