"""Recorded static tests of servovalves, made from equations (4.2) to (4.14) of Ledezma (2019), as instruments show them. SI units.

Three tests after ISO 10770-1, each with a slow triangle of the command that begins at zero: internal leakage and pressure gain with blocked ports,
metering with ports connected through a flow meter. The valve is in equilibrium at every row. Where ports are blocked, pressures have a closed form;
where they are connected, the flow between them is found by bisection. The hysteresis is an exponential memory of the command's travel.

Nothing here is shared with phea or with `valve_model.py`.
"""

import dataclasses
import math

import numpy as np

BAR, LITRE_PER_MINUTE = 1e5, 1 / 60000
NOMINAL = 10.0                     # V, full command
TARE_PRESSURE = 70e5


@dataclasses.dataclass(frozen=True)
class Valve:
    """Edges in the order supply to A, A to tank, supply to B, B to tank. `lap` is relative to the full command, of edges that open with a positive
    command and with a negative one: above zero an overlap, below zero an underlap."""

    flow: tuple
    leakage: tuple
    shape: float
    tare: float
    bias: float
    hysteresis: float
    one_curve: bool = False
    lap: tuple = (0.0, 0.0)
    saturation: float = 0.0
    clip: float = math.inf         # greatest opening
    external: float = 0.0          # conductance of a leak from port A to the tank
    uneven: float = 0.0            # what the laps of the edges at port B have more than those at port A
    growing: float = 0.0           # amplitude, in volts, at which the hysteresis is the stated one, if it is proportional to it


@dataclasses.dataclass(frozen=True)
class Meter:
    """`least`: flow below which a turbine reads zero; a turbine does not show the direction."""

    full: float
    noise: float
    least: float = 0.0
    turbine: bool = False
    drop: float = 0.0              # Pa at the full flow


@dataclasses.dataclass(frozen=True)
class Bench:
    """How a valve is tested and recorded. `metering`: flow meters, each with the amplitude of its test over the full command."""

    metering: tuple
    leak_meter: Meter
    leakage_amplitude: float = 0.3
    gain_amplitude: float = 0.05
    period: float = 240.0
    cycles: int = 2
    sample: float = 0.4
    supply: float = 70e5
    wander: float = 0.2e5          # of the supply pressure, recorded
    pressure_noise: float = 5e3
    command_noise: float = 0.0
    bits: int = 0
    oil: tuple = ()                # temperature at the start and at the end of each test, and at which the valve is stated
    rough: bool = False            # jitter, gaps and outliers
    lost_commands: float = 0.0     # share of rows whose recorded command is any of the test's
    gain_error: float = 0.0        # bound of the flow meter's
    zero_error: float = 0.0        # bound of the transducer's at port A
    sag: float = 0.0               # Pa by which the supply falls for each m3/s, not recorded
    delay: float = 0.0             # of the flow meter's reading over the period
    frequency: float = 1099.0      # rad/s, of the spool, and its damping ratio
    damping: float = 0.9
    cycled: bool = False           # the lag at the first row is anywhere in the hysteresis, not zero
    gain_b: float = 1.0            # of the reading at port B


def triangle(times, period, amplitude):
    return amplitude * 2 / math.pi * np.arcsin(np.sin(2 * math.pi * np.asarray(times) / period))


def position(valve, bench, times, amplitude, random):
    """The edges' position over the full command: each straight piece of the command draws the lag to half the width, over a travel of the width."""
    half = valve.hysteresis / 2 * (amplitude / valve.growing if valve.growing else 1.0)
    command = triangle(times, bench.period, amplitude)
    corners = [0.0] + [bench.period * (0.25 + 0.5 * turn) for turn in range(2 * bench.cycles)] + [bench.period * bench.cycles]
    ends = triangle(corners, bench.period, amplitude)
    lag, last = np.zeros_like(command), half * random.uniform(-1, 1) if bench.cycled else 0.0
    for start, end, begun, reached in zip(corners, corners[1:], ends, ends[1:]):
        toward = math.copysign(half, reached - begun)
        # (4.1) along a ramp: omega^2 (U_C - U) = 2 xi omega dU/dt
        behind = 2 * bench.damping / bench.frequency * (reached - begun) / (end - start)
        inside = (times >= start) & (times <= end)
        lag[inside] = behind + toward + (last - toward) * np.exp(-np.abs(command[inside] - begun) / (2 * half))
        last = toward + (last - toward) * math.exp(-abs(reached - begun) / (2 * half))
    return (command - valve.bias - lag) / NOMINAL


