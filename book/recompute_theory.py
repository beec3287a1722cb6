"""Recomputes the numbers that the theory pages of the book quote, from the equations alone and without phea.

Each `expect` states a number of the book with the precision it is quoted to; the script fails where they differ.
"""

import math

import numpy as np

AREA = math.pi / 4 * (0.05**2 - 0.022**2)
STROKE, MASS = 0.5, 13.1
BORE, EXPANSION, SLOPE = 12.7e-3, 1.56e-5, 2.236e-12  # the expansion at 70 bar
BETA_0, STIFFENING = 1.45e9, 5.0
OMEGA, XI = 1099.0, 0.9
GALLON_PER_MINUTE = 3.785411784e-3 / 60
FAILURES = []


def expect(what, value, quoted, tolerance):
    """The book quotes `quoted`; `tolerance` is half a unit of its last digit."""
    fine = abs(value - quoted) <= tolerance * (1 + 1e-9)
    print(f"{'ok  ' if fine else 'FAIL'} {what}: {value:.6g} (quoted {quoted:g})")
    if not fine:
        FAILURES.append(what)


def step_response(numerator, denominator, times):
    """Step response of a strictly proper system with simple poles, by partial fractions."""
    poles = np.roots(denominator)
    derivative = np.polyder(denominator)
    static = np.polyval(numerator, 0) / np.polyval(denominator, 0)
    terms = [np.polyval(numerator, p) / (p * np.polyval(derivative, p)) * np.exp(p * times) for p in poles]
    return static + np.real(sum(terms))


def metrics(response, times, band):
    """Overshoot in percent and settling time into +-band around 1."""
    outside = np.nonzero(np.abs(response - 1) > band)[0]
    return 100 * (response.max() - 1), times[outside[-1] + 1] if len(outside) else 0.0


def second_order():
    xi, omega = 0.5, 1.0
    sigma, damped = xi * omega, omega * math.sqrt(1 - xi**2)
    times = np.linspace(0, 10, 2_000_001)
    response = step_response([1.0], [1.0, 2 * xi, 1.0], times)
    reached = times[np.nonzero(response >= 1)[0][0]]
    expect("3.7 rise time at xi 0.5, first crossing", reached, 2.418, 5e-4)
    expect("3.7 corrected", (math.pi - math.atan(damped / sigma)) / damped, 2.418, 5e-4)
    expect("3.7 printed, negative", math.atan(-damped / sigma) / damped, -1.209, 5e-4)
    logarithm = math.log(0.01)
    expect("3.9 under the printed root at 1 %", math.pi**2 - logarithm**2, -11.3, 0.05)
    expect("3.9 corrected at 1 %", -logarithm / math.sqrt(math.pi**2 + logarithm**2), 0.826, 5e-4)
    expect("3.12 envelope at 1 %", -math.log(0.01), 4.6, 0.05)
    expect("3.13 critically damped, 2 %", critically_damped(0.02), 5.83, 5e-3)
    expect("3.13 critically damped, 1 %", critically_damped(0.01), 6.64, 5e-3)


def critically_damped(band):
    """omega t where (1 + omega t) e^(-omega t) = band."""
    low, high = 1.0, 20.0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if (1 + middle) * math.exp(-middle) > band else (low, middle)
    return low


