"""Compares both checkers of certificates with each other, on certificates as they are written and on mutated ones.

    python comparisons/compare_certificate.py [--mutations N] [PHEA]     # or the variable PHEA; without either, what cargo builds

`phea verify --certificate` proves what it can of the loops below. `phea check-certificate`, which rounds outwards, and
`certificate/check_certificate.py`, which computes with rational numbers, must both accept every claim. Then claims are
mutated. What no longer can be a proof (a gap between panels, a leaf that is missing or turned around, a ratio below one that is
reached) both must reject. Of what might still be one (a wider box, another coefficient, a direction turned a little), the first
must reject all that the second rejects: rounding outwards makes it the stricter one. Of some claims, the ratio is sought at
which the leaves just show it, to the last digits. Certificates that were written to deceive a checker both must reject.
"""

import argparse
import collections
import copy
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "certificate"))

from check_certificate import check   # noqa: E402

LOOPS = [
    ("examples/ybitu/hose.toml", {}),
    ("examples/ybitu/hose.toml", {"controller.delay": "1 ms"}),
    ("examples/qft/servo.toml", {}),
    ("examples/qft/acc_benchmark.toml", {}),
    ("examples/qft/dead_time.toml", {}),
    ("examples/qft/edge_plants.toml", {}),
    ("examples/qft/unstable_plant.toml", {}),
    ("examples/qft/unstable_plant.toml", {"controller.numerator": "30"}),
    ("examples/qft/unstable_plant.toml", {"controller.numerator": "30", "controller.sample_time": "10 ms"}),
    ("examples/qft/servo.toml", {"controller.sample_time": "1 ms"}),
    # coefficients that are no polynomials, parameters that move together by equal factors
    ("examples/qft/servo.toml", {"plant.numerator": '"k*a*a/a"'}),
    ("examples/qft/dead_time.toml", {"family.correlation": '[{ parameters = ["k", "tau"] }]'}),
]
SUPPLY = """{ "supply.pressure" = { nominal = 7e6, minimum = 6.5e6, maximum = 7.5e6, points = 2 },
              "line.length" = { nominal = 1.5, minimum = 1.4, maximum = 1.6, points = 2 } }""".replace("\n", "")
SLOWER = [          # with a thousand mutations
    ("examples/ybitu/hose.toml", {"controller.sample_time": "1 ms"}),
    ("examples/ybitu/hose.toml", {"uncertainty": SUPPLY}),
    ("examples/qft/dead_time.toml", {"controller.sample_time": "0.05 s", "controller.delay": "0.02 s"}),
    ("examples/qft/damped_resonance.toml", {"controller.sample_time": "10 ms"}),
    ("examples/qft/load_frame.toml", {}),
]
MANY = 1000
DECEIVING = ROOT / "crates/workbench/tests/false_certificates"      # certificates of what is false
SEED = 6021
MUTATIONS = 80
FORMAT = 2          # exit status of both checkers: no certificate


def command(phea):
    return [phea] if phea else ["cargo", "run", "--quiet", "--bin", "phea", "--"]


def certificates(phea, folder, loops):
    for i, (project, settings) in enumerate(loops):
        place = folder / f"{i}.json"
        changes = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
        ran = subprocess.run([*phea, "verify", project, *changes, "--certificate", place], cwd=ROOT, capture_output=True, text=True)
        if not place.exists():
            raise SystemExit(f"{project} {settings} has no certificate: {ran.stdout[-500:]}{ran.stderr}")
        yield f"{project} {settings or ''}".strip(), place.read_text()


# Mutations: each changes a file with a single claim in place and says what it did, or gives None where it does not apply.

def panel_lists(claim):
    if claim["claim"] == "stable":
        lists = [entry[key] for entry in claim["boxes"] for key in ("panels", "delays") if key in entry]
        return lists + [panels for entry in claim["boxes"] for panels in entry.get("count", {}).values()]
    return claim["boxes"] if claim["claim"] == "limited" else list(claim.get("count", {}).values())


