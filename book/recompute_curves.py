"""Recomputes the numbers that the pages on servovalve, friction, stiffness and passivity quote from their curves, without phea.

Each `expect` states a number of the book with the precision it is quoted to; the script fails where they differ.
"""

import math

import numpy as np

import curves

FAILURES = []


def expect(what, value, quoted, tolerance):
    """The book quotes `quoted`; `tolerance` is half a unit of its last digit."""
    fine = abs(value - quoted) <= tolerance * (1 + 1e-9)
    print(f"{'ok  ' if fine else 'FAIL'} {what}: {value:.6g} (quoted {quoted:g})")
    if not fine:
        FAILURES.append(what)


def valve():
    pressure_a, pressure_b = curves.blocked(0.0)
    expect("p_A at null, bar", pressure_a / 1e5, 37.3, 0.05)
    expect("p_B at null, bar", pressure_b / 1e5, 24.0, 0.05)
    four, single = curves.leakage(0.0)
    expect("leakage at null with the tare flow, L/min", (four + curves.TARE) * 6e4, 0.93, 0.005)
    for side, quoted, place in ((1, 0.97, 29), (-1, 0.99, -40)):
        volts = side * np.linspace(0, 0.2, 2001)
        flow = [curves.leakage(u)[0] for u in volts]
        expect("leakage at its peak, L/min", (max(flow) + curves.TARE) * 6e4, quoted, 0.005)
        expect("where, mV", 1e3 * volts[int(np.argmax(flow))], place, 0.5)
    expect("unloaded gain extending", curves.unloaded(1.0), 6.51e-5, 0.5e-7)
    expect("unloaded gain retracting", -curves.unloaded(-1.0), 4.13e-5, 0.5e-7)
    expect("flow at 10 V, L/min", curves.unloaded(10.0) * 6e4, 39.1, 0.05)
    expect("flow at -10 V, L/min", curves.unloaded(-10.0) * 6e4, -24.8, 0.05)
    expect("what the pump gives takes, V extending", curves.PUMP / curves.unloaded(1.0), 2.51, 0.005)
    expect("V retracting", curves.PUMP / -curves.unloaded(-1.0), 3.95, 0.005)
    volts = np.linspace(0, 0.5, 5001)
    gain = [curves.equal_edges(u, 25e5)[1] for u in volts]
    expect("greatest K_qU under 25 bar", max(gain), 5.27e-5, 0.5e-7)
    expect("over what 4.21 prints, percent", 100 * (max(gain) / curves.equal_edges(0, 25e5)[0] - 1), 18.3, 0.05)
    expect("at V", volts[int(np.argmax(gain))], 0.088, 0.0005)
    expect("command that holds 25 bar, equal edges, mV", 1e3 * curves.holding_command(25e5), 34.6, 0.05)
    _, gain, leak = curves.equal_edges(0.0, 0.0)
    expect("pressure gain at null, equal edges, bar/V", gain / leak / 1e5, 866, 0.5)
    for volts, quoted in ((-0.1, -47.2), (0.0, 13.3), (0.1, 61.3)):
        pressure_a, pressure_b = curves.blocked(volts)
        expect(f"p_L at {volts} V, bar", (pressure_a - pressure_b) / 1e5, quoted, 0.05)


def friction():
    expect("breakaway after, micrometres", 1e6 * curves.BREAKAWAY / curves.BRISTLES, 12, 0.5)
    required = curves.BRISTLE_DAMPING * (curves.BREAKAWAY - curves.COULOMB) / curves.COULOMB
    expect("viscous friction for passivity", required, 1000, 0.5)
    speed = np.linspace(1e-4, 0.1, 200001)
    force = curves.steady(speed)
    slope = np.gradient(force, speed)
    expect("least slope, N s/m", slope.min(), -3331, 2)
    expect("at mm/s", 1e3 * speed[int(np.argmin(slope))], 7.07, 0.02)
    expect("least steady force, N", force.min(), 82.5, 0.05)
    expect("at mm/s", 1e3 * speed[int(np.argmin(force))], 22.8, 0.05)
    expect("secant at 10 mm/s", curves.steady(0.01) / 0.01, 9572, 0.5)
    expect("99 % of the sign at v_r", 0.99 / math.sqrt(1 - 0.99**2), 7.0, 0.05)


def hoses():
    expect("expansion at 35 bar, mL/m", 1e6 * curves.expansion(35e5), 7.77, 0.005)
    expect("catalogue's point, mL/m", 4.7 / 0.3048, 15.42, 0.005)
    expect("the line there", 1e6 * curves.expansion(1000 * 6894.757), 15.36, 0.005)
    per_bar = 1e11
    expect("wall at rest, mL/(m bar)", curves.SLOPE * per_bar, 0.224, 0.0005)
    expect("wall at r_beta 5", curves.SLOPE / 5 * per_bar, 0.045, 0.0005)
    oil = (curves.bore_area() + curves.expansion(35e5)) / curves.OIL
    expect("oil at 35 bar", oil * per_bar, 0.0093, 0.00005)
    for length, uniform, by_volume in (
        (0.5, (2.85, 11.09), (9.23, 12.36)),
        (1.0, (2.50, 5.88), (6.17, 6.95)),
        (1.5, (2.23, 4.11), (4.63, 4.94)),
        (2.0, (2.02, 3.21), (3.71, 3.86)),
        (3.0, (1.69, 2.28), (2.65, 2.71)),
    ):
        for model, pair in (("uniform", uniform), ("by_volume", by_volume)):
            for place, quoted in zip((curves.STROKE / 2, 0.0), pair):
                expect(f"K_H, {model}, {length} m", curves.stiffness(length, place, model) / 1e6, quoted, 0.0051)
    for length, slow, frequency in ((0.5, -0.590, 1321), (1.5, -0.475, 1303), (3.0, -0.368, 1287)):
        real, pair = curves.poles(curves.stiffness(length, curves.STROKE / 2, "uniform"), 5.9295e-13)
        expect(f"slow pole, {length} m", real, slow, 0.0005)
        expect(f"piston, {length} m", abs(pair), frequency, 0.5)


