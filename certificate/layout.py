"""Reads the layout of a certificate, and rejects a file that is not a certificate of version 1."""

import json
import re
from fractions import Fraction

from arithmetic import Malformed, number, of_frequency

GREATEST_LIST = 10_000
LAWS = ("feedback", "prefilter", "sensor")


def need(condition, sentence):
    if not condition:
        raise Malformed(sentence)


def read(text):
    """The JSON object, its decimals as fractions."""
    def once(pairs):
        need(len({key for key, _ in pairs}) == len(pairs), "an object has a key twice")
        return dict(pairs)

    def decimal(digits):
        mantissa, _, exponent = digits.lower().partition("e")
        need(len(mantissa) <= 800 and len(exponent) <= 5 and abs(int(exponent or 0)) <= 800, "a number is out of range")
        x = Fraction(digits)
        need(abs(x) < 2**1024, "a number is out of range")
        return int(x) if x.denominator == 1 else x

    def refuse(name):
        raise Malformed(f"{name} is not a number")
    try:
        return json.loads(text, object_pairs_hook=once, parse_float=decimal, parse_int=decimal, parse_constant=refuse)
    except RecursionError:
        raise Malformed("its lists are too deep") from None
    except ValueError as error:
        raise Malformed(f"it is no JSON: {error}") from None


def is_number(x):
    return type(x) in (int, Fraction)


def is_index(x, end):
    return type(x) is int and 0 <= x < end


def is_list(x, of=lambda _: True, least=0, most=GREATEST_LIST):
    return type(x) is list and least <= len(x) <= most and all(map(of, x))


def keys(value, needed, possible, name):
    need(type(value) is dict, f"{name} is no object")
    for key in needed:
        need(key in value, f"{name} has no `{key}`")
    for key in value:
        need(key in needed or key in possible, f"{name} has an unknown key `{key}`")


def polynomial_of(value, name):
    need(is_list(value, is_number, 1, 100), f"{name} is no list of numbers")
    return of_frequency([number(x) for x in value])


def read_quotient(value, name):
    keys(value, ("numerator", "denominator"), (), name)
    quotient = [polynomial_of(value[key], f"`{key}` of {name}") for key in ("numerator", "denominator")]
    need(quotient[1].terms, f"the denominator of {name} is zero")
    return quotient


def read_sections(value, name):
    keys(value, ("gain", "numerator", "denominator"), (), name)
    need(is_number(value["gain"]) and value["gain"] != 0, f"the gain of {name} is zero, or no number")
    for key in ("numerator", "denominator"):
        need(is_list(value[key], lambda section: is_list(section, is_number, 1, 3) and section[0] != 0, 0, 40), f"a section of {name} is none")
    degrees = [sum(len(section) - 1 for section in value[key]) for key in ("numerator", "denominator")]
    need(name != "`feedback`" or degrees[0] <= degrees[1], f"{name} has more zeros than poles")
    return value


def read_sampling(value, file):
    keys(value, ("sample_time", "images", "bounds"), ("sensor_delay",), "`sampling`")
    value["sensor_delay"] = Fraction(value.get("sensor_delay", 0))
    need(0 <= value["sensor_delay"] <= Fraction(file.get("delay", 0)), "the delay of the sensor is not a part of `delay`")
    need(is_number(value["sample_time"]) and value["sample_time"] > 0, "the sample time is not greater than zero")
    value["sample_time"] = Fraction(value["sample_time"])
    need(is_index(value["images"], 65) and value["images"] > 0, "`images` is not a number from 1 to 64")
    need(is_list(value["bounds"], lambda box: is_list(box, least=1, most=2), len(file["boxes"]), len(file["boxes"])),
         "there is not a list of bounds for each box")
    for bound in (bound for box in value["bounds"] for bound in box):
        keys(bound, ("order", "ratio", "panels"), (), "a bound")
        need(is_index(bound["order"], 65) and bound["order"] > 0, "the order of a bound is not a number from 1 to 64")
        need(is_number(bound["ratio"]) and bound["ratio"] > 0, "the ratio of a bound is not greater than zero")
        bound["panels"] = read_panels(bound["panels"], "a bound")


def read_count(value, name):
    keys(value, ("characteristic", "denominator", "beyond"), (), f"{name}: `count`")
    for key in value:
        value[key] = read_panels(value[key], name)