def valve():
    rated = 0.88 * 6.31e-4
    expect("4.12 corrected", rated / math.sqrt(7e6 / 2), 2.97e-7, 0.5e-9)
    expect("4.12 printed", rated / math.sqrt(2 * 7e6), 1.48e-7, 0.5e-9)
    pressure = 3000 * 6894.757293168
    for total, quoted in [(0.40, 1.37e-9), (0.61, 3.43e-9)]:
        leakage = (total - 0.26) * GALLON_PER_MINUTE / math.sqrt(2 * pressure)
        expect(f"4.13 at {total} gpm, tare off", leakage, quoted, 0.5e-11)
    total, tare = 0.40 * GALLON_PER_MINUTE, 7.55e-6 * math.sqrt(pressure / 70e5)
    expect("the measured tare at 3000 psi", tare, 1.30e-5, 0.5e-7)
    expect("4.13 with the tare at its own pressure", (total - tare) / math.sqrt(2 * pressure), 1.906e-9, 0.5e-12)
    expect("4.13 with it as it stands", (total - 7.55e-6) / math.sqrt(2 * pressure), 2.750e-9, 0.5e-12)
    expect("the catalogue's tare at 70 bar", 0.26 * GALLON_PER_MINUTE * math.sqrt(70e5 / pressure), 9.5e-6, 0.5e-7)
    for what, share, quoted in [
        ("0.61 gpm", 0.26 / 0.61, 42.6),
        ("0.40 gpm", 0.26 / 0.40, 65.0),
        ("measured, of the total", 7.55e-6 / (7.55e-6 + 9.31e-6), 44.8),
        ("measured, over q_vin", 7.55e-6 / 9.31e-6, 81.1),
    ]:
        expect(f"tare share, {what}, percent", 100 * share, quoted, 0.05)
    expect("tare flow of 0.26 gpm", 0.26 * GALLON_PER_MINUTE, 1.64e-5, 0.5e-7)
    expect("leak peak of 5.2.1", 0.0167 * rated, 9.3e-6, 0.05e-6)
    for name, flow, leak, excess, place in [
        ("equal edges", [2.8875e-7] * 4, [2.15e-9] * 4, 10.8, 0.34),
        (
            "edges of Table 5.1",
            [3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7],
            [2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9],
            13.0,
            0.40,
        ),
    ]:
        peak, command = leakage_peak(flow, leak, 100.0, 7e6)
        expect(f"total leakage above null in percent, {name}", peak, excess, 0.05)
        expect(f"at percent of full command, {name}", command, place, 0.005)
    gain = lambda load: (2.97e-7 / 10) * math.sqrt((7e6 - load) / 2)
    expect("4.21 at null", gain(0.0), 5.56e-5, 0.5e-7)
    expect("4.21 from 2/3 p_S to null", gain(7e6 * 2 / 3) / gain(0.0), 1 / math.sqrt(3), 1e-12)
    expect("4.22 at null, K_vinp 2.402e-9", 2 * 2.402e-9 / math.sqrt(8 * 7e6), 6.42e-13, 0.5e-15)
    expect(
        "leakage's share of 4.21 at 25 bar in percent",
        leakage_share_of_gain(2.97e-7, 2.402e-9, 100.0, 7e6, 25e5),
        11.5,
        0.05,
    )
    expect("4.21 at 25 bar as printed", 2.97e-8 * math.sqrt((7e6 - 25e5) / 2), 4.455e-5, 0.5e-8)
    share = leakage_share_of_gain(2.97e-7, 2.402e-9, 100.0, 7e6, 25e5) / 100
    expect("4.21 at 25 bar with the leakage", 2.97e-8 * math.sqrt((7e6 - 25e5) / 2) * (1 + share), 4.967e-5, 0.5e-8)
    for line, stiffness, quoted in [("hose", 2.24e6, 1.69), ("pipe", 1.71e7, 1.65)]:
        lag = 2 * XI / OMEGA + 100.0 / stiffness + 6.42e-13 * MASS / AREA**2
        expect(f"tau of the feed-forward, {line}, ms", 1e3 * lag, quoted, 5e-3)
    corner = 2.97e-7 / math.sqrt(8 * 7e6 / 3)
    expect("4.22 at full opening, 2/3 p_S", corner, 6.9e-11, 0.5e-12)
    demand = 2.97e-7 * math.sqrt(7e6 / 6)
    expect("flow at that corner in L/min", demand * 60e3, 19.2, 0.05)


def leakage_share_of_gain(flow, leak, shape, supply, load):
    """The leakage's derivative over the printed 4.21, in percent, at the command that holds a load."""
    outer, inner = math.sqrt((supply + load) / 2), math.sqrt((supply - load) / 2)
    command = 0.0
    for _ in range(100):
        command = leak / flow * (outer / inner - 1) / math.cosh(shape * command)
    slope = shape * math.tanh(shape * command) / math.cosh(shape * command) * leak * (outer - inner)
    return 100 * slope / (flow * inner)


def leakage_peak(flow, leak, shape, supply):
    """Peak of the flow from the supply over spool position with both ports blocked, in percent, and where."""
    best = (0.0, 0.0)
    null = supply_flow(flow, leak, shape, supply, 0.0)
    for command in np.linspace(-0.01, 0.01, 4001):
        total = supply_flow(flow, leak, shape, supply, command)
        best = max(best, (100 * (total / null - 1), 100 * abs(command)))
    return best


def supply_flow(flow, leak, shape, supply, command):
    forward, backward = max(command, 0.0), max(-command, 0.0)
    opening = [
        f * u + k / math.cosh(shape * command)
        for f, u, k in zip(flow, [forward, backward, backward, forward], leak)
    ]
    in_series = lambda first, second: first * second / math.hypot(first, second)
    return (in_series(opening[0], opening[1]) + in_series(opening[2], opening[3])) * math.sqrt(supply)


