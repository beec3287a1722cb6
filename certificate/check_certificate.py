"""Checks a certificate of phea a second time, in exact rational arithmetic.

    python3 certificate/check_certificate.py FILE

Reads the format of book/src/guide/certificate.md, from which alone it was written, and needs nothing but Python 3.11. Exit
status 0: every claim holds, and is printed; 1: a claim is rejected; 2: the file is no certificate of a known version.
Cosines, sines, logarithms and powers are enclosed by rational numbers; all else is exact.
"""

import math
import sys
from fractions import Fraction

import arithmetic
from arithmetic import Malformed, Polynomial, Rejected, axis, exponential, logarithm, number, of_frequency, turned
from layout import LAWS, need, read, read_certificate
from panels import show

ONE = number(1)
GREATEST_FILE = 50_000_000      # bytes


# The plant

def results(operations, parameters):
    """What the operations give, polynomials in the variables."""
    done = []
    for name, *operands in operations:
        if name == "number":
            result = number(operands[0])
        elif name == "parameter":
            result = parameters[operands[0]]
        else:
            a, b = done[operands[0]], done[operands[-1]]
            if name == "divide":
                need(b.terms.keys() == {0} and b.constant() != 0, "a divisor depends on a variable, or is zero")
                result = a.times(1 / b.constant())
            else:
                result = {"negate": lambda: -a, "add": lambda: a + b, "subtract": lambda: a - b, "multiply": lambda: a * b}[name]()
        done.append(result.reduced())
    return done


def plant_over(file, box, member=None):
    """N, D, Nd, Dd and tau over a box, or of one of its members, whose parameters are numbers."""
    parameters = []
    for low, high, variable in file["boxes"][box]:
        t = number(0) if variable is None else axis(1 + variable) if member is None else number(member[variable])
        parameters.append(number(low) + number(Fraction(high) - low) * t)
    done = results(file["operations"], parameters)
    plant = {key: of_frequency([done[i] for i in places]) for key, places in file["plant"].items() if key != "dead_time"}
    need(plant["denominator"].terms, "the denominator of the plant is zero")
    plant["tau"] = number(file["delay"]) + (done[file["plant"]["dead_time"]] if "dead_time" in file["plant"] else number(0))
    return plant


# From a claim to U and V: sums {(late, functions of w): polynomial of s and the variables}

def part(polynomial, late=0, names=()):
    return {(late, names): polynomial} if polynomial.terms else {}


def plus(a, b):
    return {key: a.get(key, number(0)) + b.get(key, number(0)) for key in {**a, **b}}


def times(*factors):
    product = part(ONE)
    for factor in factors:
        sums = {}
        for (late, names), a in product.items():
            for (later, more), b in factor.items():
                sums = plus(sums, {(late + later, tuple(sorted(names + more))): a * b})
        product = sums
    return product


def laws(file, plant):
    loop = {name: part(plant[key]) for name, key in (("N", "numerator"), ("D", "denominator"), ("Nd", "disturbance_numerator"),
                                                      ("Dd", "disturbance_denominator")) if key in plant}
    for name, law in zip("GFH", LAWS):
        loop[name + "n"], loop[name + "d"] = map(part, file[law])
    late = part(ONE, 1 if plant["tau"].terms else 0)
    n, c = times(loop["N"], loop["Gn"], loop["Hn"]), times(loop["D"], loop["Gd"], loop["Hd"])
    return {**loop, "n": n, "c": c, "nE + c": plus(times(n, late), c)}


