"""Checks a certificate of phea a second time, in exact rational arithmetic.

    python3 certificate/check_certificate.py FILE

Reads the format of book/src/guide/certificate.md, from which alone it was written, and needs nothing but Python 3.11. Exit
status 0: every claim holds, and is printed; 1: a claim is rejected; 2: the file is not a certificate of a known version.
Polynomial loops without dead time are checked in whole numbers throughout, and nothing is rounded. Cosines, sines, roots,
exponentials and logarithms are enclosed by rational numbers; where one is used, control points keep 320 bits, and the
omitted part is added to e_k.

arithmetic.py: polynomials, enclosures. layout.py: the file. panels.py: control points and trees. functions.py: functions of the
frequency. sampling.py: images, poles counted. remainders.py: coefficients that are not polynomials. closed_loops.py: the
plant, U and V. This file: the claims.
"""

import math
import sys
from fractions import Fraction

import arithmetic
from arithmetic import Malformed, Rejected, axis, number, of_frequency, pi, rounded_up, turned
from closed_loops import ONE, closed_loop, laws, part, plant_over
from functions import Functions, limit_at
from layout import read, read_certificate
from panels import Loop, show
from sampling import Images, roots_outside

GREATEST_FILE = 50_000_000      # bytes


# The claims

def cover(panels, start, end, file=None):
    """Panels from one end to the other; those of a sampled loop are finite, and need reach pi/T only."""
    reached = panels[-1]["to"] == end
    if file and "sampling" in file:
        sample_time, (low, high) = file["sampling"]["sample_time"], pi()
        if any(panel["to"] is None or panel["to"] > Fraction(51, 50) * low / sample_time for panel in panels):
            raise Rejected("a panel ends beyond 0.51 of the sampling rate")
        if end is None or end * sample_time >= low:
            reached = panels[-1]["to"] * sample_time >= high
    if panels[0]["from"] != start or not reached:
        raise Rejected("the panels do not reach from one end of the band to the other")
    if any(a["to"] != b["from"] for a, b in zip(panels, panels[1:])):
        raise Rejected("a panel does not begin where the one before ends")


def show_all(panels, u, v, loop):
    """Gives all leaves as (w from, w to, a, b), in the order of w."""
    leaves = []
    for panel in panels:
        try:
            of_panel = show(panel, u, v, loop)
        except Rejected as reason:
            raise Rejected(f"the panel from {float(panel['from']):g} rad/s: {reason}") from None
        start, end = panel["from"], panel["to"]
        if end is None:       # w = w1/x
            leaves += sorted((start / high, start / low if low else math.inf, a, b) for low, high, a, b in of_panel)
        else:
            leaves += sorted((start + low * (end - start), start + high * (end - start), a, b) for low, high, a, b in of_panel)
    return leaves


def loop_of(file, plant, box, claim=None, member=False):
    """What panels of a claim need besides U and V."""
    sampling, terms = file.get("sampling"), file["terms"]
    table = claim["limit"]["table"] if claim and type(claim.get("limit")) is dict else None
    variables = 0 if member else file["variables"]
    if not sampling:
        return Loop(plant["tau"], variables, terms, table and Functions(terms, table))
    taus = {"R'": plant["tau"], "R": plant["tau"] - number(sampling["sensor_delay"])}
    images = Images(sampling["sample_time"], sampling["images"], taus, responses(file, plant, box))
    return Loop(plant["late"], variables, terms, Functions(terms, table, sampling["sample_time"], plant["tau"].constant()), images)


