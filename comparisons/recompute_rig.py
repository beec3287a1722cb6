"""Recomputes the numbers of the thesis' rig with which the tests of hydraulics and workbench compare phea.

Independent of phea: NumPy and SciPy only, from the component equations (matrices of the physical states, roots by
bracketing), never from the expanded coefficients of Ledezma (2019), equation 6.7. Prints one line for each number.

    python comparisons/recompute_rig.py
"""

import numpy as np
from scipy.linalg import eigvals
from scipy.optimize import brentq, minimize_scalar

AREA = np.pi / 4 * (0.05**2 - 0.022**2)
MASS, STROKE, SUPPLY, NOMINAL_VOLTAGE = 13.1, 0.5, 70e5, 10.0
VALVE_FREQUENCY, VALVE_DAMPING = 1099.0, 0.9
FLUID_MODULUS, DENSITY = 1.45e9, 870.0
BORE, EXPANSION, EXPANSION_SLOPE, STIFFENING, LENGTH = 12.7e-3, 1.56e-5, 2.236e-12, 5.0, 1.5
OPERATING = SUPPLY / 2
EDGES = {"3": 3.2e-7, "4": 2.5e-7, "5": 2.0e-7, "6": 3.85e-7}
LEAKS = {"3": 2.35e-9, "4": 2.2e-9, "5": 1.7e-9, "6": 2.35e-9}


def show(name, *values):
    print(f"{name:58s}", *(f"{value:.8g}" for value in values))


def blocks(area_a, area_b, c_a, c_b, kq_a, kc_a, kq_b, kc_b, friction, sensor):
    """State matrices of valve, two chambers, piston and sensor; inputs U_C and load velocity, output the force."""
    a, b, c = np.zeros((6, 6)), np.zeros((6, 2)), np.zeros((1, 6))
    a[0, 1] = 1
    a[1, 0], a[1, 1] = -(VALVE_FREQUENCY**2), -2 * VALVE_DAMPING * VALVE_FREQUENCY
    b[1, 0] = VALVE_FREQUENCY**2
    a[2, 0], a[2, 2], a[2, 5] = kq_a / c_a, -kc_a / c_a, -area_a / c_a
    a[3, 0], a[3, 3], a[3, 5] = -kq_b / c_b, -kc_b / c_b, area_b / c_b
    a[4, 5], b[4, 1] = 1, -1
    a[5, 2], a[5, 3], a[5, 4], a[5, 5] = area_a / MASS, -area_b / MASS, -sensor / MASS, -friction / MASS
    c[0, 4] = sensor
    scale = np.array([1, 1e3, 1e5, 1e5, 1e-4, 1e-2])
    return a / scale[:, None] * scale, b / scale[:, None], c * scale


def one_pressure(stiffness, kq, kc, friction, sensor):
    """The same with one load pressure: the blocks behind equation 6.7."""
    compliance = AREA**2 / stiffness
    a, b, c = np.zeros((5, 5)), np.zeros((5, 2)), np.zeros((1, 5))
    a[0, 1] = 1
    a[1, 0], a[1, 1] = -(VALVE_FREQUENCY**2), -2 * VALVE_DAMPING * VALVE_FREQUENCY
    b[1, 0] = VALVE_FREQUENCY**2
    a[2, 0], a[2, 2], a[2, 4] = kq / compliance, -kc / compliance, -AREA / compliance
    a[3, 4], b[3, 1] = 1, -1
    a[4, 2], a[4, 3], a[4, 4] = AREA / MASS, -sensor / MASS, -friction / MASS
    c[0, 3] = sensor
    scale = np.array([1, 1e3, 1e5, 1e-4, 1e-2])
    return a / scale[:, None] * scale, b / scale[:, None], c * scale


def response(system, frequency, channel):
    a, b, c = system
    return (c @ np.linalg.solve(1j * frequency * np.eye(len(a)) - a, b[:, channel]))[0]


def decomposed(frequency, stiffness, kq, kc, friction, sensor, corrected):
    s = 1j * frequency
    equivalent = stiffness * sensor / (stiffness + sensor)
    d0, d1 = (stiffness + sensor) / MASS, friction / MASS
    if corrected:
        d1 += kc * stiffness**2 / (AREA**2 * (stiffness + sensor))
    valve = VALVE_FREQUENCY**2 / (s**2 + 2 * VALVE_DAMPING * VALVE_FREQUENCY * s + VALVE_FREQUENCY**2)
    return kq * equivalent / AREA / (s + kc * equivalent / AREA**2) * d0 / (s**2 + d1 * s + d0) * valve


