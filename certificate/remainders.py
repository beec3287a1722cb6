"""Results of operations that are not polynomials: polynomials of x = 2 t - 1 with remainders, y = p(x) + r, |r| <= rest."""

import math
from fractions import Fraction

from arithmetic import (DIGIT, PRECISION, Malformed, Polynomial, axis, exponential, logarithm, number, rounded_up, spend,
                        total_degree)

LONGEST = 1200     # bits of a coefficient before it is rounded
KEPT = 256


class Model:
    def __init__(self, polynomial, rest, degree):
        """What exceeds the degree in total, and what is rounded where numbers become long, is remainder."""
        terms = {}
        for key, value in polynomial.terms.items():
            if total_degree(key) > degree:
                rest += Fraction(abs(value), polynomial.denominator)
            else:
                terms[key] = value
        denominator, longest = polynomial.denominator, max(map(abs, terms.values()), default=0)
        if longest and max(denominator, longest).bit_length() > LONGEST:
            shift = KEPT - longest.bit_length() + denominator.bit_length()
            over, under = (1 << shift, 1) if shift > 0 else (1, 1 << -shift)
            terms = {key: value * over // (denominator * under) * under for key, value in terms.items()}
            rest += Fraction(len(terms) * under, over)
            denominator = over
        self.polynomial, self.rest, self.degree = Polynomial(terms, denominator), rounded_up(rest), degree

    def size(self):
        """A bound on the magnitude of the polynomial, |x| <= 1."""
        return Fraction(sum(map(abs, self.polynomial.terms.values())), self.polynomial.denominator)

    def reach(self):
        """c and rho: y lies between c - rho and c + rho."""
        c = self.polynomial.constant()
        return c, self.size() - abs(c) + self.rest

    def __add__(self, other):
        return Model(self.polynomial + other.polynomial, self.rest + other.rest, self.degree)

    def __neg__(self):
        return Model(-self.polynomial, self.rest, self.degree)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        rest = self.size() * other.rest + other.size() * self.rest + self.rest * other.rest
        return Model(self.polynomial * other.polynomial, rest, self.degree)

    def expanded(self, coefficients, greatest):
        """sum over k <= d of f_k (y - c)^k + r, |r| <= rho^(d + 1) greatest |f_(d + 1)|; each f_k lies between two numbers."""
        c, rho = self.reach()
        z = self - Model(number(c), 0, self.degree)
        result, rest = Model(number(0), 0, self.degree), rho ** (self.degree + 1) * greatest
        for k, (low, high) in reversed(list(enumerate(coefficients))):
            middle = (low + high) / 2
            result, rest = result * z + Model(number(middle), 0, self.degree), rest + (high - low) / 2 * rho**k
        return Model(result.polynomial, result.rest + rest, self.degree)

    def in_t(self):
        """In the variables t, with the remainder."""
        result, mask = number(0), (1 << DIGIT) - 1
        for key, value in self.polynomial.terms.items():
            term = Polynomial({0: value}, self.polynomial.denominator)
            place = 1
            while key >> DIGIT * place:
                for _ in range(key >> DIGIT * place & mask):
                    term = term * (axis(place).times(2) - number(1))
                place += 1
            result = result + term
        result = result.reduced()
        result.rest = {0: self.rest} if self.rest else {}
        return result


def root_between(x):
    shift = max(0, 2 * PRECISION + 200 - x.numerator.bit_length() + x.denominator.bit_length()) // 2 * 2
    below = math.isqrt((x.numerator << shift) // x.denominator)
    exact = below * below * x.denominator == x.numerator << shift
    return Fraction(below, 1 << shift // 2), Fraction(below + (not exact), 1 << shift // 2)


def away_from_zero(y):
    c, rho = y.reach()
    if abs(c) <= rho:
        raise Malformed("an operation is not defined on the whole box")
    return c, rho


def above_zero(y):
    c, rho = y.reach()
    if c <= rho:
        raise Malformed("an operation is not defined on the whole box")
    return c, rho


def inverse(y):
    """f_k = (-1)^k/c^(k + 1)"""
    c, rho = away_from_zero(y)
    return y.expanded([((-1) ** k / c ** (k + 1),) * 2 for k in range(y.degree + 1)], 1 / (abs(c) - rho) ** (y.degree + 2))


def square_root(y):
    """f_k = C(1/2, k) c^(1/2 - k)"""
    c, rho = above_zero(y)
    low, high = root_between(c)
    coefficients, binomial = [], Fraction(1)
    for k in range(y.degree + 1):
        coefficients.append(sorted(binomial * x / c**k for x in (low, high)))
        binomial *= (Fraction(1, 2) - k) / (k + 1)
    least = c - rho
    return y.expanded(coefficients, abs(binomial) * root_between(least)[1] / least ** (y.degree + 1))


def exponential_of(y):
    """f_k = e^c/k!"""
    c, rho = y.reach()
    low, high = exponential(c, c)
    coefficients = [(low / math.factorial(k), high / math.factorial(k)) for k in range(y.degree + 1)]
    return y.expanded(coefficients, exponential(c + rho, c + rho)[1] / math.factorial(y.degree + 1))


def logarithm_of(y):
    """f_0 = ln c, f_k = -(-1)^k/(k c^k)"""
    c, rho = above_zero(y)
    coefficients = [logarithm(c)] + [(-((-1) ** k) / (k * c**k),) * 2 for k in range(1, y.degree + 1)]
    return y.expanded(coefficients, 1 / ((y.degree + 1) * (c - rho) ** (y.degree + 1)))


def mean(a, b):
    """Of two, where it is not known which one it is."""
    difference = Model(a.polynomial - b.polynomial, 0, a.degree)
    half = Model(number(Fraction(1, 2)), 0, a.degree)
    middle = Model(a.polynomial + b.polynomial, 0, a.degree) * half
    return Model(middle.polynomial, middle.rest + max(a.rest, b.rest) + (difference.size() + difference.rest) / 2, a.degree)


def magnitude(y):
    """Of y that takes both signs little: y, or -y, with what the other sign changes."""
    c, rho = y.reach()
    if abs(c) >= rho:
        return y if c >= 0 else -y
    own, middle = y if c >= 0 else -y, mean(y, -y)
    own = Model(own.polynomial, own.rest + 2 * (rho - abs(c)), y.degree)
    return own if own.rest < middle.rest else middle


def select(i, j, k, l):
    """k where i < j, else l; k and l are asked for only where they are needed."""
    c, rho = (j() - i()).reach()
    return k() if c > rho else l() if c <= -rho else mean(k(), l())


FUNCTIONS = {"negate": lambda a: -a, "add": lambda a, b: a + b, "subtract": lambda a, b: a - b, "multiply": lambda a, b: a * b,
             "divide": lambda a, b: a * inverse(b), "sqrt": square_root, "exp": exponential_of, "ln": logarithm_of, "abs": magnitude}


def parameter(entry, member, degree):
    """low + (high - low) t, or low (high/low)^t = root(low high) exp(x ln(high/low)/2)."""
    low, high, variable = (Fraction(x) if i < 2 else x for i, x in enumerate(entry[:3]))
    if variable is None:
        return Model(number(low), 0, degree)
    x = Model(axis(1 + variable) if member is None else number(2 * Fraction(member[variable]) - 1), 0, degree)
    if len(entry) == 3:
        return Model(number((low + high) / 2), 0, degree) + Model(number((high - low) / 2), 0, degree) * x
    below, above = logarithm(high / low)
    exponent = Model(number((below + above) / 4), (above - below) / 4, degree) * x
    below, above = root_between(low * high)
    return Model(number((below + above) / 2), (above - below) / 2, degree) * exponential_of(exponent)


def results(operations, box, member, degree):
    """What the operations give, in t; a function for each, which fails where the operation is not defined."""
    known = {}

    def needed(place):
        """Operations before a place that are not known yet are done in their order, so that nothing is too deep."""
        if place not in known:
            name, *operands = operations[place]
            spend(1)
            try:
                if name == "number":
                    known[place] = Model(number(operands[0]), 0, degree)
                elif name == "parameter":
                    known[place] = parameter(box[operands[0]], member, degree)
                elif name == "select":
                    known[place] = select(*((lambda i=i: needed(i)) for i in operands))
                else:
                    known[place] = FUNCTIONS[name](*(needed(i) for i in operands))
            except Malformed as problem:
                known[place] = problem
        if isinstance(known[place], Malformed):
            raise known[place]
        return known[place]

    def of(place):
        for i in range(place + 1):
            try:
                needed(i)
            except Malformed:
                pass
        return needed(place).in_t()
    return of