OPERATIONS = {"parameter": 1, "number": 1, "negate": 1, "add": 2, "subtract": 2, "multiply": 2, "divide": 2}
MODELLED = {"sqrt": 1, "exp": 1, "ln": 1, "abs": 1, "select": 4}


def read_certificate(file):
    """Checks the layout, and puts what is read in place of what stands there."""
    need(type(file) is dict and file.get("format") == "phea-certificate", "it is no certificate of phea")
    need(type(file.get("version")) is int and file["version"] == 1, "its version is unknown")
    people = ("phea", "title", "project_sha256", "settings")
    keys(file, ("format", "version", *people, "variables", "parameters", "boxes", "operations", "plant", "terms", *LAWS, "claims"),
         ("recordings", "delay", "model_degree", "sampling"), "the certificate")
    need(all(type(file[key]) is str for key in people[:3]) and is_list(file["settings"], lambda x: type(x) is str),
         "its title, version, hash or settings are no text")
    for recording in file.setdefault("recordings", []) if is_list(file.get("recordings", [])) else [None]:
        keys(recording, ("file", "sha256"), (), "a recording")
        need(type(recording["file"]) is str and type(recording["sha256"]) is str, "a recording is not a text")
    models = "model_degree" in file
    need(not models or is_index(file["model_degree"], 9) and file["model_degree"] > 0, "`model_degree` is not a number from 1 to 8")
    need(is_index(file["variables"], 13), "`variables` is not a number from 0 to 12")
    need(is_list(file["parameters"], lambda x: type(x) is str), "`parameters` is no list of names")
    need(type(file["terms"]) is int and 1 <= file["terms"] <= 24, "`terms` is not a number from 1 to 24")
    file.setdefault("delay", 0)
    need(is_number(file["delay"]) and file["delay"] >= 0, "`delay` is not a number, or negative")

    def is_range(triple):
        return is_list(triple, least=3, most=4 if models else 3) and is_number(triple[0]) and is_number(triple[1]) \
            and (triple[2] is None or is_index(triple[2], file["variables"])) \
            and (len(triple) == 3 or triple[3] == "by_factors" and triple[0] > 0 and triple[1] > 0)
    need(is_list(file["boxes"], lambda box: is_list(box, is_range) and len(box) == len(file["parameters"]), 1),
         "a box is no list with [low, high, variable] for each parameter")
    need(is_list(file["operations"]), "`operations` is no list")
    known = {**OPERATIONS, **MODELLED} if models else OPERATIONS
    for i, operation in enumerate(file["operations"]):
        need(is_list(operation, least=1) and type(operation[0]) is str and len(operation) - 1 == known.get(operation[0]),
             f"operation {i} is unknown")
        of = {"parameter": lambda x: is_index(x, len(file["parameters"])), "number": is_number}
        need(all(map(of.get(operation[0], lambda x: is_index(x, i)), operation[1:])), f"operation {i} names what is not there")
    plant, disturbance = file["plant"], ("disturbance_numerator", "disturbance_denominator")
    keys(plant, ("numerator", "denominator"), (*disturbance, "dead_time"), "the plant")
    need((disturbance[0] in plant) == (disturbance[1] in plant), "the plant has half a disturbance")
    for key, value in plant.items():
        places = [value] if key == "dead_time" else value
        need(is_list(places, lambda x: is_index(x, len(file["operations"])), 1, 100), f"`{key}` of the plant names no operations")
    if "sampling" in file:
        read_sampling(file["sampling"], file)
    for law in LAWS:
        sections = "sampling" in file and law != "sensor" and type(file[law]) is dict and "gain" in file[law]
        need(sections or law != "feedback" or "sampling" not in file, "`feedback` of a sampled loop has no sections")
        file[law] = read_sections(file[law], f"`{law}`") if sections else read_quotient(file[law], f"`{law}`")
    need(is_list(file["claims"]), "`claims` is no list")
    for i, claim in enumerate(file["claims"], 1):
        read_claim(claim, file, f"claim {i}")
    return file


CLAIMS = {
    "stable": ("boxes",),
    "unstable": ("box", "member"),
    "limited": ("closed_loop", "side", "limit", "band", "ratio", "boxes"),
    "reached": ("closed_loop", "side", "limit", "band", "ratio", "frequency", "box", "member"),
}
CLOSED_LOOPS = ("robust_stability", "sensitivity", "plant_input_disturbance", "control_effort", "load_motion", "tracking")


