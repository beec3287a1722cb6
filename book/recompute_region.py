"""Recomputes the box of operating points that the page on families quotes, from the equations alone and without phea.

Equal edges on a symmetric cylinder: the chamber pressures are (p_S +- p_L)/2, and a velocity v needs the flow A v. Each
`expect` states a number of the book with the precision it is quoted to; the script fails where they differ.
"""

import math

import numpy as np

AREA = math.pi / 4 * (0.05**2 - 0.022**2)
SUPPLY, FULL, SHAPE = 70e5, 10.0, 100.0
FLOW, LEAK = 3.0e-7, 2.40e-9
PUMP, TARE = 20e-3 / 60, 7.55e-6
FORCE = 2 / 3 * SUPPLY * AREA
FAILURES = []


def expect(what, value, quoted, tolerance):
    """The book quotes `quoted`; `tolerance` is half a unit of its last digit."""
    fine = abs(value - quoted) <= tolerance * (1 + 1e-9)
    print(f"{'ok  ' if fine else 'FAIL'} {what}: {value:.6g} (quoted {quoted:g})")
    if not fine:
        FAILURES.append(what)


def secant(spool):
    """What the edges leak at a relative spool position, and its slope over the voltage."""
    size = 1 / np.cosh(SHAPE * spool)
    return size, -SHAPE / FULL * size * np.tanh(SHAPE * spool)


def flow(spool, load):
    """Thesis (4.17): the mean flow of both chambers over spool position and load pressure."""
    size, _ = secant(spool)
    opened = FLOW * np.maximum(spool, 0) + LEAK * size
    closed = FLOW * np.maximum(-spool, 0) + LEAK * size
    return opened * np.sqrt((SUPPLY - load) / 2) - closed * np.sqrt((SUPPLY + load) / 2)


def coefficients(spool, load):
    """K_qU and K_c, thesis (4.21) and (4.22) corrected; at null K_qU is that of U > 0."""
    size, slope = secant(spool)
    above = spool >= 0
    opens, closes = np.where(above, FLOW / FULL, 0.0), np.where(above, 0.0, -FLOW / FULL)
    [drop, other] = [SUPPLY - load, SUPPLY + load]
    gain = (opens + LEAK * slope) * np.sqrt(drop / 2) - (closes + LEAK * slope) * np.sqrt(other / 2)
    opened = FLOW * np.maximum(spool, 0) + LEAK * size
    closed = FLOW * np.maximum(-spool, 0) + LEAK * size
    return gain, opened / np.sqrt(8 * drop) + closed / np.sqrt(8 * other)


def spool_at(velocity, load):
    """The relative spool position that keeps a velocity under a load pressure, by bisection."""
    low, high = -1.0 * np.ones_like(load), np.ones_like(load)
    for _ in range(80):
        middle = (low + high) / 2
        short = flow(middle, load) < AREA * velocity
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return (low + high) / 2


def box(forces, velocities):
    """Least and greatest K_qU and K_c over a grid of forces and velocities, dense around standstill."""
    force = np.linspace(*forces, 401)
    even = np.linspace(*velocities, 401)
    slow = np.concatenate([-np.logspace(-7, -2, 100), [0.0], np.logspace(-7, -2, 100)])
    velocity = np.union1d(even, slow[(slow >= velocities[0]) & (slow <= velocities[1])])
    load, speed = np.meshgrid(force / AREA, velocity)
    spool = spool_at(speed, load)
    reached = np.abs(spool) < 1 - 1e-12
    gain, coefficient = coefficients(spool[reached], load[reached])
    return gain.min(), gain.max(), coefficient.min(), coefficient.max()


def main():
    # full opening under two thirds of the supply's pressure, and what the pump gives
    speed = FLOW * math.sqrt(SUPPLY / 6) / AREA
    least, greatest, leak, loaded = box([0.0, FORCE], [0.0, 0.999 * speed])
    expect("K_qU least", least, 3.24e-5, 0.5e-7)
    expect("K_qU greatest", greatest, 5.61e-5, 0.5e-7)
    expect("K_c least", leak, 6.41e-13, 0.5e-15)
    expect("K_c greatest", loaded, 7.0e-11, 0.8e-12)
    expect("what the pump gives beyond the tare flow, of what full opening takes", (PUMP - TARE) / AREA / speed, 1.01, 0.005)
    poor = (9.8e-3 / 60) / AREA
    expect("K_c of the rig's pump", box([0.0, FORCE], [0.0, poor])[3], 3.5e-11, 0.5e-12)
    expect("the same with the tare flow", box([0.0, FORCE], [0.0, poor - TARE / AREA])[3], 3.3e-11, 0.5e-12)
    both = box([-FORCE, FORCE], [-0.999 * speed, 0.999 * speed])
    expect("K_qU least, both signs", both[0], 3.24e-5, 0.5e-7)
    expect("K_qU greatest, both signs", both[1], 7.25e-5, 0.5e-7)
    expect("wider than without", both[1] / greatest, 1.29, 0.005)
    expect("K_c greatest, both signs", both[3], loaded, 1e-16)
    if FAILURES:
        raise SystemExit(f"{len(FAILURES)} numbers differ: {', '.join(FAILURES)}")


if __name__ == "__main__":
    main()