def edges(valve, position_, thinner=1.0, lighter=1.0):
    """Conductances of the four edges, (4.2) to (4.9) with the secant of (4.14); warm oil is thinner and lighter."""
    def opened(way, lap):
        opening = np.maximum(way * position_ - lap, 0.0)
        return np.minimum(opening / (1 + valve.saturation * opening), valve.clip)

    (forward, backward), uneven = valve.lap, valve.uneven
    openings = [opened(1, forward), opened(-1, backward), opened(-1, backward + uneven), opened(1, forward + uneven)]
    secant = thinner / np.cosh(np.minimum(valve.shape * np.abs(position_), 300.0))
    flows = [lighter * k * x for k, x in zip(valve.flow, openings)]
    found = [flow + k * secant for flow, k in zip(flows, valve.leakage)]
    if valve.one_curve:
        for one, other in ((0, 1), (2, 3)):
            # in series both pass the null's conductance times the secant, whichever of them opens
            series = secant / math.hypot(1 / valve.leakage[one], 1 / valve.leakage[other])
            closed = np.where(flows[one] > flows[other], other, one)
            open_ = np.where(closed == one, found[other], found[one])
            shut = series / np.sqrt(np.maximum(1 - (series / open_) ** 2, 1e-300))
            found[one], found[other] = np.where(closed == one, shut, found[one]), np.where(closed == other, shut, found[other])
    found[1] = found[1] + valve.external
    return found


def blocked(conductances, supply):
    """Pressures of both ports and the flow from the supply but for the tare flow; the tank is at zero."""
    pressures, total = [], 0.0
    for into, out in (conductances[:2], conductances[2:]):
        size = np.hypot(into, out)
        pressures.append((into / size) ** 2 * supply)
        total = total + into * out / size * np.sqrt(supply)
    return *pressures, total


def port(into, out, flow, supply):
    """Pressure at a port that gives a flow away: into sqrt(p_S - p) - out sqrt(p) = flow, by an angle whose sine squared is p/p_S."""
    size, angle = np.hypot(into, out), np.arctan2(out, into)
    part = np.clip(flow / (size * np.sqrt(supply)), -1.0, 1.0)
    return supply * np.sin(np.arccos(part) - angle) ** 2


def connected(conductances, supply, resistance):
    """Pressures of both ports and the flow from A to B, whose drop across the meter is resistance times its square."""
    a_in, a_out, b_in, b_out = conductances
    root = np.sqrt(supply)
    low, high = -np.minimum(a_out, b_in) * root, np.minimum(a_in, b_out) * root
    for _ in range(70):
        flow = (low + high) / 2
        a, b = port(a_in, a_out, flow, supply), port(b_in, b_out, -flow, supply)
        less = a - b < resistance * flow * np.abs(flow)
        low, high = np.where(less, low, flow), np.where(less, flow, high)
    return a, b, flow


def equilibrium(valve, bench, conductances, supply, meter, lighter):
    """Pressures, flow between the ports (or none) and flow from the supply; a supply that sags is found by iteration."""
    given = supply
    for _ in range(12 if bench.sag else 1):
        if meter:
            a, b, flow = connected(conductances, supply, meter.drop / meter.full**2 / lighter**2)
            total = conductances[0] * np.sqrt(np.maximum(supply - a, 0)) + conductances[2] * np.sqrt(np.maximum(supply - b, 0))
        else:
            a, b, total = blocked(conductances, supply)
            flow = None
        total = total + valve.tare * lighter * np.sqrt(supply / TARE_PRESSURE)
        supply = given - bench.sag * total
    return a, b, flow, total


def reading(meter, flow, random):
    """A turbine that is slower than its least flow shows zero."""
    noisy = (np.abs(flow) if meter.turbine else flow) + meter.noise * random.standard_normal(len(flow))
    if not meter.turbine:
        return noisy
    return np.where(np.abs(flow) < meter.least, 0.0, np.abs(noisy))


