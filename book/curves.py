"""Curves that the theory pages draw and quote, from the equations alone and without phea; SI units inside.

The rig is that of examples/ybitu/hose.toml: edges of Table 5.1, 70 bar, 1.5 m of Eaton Synflex 3130-08 a side. `figures.py` draws
these curves, `recompute_curves.py` checks the numbers that the pages quote, `comparisons/compare_book.py` compares both with phea.
"""

import math

import numpy as np
import scipy.integrate
import scipy.optimize

SUPPLY, TANK, NOMINAL, SHAPE, TRANSITION = 7e6, 0.0, 10.0, 100.0, 1e3
FLOW = (3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7)  # supply to A, A to tank, supply to B, B to tank: Table 5.1
LEAK = (2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9)
TARE = 7.55e-6
PUMP = 9.8e-3 / 60
AREA = math.pi / 4 * (0.05**2 - 0.022**2)
STROKE, MASS, FRICTION, SENSOR = 0.5, 13.1, 100.0, 2e7
SPOOL, DAMPING = 1099.0, 0.9
BORE, EXPANSION, REFERENCE, SLOPE = 12.7e-3, 1.56e-5, 7e6, 2.236e-12
OIL, STIFFENING, LENGTH = 1.45e9, 5.0, 1.5
COULOMB, BREAKAWAY, STRIBECK, BRISTLES, BRISTLE_DAMPING, VISCOUS = 80.0, 120.0, 0.01, 1e7, 2000.0, 100.0
GAIN, INTEGRAL = 0.001, 0.008  # G1 = (0.001 s + 0.008)/s
FLOW_GAIN, FLOW_PRESSURE, STIFFNESS = 5.4e-5, 6.42e-13, 2.24e6  # nominal plant of Table 6.3


def root(drop):
    return drop / (drop**2 + TRANSITION**2) ** 0.25


def sech(argument):
    return 1 / np.cosh(np.clip(argument, -700, 700))


def openings(spool, flow=FLOW, leak=LEAK):
    """Flow through each edge over the root of its drop, 4.2 to 4.9 with sech on each leakage."""
    forward, backward, shut = max(spool, 0) / NOMINAL, max(-spool, 0) / NOMINAL, sech(SHAPE * spool / NOMINAL)
    return [f * u + k * shut for f, u, k in zip(flow, (forward, backward, backward, forward), leak)]


def chamber_flows(spool, pressure_a, pressure_b, flow=FLOW, leak=LEAK):
    """Flows into A and into B, and what the supply gives."""
    edges = openings(spool, flow, leak)
    drops = (SUPPLY - pressure_a, pressure_a - TANK, SUPPLY - pressure_b, pressure_b - TANK)
    into_a, from_a, into_b, from_b = (o * root(d) for o, d in zip(edges, drops))
    return into_a - from_a, into_b - from_b, into_a + into_b


def blocked(spool):
    """Pressures of shut ports."""
    def solve(side):
        return scipy.optimize.brentq(
            lambda p: chamber_flows(spool, p, p)[side], TANK - 1e3, SUPPLY + 1e3, xtol=1e-6
        )
    return solve(0), solve(1)


def leakage(spool):
    """Flow from the supply at shut ports, without the first stage's, and that of 4.14 with the mean of the edges."""
    pressure_a, pressure_b = blocked(spool)
    single = np.mean(LEAK) * sech(SHAPE * spool / NOMINAL) * math.sqrt(2 * SUPPLY)
    return chamber_flows(spool, pressure_a, pressure_b)[2], single


def unloaded(spool):
    """Flow of a symmetric piston that nothing holds: what A takes B gives, at one pressure."""
    def excess(pressure):
        into_a, into_b, _ = chamber_flows(spool, pressure, pressure)
        return into_a + into_b
    pressure = scipy.optimize.brentq(excess, TANK - 1e3, SUPPLY + 1e3, xtol=1e-6)
    return chamber_flows(spool, pressure, pressure)[0]


def equal_edges(spool, load, flow=2.97e-7, leak=2.402e-9):
    """K_qU as 4.21 prints it, with the leakage, and K_c of 4.22, for equal edges and a square root without transition."""
    sign = 1.0 if spool >= 0 else -1.0
    outer, inner = math.sqrt((SUPPLY + sign * load) / 2), math.sqrt((SUPPLY - sign * load) / 2)
    argument = SHAPE * abs(spool) / NOMINAL
    shut = sech(argument)
    printed = flow / NOMINAL * inner
    gain = printed + leak * SHAPE / NOMINAL * shut * math.tanh(argument) * (outer - inner)
    pressure = (flow * abs(spool) / NOMINAL + leak * shut) / (4 * inner) + leak * shut / (4 * outer)
    return printed, gain, pressure


