"""The plant of a box or of one member, and U and V of a claim."""

from fractions import Fraction

import remainders
from arithmetic import Rejected, axis, number, of_frequency
from layout import LAWS, need

ONE = number(1)


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
    if "model_degree" in file:
        of = remainders.results(file["operations"], file["boxes"][box], member, file["model_degree"])
    else:
        parameters = []
        for low, high, variable in file["boxes"][box]:
            t = number(0) if variable is None else axis(1 + variable) if member is None else number(member[variable])
            parameters.append(number(low) + number(Fraction(high) - low) * t)
        of = results(file["operations"], parameters).__getitem__
    plant = {key: of_frequency([of(i) for i in places]) for key, places in file["plant"].items() if key != "dead_time"}
    need(plant["denominator"].terms, "the denominator of the plant is zero")
    plant["tau"] = number(file["delay"]) + (of(file["plant"]["dead_time"]) if "dead_time" in file["plant"] else number(0))
    if plant["tau"].rest:
        raise Rejected("the dead time is no polynomial")
    if plant["tau"].range()[0] < 0:
        raise Rejected("the dead time is not shown to be positive on the whole box")
    # in a sampled loop E is a function of w alone where no variable moves tau, else taken as panels say
    plant["turn"] = "sampling" in file and plant["tau"].terms.keys() == {0}
    plant["late"] = number(0) if plant["turn"] else plant["tau"]
    return plant


# From a claim to U and V: sums {(late, image, functions of w): polynomial of s and the variables}

def part(polynomial, late=0, image="", names=()):
    return {(late, image, names): polynomial} if polynomial else {}


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
    """The factors of the closed loops by their names: n, c, f = n E + c, and P, what N Hd is in a loop without samples."""
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
    lowest = min((polynomial.lowest() for polynomial in (*u.values(), *v.values())), default=0)
    return [{key: polynomial.over(lowest) for key, polynomial in whole.items()} for whole in (u, v)]