def worst(ratios):
    return np.max(np.abs(20 * np.log10(np.abs(ratios)))), np.max(np.abs(np.degrees(np.angle(ratios))))


def stiffness_chain():
    hose_area = np.pi / 4 * BORE**2
    static = (hose_area + EXPANSION) / EXPANSION_SLOPE
    effective = 1 / (1 / FLUID_MODULUS + 1 / (STIFFENING * static))
    volume = hose_area * LENGTH
    show("useful area m2", AREA)
    show("static hose modulus, effective modulus Pa", static, effective)
    for ratio in (1.0, 4.0, 5.0):
        modulus = 1 / (1 / FLUID_MODULUS + 1 / (ratio * static))
        show(f"uniform K_H at mid stroke, stiffening {ratio:g}", 4 * modulus * AREA**2 / (AREA * STROKE + 2 * volume))

    def total(x, chamber_modulus, line):
        ca = AREA * x / chamber_modulus + line
        cb = AREA * (STROKE - x) / chamber_modulus + line
        return AREA**2 / ca + AREA**2 / cb

    def by_sheet(length, pressure, ratio=STIFFENING):
        """dV/dp = epsilon L/r_beta of the wall, and the oil that the bore holds at this pressure."""
        held = hose_area + EXPANSION + EXPANSION_SLOPE * (pressure - SUPPLY)
        return EXPANSION_SLOPE * length / ratio + held * length / FLUID_MODULUS

    line = by_sheet(LENGTH, OPERATING)
    printed = volume / effective
    unexpanded = EXPANSION_SLOPE * LENGTH / STIFFENING + volume / FLUID_MODULUS
    show("hose by its sheet at 35 bar: dV/dp per metre", by_sheet(1.0, OPERATING))
    show("uniform K_H at centre, end", total(STROKE / 2, effective, printed), total(0, effective, printed))
    show("by volume K_H at centre, end", total(STROKE / 2, FLUID_MODULUS, line), total(0, FLUID_MODULUS, line))
    for ratio in (4.0, 5.0):
        soft = by_sheet(LENGTH, OPERATING, ratio)
        show(f"by volume, stiffening {ratio:g}: K_H at centre, end", *(total(x, FLUID_MODULUS, soft) for x in (STROKE / 2, 0)))
    known = (line, 4.630e6), (unexpanded, 4.665e6), (by_sheet(LENGTH, SUPPLY), 4.596e6), (printed, 5.008e6)
    for compliance, stiffness in known:
        assert abs(total(STROKE / 2, FLUID_MODULUS, compliance) - stiffness) < 0.5e3
    show("the same with the unexpanded bore's oil", total(STROKE / 2, FLUID_MODULUS, unexpanded))
    show("the same with the bore at 70 bar", total(STROKE / 2, FLUID_MODULUS, by_sheet(LENGTH, SUPPLY)))
    old = total(STROKE / 2, FLUID_MODULUS, printed), total(0, FLUID_MODULUS, printed)
    show("modulus of 6.24 on the unexpanded bore: centre, end", *old)
    show("6.24 too stiff by %", 100 * (old[0] / total(STROKE / 2, FLUID_MODULUS, line) - 1))
    held = hose_area + EXPANSION + EXPANSION_SLOPE * (OPERATING - SUPPLY)
    speed = np.sqrt(held / (by_sheet(1.0, OPERATING) * DENSITY))
    show("wave speed, delay, quarter wave at 35 bar", speed, LENGTH / speed, np.pi * speed / (2 * LENGTH))

    def by_volume(length):
        return 2 * AREA**2 / (AREA * STROKE / 2 / FLUID_MODULUS + by_sheet(length, OPERATING))

    show("by volume length for 2.24e6 N/m", brentq(lambda l: by_volume(l) - 2.24e6, 0.1, 100))
    pipe = np.pi / 4 * 0.0105**2 * 0.35
    pipe_at = lambda x: FLUID_MODULUS * AREA**2 * (1 / (AREA * x + pipe) + 1 / (AREA * (STROKE - x) + pipe))
    show("pipe 10.5 mm, 0.35 m: K_H at centre, end", pipe_at(STROKE / 2), pipe_at(0))
    big, small = np.pi / 4 * 0.05**2, AREA
    asymmetric = lambda x: FLUID_MODULUS * (big**2 / (big * x + pipe) + small**2 / (small * (STROKE - x) + pipe))
    softest = minimize_scalar(asymmetric, bounds=(0, STROKE), method="bounded", options={"xatol": 1e-12})
    show("one rod, the pipe: least K_H, position, ends", softest.fun, softest.x, asymmetric(0), asymmetric(STROKE))
    return effective, volume


