"""Accumulators at the chambers, from the polytropic law and nothing of phea.

    V = V_0 (P_0/P)^(1/n)        C = -dV/dP = V_0/(n P_0) (P_0/P)^(1 + 1/n)        P absolute
    K_H = A^2/(A x/beta_0 + C(p_A)) + A^2/(A (L - x)/beta_0 + C(p_B))

The rig of Ledezma (2019): piston of 50 mm, rods of 22 mm, stroke of 500 mm, oil of 1.45 GPa; lines without volume.
"""

from math import isclose, pi

ATMOSPHERE = 101_325.0
AREA = pi / 4 * (0.05**2 - 0.022**2)
STROKE, MODULUS = 0.5, 1.45e9


def volume(gas_volume, precharge, index, pressure):
    """Volume of the gas at a gauge pressure, m3."""
    return gas_volume * ((precharge + ATMOSPHERE) / (pressure + ATMOSPHERE)) ** (1 / index)


def compliance(gas_volume, precharge, index, pressure):
    """-dV/dP of the gas at a gauge pressure, m3/Pa."""
    ratio = (precharge + ATMOSPHERE) / (pressure + ATMOSPHERE)
    return gas_volume / (index * (precharge + ATMOSPHERE)) * ratio ** (1 + 1 / index)


def stiffness(gas, pressures, position=STROKE / 2):
    """K_H in N/m with this gas (V_0, p_0, n) at both chambers; none where it is None."""
    oil = [AREA * position / MODULUS, AREA * (STROKE - position) / MODULUS]
    soft = [0.0, 0.0] if gas is None else [compliance(*gas, pressure) for pressure in pressures]
    return sum(AREA**2 / (one + other) for one, other in zip(oil, soft))


def main():
    # the compliance is the slope of the volume
    step = 1.0
    for index in (1.0, 1.2, 1.4):
        gas = (9.9e-6, 15e5, index)
        slope = (volume(*gas, 35e5 - step) - volume(*gas, 35e5 + step)) / (2 * step)
        assert isclose(compliance(*gas, 35e5), slope, rel_tol=1e-7)
    middle = [35e5, 35e5]
    idle = stiffness((9.9e-6, 35e5, 1.4), middle)
    assert round(idle, -1) == 2.24187e6, idle
    # the same gas, at 9.9 mL when it has 35 bar, fills this volume at a precharge of 15 bar
    precharged = volume(9.9e-6, 35e5, 1.4, 15e5)
    assert round(precharged, 11) == 1.766247e-5, precharged
    same = stiffness((precharged, 15e5, 1.4), middle)
    assert isclose(same, idle, rel_tol=1e-12)
    # 4 kN, half of it by each chamber
    loaded = [35e5 + 2e3 / AREA, 35e5 - 2e3 / AREA]
    assert round(stiffness((precharged, 15e5, 1.4), loaded) / idle, 5) == 1.02821
    # with a precharge of 35 bar the gas of chamber B is shut off then
    assert loaded[1] < 35e5
    # until chamber B has fallen to 15 bar
    assert round(2 * AREA * (35e5 - 15e5), -2) == 6300
    # a neck of 6 mm and 40 mm before it, with oil of 870 kg/m3 and 46 cSt: resonance and damping ratio
    diameter, length = 6e-3, 40e-3
    section = pi / 4 * diameter**2
    inertance = 870 * length / section
    resistance = 128 * 870 * 46e-6 * length / (pi * diameter**4)
    soft = compliance(9.9e-6, 35e5, 1.4, 35e5) + section * length / MODULUS
    resonance, damping = (inertance * soft) ** -0.5, resistance / 2 * (soft / inertance) ** 0.5
    assert isclose(damping, 16 * 46e-6 / (resonance * diameter**2), rel_tol=1e-12)
    assert (round(resonance), round(damping, 3)) == (643, 0.032), (resonance, damping)
    print(f"K_H {idle:.6g} N/m idle, {stiffness((precharged, 15e5, 1.4), loaded) / idle:.5f} of it at 4 kN")
    print(f"V_0 {precharged * 1e6:.4f} mL at 15 bar; without gas K_H {stiffness(None, middle):.4g} N/m")


if __name__ == "__main__":
    main()
