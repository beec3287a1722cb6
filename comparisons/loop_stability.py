"""Stability and delay margin of every plant of a grid, and of the worst between them. Read by compare_verify.py."""

import numpy as np

from worst_case import polish, scaled_roots

HALVINGS = 16  # of an interval of the grid in which |L| passes one: to 1e-5 of its frequency


def abscissa(project, values):
    """Largest real part of the closed loop's poles, 1/s; of a sampled loop by the logarithm of its poles."""
    if project.sample_time:
        radius = np.max(np.abs(np.linalg.eigvals(project.sampled_loop_matrix(values))))
        return float(np.log(radius) / project.sample_time)
    over, under = project.loop_polynomials(values)
    return float(np.max(scaled_roots(over + under).real))


def unstable_count(project, values, top):
    """Poles of a loop with dead time in the right half plane, by the growth of the argument of c + n e^(-s tau).

    Along the imaginary axis from 0 to infinity it grows by order pi/2 less pi for each of them (Mikhailov).
    """
    over, under = project.loop_polynomials(values)
    delay = project.delay(values) + project.sensor_delay
    frequencies = np.concatenate([np.geomspace(top * 1e-7, top * 1e-2, 2000), np.linspace(top * 1e-2, top, 8000)])
    for _ in range(12):
        s = 1j * frequencies
        value = under(s) + over(s) * np.exp(-s * delay)
        step = np.angle(value[1:] / value[:-1])
        coarse = np.flatnonzero(np.abs(step) > 0.5)
        if len(coarse) == 0:
            break
        frequencies = np.sort(np.concatenate([frequencies, (frequencies[coarse] + frequencies[coarse + 1]) / 2]))
    # from the real axis at zero frequency, and to the asymptote of the leading power
    start = np.angle(value[0] / np.sign(np.real(under(0) + over(0))))
    end = np.angle(value[-1] / (under.coeffs[0] * (1j) ** (under.order % 4)))
    grown = start + np.sum(step) - end
    count = (under.order * np.pi / 2 - grown) / np.pi
    assert abs(count - round(count)) < 1e-3, count
    return round(count)


def stability(search):
    """(stable, largest real part or None, plant)."""
    project = search.project
    if project.has_delay and not project.sample_time:
        top = 1e3 * search.characteristic[-1]
        plants = search.plants[:: max(1, len(search.plants) // 60)]
        counts = [unstable_count(project, values, top) for values in plants]
        return max(counts) == 0, None, plants[int(np.argmax(counts))]
    found = np.array([abscissa(project, values) for values in search.plants])
    order = np.argsort(-found)
    best, plant = found[order[0]], search.plants[order[0]]
    if project.cases is None:
        for row in order[:4]:
            function = lambda points: np.array([-abscissa(project, values) for values in project.values(points)])
            value, at = polish(function, search.shares[row], rounds=1)
            if -value > best:
                best, plant = -value, project.values(at)
    return bool(best < 0), best, plant


def delay_margin(search):
    """The least extra delay, s, that makes a plant of the family unstable, and that plant; of a stable family."""
    project = search.project
    if project.sample_time:
        return sampled_delay_margin(search)
    low, high = search.characteristic[0] * 1e-3, search.characteristic[-1] * 1e3
    found = delay_margins(project, search.plants, search.frequencies(search.plants, low, high, 200))
    order = np.argsort(found)
    best, plant = found[order[0]], search.plants[order[0]]
    if project.cases is None and np.isfinite(best):

        def function(points):
            plants = project.values(points)
            result = delay_margins(project, plants, search.frequencies(plants, low, high, 200))
            return np.where(np.isfinite(result), result / best, 1e3)

        for row in order[:3]:
            value, at = polish(function, search.shares[row], rounds=1)
            if value * best < found[order].min() and value < 1:
                best, plant = value * best, project.values(at)
    return best, plant


def delay_margins(project, plants, grids):
    """For each plant the least (pi + arg L) mod 2 pi over w, of all w with |L| = 1."""

    def loop(values, w):
        plant, _, feedback, _, sensor = project.responses(values, w)
        return plant * feedback * sensor

    level = np.log(np.abs(loop(plants[:, None, :], grids)))
    row, crossing = np.nonzero(np.diff(np.sign(level), axis=1))
    values, below = plants[row], level[row, crossing]
    low, high = grids[row, crossing], grids[row, crossing + 1]
    for _ in range(HALVINGS):
        middle = np.sqrt(low * high)
        same = np.sign(np.log(np.abs(loop(values, middle)))) == np.sign(below)
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    turn = np.mod(np.pi + np.angle(loop(values, low)), 2 * np.pi)
    least = np.full(len(plants), np.inf)
    np.minimum.at(least, row, turn / low)
    return least


def sampled_delay_margin(search):
    """By the poles themselves, with the delay grown until one leaves the unit circle."""
    project, before = search.project, search.project.loop_delay

    def unstable(values, extra):
        project.loop_delay = before + extra
        answer = abscissa(project, values) >= 0
        project.loop_delay = before
        return answer

    low, high = search.characteristic[0] * 1e-3, np.pi / project.sample_time
    grids = search.frequencies(search.plants, low, high, 600)
    # one plant after the other: each is held once for all halvings
    by_phase = [delay_margins(project, v[None], grid[None])[0] for v, grid in zip(search.plants, grids)]
    best, plant = np.inf, None
    for row in np.argsort(by_phase)[:4]:
        values = search.plants[row]
        steps = np.linspace(0, min(2 * by_phase[row], 400 * project.sample_time), 25)[1:]
        later = next((index for index, extra in enumerate(steps) if unstable(values, extra)), None)
        if later is None:
            continue
        low, high = steps[later] - steps[0], steps[later]
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (low, middle) if unstable(values, middle) else (middle, high)
        best, plant = (high, values) if high < best else (best, plant)
    return best, plant
