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
from arithmetic import DIGIT, Malformed, Polynomial, Rejected, axis, number, of_frequency, pi, rounded_up, turned
from functions import Functions, limit_at
from layout import LAWS, need, read, read_certificate
from panels import Loop, show
from sampling import Images, roots_outside

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
    if plant["tau"].range()[0] < 0:
        raise Rejected("the dead time is not shown to be positive on the whole box")
    # in a sampled loop E is a function of w alone where no variable moves tau, else taken as panels say
    plant["turn"] = "sampling" in file and plant["tau"].terms.keys() == {0}
    plant["late"] = number(0) if plant["turn"] else plant["tau"]
    return plant


# From a claim to U and V: sums {(late, image, functions of w): polynomial of s and the variables}

def part(polynomial, late=0, image="", names=()):
    return {(late, image, names): polynomial} if polynomial.terms else {}


def plus(a, b):
    return {key: a.get(key, number(0)) + b.get(key, number(0)) for key in {**a, **b}}


def times(*factors):
    product = part(ONE)
    for factor in factors:
        sums = {}
        for (late, image, names), a in product.items():
            for (later, of, more), b in factor.items():
                sums = plus(sums, {(late + later, image + of, tuple(sorted(names + more))): a * b})
        product = sums
    return product


def of_sections(sections, sample_time):
    """The product of sections; where zeta divides one, zeta = s T hold e^(j w T)."""
    polynomial, names = ONE, []
    for section in sections:
        while section[-1] == 0:
            section, polynomial = section[:-1], polynomial * axis(0).times(sample_time)
            names += [("hold",), ("turn",)]
        if len(section) == 1:
            polynomial = polynomial.times(section[0])
        else:
            names.append(("section", *section))
    return part(polynomial, names=tuple(sorted(names)))


def law_of(law, sample_time):
    if type(law) is dict:
        numerator, denominator = (of_sections(law[key], sample_time) for key in ("numerator", "denominator"))
        return times(part(number(law["gain"])), numerator), denominator
    return map(part, law)


def laws(file, plant):
    """The factors of the closed loops by their names, f = n E + c among them, and c (1 + L)/f etc. as the page has them."""
    loop = {name: part(plant[key]) for name, key in (("N", "numerator"), ("D", "denominator"), ("Nd", "disturbance_numerator"),
                                                      ("Dd", "disturbance_denominator")) if key in plant}
    sampling = file.get("sampling")
    for name, law in zip("GFH", LAWS):
        loop[name + "n"], loop[name + "d"] = law_of(file[law], sampling and sampling["sample_time"])
    loop["E"] = part(ONE, 1 if plant["late"].terms else 0, names=(("late",),) if plant["turn"] else ())
    loop["c"] = product(loop, "D Gd Hd")
    if sampling:      # with R for the images of N/D, R' for those of N Hn/(D Hd)
        loop["hold"] = part(ONE, names=(("hold",),))
        loop["n"] = plus(product(loop, "hold N Gn Hn"), times(part(ONE, image="R'"), product(loop, "hold Gn D Hd")))
        loop["P"] = times(product(loop, "hold E"), plus(product(loop, "N Hd"), times(part(ONE, image="R"), product(loop, "D Hd"))))
    else:
        loop["n"], loop["P"] = product(loop, "N Gn Hn"), product(loop, "N Hd")
    loop["nE"] = product(loop, "n E")
    loop["f"] = plus(loop["nE"], loop["c"])
    return loop


def product(loop, names):
    return times(*(loop[name] for name in names.split()))


def closed_loop(claim, file, plant):
    """U and V of `limited` and `reached`, without the powers of s that divide all their parts."""
    loop, name = laws(file, plant), claim["closed_loop"]
    wn, wd = (part(ONE, names=(("limit",),)), part(ONE)) if type(claim["limit"]) is dict else map(part, claim["limit"])
    u, v = times(part(number(claim["ratio"])), wn, loop["f"]), {
        "robust_stability": "nE" if "sampling" in file else "n", "sensitivity": "c", "plant_input_disturbance": "P Gd",
        "control_effort": "Gn D Hd", "tracking": "Fn P Gn", "load_motion": "Nd c"}[name]
    if name == "tracking":
        u = times(u, loop["Fd"])
    elif name == "load_motion":
        if file["plant"]["denominator"] == file["plant"]["disturbance_denominator"]:
            v = "Nd Gd Hd"
        else:
            u = times(u, loop["Dd"])
    v = times(wd, product(loop, v))
    if claim["side"] == "lower":
        u, v = times(part(number(claim["ratio"])), v), times(wn, loop["f"], loop["Fd"])
    mask = (1 << DIGIT) - 1
    lowest = min((key & mask for polynomial in (*u.values(), *v.values()) for key in polynomial.terms), default=0)
    return [{key: Polynomial({place - lowest: value for place, value in polynomial.terms.items()}, polynomial.denominator)
             for key, polynomial in whole.items()} for whole in (u, v)]


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
    images = Images(sampling["sample_time"], sampling["images"], plant["tau"], responses(file, plant, box))
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
    for (numerator, denominator), bound in zip(pairs, bounds):
        if len(denominator.along_frequency()) <= len(numerator.along_frequency()):
            raise Rejected("the plant has as many zeros as poles")
    if box not in file["shown"]:
        whole = plant_over(file, box)
        pairs_over = [(whole["numerator"] * file["sensor"][0], whole["denominator"] * file["sensor"][1]), (whole["numerator"], whole["denominator"])]
        for (numerator, denominator), bound in zip(pairs_over, bounds):
            m = len(denominator.along_frequency()) - len(numerator.along_frequency())
            if bound["panels"][0]["from"] * file["sampling"]["sample_time"] > 2 * pi()[0] * (file["sampling"]["images"] + Fraction(49, 100)):
                raise Rejected("a bound begins beyond the images")
            cover(bound["panels"], bound["panels"][0]["from"], None)
            show_all(bound["panels"], part(denominator.times(bound["ratio"])), part(numerator * of_frequency([ONE] + [number(0)] * m)),
                     Loop(number(0), file["variables"], file["terms"]))
        file["shown"].add(box)
    with_ratios = [(*pair, bound["ratio"]) for pair, bound in zip(pairs, bounds)]
    return {"R'": with_ratios[0], "R": with_ratios[-1]}


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
    lowest = min(key for key in denominator.terms)
    rest, alone = Polynomial({key - lowest: x for key, x in denominator.terms.items()}, denominator.denominator), Loop(number(0), 0, file["terms"])
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
    return sentence(claim, ("most", "for every plant and every frequency of the band"))


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
        value = ball_sum(ball_product(value, s), (coefficient.constant(), Fraction(0), Fraction(0)))
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
        numerator, denominator, _ = images.responses[kind]
        total = Fraction(0), Fraction(0), images.beyond(kind, w)
        for k in images.orders:
            s = Fraction(0), w + k * images.low, abs(k) * (images.high - images.low)
            over = ball_product((Fraction(0), w, Fraction(0)), ball_at(numerator, s))
            response = ball_product(over, ball_inverse(ball_product(s, ball_at(denominator, s))))
            total = ball_sum(total, ball_product(response, images.turn(k)))
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
    (ua, ub), (va, vb) = ([abs(p[degree].constant()) if degree < len(p := whole.get(late, ())) else 0 for late in (0, 1)]
                          for whole in powers)
    return va - ub - vb >= ua + ub + vb and va > ub + vb


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