def moduli():
    bore_area = math.pi / 4 * BORE**2
    static = (bore_area + EXPANSION) / SLOPE
    expect("beta_hoSS", static, 6.363e7, 0.5e4)
    wall = STIFFENING * static
    effective = BETA_0 * wall / (BETA_0 + wall)
    expect("beta_e", effective, 2.609e8, 0.5e5)
    line = bore_area * 1.5
    metre = by_sheet(bore_area)
    found = {}
    for name, chamber, compliance, centre, ends in [
        ("uniform", effective, line / effective, 2.233e6, 4.109e6),
        ("by volume", BETA_0, 1.5 * metre, 4.63e6, 4.94e6),
        ("6.24 on the unexpanded bore", BETA_0, line / effective, 5.008e6, 5.410e6),
        ("unexpanded bore's oil", BETA_0, 1.5 * SLOPE / STIFFENING + line / BETA_0, 4.665e6, 4.987e6),
    ]:
        stiffness = lambda x: sum(AREA**2 / (AREA * y / chamber + compliance) for y in (x, STROKE - x))
        digits = 0.5e4 if name == "by volume" else 0.5e3
        found[name] = stiffness(STROKE / 2)
        expect(f"K_H {name}, centre", found[name], centre, digits)
        expect(f"K_H {name}, ends", stiffness(0.0), ends, digits)
    printed = found["6.24 on the unexpanded bore"]
    expect("6.24 too stiff by, percent", 100 * (printed / found["by volume"] - 1), 8.1, 0.05)
    expect("of the wall alone, percent", 100 * (printed / found["unexpanded bore's oil"] - 1), 7.3, 0.05)
    length = (2 * AREA**2 / 2.24e6 - AREA * STROKE / (2 * BETA_0)) / metre
    expect("length for 2.24e6 N/m by volume", length, 3.64, 5e-3)
    expect("A_ho over A_ho + E", bore_area / (bore_area + EXPANSION), 0.89, 5e-3)
    held = bore_area + EXPANSION - SLOPE * 35e5
    expect("oil of a metre at 35 bar in mL", 1e6 * held, 134.5, 0.05)
    expect("of the bore at rest in mL", 1e6 * bore_area, 126.7, 0.05)
    ten_bar = [AREA * STROKE / 2 / BETA_0 + 1.5 * (metre + shift * SLOPE * 10e5 / BETA_0) for shift in (0, 1)]
    expect("10 bar more: K_H falls by percent", 100 * (1 - ten_bar[0] / ten_bar[1]), 0.21, 5e-3)
    for ratio, quoted in [(1, 0.52e6), (4, 1.85e6), (5, 2.23e6)]:
        softened = BETA_0 * ratio * static / (BETA_0 + ratio * static)
        uniform = 4 * softened * AREA**2 / (AREA * STROKE + 2 * line)
        expect(f"uniform K_H with r_beta {ratio}", uniform, quoted, 0.5e4)
    return effective, bore_area


def by_sheet(bore_area):
    """dV/dp of a metre of hose: epsilon/r_beta of its wall, and the oil that its bore holds at 35 bar."""
    return SLOPE / STIFFENING + (bore_area + EXPANSION - SLOPE * 35e5) / BETA_0


