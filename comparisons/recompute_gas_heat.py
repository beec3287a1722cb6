"""The gas of an accumulator that exchanges heat with its wall, from the first law in kelvins, and nothing of phea.

    P V = m R T        m c_v dT/dt = -P dV/dt - (m c_v/tau) (T - T_w)        c_v = R/(gamma - 1)

After Otis and Pourmovahed (1985), with nitrogen as an ideal gas. A volume that swings by 30 % about that at 35 bar, for 20 s from
rest at the temperature of the wall: pressure, temperature over that of the wall, work and heat at its end.
"""

from math import cos, isclose, log, pi, sin

from scipy.integrate import solve_ivp

ATMOSPHERE = 101_325.0
GAS_CONSTANT, GAMMA, WALL = 296.8, 1.4, 303.15
HEAT_CAPACITY = GAS_CONSTANT / (GAMMA - 1)
GAS_VOLUME, PRECHARGE, REST = 2e-5, 15e5 + ATMOSPHERE, 35e5 + ATMOSPHERE
MASS = PRECHARGE * GAS_VOLUME / (GAS_CONSTANT * WALL)
VOLUME = MASS * GAS_CONSTANT * WALL / REST


def swung(share, rate, tau, until):
    """Temperature in K, work and heat in J at the end, of the volume V_e (1 - share sin(rate t))."""

    def rates(time, state):
        volume = VOLUME * (1 - share * sin(rate * time))
        growing = -VOLUME * share * rate * cos(rate * time)
        pressure = MASS * GAS_CONSTANT * state[0] / volume
        heat = MASS * HEAT_CAPACITY / tau * (state[0] - WALL)
        return [(-pressure * growing - heat) / (MASS * HEAT_CAPACITY), -pressure * growing, heat]

    solved = solve_ivp(rates, (0, until), [WALL, 0, 0], "DOP853", rtol=1e-12, atol=1e-12, max_step=0.05 / rate)
    assert solved.success
    return solved.y[:, -1], VOLUME * (1 - share * sin(rate * until))


def small_signal(rate, tau):
    """dV/dP over that of isothermal gas, by a cycle so small that it is linear, once it repeats."""
    share, periods = 1e-5, 40
    cycle = 2 * pi / rate
    (temperature, _, _), _ = swung(share, rate, tau, max(periods * cycle, 40 * tau) // cycle * cycle)
    # theta - 1 = share Im(H e^jwt); at whole cycles it is the imaginary part
    lead = 0.4 * 1j * rate * tau / (1 + 1j * rate * tau)
    return temperature / WALL - 1, share * lead.imag


def main():
    (temperature, work, heat), volume = swung(0.3, 3.0, 0.4, 20.0)
    pressure = MASS * GAS_CONSTANT * temperature / volume - ATMOSPHERE
    # what is not in the gas has gone to its wall
    assert isclose(MASS * HEAT_CAPACITY * (temperature - WALL), work - heat, rel_tol=1e-9)
    assert isclose(pressure, 2_940_280.9426, abs_tol=1e-3), pressure
    assert isclose(temperature / WALL - 1, -0.0781892549, abs_tol=1e-9)
    assert isclose(work, 15.204442640, abs_tol=1e-7) and isclose(heat, 21.464763071, abs_tol=1e-7)
    print(f"{pressure:.4f} Pa, theta - 1 {temperature / WALL - 1:.10f}, {work:.9f} J, {heat:.9f} J")
    # limits of the time constant: adiabatic and isothermal work of half a cycle
    (hot, work, _), volume = swung(0.3, 3.0, 1e9, pi / 6)
    assert isclose(hot / WALL, (VOLUME / volume) ** (GAMMA - 1), rel_tol=1e-8)
    assert isclose(work, MASS * HEAT_CAPACITY * (hot - WALL), rel_tol=1e-8)
    (cold, work, _), volume = swung(0.3, 3.0, 1e-4, pi / 6)
    assert isclose(work, MASS * GAS_CONSTANT * WALL * log(VOLUME / volume), rel_tol=1e-3)
    found, expected = small_signal(3.0, 0.4)
    assert isclose(found, expected, rel_tol=1e-4), (found, expected)


if __name__ == "__main__":
    main()