def read_claim(claim, file, name):
    need(type(claim) is dict and type(claim.get("claim")) is str and claim["claim"] in CLAIMS, f"{name} claims nothing known")
    kind, boxes = claim["claim"], len(file["boxes"])
    count = ("count",) if "sampling" in file else ()
    keys(claim, ("claim", *CLAIMS[kind], *(count if kind == "unstable" else ())), (), name)
    if "count" in claim:
        read_count(claim["count"], name)
    late = "dead_time" in file["plant"] or file["delay"] != 0
    if "member" in claim:
        read_member(claim, file, name)
        need(is_index(claim["box"], boxes), f"{name}: `box` is no index of a box")
    if "closed_loop" in claim:
        need(claim["closed_loop"] in CLOSED_LOOPS, f"{name}: the closed loop is unknown")
        need(claim["side"] in ("upper", "lower") and (claim["side"] == "upper" or claim["closed_loop"] == "tracking"),
             f"{name}: the side is unknown, or only tracking has it")
        need(claim["closed_loop"] != "load_motion" or "disturbance_numerator" in file["plant"],
             f"{name}: the plant has no path of the load's motion")
        need(is_number(claim["ratio"]) and claim["ratio"] > 0, f"{name}: the ratio is not greater than zero")
        need(is_list(claim["band"], least=2, most=2), f"{name}: the band has no two ends")
        claim["band"] = start, end = [read_frequency(w, f"{name}: an end of the band") for w in claim["band"]]
        need(start is not None and (end is None or start < end), f"{name}: the band has no 0 <= from < to")
        read_limit(claim, name)
    if "frequency" in claim:
        claim["frequency"] = read_frequency(claim["frequency"], f"{name}: `frequency`")
    if kind == "stable":
        need(is_list(claim["boxes"], least=boxes, most=boxes), f"{name} has not one entry for each box")
        for entry in claim["boxes"]:
            keys(entry, ("member", "panels", *(count or (("delays",) if late else ()))), (), f"{name}, an entry of a box,")
            read_member(entry, file, name)
            for key in entry.keys() - {"member", "count"}:
                entry[key] = read_panels(entry[key], name)
            if count:
                read_count(entry["count"], name)
    if kind == "limited":
        need(is_list(claim["boxes"], least=boxes, most=boxes), f"{name} has not one list of panels for each box")
        claim["boxes"] = [read_panels(panels, name) for panels in claim["boxes"]]


def read_member(value, file, name):
    n = file["variables"]
    need(is_list(value["member"], lambda t: is_number(t) and 0 <= t <= 1, n, n), f"{name}: `member` is no list of {n} numbers in [0, 1]")


def read_frequency(w, name):
    """None stands for the infinite frequency."""
    need(w == "inf" or is_number(w) and w >= 0, f"{name} is no frequency")
    return None if w == "inf" else Fraction(w)


def read_limit(claim, name):
    limit = claim["limit"]
    if type(limit) is dict and "table" in limit:
        keys(limit, ("table",), (), f"{name}: the limit")
        table = limit["table"]
        need(is_list(table, lambda row: is_list(row, lambda x: is_number(x) and x > 0, 2, 2), 2), f"{name}: the table has a row that is no point")
        need(all(a[0] < b[0] for a, b in zip(table, table[1:])), f"{name}: the frequencies of the table do not increase")
        limit["table"] = [(Fraction(w), Fraction(value)) for w, value in table]
    else:
        claim["limit"] = read_quotient(limit, f"{name}: the limit")


def read_panels(panels, name):
    need(is_list(panels, least=1), f"{name}: panels are no list")
    read_all = []
    for panel in panels:
        keys(panel, ("from", "to", "tree"), ("late",), f"{name}: a panel")
        start, end = (read_frequency(panel[key], f"{name}: `{key}` of a panel") for key in ("from", "to"))
        need(start is not None and (start < end if end is not None else start > 0), f"{name}: a panel has no width")
        late = panel.get("late")
        need("late" not in panel or late in ("less", "more") or is_number(late), f"{name}: `late` of a panel is unknown")
        need(type(panel["tree"]) is str and re.fullmatch("([0-9a-fA-F]{2})+", panel["tree"]), f"{name}: a tree is not hexadecimal")
        read_all.append({"from": start, "to": end, "late": Fraction(late) if is_number(late) else late, "tree": bytes.fromhex(panel["tree"])})
    return read_all