def some_panel(file, chance):
    lists = panel_lists(file["claims"][0])
    return chance.choice(chance.choice(lists)) if lists else None


def panel_end(file, chance):
    if (panel := some_panel(file, chance)) is None:
        return None
    # the last panel of a sampled loop may end anywhere above pi/T
    key = "from" if "sampling" in file else chance.choice(["from", "to"])
    old = panel[key]
    panel[key] = 1e9 if old == "inf" else old * chance.choice([0.999, 1.001, 1 + 1e-12]) or 0.001
    return f"a panel {key} {panel[key]} in place of {old}"


def panel_missing(file, chance):
    lists = panel_lists(file["claims"][0])
    if not lists:
        return None
    panels = chance.choice(lists)
    del panels[i := chance.randrange(len(panels))]
    return f"panel {i} missing"


def box_missing(file, chance):
    claim = file["claims"][0]
    if claim["claim"] not in ("stable", "limited"):
        return None
    claim["boxes"].pop()
    return "a box without panels"


def leaves(tree):
    """Where the leaves of a tree begin."""
    data, place = bytes.fromhex(tree), 0
    while place < len(data):
        if data[place] == 255:
            yield place
            place += 5
        else:
            place += 1


def tree_torn(file, chance):
    if (panel := some_panel(file, chance)) is None:
        return None
    data = bytearray.fromhex(panel["tree"])
    leaf = chance.choice(list(leaves(panel["tree"])))
    way = chance.choice(["leaf dropped", "leaf added", "byte dropped", "byte added", "leaf doubled", "halved without an axis"])
    if way == "leaf dropped":
        del data[leaf:leaf + 5]
    elif way == "leaf added":
        data += data[leaf:leaf + 5]
    elif way == "byte dropped":
        del data[-1]
    elif way == "byte added":
        data.append(chance.choice([0, 255]))
    elif way == "leaf doubled":
        data[leaf:leaf] = data[leaf:leaf + 5]
    else:
        data[leaf:leaf + 5] = bytes([chance.randrange(14, 255)]) + data[leaf:leaf + 5] * 2
    panel["tree"] = data.hex()
    return f"tree with a {way}"


def turn_leaf(panel, chance, turned):
    data = bytearray.fromhex(panel["tree"])
    leaf = chance.choice(list(leaves(panel["tree"])))
    direction = [int.from_bytes(data[leaf + i:leaf + i + 2], "big", signed=True) for i in (1, 3)]
    new = [max(-32768, min(32767, x)) for x in turned(direction)]
    data[leaf + 1:leaf + 5] = b"".join(x.to_bytes(2, "big", signed=True) for x in new)
    panel["tree"] = data.hex()
    return f"direction {new} in place of {direction}"


def leaf_around(file, chance):
    panel = some_panel(file, chance)
    return panel and turn_leaf(panel, chance, chance.choice([lambda d: [-x for x in d], lambda d: [0, 0]]))


def leaf_turned(file, chance):
    panel = some_panel(file, chance)
    step = int(10 ** chance.uniform(0, 4.5))
    return panel and turn_leaf(panel, chance, lambda d: [x + chance.randint(-step, step) for x in d])


def tree_axis(file, chance):
    if (panel := some_panel(file, chance)) is None:
        return None
    data, axes = bytearray.fromhex(panel["tree"]), file["variables"] + 1
    inner, place = [], 0
    while place < len(data):
        inner += [place] if data[place] != 255 else []
        place += 5 if data[place] == 255 else 1
    if not inner or axes == 1:
        return None
    place = chance.choice(inner)
    data[place] = (data[place] + chance.randrange(1, axes)) % axes
    panel["tree"] = data.hex()
    return f"axis {data[place]} at byte {place}"


def tree_of_another(file, chance):
    lists = panel_lists(file["claims"][0])
    panels = chance.choice(lists) if lists else []
    if len(panels) < 2:
        return None
    a, b = chance.sample(panels, 2)
    a["tree"], b["tree"] = b["tree"], a["tree"]
    return "the trees of two panels exchanged"