def holding_command(load, flow=2.97e-7, leak=2.402e-9):
    """Command of equal edges that holds a load pressure at shut ports."""
    def control(spool):
        sign = 1.0 if spool >= 0 else -1.0
        outer, inner = math.sqrt((SUPPLY + sign * load) / 2), math.sqrt((SUPPLY - sign * load) / 2)
        shut = leak * sech(SHAPE * spool / NOMINAL)
        return sign * ((flow * abs(spool) / NOMINAL + shut) * inner - shut * outer)
    return scipy.optimize.brentq(control, -1, 1, xtol=1e-15)


def sliding(velocity):
    """g(v) of 4.31."""
    return COULOMB + (BREAKAWAY - COULOMB) * np.exp(-((np.abs(velocity) / STRIBECK) ** 2))


def steady(velocity):
    """4.33."""
    return np.sign(velocity) * sliding(velocity) + VISCOUS * velocity


def smoothed(velocity, regular):
    return sliding(velocity) * velocity / np.hypot(velocity, regular) + VISCOUS * velocity


def bristles(amplitude, frequency, periods=3, points=2000):
    """Velocity and LuGre friction over the last period of v = amplitude sin(2 pi f t)."""
    omega = 2 * math.pi * frequency
    velocity = lambda t: amplitude * np.sin(omega * t)
    rate = lambda t, z: velocity(t) - BRISTLES * abs(velocity(t)) * z / sliding(velocity(t))
    slope = lambda t, z: [[-BRISTLES * abs(velocity(t)) / sliding(velocity(t))]]
    end = periods / frequency
    times = np.linspace(end - 1 / frequency, end, points)
    found = scipy.integrate.solve_ivp(
        rate, (0, end), [0.0], "Radau", times, jac=slope, rtol=1e-9, atol=1e-13, max_step=0.002 / frequency
    )
    z = found.y[0]
    return velocity(times), BRISTLES * z + BRISTLE_DAMPING * rate(times, z) + VISCOUS * velocity(times)


def expansion(pressure):
    """E(p) of 6.23, a straight line as in 6.24."""
    return EXPANSION + SLOPE * (pressure - REFERENCE)


def bore_area():
    return math.pi / 4 * BORE**2


def uniform_modulus(stiffening=STIFFENING):
    wall = stiffening * (bore_area() + EXPANSION) / SLOPE
    return wall * OIL / (wall + OIL)


def compliances(length, position, model, stiffening=STIFFENING):
    """C_A and C_B of both stiffness models."""
    swept = (AREA * position, AREA * (STROKE - position))
    if model == "uniform":
        return [(volume + bore_area() * length) / uniform_modulus(stiffening) for volume in swept]
    held = bore_area() + expansion(SUPPLY / 2)
    return [volume / OIL + SLOPE * length / stiffening + held * length / OIL for volume in swept]


def stiffness(length, position, model, stiffening=STIFFENING):
    return sum(AREA**2 / compliance for compliance in compliances(length, position, model, stiffening))


def denominator(stiffness, flow_pressure, friction=FRICTION, sensor=SENSOR, spool=SPOOL, damping=DAMPING, mass=MASS):
    """6.7 without and with the spool's factor, highest power first."""
    leak, square = flow_pressure * stiffness, AREA**2
    piston = [
        square * mass,
        square * friction + leak * mass,
        square * (stiffness + sensor) + leak * friction,
        leak * sensor,
    ]
    return piston, np.polymul(piston, [1, 2 * damping * spool, spool**2])


def poles(stiffness, flow_pressure, friction=FRICTION, sensor=SENSOR, mass=MASS):
    """The slow pole and the piston's pair of 6.7."""
    roots = np.roots(denominator(stiffness, flow_pressure, friction, sensor, mass=mass)[0])
    slow = roots[np.argmin(np.abs(roots))].real
    pair = roots[np.argmax(roots.imag)]
    return slow, pair


def admittance(omega, stiffness, gain=GAIN, integral=INTEGRAL, friction=FRICTION, flow_gain=FLOW_GAIN,
               flow_pressure=FLOW_PRESSURE, sensor=SENSOR, spool=SPOOL):
    """1/Z of the closed loop: the sensor's spring in series with piston, fluid and feedback."""
    s = 1j * np.asarray(omega)
    fluid = 1 / (s / stiffness + flow_pressure / AREA**2)
    piston = MASS * s + friction
    lag = spool**2 / (s**2 + 2 * DAMPING * spool * s + spool**2)
    feedback = flow_gain / AREA * lag * (gain + integral / s)
    return s / sensor + (1 + fluid * feedback) / (fluid + piston)