def table_6_1():
    for stiffness in (1.5e7, 1.5e6, 1.5e5):
        poles = eigvals(one_pressure(stiffness, 5.4e-5, 5.7e-13, 299.0, 9.81e7)[0])
        for pole in sorted(poles[poles.imag >= 0], key=lambda pole: -pole.real):
            show(f"Table 6.1, K_H {stiffness:g}", pole.real, pole.imag)


def table_6_2(effective):
    hose_area = np.pi / 4 * BORE**2
    kq, kc, sensor, tau = 5.62e-5, 6.42e-13, 2e7, 0.05

    def time_constant(stiffness, gain):
        equivalent = stiffness * sensor / (stiffness + sensor)
        return 1 / (kc * equivalent / AREA**2 + gain * kq * equivalent / AREA)

    for gain in (0.01, 0.001, 0.0005, 0.00025):
        stiffness = brentq(lambda k: time_constant(k, gain) - tau, 1e3, 1e10, xtol=1e-6)
        length = (4 * effective * AREA**2 / stiffness - AREA * STROKE) / (2 * hose_area)
        show(f"Table 6.2, K_p {gain:g}: K_H, L_ho", stiffness, length)
    stiffness = 4 * effective * AREA**2 / (AREA * STROKE + 2 * hose_area * LENGTH)
    show("K_p for 1.5 m", brentq(lambda gain: time_constant(stiffness, gain) - tau, 1e-6, 1))
    kq = 5.4e-5
    show("K_p for 1.5 m with K_qU 5.4e-5", brentq(lambda gain: time_constant(stiffness, gain) - tau, 1e-6, 1))
    kq = 5.62e-5
    show("K_p at which K_H is infinite", brentq(lambda gain: time_constant(1e16, gain) - tau, 1e-6, 1))
    for kc, name in ((6.42e-13, "null"), (7e-11, "largest")):
        driven = AREA * 2.73e-4 * 5.62e-5
        show(f"K_SS at K_p 2.73e-4, {name} K_c", driven / (kc + driven))


def decomposition_errors():
    case = (1.5e7, 5.4e-5, 5.7e-13, 299.0, 9.81e7)
    below = np.logspace(-3, 3, 2001)
    resonance = abs(eigvals(one_pressure(*case)[0])).max()
    for corrected in (False, True):
        name = "corrected" if corrected else "printed"
        ratio = lambda w: decomposed(w, *case, corrected) / response(one_pressure(*case), w, 0)
        show(f"6.12 {name} below 1000 rad/s: dB, deg", *worst([ratio(w) for w in below]))
        near = np.linspace(resonance - 60, resonance + 60, 4001)
        show(f"6.12 {name} at 2938 rad/s: dB, deg", *worst([ratio(2938.0)]))
        show(f"6.12 {name} around {resonance:.1f} rad/s: dB, deg", *worst([ratio(w) for w in near]))
    grid = np.concatenate([np.logspace(-3, 4, 1401), np.linspace(1200, 1500, 6001)])
    for corrected in (False, True):
        largest = (0.0, 0.0)
        for stiffness in (2.24e6, 4.11e6):
            for friction in (100.0, 3e4):
                for kc in (6.42e-13, 7e-11):
                    case = (stiffness, 5.4e-5, kc, friction, 2e7)
                    system = one_pressure(*case)
                    ratios = [decomposed(w, *case, corrected) / response(system, w, 0) for w in grid]
                    largest = max(largest, worst(ratios))
        show(f"6.12 {'corrected' if corrected else 'printed'} over Table 6.3: dB, deg", *largest)


def passivity():
    system = one_pressure(2.24e6, 5.4e-5, 6.42e-13, 100.0, 2e7)

    def impedance(frequency, closed):
        loop = (0.001 + 0.008 / (1j * frequency)) * response(system, frequency, 0) if closed else 0
        return -response(system, frequency, 1) / (1 + loop)

    grid = np.logspace(-3, 5, 8001)
    show("open loop: least Re Z", min(impedance(w, False).real for w in grid))
    real = np.array([impedance(w, True).real for w in grid])
    for i in np.nonzero(np.diff(np.sign(real)))[0]:
        show("closed loop: Re Z changes sign at rad/s", brentq(lambda w: impedance(w, True).real, grid[i], grid[i + 1]))