def responses(file, plant, box):
    """Numerator, denominator and bound of the plant with its sensor and without; the bounds of a box are shown once."""
    sensor = [quotient.terms == {0: quotient.denominator} for quotient in file["sensor"]]
    pairs = [(plant["numerator"] * file["sensor"][0], plant["denominator"] * file["sensor"][1])]
    bounds = file["sampling"]["bounds"][box]
    if not all(sensor):
        pairs.append((plant["numerator"], plant["denominator"]))
    if len(bounds) != len(pairs):
        raise Rejected("the bounds beyond the images are not those of the loop")
    if box not in file["shown"]:
        whole = plant_over(file, box)
        pairs_over = [(whole["numerator"] * file["sensor"][0], whole["denominator"] * file["sensor"][1]), (whole["numerator"], whole["denominator"])]
        for (numerator, denominator), bound in zip(pairs_over, bounds):
            if bound["panels"][0]["from"] * file["sampling"]["sample_time"] > 2 * pi()[0] * (file["sampling"]["images"] + Fraction(49, 100)):
                raise Rejected("a bound begins beyond the images")
            cover(bound["panels"], bound["panels"][0]["from"], None)
            show_all(bound["panels"], part(denominator.times(bound["ratio"])), part(numerator * of_frequency([ONE] + [number(0)] * bound["order"])),
                     Loop(number(0), file["variables"], file["terms"]))
        file["shown"].add(box)
    with_ratios = [(*pair, bound["ratio"], bound["order"]) for pair, bound in zip(pairs, bounds)]
    return {"R'": with_ratios[0], "R": with_ratios[-1]}


def roots_on_the_left(polynomial):
    """All entries of the first column of the Routh array have the sign of the leading coefficient, strictly. Each number stands
    between two others, which are equal where nothing remains."""
    def quotient(a, b):       # b > 0
        return min(a[0] / b[0], a[0] / b[1]), max(a[1] / b[0], a[1] / b[1])

    def less(a, factor, b):
        products = [x * y for x in factor for y in b]
        return a[0] - max(products), a[1] - min(products)
    coefficients = [(p.constant() - p.rest.get(0, 0), p.constant() + p.rest.get(0, 0)) for p in reversed(polynomial.along_frequency())]
    if not coefficients or coefficients[0][0] <= 0 <= coefficients[0][1]:
        raise Rejected("a leading coefficient is zero")
    if coefficients[0][0] < 0:
        coefficients = [(-high, -low) for low, high in coefficients]
    above, row = coefficients[::2], coefficients[1::2]
    for _ in coefficients[1:]:
        if row[0][1] <= 0:
            return False
        if row[0][0] <= 0:
            raise Rejected("an entry of the Routh array cannot be told from zero")
        row += [(Fraction(0),) * 2] * (len(above) - len(row))
        factor = quotient(above[0], row[0])
        above, row = row, [less(a, factor, b) for a, b in zip(above[1:], row[1:])]
    return True


def prefilter_is_stable(file):
    """Sections zeta^2 + b_1 zeta + b_0: b_0 > 0, b_1 > b_0, 4 - 2 b_1 + b_0 > 0; zeta + b_0: 0 < b_0 < 2."""
    if type(file["prefilter"]) is not dict:
        return roots_on_the_left(file["prefilter"][1])
    for first, *others in file["prefilter"]["denominator"]:
        b = [Fraction(x) / first for x in others]
        if len(b) == 1 and not 0 < b[0] < 2 or len(b) == 2 and not (b[1] > 0 and b[0] > b[1] and 4 - 2 * b[0] + b[1] > 0):
            return False
    return True


def poles_outside(file, box, member, count):
    """Of the sampled loop with one plant."""
    plant = plant_over(file, box, member)
    loop = loop_of(file, plant, box, member=True)
    cover(count["characteristic"], 0, None, file)
    of_f = show_all(count["characteristic"], laws(file, plant)["f"], {}, loop)
    denominator = plant["denominator"] * file["sensor"][1]
    rest, alone = denominator.over(denominator.lowest()), Loop(number(0), 0, file["terms"])
    end = count["denominator"][-1]["to"]
    cover(count["denominator"], 0, end)
    cover(count["beyond"], end, None)
    of_denominator, beyond = (show_all(count[key], part(rest), {}, alone) for key in ("denominator", "beyond"))
    degree = sum(len(section) - 1 for section in file["feedback"]["denominator"])
    return roots_outside(file["sampling"]["sample_time"], degree, denominator, of_f, of_denominator, beyond)


