"""A panel of frequencies: control points of U and V over panel and box, and the tree of halves that shows |V| <= |U|."""

from fractions import Fraction
from math import comb, factorial, gcd, lcm

from arithmetic import DIGIT, PRECISION, Polynomial, Rejected, axis, number, rounded_up, spend, turned

GREATEST_DEPTH = 256
GREATEST_POINTS = 4_000_000
BITS = 320          # of a control point that is rounded


def on_panel(polynomial, start, end, degree, turned_by=1):
    """Real and imaginary part of a polynomial at s = j w, in x in place of w: w = w1 + (w2 - w1) x, or divided by w^degree,
    1/w = x/w1, on a panel to infinity. With turned_by = 0 at s = w."""
    mask = (1 << DIGIT) - 1
    highest = max((key & mask for key in polynomial.terms), default=0)
    common = lcm(start.denominator, 1 if end is None else end.denominator)
    low, width = int(start * common), int((end - start) * common) if end is not None else 0
    if end is not None:       # w^i = sum over l of C(i, l) low^(i - l) width^l x^l/common^i
        powers = [[(l, comb(i, l) * low ** (i - l) * width**l * common ** (highest - i)) for l in range(i + 1)]
                  for i in range(highest + 1)]
        denominator = common**highest
    else:         # w^(i - degree) = x^(degree - i) common^(degree - i)/low^(degree - i)
        powers = [[(degree - i, common ** (degree - i) * low**i)] for i in range(highest + 1)]
        denominator = low**degree
    parts = {}, {}
    for key, value in polynomial.terms.items():
        i = key & mask
        turns = i * turned_by % 4
        part, value = parts[turns % 2], -value if turns > 1 else value
        spend(len(powers[i]))
        for power, factor in powers[i]:
            place = key - i + power
            part[place] = part.get(place, 0) + value * factor
    return tuple(Polynomial(part, polynomial.denominator * denominator) for part in parts)


def axis_power(i, factor):
    return Polynomial({i: factor.numerator}, factor.denominator)


def complex_sum(a, b):
    return a[0] + b[0], a[1] + b[1]