def off_centre(effective, volume):
    kq, kc, friction, sensor = 5.62e-5, 6.42e-13, 100.0, 2e7
    grid = np.logspace(-3, 4, 2001)
    for x in (0.25, 0.1, 0.0):
        c_a, c_b = (volume + AREA * x) / effective, (volume + AREA * (STROKE - x)) / effective
        full = blocks(AREA, AREA, c_a, c_b, kq, 2 * kc, kq, 2 * kc, friction, sensor)
        reduced = one_pressure(AREA**2 * (1 / c_a + 1 / c_b), kq, kc, friction, sensor)
        for channel, name in ((0, "command"), (1, "load")):
            ratios = [response(reduced, w, channel) / response(full, w, channel) for w in grid]
            show(f"6.7 against two pressures at x = {x:g}, {name}: dB, deg", *worst(ratios))


def valve():
    root = np.sqrt(SUPPLY)
    gallon, high = 3.785411784e-3 / 60, 3000 * 6894.757293168
    tare = 7.55e-6 * np.sqrt(high / SUPPLY)
    show("K_vinp of 0.40 gpm, the tare measured at 70 bar", (0.40 * gallon - tare) / np.sqrt(2 * high))
    show("tare of 0.26 gpm at 3000 psi, at 70 bar", 0.26 * gallon * np.sqrt(SUPPLY / high))
    series = lambda one, other: 1 / np.sqrt(1 / one**2 + 1 / other**2) * root / NOMINAL_VOLTAGE
    show("flow gain, edges in series, extending", series(EDGES["3"], EDGES["6"]))
    show("flow gain, edges in series, retracting", series(EDGES["5"], EDGES["4"]))
    half = np.sqrt(SUPPLY / 2) / NOMINAL_VOLTAGE
    show("flow gain, mean of chambers, extending", (EDGES["3"] + EDGES["6"]) / 2 * half)
    show("flow gain, mean of chambers, retracting", (EDGES["4"] + EDGES["5"]) / 2 * half)
    balance = lambda supply, tank: brentq(lambda p: supply * np.sqrt(SUPPLY - p) - tank * np.sqrt(p), 0, SUPPLY)
    p_a, p_b = balance(LEAKS["3"], LEAKS["4"]), balance(LEAKS["5"], LEAKS["6"])
    show("null valve, unequal edges: p_A, p_B", p_a, p_b)
    show("null valve, unequal edges: force N", AREA * (p_a - p_b))
    equal = lambda p_l: 3.0e-7 / NOMINAL_VOLTAGE * np.sqrt((SUPPLY - p_l) / 2)
    show("K_qU of 4.21 with K_vp 3.0e-7 at p_L 0, 2 p_S/3", equal(0), equal(2 * SUPPLY / 3))
    flow = lambda p_l: 3.0e-7 * np.sqrt((SUPPLY - p_l) / 2)
    at, step = 2 * SUPPLY / 3, 1.0
    show("K_c at full opening, p_L = 2 p_S/3, no leakage", -(flow(at + step) - flow(at - step)) / (2 * step))
    show("the flow there L/min", flow(at) * 6e4)


def nonlinear_rates():
    """Rates of the nonlinear model at one state far from rest: U, dU/dt, p_A, p_B, deflection, velocity."""
    spool, spool_rate, p_a, p_b, deflection, velocity = -0.37, 12.0, 21e5, 48e5, 1.3e-4, -0.02
    command, load_velocity, load_position, friction, sensor, shape = 0.9, 0.004, 0.31, 100.0, 2e7, 100.0
    u = spool / NOMINAL_VOLTAGE
    leak, ahead, back = 1 / np.cosh(shape * u), max(u, 0.0), max(-u, 0.0)
    root = lambda dp: dp / (dp**2 + 1e6) ** 0.25
    q3 = (EDGES["3"] * ahead + LEAKS["3"] * leak) * root(SUPPLY - p_a)
    q4 = (EDGES["4"] * back + LEAKS["4"] * leak) * root(p_a)
    q5 = (EDGES["5"] * back + LEAKS["5"] * leak) * root(SUPPLY - p_b)
    q6 = (EDGES["6"] * ahead + LEAKS["6"] * leak) * root(p_b)
    hose_area = np.pi / 4 * BORE**2
    held = hose_area + EXPANSION + EXPANSION_SLOPE * (OPERATING - SUPPLY)
    x = load_position + deflection
    line = EXPANSION_SLOPE * LENGTH / STIFFENING + held * LENGTH / FLUID_MODULUS
    c_a, c_b = AREA * x / FLUID_MODULUS + line, AREA * (STROKE - x) / FLUID_MODULUS + line
    show(
        "nonlinear rates, by volume",
        spool_rate,
        VALVE_FREQUENCY**2 * (command - spool) - 2 * VALVE_DAMPING * VALVE_FREQUENCY * spool_rate,
        (q3 - q4 - AREA * velocity) / c_a,
        (q5 - q6 + AREA * velocity) / c_b,
        velocity - load_velocity,
        (AREA * (p_a - p_b) - friction * velocity - sensor * deflection) / MASS,
    )