def sizing(effective, bore_area):
    sensor, gain, leak, constant = 2e7, 5.625e-5, 6.42e-13, 0.05
    for proportional, stiffness, length, digits in [
        # a unit of the last digit: no one K_qU rounds to all eight
        (0.01, 5.65e4, 180, 1),
        (0.001, 5.76e5, 14.84, 1e-2),
        (0.0005, 1.175e6, 5.66, 1e-2),
        (0.00025, 2.46e6, 1.07, 1e-2),
    ]:
        last_digit = 1e2 if stiffness < 1e5 else 1e3 if stiffness in (5.76e5, 1.175e6) else 1e4
        needed = sensor * AREA**2 / (sensor * constant * (leak + AREA * proportional * gain) - AREA**2)
        expect(f"Table 6.2 K_H at {proportional}", needed, stiffness, last_digit)
        metres = (4 * effective * AREA**2 / needed - AREA * STROKE) / 2 / bore_area
        expect(f"Table 6.2 L_ho at {proportional}", metres, length, digits)
    settling = lambda band: 1e3 * 0.2 / math.log(100 / band)
    expect("tau_d of 0.2 s to 1 % in ms", settling(1), 43.4, 0.05)
    expect("time constants to 2 %", math.log(50), 3.9, 0.05)
    needed = sensor * AREA**2 / (sensor * constant * (leak + AREA * 0.0005 * 5.62e-5) - AREA**2)
    expect("Table 6.2 with K_qU 5.62e-5, 0.0005: K_H", needed, 1.176e6, 0.5e3)
    expect("and L_ho", (4 * effective * AREA**2 / needed - AREA * STROKE) / 2 / bore_area, 5.655, 5e-4)
    needed = sensor * AREA**2 / (sensor * constant * (leak + AREA * 0.001 * 5.62e-5) - AREA**2)
    expect("0.001: L_ho", (4 * effective * AREA**2 / needed - AREA * STROKE) / 2 / bore_area, 14.82, 5e-3)
    limit = (AREA / (constant * sensor) - leak / AREA) / gain
    expect("gain with infinite stiffness", limit, 2.1e-5, 0.05e-5)
    for flow_gain, quoted in [(5.62e-5, 2.73e-4), (5.4e-5, 2.84e-4)]:
        stiffness = 2.233e6
        proportional = (
            AREA * (stiffness + sensor) / (constant * stiffness * sensor) - leak / AREA
        ) / flow_gain
        expect(f"K_p for 1.5 m with K_qU {flow_gain}", proportional, quoted, 0.5e-6)
    for coefficient, quoted in [(6.42e-13, 0.974), (7e-11, 0.26)]:
        driven = AREA * 2.844e-4 * 5.4e-5
        expect(
            f"K_SS at K_c {coefficient}",
            driven / (coefficient + driven),
            quoted,
            0.5 * 10 ** -len(str(quoted)[2:]),
        )
    for flow, velocity, quoted in [
        (1.6e-4, 4.6, 6.7),
        (1.6e-4, 2.1, 9.8),
        (9.8e-3 / 60, 4.6, 6.72),
        (9.8e-3 / 60, 2.1, 9.95),
    ]:
        bore = 1e3 * math.sqrt(4 * flow / (math.pi * velocity))
        expect(
            f"6.17 in mm, {flow:.4g} m3/s at {velocity} m/s",
            bore,
            quoted,
            0.05 if quoted in (6.7, 9.8) else 0.005,
        )
    expect("velocity in 12.7 mm", 1.6e-4 / bore_area, 1.26, 5e-3)


def denominator(stiffness, sensor, friction, leak):
    """a_5 ... a_0 of 6.7, by multiplying the block equations out."""
    spool = np.array([1.0, 2 * XI * OMEGA, OMEGA**2])
    piston = np.polyadd(
        AREA**2 * np.array([MASS, friction, sensor + stiffness, 0.0]),
        leak * stiffness * np.array([0.0, MASS, friction, sensor]),
    )
    return np.polymul(spool, piston)


def linear_models():
    sensor, friction, leak, gain = 9.81e7, 299.0, 5.7e-13, 5.4e-5
    for stiffness, real, mechanical in [
        (1.5e7, -2.96, -11.64 + 2938j),
        (1.5e6, -0.336, -11.41 + 2757j),
        (1.5e5, -0.0341, -11.41 + 2739j),
    ]:
        poles = np.roots(denominator(stiffness, sensor, friction, leak))
        slow = max(poles, key=lambda pole: pole.real).real
        expect(
            f"Table 6.1 real pole at {stiffness:g}",
            slow,
            real,
            0.5 * 10.0 ** (math.floor(math.log10(-real)) - 2),
        )
        pair = max(poles, key=lambda pole: pole.imag)
        expect(f"Table 6.1 pair at {stiffness:g}, real", pair.real, mechanical.real, 5e-3)
        expect(f"Table 6.1 pair at {stiffness:g}, imaginary", pair.imag, mechanical.imag, 0.5)
    for name, stiffness, sensor, friction, leak, printed, corrected in [
        ("Table 6.1", 1.5e7, 9.81e7, 299.0, 5.7e-13, 0.17, 0.0006),
        ("Table 6.3 corner", 4.11e6, 2e7, 100.0, 7e-11, 11.0, 0.22),
    ]:
        omegas = np.concatenate(
            [
                np.geomspace(0.01, 5000, 20001),
                math.sqrt((stiffness + sensor) / MASS) * np.linspace(0.95, 1.05, 20001),
            ]
        )
        full = (
            AREA
            * stiffness
            * gain
            * sensor
            * OMEGA**2
            / np.polyval(denominator(stiffness, sensor, friction, leak), 1j * omegas)
        )
        for label, extra, quoted in [
            ("printed", 0.0, printed),
            ("corrected", leak * stiffness**2 / (AREA**2 * (stiffness + sensor)), corrected),
        ]:
            error = np.abs(
                20
                * np.log10(
                    np.abs(decomposed(omegas, stiffness, sensor, friction / MASS + extra, leak, gain) / full)
                )
            ).max()
            expect(f"6.12 {label} against 6.7 in dB, {name}", error, quoted, 0.06 * quoted + 5e-5)
        if name == "Table 6.1":
            printed_phase = decomposed(omegas, stiffness, sensor, friction / MASS, leak, gain) / full
            degrees = np.abs(np.degrees(np.angle(printed_phase)))
            expect("6.12 printed against 6.7 in degrees", degrees.max(), 0.57, 5e-3)
            expect("and where, rad/s", omegas[degrees.argmax()], 2950, 5)
            expect("and below 1000 rad/s", degrees[omegas < 1000].max(), 0.0034, 5e-5)
            expect("piston on the cell, with the pipe", math.sqrt((stiffness + sensor) / MASS), 2938, 0.5)
    expect("piston on K_S, with the hose", math.sqrt((2.24e6 + 2e7) / MASS), 1303, 0.5)


