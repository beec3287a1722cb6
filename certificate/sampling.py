"""Sampled loops: the images of the plant, enclosed by discs, and the poles of one plant, counted by turns.

An image is the plant at w_k = w + k W, W = 2 pi/T; R = sum over k != 0 of (w/w_k) e^(-j k W tau) N/D(j w_k)."""

import math
from fractions import Fraction

from arithmetic import Rejected, axis, number, pi, rounded_up, spend, turned
from panels import complex_product, control_points, degrees_of, on_panel

BITS = 160      # of a control point of an image


def root_above(x):
    """Not less than the root of x >= 0."""
    x = rounded_up(x, 128)
    shift = max(0, 160 + x.denominator.bit_length() - x.numerator.bit_length()) // 2 * 2
    return Fraction(math.isqrt((x.numerator << shift) // x.denominator) + 1, 1 << shift // 2)


def short(x, bits=64):
    """A number near x with few bits."""
    return (rounded_up(abs(x), bits) if x > 0 else -rounded_up(abs(x), bits)) if x else Fraction(0)


def steepest(polynomial, w):
    """A bound on how fast the polynomial changes with the frequency up to w, over the whole box."""
    total = Fraction(0)
    for i, coefficient in enumerate(polynomial.along_frequency()):
        total += i * Fraction(sum(map(abs, coefficient.terms.values())), coefficient.denominator) * w ** max(0, i - 1)
    return total


class Images:
    def __init__(self, sample_time, count, taus, responses):
        """Of each kind the dead time; and numerator, denominator, and of the bound beyond the ratio C and the order m."""
        self.count, self.taus, self.responses = count, taus, responses
        low, high = (2 * x / sample_time for x in pi())
        self.low, self.high = low, high
        self.orders = [k for k in range(-count, count + 1) if k]

    def beyond(self, kind, w):
        """2 w C W^-(m+1) (K - 0.01)^-m/m"""
        _, _, ratio, m = self.responses[kind]
        return 2 * w * ratio / self.low ** (m + 1) / (self.count - Fraction(1, 100)) ** m / m

    def turn(self, kind, k):
        """e^(-j k W tau), dead time being a number."""
        tau = self.taus[kind].constant()
        re, im, error = turned(k * self.low * tau)
        return re, im, error + abs(k) * (self.high - self.low) * tau

    def on(self, panel, kinds, loop):
        """Bundles of the control points of j w N(j w_k) and j w_k D(j w_k), and what encloses R in a part of the panel."""
        start, end, bundles, numbers = panel["from"], panel["to"], [], {}
        s, spread = axis(0), self.high - self.low
        for kind in kinds:
            numerator, denominator, _, _ = self.responses[kind]
            numbers[kind] = []
            for k in self.orders:
                low, high = start + k * self.low, end + k * self.low
                top = max(abs(low), abs(high))
                over = on_panel(s, start, end, 1)
                n = complex_product(over, on_panel(numerator, low, high, 0))
                d = on_panel(s * denominator, low, high, 0)
                # W is known within spread, so that w_k is within k times that
                rest = abs(k) * spread * (end * steepest(numerator, top + 1) + steepest(s * denominator, top + 1))
                rest += sum(r * end * top**i for i, r in numerator.rest.items()) + sum(r * top ** (i + 1) for i, r in denominator.rest.items())
                degrees = degrees_of([*n, *d], loop.axes)
                scale = math.lcm(*(p.denominator for p in (*n, *d)))
                *lists, unit = control_points([*n, *d, number(1)], degrees, scale, BITS)
                # number(1) tells how large 1 is among them, to less than 2
                lists.append([int(rest * (value + 2)) + 9 for value in unit])
                numbers[kind].append((len(bundles), k))
                bundles.append((degrees, lists))

        def enclosed(kind, lists, w):
            """Centre and radius of a disc around R."""
            alpha, rho = [Fraction(0), Fraction(0)], self.beyond(kind, w)
            for place, k in numbers[kind]:
                centre, radius = disc(*lists[place])
                size = root_above(centre[0] ** 2 + centre[1] ** 2)
                if any(self.taus[kind].terms.keys() - {0}):
                    rho += size + radius
                    continue
                re, im, error = self.turn(kind, k)
                alpha[0] += centre[0] * re - centre[1] * im
                alpha[1] += centre[0] * im + centre[1] * re
                rho += radius + size * error
            return alpha, rounded_up(rho)
        return bundles, enclosed


def disc(n_real, n_imaginary, d_real, d_imaginary, rest):
    """Centre c and radius of a disc around n/d: radius = greatest (|n_i - c d_i| + e (1 + |c|))/least (Re(conj(d) d_i)/|d| - e),
    c and d being the quotient of the means, and the mean of the denominator."""
    spend(8 * len(n_real))
    a, b, e = sum(d_real), sum(d_imaginary), max(rest)
    over = a * a + b * b
    if not over:
        raise Rejected("an image may be infinite")
    p, q = sum(n_real), sum(n_imaginary)
    centre = short(Fraction(p * a + q * b, over)), short(Fraction(q * a - p * b, over))
    common = math.lcm(*(x.denominator for x in centre))
    c, d = (int(x * common) for x in centre)
    farthest = max((common * nr - c * dr + d * di) ** 2 + (common * ni - c * di - d * dr) ** 2
                   for nr, ni, dr, di in zip(n_real, n_imaginary, d_real, d_imaginary))
    cut = max(0, max(abs(a), abs(b)).bit_length() - 48)
    a, b = a >> cut, b >> cut
    least = min(a * dr + b * di for dr, di in zip(d_real, d_imaginary)) / root_above(Fraction(a * a + b * b)) - e
    if least <= 0:
        raise Rejected("an image may be infinite")
    return centre, (root_above(Fraction(farthest)) / common + e * (1 + root_above(centre[0] ** 2 + centre[1] ** 2))) / least


# Counting

def turn(directions):
    """The sum of the angles between neighbours."""
    total = 0.0
    for (a, b), (c, d) in zip(directions, directions[1:]):
        if (cross := a * d - b * c) == 0 and a * c + b * d < 0:
            raise Rejected("two neighbours have opposite directions")
        total += math.atan2(cross, a * c + b * d)
    return total


def off(direction, value):
    """The angle of a value, or of its opposite, from a direction: less than a quarter turn."""
    a, b, (re, im) = *direction, value
    along, across = a * re + b * im, a * im - b * re
    if along == 0:
        raise Rejected("a direction is no direction of its function")
    scale = max(abs(along), abs(across))
    along, across = float(along / scale), float(across / scale)
    return math.atan2(across, along) if along > 0 else math.atan2(-across, -along)


def whole(x):
    if abs(x - round(x)) > 0.01:
        raise Rejected("the turns are no whole number of half turns")
    return round(x)


def roots_outside(sample_time, degree, denominator, of_f, of_denominator, beyond):
    """turn of f - turn of D' - i pi/2 = pi (degree of Gd + roots of D' to the right - roots of chi outside), from 0 to pi/T.

    Leaves are (w from, w to, a, b) in the order of w. At 0, f and D' are real; at pi/T, f has the direction of j^i D', or the opposite."""
    order = denominator.lowest()
    rest = [coefficient.constant() for coefficient in denominator.over(order).along_frequency()]
    low, high = (x / sample_time for x in pi())

    def up_to_the_end(leaves):
        kept = [leaf[2:] for leaf in leaves if leaf[0] < low]
        if not any(leaf[0] < low and high < leaf[1] for leaf in leaves):
            raise Rejected("no leaf contains half of the sampling rate")
        return kept
    value = [sum((-1) ** (i // 2) * x * low**i for i, x in enumerate(rest) if i % 2 == part) for part in (0, 1)]
    unsure = sum(i * abs(x) * high ** (i - 1) * (high - low) for i, x in enumerate(rest) if i)
    unsure += sum(r * high ** (i - order) for i, r in denominator.rest.items())
    if max(map(abs, value)) < 10**6 * unsure:
        raise Rejected("the denominator cannot be told from zero at half of the sampling rate")
    re, im = value
    turned_value = ((re, im), (-im, re), (-re, -im), (im, -re))[order % 4]
    real = Fraction(1), Fraction(0)
    f, d, every = up_to_the_end(of_f), up_to_the_end(of_denominator), [leaf[2:] for leaf in (*of_denominator, *beyond)]
    turn_of_f = turn(f) + off(f[-1], turned_value) - off(f[0], real)
    turn_of_d = turn(d) + off(d[-1], (re, im)) - off(d[0], real)
    last = ((1, 0), (0, 1), (-1, 0), (0, -1))[(len(rest) - 1) % 4]
    turn_to_infinity = turn(every) + off(every[-1], last) - off(every[0], real)
    right = whole((len(rest) - 1 - turn_to_infinity / (math.pi / 2)) / 2)
    return whole(degree + right - (turn_of_f - turn_of_d - order * math.pi / 2) / math.pi)