def closed_loop(claim, file, plant):
    """U and V of `limited` and `reached`, without the powers of s that divide all their parts."""
    loop = laws(file, plant)
    wn, wd = (part(ONE, 0, ("limit",)), part(ONE)) if type(claim["limit"]) is dict else map(part, claim["limit"])
    ratio, f, name = part(number(claim["ratio"])), loop["nE + c"], claim["closed_loop"]

    def of(names):
        return times(*(loop[key] for key in names.split()))
    u = times(ratio, wn, f)
    if name == "tracking":
        u, v = times(u, loop["Fd"]), times(wd, of("Fn N Gn Hd"))
        if claim["side"] == "lower":
            u, v = times(ratio, v), times(wn, f, loop["Fd"])
    elif name == "load_motion":
        same = file["plant"]["denominator"] == file["plant"]["disturbance_denominator"]
        u, v = (u, times(wd, of("Nd Gd Hd"))) if same else (times(u, loop["Dd"]), times(wd, of("Nd c")))
    else:
        v = times(wd, of({"robust_stability": "n", "sensitivity": "c", "plant_input_disturbance": "N Gd Hd", "control_effort": "Gn D Hd"}[name]))
    mask = 1023
    lowest = min((key & mask for polynomial in (*u.values(), *v.values()) for key in polynomial.terms), default=0)
    return [{key: Polynomial({place - lowest: value for place, value in polynomial.terms.items()}, polynomial.denominator)
             for key, polynomial in whole.items()} for whole in (u, v)]


# Limits given as tables: W = W_1 (w/v_1)^alpha, alpha = ln(W_2/W_1)/ln(v_2/v_1)

def exponent(piece):
    """Two numbers that enclose alpha."""
    (v1, w1), (v2, w2) = piece
    rise, run = logarithm(w2 / w1), logarithm(v2 / v1)
    need(run[0] > 0, "two frequencies of a table are too close")
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


def limit_series(table, terms):
    """For each panel W as a polynomial of x with a remainder: with the middle w_m, half the width h, u = h/w_m, w = w_m + h y

    W = W_1 (w_m/v_1)^alpha (sum over k < m of C(alpha, k) u^k y^k + r),  |r| <= |C(alpha, m)| u^m/(1 - u max(1, (m + |alpha|)/(m + 1)))"""
    def on(panel):
        start, end = panel["from"], panel["to"]
        piece = next(((a, b) for a, b in zip(table, table[1:]) if a[0] <= start and end is not None and end <= b[0]), None)
        if piece is None:
            raise Rejected("a panel lies across a point of the table")
        alpha, middle = exponent(piece), (start + end) / 2
        u, (low, high) = (end - start) / 2 / middle, power_at(piece, alpha, middle)
        centre, spread = sum(alpha) / 2, (alpha[1] - alpha[0]) / 2
        greatest = max(map(abs, alpha))
        falling = 1 - u * max(Fraction(1), (terms + greatest) / (terms + 1))
        if falling <= 0:
            raise Rejected("a panel is too wide for the table of the limit")
        y, series, power = axis(0).times(2) - ONE, number(0), ONE
        coefficient, error, remainder, total = Fraction(1), Fraction(0), Fraction(0), Fraction(0)
        for k in range(terms):    # C(alpha, k + 1) u^(k + 1) = C(alpha, k) u^k (alpha - k) u/(k + 1)
            series, remainder, total = series + power.times(coefficient), remainder + error, total + abs(coefficient)
            power = power * y
            error = (error * (abs(centre - k) + spread) + abs(coefficient) * spread) * u / (k + 1)
            coefficient *= (centre - k) * u / (k + 1)
        remainder += (abs(coefficient) + error) / falling
        factor = (low + high) / 2
        return (series.times(factor), number(0)), high * remainder + (high - low) / 2 * total
    return lambda panel: lambda names: on(panel)


# The claims

def cover(panels, start, end):
    if panels[0]["from"] != start or panels[-1]["to"] != end:
        raise Rejected("the panels do not reach from one end of the band to the other")
    if any(a["to"] != b["from"] for a, b in zip(panels, panels[1:])):
        raise Rejected("a panel does not begin where the one before ends")


def show_all(panels, u, v, tau, variables, file, functions=None):
    for panel in panels:
        try:
            show(panel, u, v, tau, 1 + variables, file["terms"], functions or (lambda _: None))
        except Rejected as reason:
            raise Rejected(f"the panel from {float(panel['from']):g} rad/s: {reason}") from None