def ratio_false(file, chance):
    """The enclosures are 0.05 dB wide, 0.6 %."""
    claim = file["claims"][0]
    if "ratio" not in claim:
        return None
    claim["ratio"] *= (1 - chance.uniform(0.01, 0.5)) if claim["claim"] == "limited" else 1 / (1 - chance.uniform(0.01, 0.5))
    return f"ratio {claim['ratio']}"


def limit_false(file, chance):
    claim = file["claims"][0]
    if "limit" not in claim:
        return None
    tighter = 1 - chance.uniform(0.01, 0.5)
    factor = tighter if (claim["claim"] == "limited") == (claim["side"] == "upper") else 1 / tighter
    limit = claim["limit"]
    if "table" in limit:
        limit["table"] = [[w, value * factor] for w, value in limit["table"]]
    else:
        limit["numerator"] = [x * factor for x in limit["numerator"]]
    return f"limit times {factor}"


def limit_changed(file, chance):
    limit = file["claims"][0].get("limit", {})
    if "numerator" not in limit:
        return None
    part = limit[chance.choice(["numerator", "denominator"])]
    part[i := chance.randrange(len(part))] *= 1 + chance.uniform(-0.3, 0.3)
    return f"coefficient {i} of the limit {part[i]}"


def ratio_changed(file, chance):
    if "ratio" not in (claim := file["claims"][0]):
        return None
    claim["ratio"] *= 1 + chance.uniform(-0.01, 0.01)
    return f"ratio {claim['ratio']}"


def band_false(file, chance):
    claim = file["claims"][0]
    if "band" not in claim or "table" in claim["limit"]:
        return None
    start, end = claim["band"]
    if claim["claim"] == "reached":
        w = claim["frequency"]
        claim["band"] = [w * 1.01 + 0.01, "inf"] if w != "inf" else [0, 1e9]
    elif chance.random() < 0.5 and "sampling" not in file:
        claim["band"] = [start, 1e12 if end == "inf" else end * 1.01]
    else:
        claim["band"] = [start / 2 if start else 1e-3, end]
    return f"band {claim['band']}"


def delay_added(file, chance):
    """Without `late` there is no proof."""
    if "sampling" in file or "dead_time" in file["plant"] or file.get("delay") or file["claims"][0]["claim"] not in ("stable", "limited"):
        return None
    file["delay"] = chance.choice([1e-9, 1e-3, 0.5])
    return f"delay {file['delay']}"


def delay_changed(file, chance):
    if not file.get("delay"):
        return None
    file["delay"] *= chance.choice([0.5, 0.9, 1.05, 1.5, 5])
    return f"delay {file['delay']}"


def member_outside(file, chance):
    holder = file["claims"][0]
    holder = chance.choice(holder["boxes"]) if holder["claim"] == "stable" else holder
    if not holder.get("member") if type(holder) is dict else True:
        return None
    holder["member"][i := chance.randrange(len(holder["member"]))] = chance.choice([-1e-9, 1.0000001, 7])
    return f"member {i} outside"


def member_changed(file, chance):
    holder = file["claims"][0]
    holder = chance.choice(holder["boxes"]) if holder["claim"] == "stable" else holder
    if not holder.get("member") if type(holder) is dict else True:
        return None
    holder["member"][i := chance.randrange(len(holder["member"]))] = chance.random()
    return f"member {i} at {holder['member'][i]}"


def box_wider(file, chance):
    box = chance.choice(file["boxes"])
    moving = [triple for triple in box if triple[2] is not None]
    if not moving:
        return None
    triple, side = chance.choice(moving), chance.randrange(2)
    old, factor = triple[side], 10 ** chance.uniform(0, 2)
    triple[side] = old / factor if (old < triple[1 - side]) == (old > 0) else old * factor
    return f"end {triple[side]} of a box in place of {old}"