def unequal_areas():
    for rod, model, rows in (
        (0.022, "uniform", ((0.0, 1.5, 7.1, 0.94), (0.25, 0.07, 0.27, 1.01), (0.5, 3.1, 10.7, 1.09))),
        (0.022, "by_volume", ((0.0, 0.22, 1.3, 0.97), (0.25, 0.03, 0.09, 1.00), (0.5, 0.52, 1.9, 1.03))),
        (0.036, "uniform", ((0.0, 1.0, 5.0, 0.89), (0.25, 0.63, 2.3, 1.07), (0.5, 4.5, 15.9, 1.36))),
        (0.036, "by_volume", ((0.0, 0.37, 1.3, 0.96), (0.25, 0.20, 0.70, 1.02), (0.5, 0.87, 3.3, 1.10))),
    ):
        area = math.pi / 4 * (0.05**2 - rod**2)
        for place, decibels, degrees, static in rows:
            found = curves.reduction_cost(area, place, model)
            name = f"one rod of {rod} m, {model}, x = {place}"
            expect(f"{name}, dB", found[0], decibels, 0.05 if decibels >= 1 else 0.005)
            expect(f"{name}, degrees", found[1], degrees, 0.05 if degrees >= 1 else 0.005)
            expect(f"{name}, static gain", found[2], static, 0.005)
    for least, quoted_db, quoted_degrees, digit in ((10.0, 0.12, 4.3, 0.05), (100.0, 0.12, 0.44, 0.005)):
        costs = [
            curves.reduction_cost(math.pi / 4 * (0.05**2 - rod**2), place, model, least)
            for rod in (0.022, 0.036)
            for model in ("uniform", "by_volume")
            for place in (0.0, 0.25, 0.5)
        ]
        expect(f"worst from {least} rad/s, dB", max(cost[0] for cost in costs), quoted_db, 0.005)
        expect(f"worst from {least} rad/s, degrees", max(cost[1] for cost in costs), quoted_degrees, digit)


def damping():
    """Where valve leakage damps the piston as much as f_v = 100 N s/m does."""
    ratio = curves.FRICTION / curves.MASS * curves.AREA**2 / 5.9295e-13
    expect("K_H there, MN/m", (ratio + math.sqrt(ratio**2 + 4 * ratio * curves.SENSOR)) / 2e6, 46, 0.5)


def passivity():
    band = curves.active_band(curves.STIFFNESS)
    expect("first frequency with Re Z < 0", band[0], 446.6, 0.05)
    expect("last", band[1], 921.6, 0.05)
    expect("K_H alone would begin it at", math.sqrt(curves.STIFFNESS / curves.MASS), 413.5, 0.05)
    expect("least friction for passivity", curves.friction_for_passivity(curves.STIFFNESS), 269, 0.5)
    expect("most, K_H K_p/K_i", curves.STIFFNESS * curves.GAIN / curves.INTEGRAL, 2.8e5, 0.5e4)
    first, last = curves.unstable_springs(curves.STIFFNESS)
    expect("softest spring that makes it unstable, MN/m", first / 1e6, 0.416, 0.0005)
    expect("stiffest, MN/m", last / 1e6, 9.38, 0.005)
    cell = 98.1e6
    for spring, quoted, digit in ((first, 0.418, 0.0005), (last, 10.4, 0.05)):
        expect("environment behind a cell of 98.1 MN/m, MN/m", 1 / (1 / spring - 1 / cell) / 1e6, quoted, digit)
    expect("largest real part with 2 MN/m, 1/s", curves.closed_loop(curves.STIFFNESS, 2e6).real.max(), 6.05, 0.005)
    phase = np.degrees(np.angle(1 / curves.admittance(np.linspace(*band, 4001), curves.STIFFNESS)))
    expect("largest phase of Z, degrees", phase.max(), 93.2, 0.05)
    expect("least friction with a spool of 2000 rad/s", curves.friction_for_passivity(curves.STIFFNESS, spool=2000.0), 528, 0.5)
    bound = curves.MASS * curves.GAIN * curves.FLOW_GAIN * curves.STIFFNESS / curves.AREA
    expect("without lag of the spool", bound, 1001, 0.5)
    expect("nearly without", curves.friction_for_passivity(curves.STIFFNESS, spool=1e6) / bound, 1, 0.02)
    expect("stiffness that shuts the band, MN/m", curves.MASS * curves.SPOOL**2 / 1e6, 15.8, 0.05)
    for stiffness, quoted in ((5e5, 151), (2.24e6, 69), (5e6, 20)):
        gain = curves.tuned_gain(stiffness)
        found = curves.friction_for_passivity(stiffness, gain=gain, integral=8 * gain)
        expect(f"friction with the gain of 6.27, K_H = {stiffness:g}", found, quoted, 0.5)


for check in (valve, friction, hoses, unequal_areas, damping, passivity):
    check()
if FAILURES:
    raise SystemExit(f"{len(FAILURES)} numbers of the book part from their recomputation: " + "; ".join(FAILURES))
