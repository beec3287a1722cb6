"""What a servovalve shows in slow static tests: a model of its own, from theory/valve_tests.md and theory/servovalve.md.

Numbers are the twelve static coefficients in the order of theory/valve_tests.md: K_v3 to K_v6, K_vin3 to K_vin6, lambda, q_tare,
U_0 and the width of the hysteresis. Pressures are found by a bracketed Newton method over real numbers; derivatives follow from
complex steps of 1e-30 through the last step of it. SI units.
"""

import numpy as np

COUNT = 12
STEP = 1e-30


def root(drop, transition):
    return drop / np.sqrt(np.sqrt(drop**2 + transition**2))


def root_and_slope(drop, transition):
    """The regular root of a drop, and its derivative over the drop."""
    square = drop * drop
    whole = square + transition**2
    fourth = np.sqrt(np.sqrt(whole))
    return drop / fourth, (square / 2 + transition**2) / (whole * fourth)


def corners(times, command):
    """Rows before which the command turned beyond both neighbours, and where: two straight lines, each through three rows, that meet between them."""
    rows, values = [], []
    slope = np.diff(command) / np.diff(times)
    for row in range(3, len(command) - 2):
        before, after = slope[row - 3 : row - 1], slope[row : row + 2]
        straight = all(abs(np.ptp(pair)) <= 0.01 * abs(np.mean(pair)) for pair in (before, after))
        if not straight or np.mean(before) * np.mean(after) >= 0:
            continue
        lines = [np.polyfit(times[part] - times[row], command[part], 1) for part in (slice(row - 3, row), slice(row, row + 3))]
        at = (lines[1][1] - lines[0][1]) / (lines[0][0] - lines[1][0])
        value, way = np.polyval(lines[0], at), np.sign(lines[0][0])
        step = abs(lines[0][0]) * (times[row] - times[row - 1])
        if min(way * (value - command[row - 1]), way * (value - command[row])) > 1e-6 * step:
            rows.append(row)
            values.append(value)
    return rows, values


def openings(command, bias, width, corners):
    """Position of the edges over the command's unit: the magnetic lag along each piece that rises or falls, on the way over the corners."""
    recorded = np.asarray(command)
    command = np.insert(recorded, *corners) if corners[0] else recorded
    moves = np.diff(command, prepend=command[0])
    way = np.sign(moves)
    for index in range(1, len(way)):          # a command that stands changes nothing
        way[index] = way[index] or way[index - 1]
    turns = np.flatnonzero(np.diff(way)) + 1
    lags, lag = [], 0 * width
    for piece in np.split(np.arange(len(command)), turns):
        travelled = np.cumsum(np.abs(moves[piece]))
        end = way[piece[0]] * width / 2
        lags.append(end + (lag - end) * np.exp(-travelled / width))
        lag = lags[-1][..., -1:]
    inserted = [row + index for index, row in enumerate(corners[0])]
    return recorded - bias - np.delete(np.concatenate(lags, axis=-1), inserted, axis=-1)


def conductances(u, numbers, one_curve):
    """G_3 to G_6 at a relative position of the edges."""
    flow, leak, shape = numbers[:4], numbers[4:8], numbers[8]
    positive = u.real >= 0
    forward, backward = np.where(positive, u, 0), np.where(positive, 0, -u)
    decay = np.exp(-np.where(positive, shape * u, -shape * u))
    sech = 2 * decay / (1 + decay**2)
    opened = [flow[0] * forward, flow[1] * backward, flow[2] * backward, flow[3] * forward]
    each = [a + b * sech for a, b in zip(opened, leak)]
    if not one_curve:
        return each

    def closing(opening, own, other):
        # k sech G_j/sqrt(G_j^2 - k^2 sech^2), the difference of two squares written out
        rest = opening * (opening + 2 * own * sech) + own**4 * sech**2 / (own**2 + other**2)
        return own * other / np.sqrt(own**2 + other**2) * sech * (opening + own * sech) / np.sqrt(rest)

    with np.errstate(divide="ignore", invalid="ignore"):        # of edges that open, which are not taken
        shut = [closing(opened[j], leak[j], leak[i]) for i, j in ((0, 1), (1, 0), (2, 3), (3, 2))]
    return [np.where(positive == opens, a, b) for opens, a, b in zip((True, False, False, True), each, shut)]