def two_pressures(effective, bore_area):
    omegas = np.geomspace(0.01, 5000, 200001)
    for model, modulus, line, quoted in [
        ("uniform", effective, bore_area * 1.5 / effective, [(0.1, 0.70, 2.3), (0.0, 2.1, 7.0)]),
        ("by volume", BETA_0, 1.5 * by_sheet(bore_area), [(0.1, 0.09, 0.30), (0.0, 0.25, 0.83)]),
    ]:
        for position, decibels, degrees in quoted:
            chambers = [AREA * y / modulus + line for y in (position, STROKE - position)]
            mean = 2 * chambers[0] * chambers[1] / sum(chambers)
            ratio = force(omegas, [mean, mean]) / force(omegas, chambers)
            place = f"6.7 against two pressures, {model}, x = {position}"
            digit = 0.05 if degrees > 1 else 0.005
            expect(f"{place}, dB", np.abs(20 * np.log10(np.abs(ratio))).max(), decibels, digit)
            expect(f"{place}, degrees", np.abs(np.degrees(np.angle(ratio))).max(), degrees, digit)


def force(omegas, compliances):
    """F_e per command ahead of the spool's dynamics, with each chamber's own pressure."""
    s = 1j * omegas
    chambers = sum(1 / (compliance * s + 2 * 6.42e-13) for compliance in compliances)
    sensor = 2e7
    moved = MASS * s**2 + 100.0 * s + sensor + AREA**2 * s * chambers
    return sensor * AREA * 5.4e-5 * chambers / moved


def decomposed(omegas, stiffness, sensor, damping, leak, gain):
    s = 1j * omegas
    equal, square = stiffness * sensor / (stiffness + sensor), (stiffness + sensor) / MASS
    hydraulic = (gain * equal / AREA) / (s + leak * equal / AREA**2)
    return (
        hydraulic * square / (s**2 + damping * s + square) * OMEGA**2 / (s**2 + 2 * XI * OMEGA * s + OMEGA**2)
    )


def impedance():
    stiffness, sensor, leak = 2.24e6, 2e7, 6.42e-13
    omegas = np.geomspace(0.01, 1e4, 400001)
    open_loop = driving_point(omegas, stiffness, sensor, 100.0, leak, 0.0, 0.0)
    expect("open loop, least Re Z above zero", float(np.real(open_loop).min() > 0), 1, 0)
    active = omegas[np.real(driving_point(omegas, stiffness, sensor, 100.0, leak, 0.001, 0.008)) < 0]
    expect("closed loop is active from", active[0], 447, 0.5)
    expect("closed loop is active to", active[-1], 922, 0.5)
    rough = np.real(driving_point(omegas, stiffness, sensor, 299.0, leak, 0.001, 0.008))
    expect("closed loop with f_v 299, least Re Z above zero", float(rough.min() > 0), 1, 0)
    expect("compliance hidden above, hose", math.sqrt(2.233e6 / MASS), 413, 0.5)
    ends = np.array([4e-3, 3e4])
    low, high = np.abs(driving_point(ends, stiffness, sensor, 100.0, leak, 0.0, 0.0))
    expect("open-loop damper at low frequency", low / ((AREA**2 + 100.0 * leak) / leak), 1, 0.005)
    expect("spring K_S at high frequency", high / (sensor / ends[1]), 1, 0.005)
    damper = abs(driving_point(np.array([1e-3]), stiffness, sensor, 100.0, leak, 0.001, 0.0))[0]
    expect("P control, damper", damper / (AREA / (5.4e-5 * 0.001)), 1, 0.01)
    mass = abs(driving_point(np.array([1e-5]), stiffness, sensor, 100.0, leak, 0.001, 0.008))[0] / 1e-5
    expect("PI control, mass", mass / (AREA / (5.4e-5 * 0.008)), 1, 0.01)


