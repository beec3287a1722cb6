"""Polynomials with rational coefficients, and functions of rational numbers enclosed by rational numbers."""

from fractions import Fraction
from math import gcd, lcm

DIGIT = 10                      # bits for the exponent of each axis in the key of a term
GREATEST_DEGREE = 480           # in total; sums of two of them still fit into the bits
GREATEST_BITS = 60_000          # of a coefficient
GREATEST_WORK = 1_000_000_000   # operations on coefficients in one file
PRECISION = 192                 # bits behind the point of what is enclosed


class Malformed(Exception):
    """The file is no certificate of this format, or asks for more than a checker computes."""


class Rejected(Exception):
    """A claim is not shown."""


work = 0


def spend(operations):
    """Counts work, so that no file keeps the checker busy without end."""
    global work
    work += operations
    if work > GREATEST_WORK:
        raise Malformed("it asks for more work than this checker does")


class Polynomial:
    """Real terms over one denominator. A term's key holds its exponents, DIGIT bits for each axis: axis 0 is the frequency (s,
    then x), axis 1 + i the variable i. Terms that cancel stay, with the coefficient 0, because they count for the degree; only the
    number zero has no term. With rest, the coefficient of s^i is known within rest[i]."""

    def __init__(self, terms, denominator=1, degree=None, rest=None):
        self.terms, self.denominator, self.rest = terms, denominator, rest or {}
        self.degree = max(map(total_degree, terms), default=0) if degree is None else degree
        if self.degree > GREATEST_DEGREE:
            raise Malformed(f"a polynomial has a degree above {GREATEST_DEGREE}")

    def __add__(self, other):
        if not self or not other:
            return self if self else other
        common = lcm(self.denominator, other.denominator)
        mine, theirs = common // self.denominator, common // other.denominator
        terms = {key: value * mine for key, value in self.terms.items()}
        for key, value in other.terms.items():
            terms[key] = terms.get(key, 0) + value * theirs
        spend(len(terms))
        rest = {i: self.rest.get(i, 0) + other.rest.get(i, 0) for i in {**self.rest, **other.rest}}
        return Polynomial(terms, common, max(self.degree, other.degree), rest)

    def __bool__(self):
        return bool(self.terms or self.rest)

    def __neg__(self):
        return Polynomial({key: -value for key, value in self.terms.items()}, self.denominator, self.degree, self.rest)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        spend(len(self.terms) * len(other.terms))
        terms = {}
        for mine, value in self.terms.items():
            for theirs, factor in other.terms.items():
                terms[mine + theirs] = terms.get(mine + theirs, 0) + value * factor
        product = Polynomial(terms, self.denominator * other.denominator, self.degree + other.degree)
        if self.rest or other.rest:      # |p| rest of q + |q| rest of p + rest of p rest of q
            for i, (p, more) in enumerate(self.sizes()):
                for k, (q, rest) in enumerate(other.sizes()):
                    product.rest[i + k] = product.rest.get(i + k, 0) + p * rest + q * more + more * rest
            product.rest = {i: rounded_up(rest) for i, rest in product.rest.items() if rest}
        longest = max(map(abs, terms.values()), default=0)
        if max(longest, product.denominator).bit_length() > GREATEST_BITS:
            raise Malformed("its numbers have too many digits")
        return product

    def times(self, factor):
        """The product with a number."""
        return self * number(factor)

    def reduced(self):
        common = gcd(self.denominator, *self.terms.values())
        return Polynomial({key: value // common for key, value in self.terms.items()}, self.denominator // common, self.degree, self.rest)

    def constant(self):
        return Fraction(self.terms.get(0, 0), self.denominator)

    def range(self):
        """The term without a variable with all negative coefficients, and with all positive ones."""
        others = [value for key, value in self.terms.items() if key]
        low, high = (self.terms.get(0, 0) + sum(sign(value, 0) for value in others) for sign in (min, max))
        return Fraction(low, self.denominator), Fraction(high, self.denominator)

    def along_frequency(self):
        """A list: for each power of the frequency the polynomial that it is multiplied by."""
        mask = (1 << DIGIT) - 1
        powers = [{} for _ in range(1 + max([-1, *(key & mask for key in self.terms), *self.rest]))]
        for key, value in self.terms.items():
            powers[key & mask][key & ~mask] = value
        return [Polynomial(terms, self.denominator, None, {0: self.rest[i]} if i in self.rest else {}) for i, terms in enumerate(powers)]

    def sizes(self):
        """For each power of the frequency a bound on the magnitude of its coefficient, and how well that is known."""
        return [(max(map(abs, p.range())), p.rest.get(0, Fraction(0))) for p in self.along_frequency()]

    def lowest(self):
        """The lowest power of the frequency."""
        mask = (1 << DIGIT) - 1
        return min([*(key & mask for key in self.terms), *self.rest])

    def over(self, power):
        """Divided by a power of the frequency that divides it."""
        return Polynomial({key - power: value for key, value in self.terms.items()}, self.denominator, None,
                          {i - power: rest for i, rest in self.rest.items()})


def total_degree(key):
    degree = 0
    while key:
        degree, key = degree + key % (1 << DIGIT), key >> DIGIT
    return degree


def number(x):
    assert not isinstance(x, float), "nothing here is rounded"
    x = Fraction(x)
    return Polynomial({0: x.numerator} if x else {}, x.denominator, 0)


def axis(i):
    """The variable of an axis."""
    return Polynomial({1 << DIGIT * i: 1})


def of_frequency(coefficients):
    """The polynomial of s with these polynomials of the variables as coefficients, the highest power first."""
    result, power = number(0), number(1)
    for coefficient in reversed(coefficients):
        result, power = result + coefficient * power, power * axis(0)
    return result


def rounded_up(x, bits=64):
    """A number not less than x >= 0, with about so many bits before its power of two."""
    if x == 0:
        return Fraction(0)
    shift = bits - x.numerator.bit_length() + x.denominator.bit_length()
    scale = Fraction(2) ** shift
    return -(-x * scale // 1) / scale


def rounded(x, bits):
    return Fraction((x.numerator << bits) // x.denominator, 1 << bits)


def turned(angle):
    """e^(-j angle): real part, imaginary part, and a bound on the magnitude of the error.

    The angle is halved h times, the series is summed until its terms are below 2^-bits, and the sum is squared h times. Each
    square doubles the error at most, up to its rounding: 3 covers both."""
    halvings = max(0, abs(angle).__ceil__().bit_length() + 2)
    bits = PRECISION + 2 * halvings + 24
    small = rounded(angle / 2**halvings, bits)
    real, imaginary, power, k = Fraction(1), Fraction(0), Fraction(1), 0
    while abs(power) > Fraction(1, 1 << bits):
        k += 1
        power = rounded(power * small / k, bits)
        if k % 2:
            imaginary += -power if k % 4 == 1 else power
        else:
            real += -power if k % 4 == 2 else power
    error = Fraction(4 * k + 8, 1 << bits)
    for _ in range(halvings):
        real, imaginary = rounded(real * real - imaginary * imaginary, bits), rounded(2 * real * imaginary, bits)
        error *= 3
    return real, imaginary, (error if angle else Fraction(0))


def pi():
    """Two numbers that enclose it: pi = 16 arctan(1/5) - 4 arctan(1/239), sums of alternating terms."""
    def arctan(k):
        total, i, unit = 0, 0, 1 << PRECISION + 24
        while unit // k ** (2 * i + 1):
            total, i = total + (-1) ** i * (unit // k ** (2 * i + 1) // (2 * i + 1)), i + 1
        return total, 2 * i + 2
    (a, more), (b, less) = arctan(5), arctan(239)
    middle, error = 16 * a - 4 * b, 16 * more + 4 * less
    return Fraction(middle - error, 1 << PRECISION + 24), Fraction(middle + error, 1 << PRECISION + 24)


def logarithm(x):
    """Two numbers that enclose ln x: with x = 2^k m, ln m = 2 (z + z^3/3 + z^5/5 + ...), z = (m - 1)/(m + 1)."""
    def of_mantissa(m):
        z, bits = (m - 1) / (m + 1), PRECISION + 24
        z = rounded(z, bits)
        total, power, i = Fraction(0), z, 1
        while abs(power) > Fraction(1, 1 << bits):
            total, power, i = total + rounded(power / i, bits), rounded(power * z * z, bits), i + 2
        return 2 * total, Fraction(8 * i + 16, 1 << bits)
    k = x.numerator.bit_length() - x.denominator.bit_length()
    (value, error), (two, error_of_two) = of_mantissa(x / Fraction(2) ** k), of_mantissa(Fraction(2))
    error = error + abs(k) * error_of_two if x != 1 else Fraction(0)
    return value + k * two - error, value + k * two + error


def exponential(low, high):
    """Two numbers that enclose e^x for x between two others: the series of x/2^h, squared h times."""
    def of(x):
        halvings = max(0, abs(x).__ceil__().bit_length() + 2)
        if halvings > 14:
            raise Malformed("an exponential is out of range")
        bits = PRECISION + 4 * halvings + 2 * abs(x).__ceil__() + 24
        small = rounded(x / 2**halvings, bits)
        total, power, k = Fraction(1), Fraction(1), 0
        while abs(power) > Fraction(1, 1 << bits):
            k += 1
            power = rounded(power * small / k, bits)
            total += power
        error = Fraction(4 * k + 8, 1 << bits)      # of the sum, which is between 1/2 and 2; from here on the relative one
        error *= 2
        for _ in range(halvings):
            total, error = rounded(total * total, bits), 3 * error + Fraction(2) ** (2 * abs(x).__ceil__() - bits)
        return total * (1 - error), total * (1 + error)
    return of(low)[0] if low else Fraction(1), of(high)[1] if high else Fraction(1)
