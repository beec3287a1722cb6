"""Recomputes what a valve between the chambers does to the load-cell resonance of Ledezma (2019), from block equations.

C dp/dt = K_qU U - K_c p - q_x - A v,  M dv/dt = A p - f_v v - K_S x,  with Table 6.3's nominal plant; the valve is
a laminar conductance, q_x = G p, or that in series with a capacity, q_x = G (p - p_x), C_x dp_x/dt = q_x.

    python comparisons/recompute_cross_port.py
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

AREA, MASS, SENSOR, FRICTION, LEAK = np.pi / 4 * (0.05**2 - 0.022**2), 13.1, 2e7, 100.0, 6.42e-13
HOSE, PIPE = 2.24e6, 1.71e7


def machine(stiffness, conductance, capacity=None):
    """States load pressure, deflection, velocity, and the pressure over the capacity."""
    a = np.zeros((4, 4))
    softness = AREA**2 / stiffness
    a[0, [0, 2, 3]] = -(LEAK + conductance) / softness, -AREA / softness, conductance / softness
    a[1, 2] = 1
    a[2, [0, 1, 2]] = AREA / MASS, -SENSOR / MASS, -FRICTION / MASS
    if capacity is None:
        return a[:3, :3]
    a[3, [0, 3]] = conductance / capacity, -conductance / capacity
    return a


def resonance(*rig):
    return max(np.linalg.eigvals(machine(*rig)), key=lambda pole: pole.imag)


def damping(*rig):
    pole = resonance(*rig)
    return -pole.real / abs(pole)


def check(name, value, expected, tolerance):
    print(f"{name:70s} {value:.6g}")
    assert abs(value / expected - 1) <= tolerance, f"{name}: {value} is not {expected}"


def main():
    check("damping ratio with the hose and no valve", damping(HOSE, 0.0), 0.00295149, 1e-5)
    # the hose is a tenth as stiff as the sensor, so that no valve beside it damps the sensor's resonance much
    best = minimize_scalar(lambda power: -damping(HOSE, 10**power), bounds=(-11, -7), method="bounded", options={"xatol": 1e-9})
    check("most that a laminar valve adds with the hose", -best.fun, 0.0303473, 1e-5)
    check("    at a conductance in m3/(s Pa)", 10**best.x, 1.50126e-9, 1e-4)
    power = brentq(lambda power: damping(PIPE, 10**power) - 0.1, -12, -9.6, xtol=1e-13)
    conductance = 10**power
    check("conductance for a damping ratio of 0.1 with pipes, m3/(s Pa)", conductance, 1.076440e-10, 1e-6)
    check("    L/min at 25 bar", conductance * 25e5 * 6e4, 16.14661, 1e-6)
    check("    W at 25 bar", conductance * 25e5**2, 672.775, 1e-6)
    for share, ratio in ((1, 0.0711360), (3, 0.0922906)):
        capacity = share * AREA**2 / PIPE
        check(f"damping ratio in series with {share} A^2/K_H", damping(PIPE, conductance, capacity), ratio, 1e-5)


if __name__ == "__main__":
    main()