def driving_point(omegas, stiffness, sensor, friction, leak, proportional, integral):
    """Z = -F_e/(s X_L) with U_C = -(K_p + K_i/s) F_e and K_qU = 5.4e-5."""
    s = 1j * omegas
    spool = np.array([1.0, 2 * XI * OMEGA, OMEGA**2])
    own = np.polyadd(
        AREA**2 * np.array([MASS, friction, stiffness]), leak * stiffness * np.array([0, MASS, friction])
    )
    command = AREA * stiffness * 5.4e-5 * sensor * OMEGA**2
    closed = (
        np.polyval(denominator(stiffness, sensor, friction, leak), s)
        + (proportional + integral / s) * command
    )
    return sensor * np.polyval(np.polymul(spool, own), s) / closed


def limits():
    times = np.linspace(0, 1, 1_000_001)
    upper = step_response(np.polymul([2116.0], [1 / 75, 1.0]), [1.0, 73.6, 2116.0], times)
    overshoot, settling = metrics(upper, times, 0.01)
    expect("6.28 overshoot in percent", overshoot, 2.2, 0.05)
    expect("6.28 settling time", settling, 0.126, 5e-4)
    lower_denominator = np.polymul([1.0, 40.0000004, 400.000004], [1.0, 50.0])
    _, settling = metrics(step_response([20000.0], lower_denominator, times), times, 0.01)
    expect("6.29 settling time", settling, 0.356, 5e-4)
    expect("6.30 gain margin of 1.3 in dB", 20 * math.log10(1 + 1 / 1.3), 4.96, 5e-3)
    expect("6.30 phase margin of 1.3 in degrees", math.degrees(2 * math.asin(0.5 / 1.3)), 45.2, 0.05)
    expect("6.30 limit for 5 dB", 1 / (10 ** (5 / 20) - 1), 1.285, 5e-4)


def sources_of_constants():
    expect("K_S, cell and environment in series", 1 / (1 / 9.81e7 + 1 / 2.51e7), 2.0e7, 0.5e5)
    expect("cell of 1 t per 0.1 mm", 1000 * 9.80665 / 1e-4, 9.81e7, 0.5e5)
    expect("K_qU nominal", 5.4e-5 * 10 / math.sqrt(7e6 / 2), 2.89e-7, 0.5e-9)
    for edges, quoted in [((3.2e-7, 3.85e-7), 6.51e-5), ((2.0e-7, 2.5e-7), 4.13e-5)]:
        inlet, outlet = edges
        gain = inlet * outlet / math.hypot(inlet, outlet) * math.sqrt(7e6) / 10
        expect(f"no-load flow gain of edges {edges}", gain, quoted, 0.5e-7)
    bore_area = math.pi / 4 * BORE**2
    held = bore_area + EXPANSION - SLOPE * 35e5
    speed = math.sqrt(held / by_sheet(bore_area) / 870)
    expect("modulus of the oil in the hose, its wall included", held / by_sheet(bore_area), 2.490e8, 0.5e5)
    expect("wave speed in the hose", speed, 535, 0.5)
    expect("delay of 1.5 m in ms", 1e3 * 1.5 / speed, 2.80, 5e-3)
    expect("quarter wave in 1.5 m, rad/s", math.pi * speed / (2 * 1.5), 560, 0.5)
    expect("1099 rad/s in Hz", 1099 / (2 * math.pi), 175, 0.5)


def main():
    second_order()
    valve()
    hose = moduli()
    sizing(*hose)
    two_pressures(*hose)
    linear_models()
    impedance()
    limits()
    sources_of_constants()
    if FAILURES:
        raise SystemExit(f"{len(FAILURES)} numbers of the book do not hold: {', '.join(FAILURES)}")


if __name__ == "__main__":
    main()
