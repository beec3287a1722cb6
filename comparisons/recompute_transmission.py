"""Recomputes the modes of Ledezma's (2019) rig with a hydraulic transmission between force sensor and a load that is held, from pressures and flows.

C_L dp_L/dt = -K_c p_L - A v,  M dv/dt = A p_L - f_v v - K_S d,  with Table 6.3's nominal plant; the transmission has pistons of area B, three
segments of a pipe with a rigid wall, and K_S d = B (p_0 - p_f):

C_0 dp_0/dt = B v_m - q_1,  I dq_j/dt = p_j-1 - p_j - R q_j,  C dp_j/dt = q_j - q_j+1,  C_3 dp_3/dt = q_3,  dd/dt = v - v_m

    python comparisons/recompute_transmission.py
"""

import numpy as np

AREA, MASS, SENSOR, FRICTION, LEAK, STIFFNESS = np.pi / 4 * (0.05**2 - 0.022**2), 13.1, 2e7, 100.0, 6.42e-13, 1.71e7
BULK, DENSITY, VISCOSITY = 1.45e9, 870.0, 46e-6
PISTON, BORE, LENGTH, END = 2e-3, 12e-3, 3.0, 25e-6
SEGMENTS = 3


def rig():
    """States p_L, v, d, then q_j and p_j of each segment."""
    bore = np.pi / 4 * BORE**2
    share = bore * LENGTH / BULK / SEGMENTS
    inertance = DENSITY * LENGTH / bore / SEGMENTS
    resistance = 128 * DENSITY * VISCOSITY * LENGTH / (np.pi * BORE**4) / SEGMENTS
    end = END / BULK + share / 2
    count = 3 + 2 * SEGMENTS
    a = np.zeros((count, count))
    softness = AREA**2 / STIFFNESS
    a[0, [0, 1]] = -LEAK / softness, -AREA / softness
    a[1, [0, 1, 2]] = AREA / MASS, -FRICTION / MASS, -SENSOR / MASS
    # B v_m = C_0 dp_0/dt + q_1 and p_0 = p_f + K_S d/B
    yields = 1 + end * SENSOR / PISTON**2
    a[2, [1, 3]] = 1 / yields, -1 / PISTON / yields
    for j in range(SEGMENTS):
        flow, pressure = 3 + 2 * j, 4 + 2 * j
        before = (2, SENSOR / PISTON) if j == 0 else (pressure - 2, 1.0)
        a[flow, before[0]] += before[1] / inertance
        a[flow, [flow, pressure]] = -resistance / inertance, -1 / inertance
        capacity = end if j == SEGMENTS - 1 else share
        a[pressure, flow] = 1 / capacity
        if j < SEGMENTS - 1:
            a[pressure, flow + 2] = -1 / capacity
    return a


def main():
    poles = np.linalg.eigvals(rig())
    modes = sorted((pole for pole in poles if pole.imag > 1e-6), key=lambda pole: pole.imag)
    expected = ((709.271114, 7.68106328e-3), (1529.15355, 3.31151103e-3), (1845.21957, 2.70578448e-3), (2395.04041, 2.13187477e-3))
    for pole, (frequency, damping) in zip(modes, expected, strict=True):
        found, ratio = abs(pole), -pole.real / abs(pole)
        print(f"{found:.9g} rad/s, damping ratio {ratio:.9g}")
        assert abs(found / frequency - 1) < 1e-7 and abs(ratio / damping - 1) < 1e-6
    slowest = max(pole.real for pole in poles if abs(pole.imag) <= 1e-6)
    print(f"slowest pole {slowest:.9g} 1/s")
    assert abs(slowest / -1.45829212 - 1) < 1e-8


if __name__ == "__main__":
    main()