def box_moved(file, chance):
    triple = chance.choice(chance.choice(file["boxes"]))
    side = chance.randrange(2)
    triple[side] *= chance.choice([-1, 0, 0.5, 0.9, 1.1, 3])
    return f"end {triple[side]} of a box"


def law_changed(file, chance):
    law = chance.choice(["feedback", "prefilter", "sensor"])
    part = file[law][chance.choice(["numerator", "denominator"])]
    part = chance.choice(part) if part and type(part[0]) is list else part or [0]
    part[i := chance.randrange(len(part))] *= chance.choice([-1, 0, 0.5, 0.97, 1.03, 2, 10])
    return f"coefficient {i} of {law} {part[i]}"


def operation_changed(file, chance):
    i = chance.randrange(len(file["operations"]))
    operation = file["operations"][i]
    if operation[0] == "number":
        operation[1] = operation[1] * chance.choice([-1, 0.5, 0.97, 1.03, 2]) or chance.choice([1, -0.01])
    elif operation[0] in ("add", "subtract", "multiply"):
        operation[0] = chance.choice(["add", "subtract", "multiply"])
    elif operation[0] == "parameter":
        operation[1] = chance.randrange(len(file["parameters"]))
    else:
        operation[1] = chance.randrange(i) if i else 0
    return f"operation {i} {operation}"


def plant_changed(file, chance):
    part = file["plant"][chance.choice([key for key in file["plant"] if key != "dead_time"])]
    part[i := chance.randrange(len(part))] = chance.randrange(len(file["operations"]))
    return f"coefficient {i} of the plant is operation {part[i]}"


def sampling_changed(file, chance):
    if "sampling" not in file:
        return None
    sampling = file["sampling"]
    way = chance.choice(["sample_time", "images", "ratio"])
    if way == "images":
        sampling["images"] = max(1, sampling["images"] + chance.choice([-1, 1, 5]))
    else:
        holder = sampling if way == "sample_time" else chance.choice(chance.choice(sampling["bounds"]))
        holder[way] *= chance.choice([0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 2])
    return f"{way} of sampling changed"


def bound_false(file, chance):
    """It begins beyond the images, or is too low by far."""
    if "sampling" not in file or file["claims"][0]["claim"] == "reached":
        return None
    bound = file["sampling"]["bounds"][0][0]
    if chance.random() < 0.5:
        bound["panels"][0]["from"] *= 1.05
    else:
        bound["ratio"] *= 1e-3
    return "a bound that does not hold"


def degree_changed(file, chance):
    key = chance.choice(["model_degree", "terms"])
    if key not in file:
        return None
    file[key] = chance.randint(1, 8 if key == "model_degree" else 24)
    return f"{key} {file[key]}"


def key_unknown(file, chance):
    chance.choice([file, file["plant"], file["claims"][0]])["bound"] = 1
    return "an unknown key"


def operation_unknown(file, chance):
    i = chance.randrange(len(file["operations"]))
    file["operations"][i] = chance.choice([["power", 0, 0], ["parameter", len(file["parameters"])], ["add", i, i], ["add", 0], ["number", "nan"]])
    return f"operation {i} {file['operations'][i]}"


def variable_unknown(file, chance):
    chance.choice(chance.choice(file["boxes"]))[2] = chance.choice([file["variables"], -1, 0.5])
    return "a variable that is not there"


BROKEN = [panel_end, panel_missing, box_missing, tree_torn, leaf_around, ratio_false, limit_false, band_false, delay_added, member_outside,
          bound_false, key_unknown, operation_unknown, variable_unknown]
OPEN = [leaf_turned, tree_axis, tree_of_another, limit_changed, ratio_changed, delay_changed, member_changed, box_wider, box_moved,
        law_changed, operation_changed, plant_changed, sampling_changed, degree_changed]


def just_shown(file):
    """The ratio of a claim `limited` at which its leaves just show it, and the next ones that they do not."""
    claim = file["claims"][0]
    fails, shows = claim["ratio"] * 0.9, claim["ratio"]
    while (middle := (fails + shows) / 2) not in (fails, shows):
        claim["ratio"] = middle
        fails, shows = (fails, middle) if check(json.dumps(file))[0] == 0 else (middle, shows)
    return fails, shows