def check_stable(claim, file):
    if not prefilter_is_stable(file):
        raise Rejected("the prefilter is not stable")
    for box, entry in enumerate(claim["boxes"]):
        plant, member = plant_over(file, box), plant_over(file, box, entry["member"])
        of_member = laws(file, member)
        if "count" in entry:
            if poles_outside(file, box, entry["member"], entry["count"]):
                raise Rejected(f"the member of box {box} is not stable")
        elif not roots_on_the_left(sum((*of_member["n"].values(), *of_member["c"].values()), number(0))):
            raise Rejected(f"the member of box {box} is not stable")
        cover(entry["panels"], 0, None, file)
        show_all(entry["panels"], laws(file, plant)["f"], {}, loop_of(file, plant, box))
        if "delays" in entry:     # v tau in place of tau
            cover(entry["delays"], 0, None)
            show_all(entry["delays"], of_member["f"], {}, Loop(member["tau"] * axis(1), 1, file["terms"]))
    return "every plant of the box is stable in the loop"


def check_unstable(claim, file):
    loop, late = laws(file, plant_over(file, claim["box"], claim["member"])), "dead_time" in file["plant"] or file["delay"] != 0
    if "count" in claim:
        stable = poles_outside(file, claim["box"], claim["member"], claim["count"]) == 0
    else:
        stable = late or roots_on_the_left(sum((*loop["n"].values(), *loop["c"].values()), number(0)))
    if stable and prefilter_is_stable(file):
        raise Rejected("it is not shown that the plant is unstable in the loop")
    return "a plant of the box is not stable in the loop"


def sentence(claim, words):
    names = (claim["closed_loop"] + " over its limit", "lower limit over tracking")
    return f"{names[claim['side'] == 'lower']} is at {words[0]} {20 * math.log10(claim['ratio']):+.4f} dB {words[1]}"


def check_limited(claim, file):
    start, end = claim["band"]
    if type(claim["limit"]) is dict:
        table = claim["limit"]["table"]
        start, end = max(start, table[0][0]), table[-1][0] if end is None else min(end, table[-1][0])
        if start >= end:
            raise Rejected("the table of the limit does not reach the band")
    for box, panels in enumerate(claim["boxes"]):
        cover(panels, start, end, file)
        plant = plant_over(file, box)
        show_all(panels, *closed_loop(claim, file, plant), loop_of(file, plant, box, claim))
    if "sampling" in file:
        half = pi()[1] / file["sampling"]["sample_time"]
        end = half if end is None else min(end, half)
    until = "on" if end is None else f"to {float(end):g} rad/s"
    return sentence(claim, ("most", f"for every plant from {float(start):g} rad/s {until}"))


# A ball is a real part, an imaginary part, and a bound on the distance from them.

def ball_sum(a, b):
    return tuple(x + y for x, y in zip(a, b))


def ball_product(a, b):
    # |x + j y| <= max + 0.4143 min of |x| and |y|
    size = [max(abs(z[0]), abs(z[1])) + min(abs(z[0]), abs(z[1])) * Fraction(4143, 10000) for z in (a, b)]
    error = size[0] * b[2] + size[1] * a[2] + a[2] * b[2]
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0], rounded_up(error)


def ball_inverse(a):
    """|1/z - 1/a| = |z - a|/(|z| |a|)"""
    square = a[0] * a[0] + a[1] * a[1]
    least = max(abs(a[0]), abs(a[1])) - a[2]
    if least <= 0:
        raise Rejected("a denominator cannot be told from zero")
    return a[0] / square, -a[1] / square, rounded_up(a[2] / least**2)


def ball_at(polynomial, s):
    value = (Fraction(0),) * 3
    for coefficient in reversed(polynomial.along_frequency()):
        value = ball_sum(ball_product(value, s), (coefficient.constant(), Fraction(0), coefficient.rest.get(0, Fraction(0))))
    return value


def value_at(whole, w, names_at, late, image_at):
    total = (Fraction(0),) * 3
    for (is_late, image, names), polynomial in whole.items():
        value = ball_at(polynomial, (Fraction(0), w, Fraction(0)))
        for name in names:
            value = ball_product(value, names_at(name))
        for factor in [late] * is_late + ([image_at(image)] if image else []):
            value = ball_product(value, factor)
        total = ball_sum(total, value)
    return total