def roots_on_the_left(polynomial):
    """All entries of the first column of the Routh array have the sign of the leading coefficient, strictly."""
    coefficients = [coefficient.constant() for coefficient in reversed(polynomial.along_frequency())]
    if not coefficients or coefficients[0] == 0:
        raise Rejected("a leading coefficient is zero")
    above, row = ([x / coefficients[0] for x in coefficients[i::2]] for i in range(2))
    for _ in coefficients[1:]:
        if row[0] <= 0:
            return False
        row += [Fraction(0)] * (len(above) - len(row))
        above, row = row, [a - above[0] / row[0] * b for a, b in zip(above[1:], row[1:])]
    return True


def check_stable(claim, file):
    for box, entry in enumerate(claim["boxes"]):
        member = plant_over(file, box, entry["member"])
        loop = laws(file, member)
        characteristic = sum((*loop["n"].values(), *loop["c"].values()), number(0))
        if not roots_on_the_left(characteristic):
            raise Rejected(f"the member of box {box} is not stable")
        if not roots_on_the_left(file["prefilter"][1]):
            raise Rejected("the prefilter is not stable")
        plant = plant_over(file, box)
        cover(entry["panels"], 0, None)
        show_all(entry["panels"], laws(file, plant)["nE + c"], {}, plant["tau"], file["variables"], file)
        if "delays" in entry:     # v tau in place of tau
            member["tau"] = member["tau"] * axis(1)
            cover(entry["delays"], 0, None)
            show_all(entry["delays"], laws(file, member)["nE + c"], {}, member["tau"], 1, file)
    return "every plant of the box is stable in the loop"


def check_unstable(claim, file):
    loop = laws(file, plant_over(file, claim["box"], claim["member"]))
    late = "dead_time" in file["plant"] or file["delay"] != 0
    of_loop = not late and not roots_on_the_left(sum((*loop["n"].values(), *loop["c"].values()), number(0)))
    if not of_loop and roots_on_the_left(file["prefilter"][1]):
        raise Rejected("it is not shown that the plant is unstable in the loop")
    return "a plant of the box is not stable in the loop"


def sentence(claim, words):
    names = (claim["closed_loop"] + " over its limit", "lower limit over tracking")
    return f"{names[claim['side'] == 'lower']} is at {words[0]} {20 * math.log10(claim['ratio']):+.4f} dB {words[1]}"


def check_limited(claim, file):
    band, functions = claim["band"], None
    if type(claim["limit"]) is dict:
        table = claim["limit"]["table"]
        band = [max(band[0], table[0][0]), table[-1][0] if band[1] is None else min(band[1], table[-1][0])]
        functions = limit_series(table, file["terms"])
        if band[0] >= band[1]:
            raise Rejected("the table of the limit does not reach the band")
    for box, panels in enumerate(claim["boxes"]):
        cover(panels, *band)
        plant = plant_over(file, box)
        show_all(panels, *closed_loop(claim, file, plant), plant["tau"], file["variables"], file, functions)
    return sentence(claim, ("most", "for every plant and every frequency of the band"))