def surplus(edges, mean, half, supply, tank, transition):
    """Flow out of the ports less flow into them, and its slope over the mean of the pressures.

    Of one port alone there are two edges: from the supply and to the tank."""
    drops = np.array([supply - mean - half, mean + half - tank, supply - mean + half, mean - half - tank][: len(edges)])
    flow, rate = root_and_slope(drops, transition)
    total, rising = 0, 0
    for edge, one, slope, sign in zip(edges, flow, rate, (-1, 1, -1, 1)):
        total, rising = total + sign * edge * one, rising + edge * slope
    return total, rising


def balanced(edges, half, supply, tank, transition):
    """The mean pressure at which what flows in flows out: a rising function's zero."""
    span = np.abs(half)
    low, high = tank - span, supply + span
    into, out = sum(edges[0::2]), sum(edges[1::2])
    mean = tank + span + np.maximum(supply - tank - 2 * span, 0) * into**2 / (into**2 + out**2)
    for _ in range(100):
        value, rate = surplus(edges, mean, half, supply, tank, transition)
        low, high = np.where(value < 0, mean, low), np.where(value > 0, mean, high)
        moved = mean - value / rate
        moved = np.where((moved >= low) & (moved <= high), moved, (low + high) / 2)
        change, mean = np.max(np.abs(moved - mean)), moved
        if change < 1e-8:
            break
    return mean


def solved(edges, half, supply, tank, transition):
    """The same, with derivatives where the conductances have them."""
    real = [np.real(edge) for edge in edges]
    if edges[0].ndim > 1:
        real = [edge[0] for edge in real]
    mean = balanced(real, half, supply, tank, transition)
    value, _ = surplus(edges, mean, half, supply, tank, transition)
    _, rate = surplus(real, mean, half, supply, tank, transition)
    return mean - value / rate


def shown(test, numbers, valve):
    """All signals of a test: a dictionary of `command`, how far the spool is behind it, `lag`, `supply`, `tank`, `load` over its rows, its
    `corners`, and whether ports are `joined`."""
    u = (openings(test["command"], numbers[10], numbers[11], test["corners"]) - test["lag"]) / valve["nominal_voltage"]
    edges = [np.asarray(edge) for edge in conductances(u, numbers, valve["one_curve"])]
    supply, tank, transition = test["supply"], test["tank"], valve["transition"]
    nothing = np.zeros_like(supply)
    if test["joined"]:
        half = test["load"] / 2
        mean = solved(edges, half, supply, tank, transition)
        port = edges[0] * root(supply - mean - half, transition) - edges[1] * root(mean + half - tank, transition)
        return {"mean_pressure": mean, "flow": port, "magnitude": np.where(port.real < 0, -port, port)}
    a, b = (solved(port, nothing, supply, tank, transition) for port in (edges[:2], edges[2:]))
    leak = edges[0] * root(supply - a, transition) + edges[2] * root(supply - b, transition)
    tare = numbers[9] * root(supply - tank, transition) / root(valve["tare_pressure"], transition)
    return {"pressure_a": a, "pressure_b": b, "leak_flow": leak + tare}


def with_derivatives(numbers):
    """Each number as a column of complex ones, of which one is moved."""
    return [np.where(np.arange(COUNT) == index, number + 1j * STEP * (abs(number) or 1), number)[:, None]
            for index, number in enumerate(numbers)]


def derivative(signal, numbers):
    """Over each number: one row of the result for each."""
    steps = np.array([STEP * (abs(number) or 1) for number in numbers])
    return np.imag(signal) / steps[:, None]