def names_at(claim, file, w, tau):
    """The functions of w at one frequency."""
    one = Fraction(1), Fraction(0), Fraction(0)

    def of(name):
        if name[0] == "limit":
            low, high = limit_at(claim["limit"]["table"], w)
            return (low + high) / 2, Fraction(0), (high - low) / 2
        if name[0] == "late":
            return turned(w * tau)
        angle = w * file["sampling"]["sample_time"]
        if name[0] == "hold":
            re, im, error = turned(angle)         # (1 - e^(-j angle))/(j angle)
            return (-im / angle, (re - 1) / angle, error / angle) if angle else one
        turn = turned(-angle)
        if name[0] == "turn":
            return turn
        zeta, value = (turn[0] - 1, *turn[1:]), (Fraction(0),) * 3
        for coefficient in name[1:]:
            value = ball_sum(ball_product(value, zeta), (Fraction(coefficient), Fraction(0), Fraction(0)))
        return value
    return of


def image_at(images, w):
    """R or R' of one plant at one frequency."""
    def of(kind):
        numerator, denominator, _, _ = images.responses[kind]
        total = Fraction(0), Fraction(0), images.beyond(kind, w)
        for k in images.orders:
            s = Fraction(0), w + k * images.low, abs(k) * (images.high - images.low)
            over = ball_product((Fraction(0), w, Fraction(0)), ball_at(numerator, s))
            response = ball_product(over, ball_inverse(ball_product(s, ball_at(denominator, s))))
            total = ball_sum(total, ball_product(response, images.turn(kind, k)))
        return total
    return of


def root(x):
    """Two numbers that enclose the root of x."""
    shift = max(0, 400 - x.numerator.bit_length() + x.denominator.bit_length()) // 2 * 2
    below = math.isqrt((x.numerator << shift) // x.denominator)
    return Fraction(below, 1 << shift // 2), Fraction(below + 1, 1 << shift // 2)


def reached_at_infinity(u, v):
    """|Va_d| - e >= |Ua_d| + e and |Va_d| > e with e = |Ub_d| + |Vb_d|."""
    powers = [{late: p.along_frequency() for (late, *_), p in whole.items()} for whole in (u, v)]
    degree = max(len(p) for whole in powers for p in whole.values()) - 1
    (ua, ub), (va, vb) = ([sizes(whole.get(late, ()), degree) for late in (0, 1)] for whole in powers)
    return va[0] - ub[1] - vb[1] >= ua[1] + ub[1] + vb[1] and va[0] > ub[1] + vb[1]


def sizes(powers, degree):
    """The magnitude of a coefficient stands between two numbers."""
    if degree >= len(powers):
        return Fraction(0), Fraction(0)
    value, rest = abs(powers[degree].constant()), powers[degree].rest.get(0, Fraction(0))
    return max(Fraction(0), value - rest), value + rest


def check_reached(claim, file):
    w, (start, end), table = claim["frequency"], claim["band"], type(claim["limit"]) is dict
    if end is not None if w is None else w < start or end is not None and w > end:
        raise Rejected("the frequency lies outside of the band")
    if "sampling" in file and (w is None or w * file["sampling"]["sample_time"] > pi()[0]):
        raise Rejected("the frequency is above half of the sampling rate")
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
        images = loop_of(file, plant, claim["box"], member=True).images
        at = names_at(claim, file, w, tau), turned(w * tau), images and image_at(images, w)
        (*u, error_of_u), (*v, error_of_v) = (value_at(whole, w, *at) for whole in (u, v))
        square_of_u, square_of_v = (re * re + im * im for re, im in (u, v))
        error = error_of_u + error_of_v
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
        file = {**read_certificate(read(text)), "shown": set()}
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
    told.append(f"Every claim holds: {len(file['claims'])}.")
    if not any(claim["claim"] == "stable" for claim in file["claims"]):
        told.append("Nothing is claimed of stability: without it no magnitude describes a response.")
    return 0, told


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