def leakage_peak():
    """Total leakage of the four-edge valve with blocked ports, over the command."""
    def total(u, edges, leaks):
        leak, ahead, back = 1 / np.cosh(100 * u), max(u, 0.0), max(-u, 0.0)
        q = 0.0
        for supply, tank, opening_s, opening_t in (("3", "4", ahead, back), ("5", "6", back, ahead)):
            k_s = edges[supply] * opening_s + leaks[supply] * leak
            k_t = edges[tank] * opening_t + leaks[tank] * leak
            p = SUPPLY * k_s**2 / (k_s**2 + k_t**2)
            q += k_s * np.sqrt(SUPPLY - p)
        return q

    equal = ({edge: 2.97e-7 for edge in EDGES}, {edge: 2.48e-9 for edge in EDGES})
    for name, edges, leaks in (("Table 5.1", EDGES, LEAKS), ("equal", *equal)):
        for side in (1, -1):
            found = minimize_scalar(
                lambda u: -total(side * u, edges, leaks), bounds=(0, 0.02), method="bounded", options={"xatol": 1e-10}
            )
            ratio = -found.fun / total(0.0, edges, leaks)
            show(f"leakage peak, {name}, side {side:+d}: ratio, command", ratio, side * found.x)


# Name: bore m, expansion at the supply's pressure m3/m, its slope m3/(m Pa).
HOSES = {
    "eaton": (BORE, EXPANSION, EXPANSION_SLOPE),
    "too fast": (6.4e-3, 1e-12 * SUPPLY, 1e-12),
    "right": (7.9e-3, 2e-12 * SUPPLY, 2e-12),
    "rigid": (7.9e-3, 5e-14 * SUPPLY, 5e-14),
    "stubborn": (9.5e-3, 8e-6 + 2.5e-12 * 35e5, 2.5e-12),
    "slow": (15.9e-3, 3e-12 * SUPPLY, 3e-12),
}
FLOW = 9.8e-3 / 60
SIZING = {"gain": 5.62e-5, "leak": 6.42e-13, "sensor": 2e7, "tau": 0.05}


def least_and_greatest(hose, length, model, areas):
    """Stiffness over the stroke by search, from the compliance of each volume."""
    bore, expansion, slope = hose
    section = np.pi / 4 * bore**2
    wall = STIFFENING * (section + expansion) / slope
    held = section + expansion + slope * (OPERATING - SUPPLY)
    line = section * length / FLUID_MODULUS + section * length / wall
    if model == "by_volume":
        line = slope * length / STIFFENING + held * length / FLUID_MODULUS
    oil = 1 / FLUID_MODULUS + (1 / wall if model == "uniform" else 0.0)

    def total(x):
        return areas[0] ** 2 / (line + areas[0] * x * oil) + areas[1] ** 2 / (line + areas[1] * (STROKE - x) * oil)

    inside = minimize_scalar(total, bounds=(0, STROKE), method="bounded", options={"xatol": 1e-13})
    return min(inside.fun, total(0.0), total(STROKE)), max(total(0.0), total(STROKE))


def sizing_gain(stiffness, area):
    """The K_p that makes the slow pole of force feedback -1/tau, found from the pole itself."""
    equivalent = 1 / (1 / stiffness + 1 / SIZING["sensor"])
    rate = lambda gain: equivalent / area * (SIZING["gain"] * gain + SIZING["leak"] / area) * SIZING["tau"]
    return brentq(lambda gain: rate(gain) - 1, -1, 1, xtol=1e-18, rtol=1e-14)


