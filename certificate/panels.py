"""A panel of frequencies: control points of U and V over panel and box, and the tree of halves that shows |V| <= |U|."""

from fractions import Fraction
from math import comb, factorial, gcd, lcm

from arithmetic import DIGIT, Polynomial, Rejected, axis, number, rounded_up, spend, turned

GREATEST_DEPTH = 256
GREATEST_POINTS = 4_000_000


def on_panel(polynomial, start, end, degree):
    """Real and imaginary part of a polynomial at s = j w, in x in place of w: w = w1 + (w2 - w1) x, or divided by w^degree,
    1/w = x/w1, on a panel to infinity."""
    mask = (1 << DIGIT) - 1
    highest = max((key & mask for key in polynomial.terms), default=0)
    common = lcm(start.denominator, end.denominator if end else 1)
    low, width = int(start * common), int((end - start) * common) if end else 0
    if end:       # w^i = sum over l of C(i, l) low^(i - l) width^l x^l/common^i
        powers = [[(l, comb(i, l) * low ** (i - l) * width**l * common ** (highest - i)) for l in range(i + 1)]
                  for i in range(highest + 1)]
        denominator = common**highest
    else:         # w^(i - degree) = x^(degree - i) common^(degree - i)/low^(degree - i)
        powers = [[(degree - i, common ** (degree - i) * low**i)] for i in range(highest + 1)]
        denominator = low**degree
    parts = {}, {}
    for key, value in polynomial.terms.items():
        i = key & mask
        part, value = parts[i % 2], -value if i % 4 > 1 else value
        spend(len(powers[i]))
        for power, factor in powers[i]:
            place = key - i + power
            part[place] = part.get(place, 0) + value * factor
    return tuple(Polynomial(part, polynomial.denominator * denominator) for part in parts)


def complex_sum(a, b):
    return a[0] + b[0], a[1] + b[1]


def complex_product(a, b):
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def late_series(start, end, tau, angle, terms):
    """S and R: e^(-j w tau) = S + what is at most R, about an angle."""
    low, high = tau.range()
    if low < 0:
        raise Rejected("the dead time is not shown to be positive on the whole box")
    greatest = max(abs(end * high - angle), abs(start * low - angle))
    remainder = rounded_up(greatest**terms / factorial(terms))
    delta = (number(start) + axis(0).times(end - start)) * tau - number(angle)
    series, power = (number(0), number(0)), number(1)
    for k in range(terms):        # (-j delta)^k/k!
        term = power.times(Fraction((1, -1, -1, 1)[k % 4], factorial(k)))
        series = complex_sum(series, (number(0), term) if k % 2 else (term, number(0)))
        power = power * delta
    real, imaginary, error = turned(angle)
    return complex_product((number(real), number(imaginary)), series), remainder + error * (1 + remainder)


def degrees_of(polynomials, axes):
    mask, degrees = (1 << DIGIT) - 1, [0] * axes
    for polynomial in polynomials:
        for key in polynomial.terms:
            for i in range(axes):
                degrees[i] = max(degrees[i], key >> DIGIT * i & mask)
    return degrees