def value_at(whole, w, limit, turn):
    """Real and imaginary part at s = j w, and a bound on the error of each."""
    total = [Fraction(0)] * 3
    for (late, names), polynomial in whole.items():
        z = [Fraction(0)] * 3
        for i, coefficient in enumerate(polynomial.along_frequency()):
            z[i % 2] += (-1) ** (i // 2) * coefficient.constant() * w**i
        for value, error in [((limit[0] + limit[1]) / 2, (limit[1] - limit[0]) / 2)] * len(names):
            z = [z[0] * value, z[1] * value, (abs(z[0]) + abs(z[1])) * error]
        if late:
            z = [z[0] * turn[0] - z[1] * turn[1], z[0] * turn[1] + z[1] * turn[0], z[2] + (abs(z[0]) + abs(z[1]) + z[2]) * turn[2]]
        total = [a + b for a, b in zip(total, z)]
    return total


def root(x):
    """Two numbers that enclose the root of x."""
    shift = max(0, 400 - x.numerator.bit_length() + x.denominator.bit_length()) // 2 * 2
    below = math.isqrt((x.numerator << shift) // x.denominator)
    return Fraction(below, 1 << shift // 2), Fraction(below + 1, 1 << shift // 2)


def reached_at_infinity(u, v):
    """|Va_d| - e >= |Ua_d| + e and |Va_d| > e with e = |Ub_d| + |Vb_d|."""
    powers = [{late: p.along_frequency() for (late, _), p in whole.items()} for whole in (u, v)]
    degree = max(len(p) for whole in powers for p in whole.values()) - 1
    (ua, ub), (va, vb) = ([abs(p[degree].constant()) if degree < len(p := whole.get(late, ())) else 0 for late in (0, 1)]
                          for whole in powers)
    return va - ub - vb >= ua + ub + vb and va > ub + vb


def check_reached(claim, file):
    w, (start, end), table = claim["frequency"], claim["band"], type(claim["limit"]) is dict
    if end is not None if w is None else w < start or end is not None and w > end:
        raise Rejected("the frequency lies outside of the band")
    plant = plant_over(file, claim["box"], claim["member"])
    tau = plant["tau"].constant()
    if tau < 0:
        raise Rejected("the dead time is negative")
    u, v = closed_loop(claim, file, plant)
    if w is None:
        if table:
            raise Rejected("the table of the limit does not reach the frequency")
        reached = reached_at_infinity(u, v)
    else:
        limit, turn = limit_at(claim["limit"]["table"], w) if table else (Fraction(1),) * 2, turned(w * tau)
        (*u, error_of_u), (*v, error_of_v) = (value_at(whole, w, limit, turn) for whole in (u, v))
        square_of_u, square_of_v = (re * re + im * im for re, im in (u, v))
        error = 2 * (error_of_u + error_of_v)
        if error:
            reached = root(square_of_v)[0] - error >= root(square_of_u)[1]
        else:
            reached = square_of_v >= square_of_u and square_of_v > 0
    if not reached:
        raise Rejected("the ratio is not reached")
    place = "at infinite frequency" if w is None else f"at {float(w):g} rad/s"
    return sentence(claim, ("least", f"with a plant of the box {place}"))


CHECKS = {"stable": check_stable, "unstable": check_unstable, "limited": check_limited, "reached": check_reached}


def check(text):
    """The exit status, and what is said: a sentence for each claim, the last one about the file."""
    arithmetic.work, told = 0, []
    try:
        file = read_certificate(read(text))
        told.append(file["title"])
        if not file["claims"]:
            raise Rejected("The certificate is rejected: it makes no claim")
        for i, claim in enumerate(file["claims"], 1):
            try:
                told.append(f"  holds: {CHECKS[claim['claim']](claim, file)}")
            except Rejected as reason:
                raise Rejected(f"The certificate is rejected at claim {i}, {claim['claim']}: {reason}") from None
    except Malformed as problem:
        return 2, [*told, f"No certificate that can be checked: {problem}."]
    except Rejected as reason:
        return 1, [*told, f"{reason}."]
    return 0, [*told, f"Every claim holds: {len(file['claims'])}."]


def main():
    if len(sys.argv) != 2:
        print("usage: python3 check_certificate.py FILE", file=sys.stderr)
        return 2
    try:
        with open(sys.argv[1], "rb") as certificate:
            data = certificate.read(GREATEST_FILE + 1)
        if len(data) > GREATEST_FILE:
            raise ValueError("the file is too long")
        status, told = check(data.decode())
    except (OSError, ValueError) as problem:
        status, told = 2, [f"No certificate that can be checked: {problem}."]
    print("\n".join(told))
    return status


if __name__ == "__main__":
    sys.exit(main())