FREQUENCIES = np.geomspace(1, 1e5, 40001)


def gives_energy(stiffness, **rest):
    """Where on the grid Re Z < 0, which is where Re 1/Z < 0."""
    return admittance(FREQUENCIES, stiffness, **rest).real < 0


def active_band(stiffness, **rest):
    """Ends of the band in which Re Z < 0, in rad/s; None where there is none."""
    negative = gives_energy(stiffness, **rest)
    if not negative.any():
        return None
    grid, (first, last) = FREQUENCIES, np.nonzero(negative)[0][[0, -1]]
    edge = lambda a, b: scipy.optimize.brentq(lambda w: admittance(w, stiffness, **rest).real, a, b, xtol=1e-9)
    return edge(grid[first - 1], grid[first]), edge(grid[last], grid[last + 1])


def friction_for_passivity(stiffness, **rest):
    """Least f_v with Re Z >= 0 at every frequency, by bisection; the integral action sets an upper end too, far above."""
    low, high = 0.0, 1e4
    for _ in range(36):
        middle = (low + high) / 2
        low, high = (middle, high) if gives_energy(stiffness, friction=middle, **rest).any() else (low, middle)
    return high


def tuned_gain(stiffness, time_constant=0.05):
    """K_p of 6.27."""
    series = stiffness * SENSOR / (stiffness + SENSOR)
    return (AREA / (time_constant * series) - FLOW_PRESSURE / AREA) / FLOW_GAIN


def unstable_springs(stiffness, **rest):
    """Ends of the stiffness between piston and ground, sensor and environment in series, with which the loop is unstable."""
    ends = active_band(stiffness, **rest)
    return [1 / (admittance(w, stiffness, sensor=math.inf, **rest).imag / -w) for w in ends]


def closed_loop(stiffness, sensor, friction=FRICTION, gain=GAIN, integral=INTEGRAL):
    """Poles of 6.8 under a PI controller, the load held."""
    full = np.polymul(denominator(stiffness, FLOW_PRESSURE, friction, sensor)[1], [1, 0])
    driven = AREA * stiffness * FLOW_GAIN * sensor * SPOOL**2
    return np.roots(np.polyadd(full, driven * np.array([gain, integral])))


def chamber_pair(area_b, position, model="by_volume", flow=2.97e-7, leak=2.402e-9, length=LENGTH):
    """Two pressures of a cylinder with its rod on one side, equal edges at null: areas, compliances, gain, K_cA = K_cB."""
    areas = (math.pi / 4 * 0.05**2, area_b)
    shares = (position, STROKE - position)
    held = bore_area() + expansion(SUPPLY / 2)
    if model == "uniform":
        capacities = [(a * x + bore_area() * length) / uniform_modulus() for a, x in zip(areas, shares)]
    else:
        line = SLOPE * length / STIFFENING + held * length / OIL
        capacities = [a * x / OIL + line for a, x in zip(areas, shares)]
    return areas, capacities, flow / NOMINAL * math.sqrt(SUPPLY / 2), leak / math.sqrt(SUPPLY / 2)


def reduction_cost(area_b, position, model="by_volume", least=1e-3):
    """Largest difference of F_e/U_C in dB and degrees between two pressures and their reduction, and of the static gain as a factor.

    Frequencies from `least` rad/s up.
    """
    (a, b), (c_a, c_b), gain, leak = chamber_pair(area_b, position, model)
    mean, stiffness = (a + b) / 2, a**2 / c_a + b**2 / c_b
    reduced_gain = mean / stiffness * gain * (a / c_a + b / c_b)
    reduced_leak = mean**2 * leak / (a**2 + b**2)
    s = 1j * np.geomspace(least, 2e4, 200001)
    y_a, y_b = c_a * s + leak, c_b * s + leak

    def force(own, driven, displaced):
        return driven / ((MASS * s**2 + FRICTION * s + SENSOR) * own + displaced * s)

    two = force(y_a * y_b, gain * (a * y_b + b * y_a), a**2 * y_b + b**2 * y_a)
    own = mean**2 * s + reduced_leak * stiffness
    one = force(own, mean * stiffness * reduced_gain, mean**2 * stiffness)
    quotient = one / two
    static = mean * reduced_gain / reduced_leak / (gain * (a + b) / leak)
    return np.abs(20 * np.log10(np.abs(quotient))).max(), np.abs(np.degrees(np.angle(quotient))).max(), static
