"""Recomputes how many unstable poles waves in the hoses give the published loop of Ledezma (2019), and where the hose is a quarter wave.

Independent of the lines of phea: the exact conduit p_1 = p cosh Gamma + q Z sinh Gamma, q_1 = p sinh Gamma/Z + q cosh Gamma,
Gamma = s T sqrt(N), Z = Z_c sqrt(N), with N = 1 (no friction) or the laminar friction factor I_0/I_2 (Zielke 1968; scipy's Bessel
functions), behind each port of the valve and before a chamber of plain oil. Zeros of 1 + L are counted by the turns of its argument
along a parallel to the imaginary axis at -0.01 1/s in steps of at most 5 degrees: no pole lies between.

    python comparisons/recompute_waves.py
"""

import numpy as np
import scipy.special

AREA, MASS, SENSOR, FRICTION = np.pi / 4 * (0.05**2 - 0.022**2), 13.1, 2e7, 100.0
FLOW_GAIN, LEAK, FREQUENCY, DAMPING = 5.4e-5, 6.42e-13, 1099.0, 0.9
OIL, DENSITY, VISCOSITY = 1.45e9, 870.0, 46e-6
BORE, LENGTH, STROKE = 12.7e-3, 1.5, 0.5
# the hose by its sheet: what a metre holds beyond its bore at 35 bar, how that grows with pressure, and its dynamic stiffening
EXPANSION, EXPANSION_SLOPE, STIFFENING = 7.774e-6, 2.236e-12, 5.0


def hose_modulus():
    """Of oil and wall together, and the area, on the volume that it holds at 35 bar."""
    area = np.pi / 4 * BORE**2 + EXPANSION
    wall = STIFFENING * area / EXPANSION_SLOPE
    return 1 / (1 / OIL + 1 / wall), area


def loop(s, friction=False, creep=None):
    """L of G_1 and one load pressure behind equal hoses."""
    modulus, area = hose_modulus()
    if creep is not None:
        wall = STIFFENING * area / EXPANSION_SLOPE
        follows = (STIFFENING - 1) / wall / (1 + creep * STIFFENING * s)  # Zener: all of it at rest, none when fast
        modulus = 1 / (1 / OIL + 1 / wall + follows)
    speed = np.sqrt(modulus / DENSITY + 0j)
    factor = 1.0
    if friction:
        z = np.sqrt(s * area / np.pi / VISCOSITY)
        factor = scipy.special.ive(0, z) / scipy.special.ive(2, z)
    gamma, impedance = s * LENGTH / speed * np.sqrt(factor), DENSITY * speed / area * np.sqrt(factor)
    a, b, c = np.cosh(gamma), impedance * np.sinh(gamma), np.sinh(gamma) / impedance
    # each chamber: q = K_q/(d + k b) u - (c + k a)/(d + k b) p, with k = 2 K_c of one port
    passed = a + 2 * LEAK * b
    admittance = AREA * STROKE / 2 / OIL * s + (c + 2 * LEAK * a) / passed
    spool = FREQUENCY**2 / (s**2 + 2 * DAMPING * FREQUENCY * s + FREQUENCY**2)
    driven = 2 * AREA * FLOW_GAIN / passed * spool
    moved = s * ((MASS * s + FRICTION) * admittance + 2 * AREA**2)
    plant = SENSOR * driven / (moved + SENSOR * admittance)
    return plant * (0.001 * s + 0.008) / s


def unstable(shift=-0.01, top=5e4, **line):
    """Zeros of 1 + L to the right of the parallel; L has its one pole there, the integrator's, to the right of it too."""
    at = lambda w: 1 + loop(shift + 1j * w, **line)
    grid = np.concatenate([[0.0], np.geomspace(1e-4, top, 4000)])
    stack = list(grid[::-1])
    w = stack.pop()
    value, turned = at(w), 0.0
    while stack:
        following = at(stack[-1])
        turn = np.angle(following / value)
        if abs(turn) > np.radians(5) and stack[-1] - w > 1e-12 * stack[-1]:
            stack.append((w + stack[-1]) / 2)
            continue
        turned, w, value = turned + turn, stack.pop(), following
    count = 1 - (turned - np.angle(value)) / np.pi
    assert abs(count - round(count)) < 1e-3, count
    return round(count)


def check(name, value, expected, tolerance=0):
    print(f"{name:60s} {value:.6g}")
    assert abs(value - expected) <= tolerance, f"{name}: {value} is not {expected}"


if __name__ == "__main__":
    modulus, _ = hose_modulus()
    check("quarter wave of the hose, rad/s", np.pi / 2 * np.sqrt(modulus / DENSITY) / LENGTH, 560, 1)
    check("unstable poles without friction", unstable(), 6)
    check("unstable poles with laminar friction", unstable(friction=True), 4)
    for creep, poles in [(1e-3, 0), (3e-3, 0), (10e-3, 2)]:
        check(f"the same with a wall that creeps in {creep} s", unstable(friction=True, creep=creep), poles)
    at = lambda w: loop(1j * w, friction=True)
    for frequency in [1.0, 100.0, 560.0, 1500.0]:
        print(f"L at {frequency} rad/s: {at(frequency):.6g}")