def deceived(rounding_outwards, counts):
    """Certificates of what is false, and which checker accepts them."""
    wrong = []
    for path in sorted(DECEIVING.glob("*.json")):
        verdicts = check(path.read_text()), rounding_outwards(path.read_text())
        counts["written to deceive, rejected by both"] += all(status for status, _ in verdicts)
        if not all(status for status, _ in verdicts):
            wrong.append(f"a certificate that deceives is accepted: {path.name}: {[told[-1:] for _, told in verdicts]}")
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mutations", type=int, default=MUTATIONS)
    parser.add_argument("phea", nargs="?", default=os.environ.get("PHEA"))
    given = parser.parse_args()
    phea, chance, wrong, counts = command(given.phea), random.Random(SEED), [], collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name) / "mutated.json"

        def rounding_outwards(text):
            place.write_text(text)
            ran = subprocess.run([*phea, "check-certificate", place], cwd=ROOT, capture_output=True, text=True)
            if ran.returncode not in (0, 1, 2) or "panicked" in ran.stderr:
                wrong.append(f"phea ended with {ran.returncode}: {ran.stderr[-300:]}")
            return ran.returncode, (ran.stdout + ran.stderr).strip().splitlines()[-1:]

        files = []
        for loop, text in certificates(phea, pathlib.Path(name), LOOPS + SLOWER * (given.mutations >= MANY)):
            verdicts = check(text), rounding_outwards(text)
            if any(status for status, _ in verdicts):
                wrong.append(f"{loop}: the certificate is rejected: {[told[-1:] for _, told in verdicts]}")
            files.append((loop, json.loads(text)))
        wrong += deceived(rounding_outwards, counts)
        while counts["mutations"] < given.mutations:
            loop, file = chance.choice(files)
            mutate = chance.choice(chance.choice([BROKEN, OPEN]))
            mutated = copy.deepcopy(file)
            mutated["claims"] = [chance.choice(mutated["claims"])]
            mutated["claims"] = copy.deepcopy(mutated["claims"])
            if (what := mutate(mutated, chance)) is None:
                continue
            text = json.dumps(mutated)
            (exact, reason), (outwards, other) = check(text), rounding_outwards(text)
            story = f"{loop}, {mutated['claims'][0]['claim']}, {mutate.__name__}: {what}: exact {exact} {reason[-1:]}, phea {outwards} {other}"
            counts["mutations"] += 1
            if mutate in BROKEN:
                counts["broken, rejected by both"] += bool(exact and outwards)
                if not (exact and outwards):
                    wrong.append(f"a broken proof is accepted: {story}")
            else:
                counts["open, " + ("still a proof" if not exact else "rejected by both" if outwards else "accepted by phea alone")] += 1
                counts["open, rejected by phea alone"] += bool(outwards and not exact)
                if exact and not outwards and exact != FORMAT:
                    wrong.append(f"phea accepts what does not follow: {story}")
                elif exact and not outwards:
                    counts["open, refused as a file by the exact checker alone"] += 1
        limited = [(loop, file, claim) for loop, file in files for claim in file["claims"] if claim["claim"] == "limited"]
        quick = [entry for entry in limited if "sampling" not in entry[1] and "model_degree" not in entry[1]]
        for loop, file, claim in chance.sample(quick, min(len(quick), max(1, given.mutations // 50))):
            single = {**file, "claims": [dict(claim)]}
            ratio, _ = just_shown(single)
            single["claims"][0]["ratio"] = ratio
            counts["ratios sought to the last digit"] += 1
            if rounding_outwards(json.dumps(single))[0] == 0:
                wrong.append(f"phea accepts what does not follow: {loop}, {claim['closed_loop']}: ratio {ratio!r}")
    for name, count in counts.items():
        print(f"{count:6} {name}")
    print("\n".join(wrong) or "both checkers agree")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