def complex_product(a, b):
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def late_series(start, end, tau, angle, terms):
    """S and R: e^(-j w tau) = S + what is at most R, about an angle."""
    low, high = tau.range()
    greatest = max(abs(end * high - angle), abs(start * low - angle))
    remainder = rounded_up(greatest**terms / factorial(terms))
    delta = (number(start) + axis(0).times(end - start)) * tau - number(angle)
    series, power = (number(0), number(0)), number(1)
    for k in range(terms):        # (-j delta)^k/k!
        term = power.times(Fraction((1, -1, -1, 1)[k % 4], factorial(k)))
        series = complex_sum(series, (number(0), term) if k % 2 else (term, number(0)))
        power = power * delta
    real, imaginary, error = turned(angle)
    series, remainder = complex_product((number(real), number(imaginary)), series), remainder + error * (1 + remainder)
    remainder += Fraction(sum(len(p.terms) for p in series), 1 << BITS)
    return tuple(Polynomial({key: (value << BITS) // p.denominator for key, value in p.terms.items()}, 1 << BITS) for p in series), remainder


def degrees_of(polynomials, axes):
    mask, degrees = (1 << DIGIT) - 1, [0] * axes
    for polynomial in polynomials:
        for key in polynomial.terms:
            for i in range(axes):
                degrees[i] = max(degrees[i], key >> DIGIT * i & mask)
    return degrees


def strides_of(degrees):
    strides = [1]
    for degree in reversed(degrees[1:]):
        strides.insert(0, strides[0] * (degree + 1))
    return strides


def placed(polynomial, degrees, scale):
    """Coefficients a_i, times scale, times L/C(N, i) along each axis of degree N, L being the least common multiple of all C(N, i).
    Axis 0 varies slowest."""
    mask, strides = (1 << DIGIT) - 1, strides_of(degrees)
    size = strides[0] * (degrees[0] + 1)
    if size > GREATEST_POINTS:
        raise Rejected("it has more control points than this checker takes")
    factors = []
    for degree in degrees:
        common = lcm(*(comb(degree, i) for i in range(degree + 1)))
        factors.append([common // comb(degree, i) for i in range(degree + 1)])
    values, factor = [0] * size, scale // polynomial.denominator
    for key, value in polynomial.terms.items():
        place = 0
        for i, stride in enumerate(strides):
            power = key >> DIGIT * i & mask
            place += power * stride
            value *= factors[i][power]
        values[place] = value * factor
    return values


def summed(values, degrees):
    """b_k = sum over i <= k of C(k, i)/C(N, i) a_i along one axis after the other, by N (N + 1)/2 additions."""
    if not any(values):
        return values
    size = len(values)
    for degree, stride in zip(degrees, strides_of(degrees)):
        spend(size * (degree + 1) // 2)
        block = stride * (degree + 1)
        for begin in range(0, size, block):
            rows = [values[begin + i * stride:begin + (i + 1) * stride] for i in range(degree + 1)]
            for j in range(degree):
                for i in range(degree, j, -1):
                    rows[i] = [a + b for a, b in zip(rows[i], rows[i - 1])]
            values[begin:begin + block] = [value for row in rows for value in row]
    return values


def longest(lists):
    return max((max(max(values), -min(values)) for values in lists), default=0).bit_length()


def control_points(polynomials, degrees, scale, bits=None):
    """Control points times scale and times a positive number that depends on the degrees alone. Without bits they are exact.
    Otherwise they are divided by a power of two, so that about so many bits are left, and are too small by less than 2: coefficients
    are rounded down before they are summed, with weights whose sum is at most 2^(sum of the degrees)."""
    lists = [placed(p, degrees, scale) for p in polynomials]
    if bits is None:
        return [summed(values, degrees) for values in lists]
    guard = sum(degrees)
    shift = longest(lists) - bits - guard
    lists = [[value >> shift if shift > 0 else value << -shift for value in values] for values in lists]
    return [[value >> guard for value in summed(values, degrees)] for values in lists]


def halves(values, degree, stride):
    """Control points of both halves along an axis, times 2^degree: de Casteljau's rule."""
    if values is None:
        return None, None
    spend(len(values) * (degree + 1) // 2)
    lower, upper, block = [], [], stride * (degree + 1)
    for begin in range(0, len(values), block):
        rows = [values[begin + i * stride:begin + (i + 1) * stride] for i in range(degree + 1)]
        first, last = [], []
        for j in range(degree + 1):
            first.append([value << degree - j for value in rows[0]])
            last.append([value << degree - j for value in rows[-1]])
            rows = [[a + b for a, b in zip(rows[i], rows[i + 1])] for i in range(len(rows) - 1)]
        lower += [value for row in first for value in row]
        upper += [value for row in reversed(last) for value in row]
    return lower, upper


def leaf_shows(points, a, b):
    """x_k = a Re U_k + b Im U_k - (|a| + |b|) e_k > 0 and x_k^2 >= (a^2 + b^2) |V_k|^2 for every control point."""
    u_real, u_imaginary, v_real, v_imaginary, rest = points
    square, both = a * a + b * b, abs(a) + abs(b)
    distances = [a * re + b * im for re, im in zip(u_real, u_imaginary)]
    if rest:
        distances = [x - both * e for x, e in zip(distances, rest)]
    if min(distances) <= 0:
        return False
    if v_real is None:
        return True
    return all(x * x >= square * (re * re + im * im) for x, re, im in zip(distances, v_real, v_imaginary))


def examine(tree, bundles, five):
    """Reads a tree: every leaf must show the claim on its part of the box. A bundle is (degrees, lists of control points);
    `five` makes of the bundles of a part, and its interval of x, the five lists that a leaf needs. Gives the leaves: x from, x
    to, and the direction."""
    strides = [strides_of(degrees) for degrees, _ in bundles]
    place, leaves, waiting = 0, [], [([lists for _, lists in bundles], Fraction(0), Fraction(1), 0)]
    while waiting:
        lists, low, high, depth = waiting.pop()
        if place == len(tree):
            raise Rejected("the tree ends before every half is shown")
        code = tree[place]
        if code == 255:
            if place + 5 > len(tree):
                raise Rejected("the tree ends within a leaf")
            a, b = (int.from_bytes(tree[place + i:place + i + 2], "big", signed=True) for i in (1, 3))
            spend(2 * len(lists[0][0]))
            if not leaf_shows(five(lists, low, high), a, b):
                raise Rejected(f"leaf {len(leaves) + 1} does not show the claim")
            leaves.append((low, high, a, b))
            place += 5
            continue
        if code >= len(strides[0]):
            raise Rejected(f"the tree halves axis {code}, and there are {len(strides[0])}")
        if depth == GREATEST_DEPTH:
            raise Rejected(f"the tree is deeper than {GREATEST_DEPTH}")
        both = [[halves(values, degrees[code], steps[code]) for values in part]
                for (degrees, _), steps, part in zip(bundles, strides, lists)]
        middle = (low + high) / 2 if code == 0 else None
        for i, ends in ((1, (middle, high)), (0, (low, middle))):
            waiting.append(([[pair[i] for pair in part] for part in both], *(ends if code == 0 else (low, high)), depth + 1))
        place += 1
    if place != len(tree):
        raise Rejected("the tree goes on behind its last leaf")
    return leaves


class Loop:
    """What U and V of a claim depend on besides themselves: dead time, the number of axes, terms of series, functions of w, and the
    images of a sampled plant."""

    def __init__(self, tau, variables, terms, functions=None, images=None):
        self.tau, self.axes, self.terms, self.functions, self.images = tau, 1 + variables, terms, functions, images


def show(panel, u, v, loop):
    """Shows |V| <= |U| and U not zero on a panel; gives the leaves. u and v are sums: {(late, image, functions of w): polynomial of
    s and the variables}. A part with an image is multiplied by R or R'.

    U = Ua + Ub E and V = Va + Vb E with E = e^(-j w tau) as the panel says. What is left over counts in e_k: a pair (r, Q) adds
    r (|Re Q_k| + |Im Q_k|)."""
    start, end = panel["from"], panel["to"]
    of_names = loop.functions.on(start, end) if loop.functions else None
    degree = max([len(polynomial.along_frequency()) for whole in (u, v) for polynomial in whole.values()], default=1) - 1
    sums = {"": [[(number(0), number(0))] * 2, [(number(0), number(0))] * 2, []]}
    for side, whole in enumerate((u, v)):
        for (late, image, names), polynomial in whole.items():
            parts = sums.setdefault(image, [[(number(0), number(0))] * 2, [(number(0), number(0))] * 2, []])
            term, series = on_panel(polynomial, start, end, degree), of_names(names) if names else None
            if polynomial.rest:
                rest = sum((axis_power(i, rest) for i, rest in polynomial.rest.items()), number(0))
                parts[2].append((series.greatest() if names else Fraction(1), on_panel(rest, start, end, degree, 0)))
            if names:
                parts[2].append((Fraction(series.remainder, 1 << PRECISION), term))
                term = complex_product(term, series.in_x())
            parts[side][late] = complex_sum(parts[side][late], term)
    turned_by = way_of(panel, loop)
    shown, every = {}, []
    for image, ((ua, ub), (va, vb), rest) in sums.items():
        (shown_u, u_left), (shown_v, v_left), remainder = *(turned_by[0](a, b) for a, b in ((ua, ub), (va, vb))), turned_by[1]
        rest = [(rounded_up(r), pair) for r, pair in (*rest, (remainder, u_left), (remainder, v_left)) if r and (pair[0].terms or pair[1].terms)]
        shown[image] = shown_u, shown_v, rest
        every += [p for pair in (ua, ub, va, vb, shown_u, shown_v, *(pair for _, pair in rest)) for p in pair]
    degrees = degrees_of(every, loop.axes)
    bundles = tensors(shown, degrees)
    if len(bundles) == 1:
        return examine(panel["tree"], [(degrees, bundles[""])], lambda lists, low, high: lists[0])
    kinds = [image for image in shown if image]
    images, enclosed = loop.images.on(panel, kinds, loop)

    def five(lists, low, high):
        return with_images(lists[0], [(products, *enclosed(kind, lists[1 + len(kinds):], start + high * (end - start)))
                                      for kind, products in zip(kinds, lists[1:])])
    return examine(panel["tree"], [(degrees, bundles[image]) for image in ("", *kinds)] + images, five)


def way_of(panel, loop):
    """How dead time is taken: a function that gives of Ua and Ub what is shown and what the remainder multiplies, and R."""
    late, tau, nothing = panel["late"], loop.tau, (number(0), number(0))
    if not tau.terms:
        if late is not None:
            raise Rejected("it says how dead time is taken, and there is none")
        return lambda a, b: (a, nothing), Fraction(0)
    if late is None:
        raise Rejected("it does not say how dead time is taken")
    if late == "less":
        return lambda a, b: (a, b), Fraction(1)
    if panel["to"] is None:
        raise Rejected("to infinity dead time is taken as less")
    if late == "more":
        return lambda a, b: (b, a), Fraction(1)
    series, remainder = late_series(panel["from"], panel["to"], tau, late, loop.terms)
    return lambda a, b: (complex_sum(a, complex_product(b, series)), b), remainder


def tensors(shown, degrees):
    """For each image (none, R, R') five lists of control points, whole numbers with a common factor. Where anything remains they
    are rounded, and e_k holds that too."""
    every = [p for u, v, rest in shown.values() for pair in (u, v, *(pair for _, pair in rest)) for p in pair]
    scale, bundles = lcm(*(p.denominator for p in every)), {}
    exact = len(shown) == 1 and len(every) == 4
    points = iter(control_points(every, degrees, scale, None if exact else BITS))
    for image, (_, v, rest) in shown.items():
        lists = [next(points) for _ in range(4)]
        if not (v[0].terms or v[1].terms) and len(shown) == 1:
            lists[2:] = None, None
        bounds = None if exact else [8] * len(lists[0])
        for r, _ in rest:
            a, b = r.numerator, r.denominator
            bounds = [e - -a * (abs(re) + abs(im) + 4) // b for e, re, im in zip(bounds, next(points), next(points))]
        bundles[image] = [*lists, bounds]
    if exact:
        common = gcd(*(value for values in lists if values for value in values)) or 1
        return {image: [values and [value // common for value in values] for values in lists] + [None]}
    return bundles


def with_images(points, images):
    """U_k + alpha M_k, V_k likewise, and e_k + rho (|Re M_k| + |Im M_k|) + (|alpha| + rho) (what remains of M_k): all times 2^q."""
    every = [x for _, alpha, rho in images for x in (*alpha, rho) if x]
    q = 96 + max([0, *(x.denominator.bit_length() - x.numerator.bit_length() for x in every)])
    points = [[x << q for x in values] for values in points]
    for products, alpha, rho in images:
        a, b = (int(x * 2**q // 1) for x in alpha)
        r = int(rho * 2**q) + 3                   # with the roundings of a and b
        both = abs(a) + abs(b) + r
        for i in (0, 2):
            re, im = products[i:i + 2]
            points[i] = [x + a * c - b * d for x, c, d in zip(points[i], re, im)]
            points[i + 1] = [x + a * d + b * c for x, c, d in zip(points[i + 1], re, im)]
        points[4] = [e + r * sum(map(abs, parts)) + both * more for e, more, *parts in zip(points[4], products[4], *products[:4])]
    return points