def control_points(polynomial, degrees, scale):
    """Control points times scale and times a positive number that depends on the degrees alone. Axis 0 varies slowest.

    Along an axis of degree N: b_k = sum over i <= k of C(k, i)/C(N, i) a_i, by N (N + 1)/2 additions."""
    mask, strides, size = (1 << DIGIT) - 1, [], 1
    for degree in reversed(degrees):
        strides.insert(0, size)
        size *= degree + 1
    if size > GREATEST_POINTS:
        raise Rejected("a panel has more control points than this checker takes")
    factor = scale // polynomial.denominator
    factors = []
    for degree in degrees:
        common = lcm(*(comb(degree, i) for i in range(degree + 1)))
        factors.append([common // comb(degree, i) for i in range(degree + 1)])
    values = [0] * size
    for key, value in polynomial.terms.items():
        place = 0
        for i, stride in enumerate(strides):
            power = key >> DIGIT * i & mask
            place += power * stride
            value *= factors[i][power]
        values[place] = value * factor
    if polynomial.terms:
        for degree, stride in zip(degrees, strides):
            spend(size * (degree + 1) // 2)
            block = stride * (degree + 1)
            for begin in range(0, size, block):
                rows = [values[begin + i * stride:begin + (i + 1) * stride] for i in range(degree + 1)]
                for j in range(degree):
                    for i in range(degree, j, -1):
                        rows[i] = [a + b for a, b in zip(rows[i], rows[i - 1])]
                values[begin:begin + block] = [value for row in rows for value in row]
    return values


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


def examine(tree, points, degrees):
    """Reads a tree: every leaf must show the claim on its part of the box. Gives the number of leaves."""
    strides = [1]
    for degree in reversed(degrees[1:]):
        strides.insert(0, strides[0] * (degree + 1))
    place, leaves, waiting = 0, 0, [(points, 0)]
    while waiting:
        points, depth = waiting.pop()
        if place == len(tree):
            raise Rejected("the tree ends before every half is shown")
        code = tree[place]
        if code == 255:
            if place + 5 > len(tree):
                raise Rejected("the tree ends within a leaf")
            a, b = (int.from_bytes(tree[place + i:place + i + 2], "big", signed=True) for i in (1, 3))
            spend(2 * len(points[0]))
            if not leaf_shows(points, a, b):
                raise Rejected(f"leaf {leaves + 1} does not show the claim")
            place, leaves = place + 5, leaves + 1
            continue
        if code >= len(degrees):
            raise Rejected(f"the tree halves axis {code}, and there are {len(degrees)}")
        if depth == GREATEST_DEPTH:
            raise Rejected(f"the tree is deeper than {GREATEST_DEPTH}")
        both = [halves(values, degrees[code], strides[code]) for values in points]
        waiting += [([upper for _, upper in both], depth + 1), ([lower for lower, _ in both], depth + 1)]
        place += 1
    if place != len(tree):
        raise Rejected("the tree goes on behind its last leaf")
    return leaves


def show(panel, u, v, tau, axes, terms, functions):
    """Shows |V| <= |U| and U not zero on a panel. u and v are sums: {(late, functions): polynomial of s and the variables}.

    U = Ua + Ub E and V = Va + Vb E with e^(-j w tau) as the panel says. What is left over counts in e_k: a pair (r, Q) adds
    r (|Re Q_k| + |Im Q_k|)."""
    start, end, late = panel["from"], panel["to"], panel["late"]
    with_functions = functions(panel)
    degree = degrees_of([polynomial for part in (u, v) for polynomial in part.values()], 1)[0]
    rest, parts = [], []
    for whole in (u, v):
        sums = [(number(0), number(0)), (number(0), number(0))]
        for (is_late, names), polynomial in whole.items():
            term = on_panel(polynomial, start, end, degree)
            if names:
                series, remainder = with_functions(names)
                rest.append((remainder, term))
                term = complex_product(term, series)
            sums[is_late] = complex_sum(sums[is_late], term)
        parts.append(sums)
    (ua, ub), (va, vb) = parts
    if tau.terms:
        if tau.range()[0] < 0:
            raise Rejected("the dead time is not shown to be positive on the whole box")
        if late is None:
            raise Rejected("it does not say how dead time is taken")
        if late == "less" or end is None:
            if late != "less":
                raise Rejected("to infinity dead time is taken as less")
            shown_u, shown_v, left_over, remainder = ua, va, (ub, vb), Fraction(1)
        elif late == "more":
            shown_u, shown_v, left_over, remainder = ub, vb, (ua, va), Fraction(1)
        else:
            series, remainder = late_series(start, end, tau, late, terms)
            shown_u = complex_sum(ua, complex_product(ub, series))
            shown_v = complex_sum(va, complex_product(vb, series))
            left_over = ub, vb
        rest += [(remainder, part) for part in left_over]
    else:
        if late is not None:
            raise Rejected("it says how dead time is taken, and there is none")
        shown_u, shown_v = ua, va
    degrees = degrees_of([p for pair in (ua, ub, va, vb, shown_u, shown_v) for p in pair], axes)
    rest = [(rounded_up(r), pair) for r, pair in rest if r and (pair[0].terms or pair[1].terms)]
    return examine(panel["tree"], tensors(shown_u, shown_v, rest, degrees), degrees)


def tensors(u, v, rest, degrees):
    """The five lists of control points, whole numbers with a common factor."""
    factors = lcm(1, *(r.denominator for r, _ in rest))
    scale = lcm(*(p.denominator for pair in (u, v, *(pair for _, pair in rest)) for p in pair))
    points = [control_points(p, degrees, scale * factors) for p in u]
    points += [control_points(p, degrees, scale * factors) for p in v] if v[0].terms or v[1].terms else [None, None]
    bounds = None
    for r, pair in rest:
        factor = int(r * factors)
        both = zip(*(control_points(p, degrees, scale) for p in pair))
        added = [factor * (abs(re) + abs(im)) for re, im in both]
        bounds = [a + b for a, b in zip(bounds, added)] if bounds else added
    points.append(bounds)
    common = gcd(*(value for values in points if values for value in values)) or 1
    return [values and [value // common for value in values] for values in points]
