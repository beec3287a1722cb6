"""Functions of the frequency alone on a panel: polynomials of y with a remainder, w = middle + half y, y in [-1, 1]."""

from fractions import Fraction
from functools import lru_cache
from math import comb, factorial

from arithmetic import PRECISION, Malformed, Polynomial, Rejected, exponential, logarithm, rounded, spend, turned


class Series:
    """Complex coefficients of powers of y and a remainder, whole numbers times 2^-PRECISION; every rounding is in the remainder."""

    def __init__(self, coefficients, remainder):
        self.coefficients, self.remainder = coefficients, remainder

    @staticmethod
    def of(coefficients, remainder):
        """From pairs of fractions."""
        fixed = [tuple(int(x * 2**PRECISION // 1) for x in pair) for pair in coefficients]
        return Series(fixed, int(remainder * 2**PRECISION) + 1 + 2 * len(fixed))

    def size(self):
        return sum(abs(re) + abs(im) for re, im in self.coefficients)

    def greatest(self):
        """A bound on its magnitude."""
        return Fraction(self.size() + self.remainder, 1 << PRECISION)

    def times(self, other, terms):
        """The product; what exceeds the degree terms - 1 is remainder."""
        spend(4 * len(self.coefficients) * len(other.coefficients))
        products = [[0, 0] for _ in range(len(self.coefficients) + len(other.coefficients) - 1)]
        for i, (a, b) in enumerate(self.coefficients):
            for k, (c, d) in enumerate(other.coefficients):
                products[i + k][0] += a * c - b * d
                products[i + k][1] += a * d + b * c
        over = sum(abs(re) + abs(im) for re, im in products[terms:])
        over += self.size() * other.remainder + other.size() * self.remainder + self.remainder * other.remainder
        kept = [(re >> PRECISION, im >> PRECISION) for re, im in products[:terms]]
        return Series(kept, (over >> PRECISION) + 1 + 2 * len(kept))

    def plus(self, re):
        """The sum with a number."""
        (first, im), *others = self.coefficients
        return Series([(first + int(re * 2**PRECISION // 1), im), *others], self.remainder + 1)

    def in_x(self):
        """Real and imaginary part as polynomials of x, y = 2 x - 1."""
        parts = {}, {}
        for k, pair in enumerate(self.coefficients):
            for part, value in zip(parts, pair):
                for i in range(k + 1):
                    part[i] = part.get(i, 0) + value * comb(k, i) * 2**i * (-1) ** (k - i)
        return tuple(Polynomial(part, 1 << PRECISION) for part in parts)


def turning(middle, half, theta, terms):
    """e^(-j w theta) = e^(-j a) sum over k < m of (-j b)^k/k! y^k + r, a = middle theta, b = half theta, |r| <= |b|^m/m!"""
    b = half * theta
    re, im, error = turned(middle * theta)
    powers = [b**k / factorial(k) for k in range(terms)]
    turns = (re, im), (im, -re), (-re, -im), (-im, re)           # times 1, -j, -1, j
    coefficients = [(power * turns[k % 4][0], power * turns[k % 4][1]) for k, power in enumerate(powers)]
    return Series.of(coefficients, abs(b) ** terms / factorial(terms) + error * sum(map(abs, powers)))


def hold(middle, half, sample_time, terms):
    """(1 - e^(-j w T))/(j w T) = sum over k < m of (-j b)^k/k! I_k y^k + r,  I_k = integral over x in [0, 1] of x^k e^(-j a x),
    a = middle T, b = half T, |r| <= b^m/m!;  I_k = sum over n of (-j a)^n/n!/(k + n + 1)"""
    a, b, bits = middle * sample_time, half * sample_time, PRECISION + 32
    powers = [Fraction(1)]
    while powers[-1] > Fraction(1, 1 << bits) or len(powers) < 2 * a:
        powers.append(rounded(powers[-1] * a / len(powers), bits))
    coefficients = []
    for k in range(terms):
        parts = [Fraction(0), Fraction(0)]
        for n, power in enumerate(powers):                      # (-j)^(k + n)
            parts[(k + n) % 2] += (1, -1, -1, 1)[(k + n) % 4] * power / (k + n + 1)
        coefficients.append(tuple(part * b**k / factorial(k) for part in parts))
    error = Fraction(8 * len(powers) ** 2, 1 << bits) * sum(b**k / factorial(k) for k in range(terms))
    return Series.of(coefficients, b**terms / factorial(terms) + error)


# Limits given as tables: W = W_1 (w/v_1)^alpha, alpha = ln(W_2/W_1)/ln(v_2/v_1)

def exponent(piece):
    """Two numbers that enclose alpha."""
    (v1, w1), (v2, w2) = piece
    rise, run = logarithm(w2 / w1), logarithm(v2 / v1)
    if run[0] <= 0:
        raise Malformed("two frequencies of a table are too close")
    quotients = [a / b for a in rise for b in run]
    return min(quotients), max(quotients)


def power_at(piece, alpha, w):
    """Two numbers that enclose W_1 (w/v_1)^alpha."""
    (v1, w1), _ = piece
    exponents = [a * b for a in alpha for b in logarithm(w / v1)]
    low, high = exponential(min(exponents), max(exponents))
    return w1 * low, w1 * high


def limit_at(table, w):
    for point in table:
        if point[0] == w:
            return point[1], point[1]
    piece = next(((a, b) for a, b in zip(table, table[1:]) if w is not None and a[0] <= w <= b[0]), None)
    if piece is None:
        raise Rejected("the table of the limit does not reach the frequency")
    return power_at(piece, exponent(piece), w)


def limit(table, start, end, terms):
    """With the middle w_m and half the width h of the panel, u = h/w_m:

    W = W_1 (w_m/v_1)^alpha (sum over k < m of C(alpha, k) u^k y^k + r),  |r| <= |C(alpha, m)| u^m/(1 - u max(1, (m + |alpha|)/(m + 1)))"""
    piece = next(((a, b) for a, b in zip(table, table[1:]) if a[0] <= start and end <= b[0]), None)
    if piece is None:
        raise Rejected("it lies across a point of the table")
    alpha, middle = exponent(piece), (start + end) / 2
    u, (low, high) = (end - start) / 2 / middle, power_at(piece, alpha, middle)
    centre, spread, greatest = sum(alpha) / 2, (alpha[1] - alpha[0]) / 2, max(map(abs, alpha))
    falling = 1 - u * max(Fraction(1), (terms + greatest) / (terms + 1))
    if falling <= 0:
        raise Rejected("it is too wide for the table of the limit")
    coefficient, error, coefficients, errors = Fraction(1), Fraction(0), [], Fraction(0)
    for k in range(terms):    # C(alpha, k + 1) u^(k + 1) = C(alpha, k) u^k (alpha - k) u/(k + 1)
        coefficients.append(coefficient)
        errors += error
        error = (error * (abs(centre - k) + spread) + abs(coefficient) * spread) * u / (k + 1)
        coefficient = rounded(coefficient * (centre - k) * u / (k + 1), 2 * PRECISION)
        error += Fraction(1, 1 << 2 * PRECISION)
    factor = (low + high) / 2
    remainder = high * (errors + (abs(coefficient) + error) / falling) + (high - low) / 2 * sum(map(abs, coefficients))
    return Series.of([(factor * value, Fraction(0)) for value in coefficients], remainder)


class Functions:
    """Products of the functions that a name stands for, on panels: "limit", and where a loop is sampled "hold", "turn" (e^(j w T)),
    "late" (E, where dead time depends on no variable), and sections, lists of coefficients of powers of zeta = e^(j w T) - 1."""

    def __init__(self, terms, table=None, sample_time=None, tau=None):
        self.terms, self.table, self.sample_time, self.tau = terms, table, sample_time, tau

    def on(self, start, end):
        """The product of a tuple of names on a panel."""
        if end is None:
            raise Rejected("it is not finite")
        middle, half = (start + end) / 2, (end - start) / 2

        @lru_cache(maxsize=None)
        def of(names):
            if len(names) > 1:
                return of(names[:-1]).times(of(names[-1:]), self.terms)
            name, *coefficients = names[0]
            if name == "limit":
                return limit(self.table, start, end, self.terms)
            if name == "hold":
                return hold(middle, half, self.sample_time, self.terms)
            if name == "turn":
                return turning(middle, half, -self.sample_time, self.terms)
            if name == "late":
                return turning(middle, half, self.tau, self.terms)
            zeta, section = of((("turn",),)).plus(-1), Series([(0, 0)], 0)
            for coefficient in coefficients:     # Horner's rule
                section = section.times(zeta, self.terms).plus(coefficient)
            return section
        return of
