"""Recomputes how many unstable poles waves in the hoses give the published loop of Ledezma (2019), and where the hose is a quarter wave.

Independent of the lines of phea: the exact conduit p_1 = p cosh Gamma + q Z sinh Gamma, q_1 = p sinh Gamma/Z + q cosh Gamma,
Gamma = s T sqrt(N), Z = Z_c sqrt(N), with N = 1 (no friction) or the laminar friction factor I_0/I_2 (Zielke 1968; scipy's Bessel
functions), behind each port of the valve and before a chamber of plain oil. A hose of two waves is the exponential of its four equations
in p, v, F and u over the length, the wall held at both ends: no waves, speeds or modes are taken apart. Zeros of 1 + L are counted by the turns of its argument
along a parallel to the imaginary axis at -0.01 1/s in steps of at most 5 degrees: no pole lies between.

    python comparisons/recompute_waves.py
"""

import numpy as np
import scipy.linalg
import scipy.special

AREA, MASS, SENSOR, FRICTION = np.pi / 4 * (0.05**2 - 0.022**2), 13.1, 2e7, 100.0
FLOW_GAIN, LEAK, FREQUENCY, DAMPING = 5.4e-5, 6.42e-13, 1099.0, 0.9
OIL, DENSITY, VISCOSITY = 1.45e9, 870.0, 46e-6
BORE, LENGTH, STROKE = 12.7e-3, 1.5, 0.5
# the hose by its sheet: what a metre holds beyond its bore at 35 bar, how that grows with pressure, and its dynamic stiffening
EXPANSION, EXPANSION_SLOPE, STIFFENING = 7.774e-6, 2.236e-12, 5.0
# a wall that moves along its axis, as the book assumes it: outer diameter, density, modulus of tube and cover at rest, braid at its neutral angle
OUTER, WALL_DENSITY, TUBE = 20.3e-3, 1150.0, 50e6


def hose_modulus():
    """Of oil and wall together, and the area, on the volume that it holds at 35 bar."""
    area = np.pi / 4 * BORE**2 + EXPANSION
    wall = STIFFENING * area / EXPANSION_SLOPE
    return 1 / (1 / OIL + 1 / wall), area


def friction_factor(s, area):
    """N(s) of laminar flow."""
    z = np.sqrt(s * area / np.pi / VISCOSITY)
    return scipy.special.ive(0, z) / scipy.special.ive(2, z)


def one_wave(s, friction, creep):
    """cosh Gamma, Z sinh Gamma and sinh Gamma/Z."""
    modulus, area = hose_modulus()
    if creep is not None:
        wall = STIFFENING * area / EXPANSION_SLOPE
        follows = (STIFFENING - 1) / wall / (1 + creep * STIFFENING * s)  # Zener: all of it at rest, none when fast
        modulus = 1 / (1 / OIL + 1 / wall + follows)
    speed = np.sqrt(modulus / DENSITY + 0j)
    factor = friction_factor(s, area) if friction else 1.0
    gamma, impedance = s * LENGTH / speed * np.sqrt(factor), DENSITY * speed / area * np.sqrt(factor)
    return np.cosh(gamma), impedance * np.sinh(gamma), np.sinh(gamma) / impedance


def two_waves(s, friction, creep):
    """p and q at one end for those at the other, u = 0 at both:

    p_x = -s (rho v + rho (N - 1) (v - u)),   F_x = s (m u - A rho (N - 1) (v - u))
    v_x = -s ((1/B + C_pp) p + C_pF F),       u_x = s (A C_pF p + C_FF F)
    """
    assert creep is None
    _, area = hose_modulus()
    section = np.pi / 4 * (OUTER**2 - BORE**2)
    yielding, mass = 1 / (STIFFENING * TUBE * section), WALL_DENSITY * section
    coupling, radial = -yielding, 1 / OIL + EXPANSION_SLOPE / STIFFENING / area + area * yielding
    drag = DENSITY * (friction_factor(s, area) - 1) if friction else 0.0
    # in MPa, m/s, kN, m/s over the length
    units = np.array([1e6, 1.0, 1e3, 1.0])
    along = s * np.array([
        [0, -(DENSITY + drag), 0, drag],
        [-radial, 0, -coupling, 0],
        [0, -area * drag, 0, mass + area * drag],
        [area * coupling, 0, yielding, 0],
    ], dtype=complex)
    across = scipy.linalg.expm(-LENGTH * along * units[None, :] / units[:, None]) * units[:, None] / units[None, :]
    # the tension that holds the wall at the other end too
    held = -across[3, :2] / across[3, 2]
    ends = across[:2, :2] + np.outer(across[:2, 2], held)
    return ends[0, 0], ends[0, 1] / area, ends[1, 0] * area


def loop(s, friction=False, creep=None, line=one_wave):
    """L of G_1 and one load pressure behind equal hoses."""
    a, b, c = line(s, friction, creep)
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
    # the end volumes of the models in time hold a hundredth of the compliance, and are left out here
    a, b, c = two_waves(100j, True, None)
    print(f"{'determinant of two waves less one':60s} {abs(a * a - b * c - 1):.1e}")
    assert abs(a * a - b * c - 1) < 1e-9
    check("unstable poles with two waves, without friction", unstable(line=two_waves, top=2e4), 8)
    check("unstable poles with two waves and laminar friction", unstable(line=two_waves, friction=True, top=2e4), 2)
    at = lambda w: loop(1j * w, friction=True)
    for frequency in [1.0, 100.0, 560.0, 1500.0]:
        print(f"L at {frequency} rad/s: {at(frequency):.6g}")