def converted(values, full, bits):
    return np.round(values / full * 2**bits) * full / 2**bits if bits else values


def test(valve, bench, kind, amplitude, meter, errors, random):
    """One recording as text. `kind`: leakage, pressure_gain or metering; `errors`: gain of the flow meter, zero of port A."""
    duration = bench.period * bench.cycles
    times = np.arange(0.0, duration + 1e-9, bench.sample)
    if bench.rough:
        times[1:-1] += bench.sample * random.uniform(-0.4, 0.4, len(times) - 2)
    volts = amplitude * NOMINAL
    thinner = lighter = 1.0
    if bench.oil:
        start, end, stated = bench.oil
        warmer = start + (end - start) * times / duration - stated
        # 4.5 % of the viscosity and 0.07 % of the density for each degree
        thinner, lighter = np.exp(0.045 * warmer), 1 / np.sqrt(1 - 7e-4 * warmer)
    supply = bench.supply + bench.wander * np.sin(2 * math.pi * (times / 170.0 + random.random()))
    conductances = edges(valve, position(valve, bench, times, volts, random), thinner, lighter)
    solved = equilibrium(valve, bench, conductances, supply, meter if kind == "metering" else None, lighter)
    noise = lambda size: size * random.standard_normal(len(times))
    pressures = [converted(value + noise(bench.pressure_noise), 100e5, bench.bits)
                 for value in (supply, solved[0] + errors[1], bench.gain_b * solved[1])]
    command = triangle(times, bench.period, volts) + noise(bench.command_noise)
    lost = random.choice(len(times), round(bench.lost_commands * len(times)), replace=False)
    command[lost] = random.uniform(-volts, volts, len(lost))
    columns = {"time_s": times, "command_v": converted(command, 2 * NOMINAL, bench.bits)}
    if not bench.sag:
        columns["supply_pressure_bar"] = pressures[0] / BAR
    columns |= {"pressure_a_bar": pressures[1] / BAR, "pressure_b_bar": pressures[2] / BAR}
    if kind != "pressure_gain":
        flow = solved[2] * (1 + errors[0]) if kind == "metering" else solved[3]
        flow = np.interp(times - bench.delay * bench.period, times, flow) if bench.delay else flow
        shown = converted(reading(meter, flow, random), 2 * meter.full, bench.bits)
        columns["flow_l_per_min" if kind == "metering" else "leak_flow_l_per_min"] = shown / LITRE_PER_MINUTE
    if bench.oil:
        columns["oil_temperature_degC"] = warmer + stated + noise(0.02)
    return text(columns, bench, random)


def text(columns, bench, random):
    """Rows of a file. A rough one has any value of a signal's range in 1 % of its rows, cells without a value in 1 %, and a gap of 20 rows."""
    cells = {name: [f"{value:.10g}" for value in values] for name, values in columns.items()}
    rows = np.arange(len(columns["time_s"]))
    if bench.rough:
        names = [name for name in columns if name not in ("time_s", "command_v")]
        for row in random.choice(rows, len(rows) // 100, replace=False):
            name = names[random.integers(len(names))]
            cells[name][row] = f"{random.uniform(min(columns[name]), max(columns[name])):.10g}"
        for row in random.choice(rows, len(rows) // 100, replace=False):
            cells[names[random.integers(len(names))]][row] = ""
        gap = random.integers(len(rows) - 20)
        rows = np.delete(rows, slice(gap, gap + 20))
    lines = [",".join(columns)] + [",".join(cells[name][row] for name in columns) for row in rows]
    return "\n".join(lines) + "\n"


def recordings(valve, bench, random):
    """The files of all tests of a valve, by name."""
    errors = (bench.gain_error * random.uniform(-1, 1), bench.zero_error * random.uniform(-1, 1))
    files = {
        "leakage.csv": test(valve, bench, "leakage", bench.leakage_amplitude, bench.leak_meter, errors, random),
        "pressure_gain.csv": test(valve, bench, "pressure_gain", bench.gain_amplitude, None, errors, random),
    }
    for number, (meter, amplitude) in enumerate(bench.metering):
        files[f"metering_{number + 1}.csv"] = test(valve, bench, "metering", amplitude, meter, errors, random)
    return files
