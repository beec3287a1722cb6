"""Recomputes the motion of a knee behind its linkage from a Lagrangian in the coordinates of the rod.

x is the piston's position and y that of the rod's end behind the force sensor. The joint's angle follows from the
positions of both pivots; mass matrix and forces follow from the energies by complex steps, so that the lever arm
appears nowhere:

    L = M x'^2/2 + J (d theta/dy y')^2/2 - K_S (x - y)^2/2 - k (theta - theta_0)^2/2 - m g d sin(theta - theta_l)
    d/dt dL/dq' - dL/dq = Q,      Q = (F - f x', -c (d theta/dy)^2 y')

A four-bar is closed by a root finder on the distance between the ends of its links.

    python comparisons/recompute_linkage.py
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

MASS, SENSOR, FRICTION, FORCE = 0.6, 1e6, 50.0, 600.0
INERTIA, STIFFNESS, DAMPING, RELAXED = 0.2, 60.0, 0.8, 0.8
A, B, RETRACTED, OFFSET = 0.30, 0.05, 0.26, 0.4
# m g d of a load of 3 kg, 0.4 m from the joint, and the angle at which it is level
WEIGHT, LEVEL = 3.0 * 0.4 * 9.80665, 0.9
START = 0.02
H = 1e-30


def opening(length):
    """Angle between the arms of a triangle, for real and complex lengths: the rod's pivot is this far along the other arm."""
    along = (A * A + B * B - length * length) / (2 * A)
    return np.arccos(along / B + 0j)


def theta(y):
    return opening(RETRACTED + y) - OFFSET


def slope(y):
    return theta(y + 1j * H).imag / H


def lagrangian(q, v, weight):
    x, y = q
    step = 3e-5
    # slope of theta at a complex y: a central difference of fourth order
    rate = (8 * (theta(y + step) - theta(y - step)) - (theta(y + 2 * step) - theta(y - 2 * step))) / (12 * step)
    kinetic = MASS * v[0] ** 2 / 2 + INERTIA * (rate * v[1]) ** 2 / 2
    held = SENSOR * (x - y) ** 2 / 2 + STIFFNESS * (theta(y) - RELAXED) ** 2 / 2
    return kinetic - held - weight * np.sin(theta(y) - LEVEL)


# All evaluations of L in one call. Its place is moved along an imaginary step, by a unit or by the motion itself;
# its velocities are fixed, with or without those of the motion.
UNITS = [(1, 0), (0, 1)]
MOVED = np.array(UNITS + [(0, 0)] * 12).T
MOVED_ALONG = np.array([0] * 8 + [1] * 6)
VELOCITIES = np.array([(0, 0)] * 2 + [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2)] + [(0, 0)] + UNITS + [(0, 0)] + UNITS).T
IN_MOTION = np.array([1] * 2 + [0] * 6 + [0] * 3 + [1] * 3)


def accelerations(q, v, weight):
    motion = v[:, None]
    places = q[:, None] + 1j * H * (MOVED + motion * MOVED_ALONG)
    value = lagrangian(places, VELOCITIES + motion * IN_MOTION, weight)
    by_position = value[:2].imag / H
    # the kinetic energy is quadratic in the velocities: the mass matrix by its values for unit velocities
    still, first, second, both, twice_first, twice_second = value[2:8].real
    across = both - first - second + still
    matrix = np.array([[twice_first - 2 * first + still, across], [across, twice_second - 2 * second + still]])
    # d/dt of the momenta less the mass matrix times the accelerations, by the change of the matrix along the motion
    at_rest, with_units, moving, moving_with_units = value[8], value[9:11], value[11], value[12:]
    changing = (moving_with_units - moving - with_units + at_rest).imag / H
    forces = np.array([FORCE - FRICTION * v[0], -DAMPING * slope(q[1]) ** 2 * v[1]])
    return np.linalg.solve(matrix, by_position + forces - changing)


def swing(weight=0.0):
    def rates(_, state):
        return np.concatenate([state[2:], accelerations(state[:2], state[2:], weight)])

    start = [START, START, 0.0, 0.0]
    found = solve_ivp(rates, (0, 0.3), start, method="DOP853", rtol=1e-10, atol=1e-12, t_eval=[0.1, 0.2, 0.3])
    return [(theta(y).real, slope(y) * vy, x) for x, y, _, vy in found.y.T]


def four_bar(position, crossed):
    """psi of the output link, its end found where it is as far from the input link's end as the coupler is long."""
    fixed, link, coupler, output, ahead = 0.20, 0.06, 0.19, 0.08, 0.2
    alpha = opening(RETRACTED + position).real + ahead
    end = link * np.exp(1j * alpha)
    missing = lambda psi: abs(fixed + output * np.exp(1j * psi) - end) - coupler
    towards = np.angle(end - fixed)
    # open: clockwise from the direction of the input link's end, crossed: the other way
    way = 1 if crossed else -1
    return brentq(lambda turn: missing(towards + way * turn), 0, np.pi, xtol=1e-15)*way + towards


def check(name, value, expected, tolerance):
    print(f"{name:60s} {value:.12g}")
    assert abs(value - expected) <= tolerance, f"{name}: {value} is not {expected}"


EXPECTED = [
    (1.2900616606, 8.4089047904, 0.050539821926),
    (1.6246320573, -2.9160959637, 0.065651126943),
    (1.1146757781, -4.0519756022, 0.041966993124),
]
HEAVY = [
    (1.0930858959, 5.7610605227, 0.040878876723),
    (1.3652031094, -1.2226167775, 0.054126149024),
    (1.0418365702, -3.3127000226, 0.038335202248),
]
LINKS = {
    (0.00, False): 1.193122678410,
    (0.04, False): 1.796072303383,
    (0.08, False): 2.496345463151,
    (0.00, True): 4.561749849302,
    (0.04, True): 3.926441197654,
    (0.08, True): 3.563629475758,
}


def main():
    for time, found, expected in zip((0.1, 0.2, 0.3), swing(), EXPECTED):
        for name, value, told in zip(("theta, rad", "omega, rad/s", "x, m"), found, expected):
            check(f"{name} at {time} s", value, told, 1e-8 * max(1, abs(told)))
    for time, found, expected in zip((0.1, 0.2, 0.3), swing(WEIGHT), HEAVY):
        for name, value, told in zip(("theta, rad", "omega, rad/s", "x, m"), found, expected):
            check(f"{name} at {time} s, with its weight", value, told, 1e-8 * max(1, abs(told)))
    for (position, crossed), told in LINKS.items():
        turned = (four_bar(position, crossed) - told + np.pi) % (2 * np.pi) - np.pi + told
        check(f"psi at {position} m, {'crossed' if crossed else 'open'}", turned, told, 1e-11)


if __name__ == "__main__":
    main()