def sizing_stiffness(gain, area):
    """The K_H for this K_p, infinite where the sensor alone is too soft."""
    flow = SIZING["tau"] / area * (SIZING["gain"] * gain + SIZING["leak"] / area) - 1 / SIZING["sensor"]
    return 1 / flow if flow > 0 else np.inf


def sizing_of_hoses():
    velocity = lambda bore: FLOW / (np.pi / 4 * bore**2)
    show("bore at 4.6 and 2.1 m/s", *(brentq(lambda d, v=v: velocity(d) - v, 1e-4, 1) for v in (4.6, 2.1)))
    full = np.pi / 4 * 0.05**2
    for name, hose in HOSES.items():
        held = np.pi / 4 * hose[0] ** 2 + hose[1] + hose[2] * (OPERATING - SUPPLY)
        wall = STIFFENING * held / hose[2]
        sound = np.sqrt(1 / (1 / FLUID_MODULUS + 1 / wall) / DENSITY)
        show(f"hose {name}: velocity m/s, surge Pa", velocity(hose[0]), DENSITY * sound * velocity(hose[0]))
        for kind, areas in (("two rods", (AREA, AREA)), ("one rod", (AREA, full))):
            for model in ("uniform", "by_volume"):
                area = sum(areas) / 2
                least, greatest = least_and_greatest(hose, LENGTH, model, areas)
                show(f"  {kind}, {model}, 1.5 m: K_H, K_H, K_p", least, greatest, sizing_gain(least, area))
                wanted = sizing_stiffness(4e-4, area)
                length = brentq(lambda l: least_and_greatest(hose, l, model, areas)[0] - wanted, 1e-3, 1e3, xtol=1e-12)
                show(f"  {kind}, {model}, K_p 4e-4: K_H, L_ho", wanted, length)
    for gain in (1e-4, 3e-5, 2.1e-5):
        show(f"two rods: K_H for K_p {gain:g}", sizing_stiffness(gain, AREA))
    for model, oil in (("uniform", 1 / FLUID_MODULUS + 1 / (STIFFENING * 63630085.0)), ("by_volume", 1 / FLUID_MODULUS)):
        show(f"two rods, no hose, {model}: K_H", 4 * AREA / (STROKE * oil))


def table_6_2_closer():
    """The eight numbers with K_qU 5.625e-5."""
    SIZING["gain"] = 5.625e-5
    section = np.pi / 4 * BORE**2
    for gain in (0.01, 0.001, 0.0005, 0.00025):
        stiffness = sizing_stiffness(gain, AREA)
        compliance = 1 / FLUID_MODULUS + EXPANSION_SLOPE / (STIFFENING * (section + EXPANSION))
        length = (4 * AREA**2 / (compliance * stiffness) - AREA * STROKE) / (2 * section)
        show(f"Table 6.2 with K_qU 5.625e-5, K_p {gain:g}: K_H, L_ho", stiffness, length)


def impedance_asymptotes():
    """Driving-point impedance far below every corner, and the straight lines it should follow."""
    kq, kc, friction, sensor, stiffness = 5.4e-5, 6.42e-13, 100.0, 2e7, 2.24e6
    system = one_pressure(stiffness, kq, kc, friction, sensor)
    low = 1e-6
    open_loop = -response(system, low, 1)
    show("open loop, low frequency: damper", open_loop.real, (AREA**2 + friction * kc) / kc)
    for name, loop in (("P", 0.001), ("PI", 0.001 + 0.008 / (1j * low))):
        value = open_loop / (1 + loop * response(system, low, 0))
        show(f"{name}, low frequency: damper, mass", value.real, value.imag / low)
    show("P: damper A/(K_qU K_p); PI: mass A/(K_qU K_i)", AREA / (kq * 0.001), AREA / (kq * 0.008))
    show("plateau K_eq, its end sqrt(K_H/M)", 1 / (1 / stiffness + 1 / sensor), np.sqrt(stiffness / MASS))


if __name__ == "__main__":
    modulus, hose_volume = stiffness_chain()
    table_6_1()
    table_6_2(modulus)
    sizing_of_hoses()
    table_6_2_closer()
    impedance_asymptotes()
    decomposition_errors()
    passivity()
    off_centre(modulus, hose_volume)
    valve()
    nonlinear_rates()
    leakage_peak()
