"""Recomputes the effect of load and leakage on the rig of Ledezma (2019): overshoot and slow pole, from block equations.

The spool follows the command, C s p = K_qU U - (K_c + G) p - A s x, M s^2 x = A p - f_v s x - F, F = K_S (x - x_L),
m s^2 x_L = F - c s x_L - k x_L, with Table 6.3's nominal plant, G_1 and F_1.

    python comparisons/recompute_plant.py
"""

import numpy as np
import scipy.signal

AREA, MASS, SENSOR, FRICTION = np.pi / 4 * (0.05**2 - 0.022**2), 13.1, 2e7, 100.0
FLOW_GAIN, LEAK, STIFFNESS, FREQUENCY, DAMPING = 5.4e-5, 6.42e-13, 2.24e6, 1099.0, 0.9


def machine(leakage=0.0, load=None):
    """States spool, its rate, load pressure, deflection, velocity, and position and velocity of the load."""
    a = np.zeros((7, 7))
    a[0, 1] = 1
    a[1, :2] = -(FREQUENCY**2), -2 * DAMPING * FREQUENCY
    a[2, [0, 2, 4]] = np.array([FLOW_GAIN, -(LEAK + leakage), -AREA]) * STIFFNESS / AREA**2
    a[3, [4, 6]] = 1, -1
    a[4, [2, 3, 4]] = AREA / MASS, -SENSOR / MASS, -FRICTION / MASS
    if load is not None:
        mass, stiffness, damping = load
        a[5, 6] = 1
        a[6, [3, 5, 6]] = SENSOR / mass, -stiffness / mass, -damping / mass
    states = 5 if load is None else 7
    b = np.zeros((7, 1))
    b[1] = FREQUENCY**2
    c = np.zeros((1, 7))
    c[0, 3] = SENSOR
    return a[:states, :states], b[:states], c[:, :states]


def overshoot(load):
    """Of a step through F_1 = 910/(s^2 + 83 s + 910) and G_1 = (0.001 s + 0.008)/s, in percent."""
    a, b, c = machine(load=load)
    n = len(a)
    closed = np.zeros((n + 3, n + 3))
    closed[:n, :n] = a - 0.001 * b @ c
    closed[:n, [n]] = b * 0.008
    closed[:n, [n + 1]] = 0.001 * b
    closed[n, :n], closed[n, n + 1] = -c[0], 1
    closed[n + 1, n + 2] = 1
    closed[n + 2, n + 1 :] = -910, -83
    drive = np.zeros((n + 3, 1))
    drive[n + 2] = 910
    out = np.concatenate([c[0], np.zeros(3)])[None]
    times = np.linspace(0, 20, 200001)
    _, force = scipy.signal.step((closed, drive, out, [[0.0]]), T=times)
    return 100 * (force.max() / force[-1] - 1)


def check(name, value, expected, tolerance):
    print(f"{name:60s} {value:.6g}")
    assert abs(value - expected) <= tolerance, f"{name}: {value} is not {expected}"


slowest = lambda leakage: min(np.linalg.eigvals(machine(leakage)[0]), key=abs).real
check("overshoot, prescribed load, %", overshoot(None), 0.41, 5e-3)
check("overshoot, 100 kg on 200 kN/m with 500 N s/m, %", overshoot((100.0, 2e5, 500.0)), 27.98, 5e-3)
check("slow pole, 1/s", slowest(0.0), -0.51584, 5e-6)
check("slow pole with leakage of 1e-11 m3/(s Pa), 1/s", slowest(1e-11), -8.5508, 5e-5)
