"""The closed loop of benches/peers/closed_loop.h written a second time, in Python, on SciPy's LSODA: continuous controller.

    python comparisons/closed_loop_scipy.py      # poles of the loop at rest, and while sliding
"""

from math import cosh, exp, pi, sqrt
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp

from closed_loop import DEFAULTS

# Spool, its rate, pressures A and B, load cell deflection, velocity, bristle, integral part, filtered reference, its rate.
ATMOSPHERE = 101_325.0
MAGNITUDES = np.array([1.0, 1e3, 1e5, 1e5, 1e-4, 1e-2, 1e-5, 1.0, 1e3, 1e5])
# Flow into the gas and its pressure, behind the necks at A and B.
NECKS = np.array([1e-5, 1e5, 1e-5, 1e5])
# Absolute temperature of the gas at A and B over that of its wall.
HEAT = np.array([1.0, 1.0])
# Pressure signal behind its low pass, and what a high pass takes from it; of a rig without gas.
FED_BACK = np.array([1e5, 1e5])


def magnitudes_of(rig):
    parts = [NECKS] * hasattr(rig, "neck") + [HEAT] * hasattr(rig, "time_constant")
    parts += [FED_BACK] * hasattr(rig, "pressure_feedback")
    return np.concatenate((MAGNITUDES, *parts))


def root(drop, transition):
    return drop / (drop**2 + transition**2) ** 0.25


def load(rig, time):
    s = min(max((time - rig.motion_start) / rig.motion_duration, 0.0), 1.0)
    moved = rig.motion_distance * (6 * s**5 - 15 * s**4 + 10 * s**3)
    return rig.start_position + moved, rig.motion_distance / rig.motion_duration * 30 * (s**2 - s) ** 2


def flows(rig, spool, pressure_a, pressure_b):
    opening = spool / rig.nominal_voltage
    sech = 1 / cosh(rig.leakage_shape * opening)

    def edge(gain, side, leak, drop):
        return (gain * max(side * opening, 0.0) + leak * sech) * root(drop, rig.transition_pressure)

    supply, tank = rig.supply_pressure, rig.tank_pressure
    into_a = edge(rig.flow_supply_to_a, 1, rig.leakage_supply_to_a, supply - pressure_a)
    into_a -= edge(rig.flow_a_to_tank, -1, rig.leakage_a_to_tank, pressure_a - tank)
    into_b = edge(rig.flow_supply_to_b, -1, rig.leakage_supply_to_b, supply - pressure_b)
    into_b -= edge(rig.flow_b_to_tank, 1, rig.leakage_b_to_tank, pressure_b - tank)
    return into_a, into_b


def gas_compliance(rig, pressure):
    """-dV/dp of the gas at a chamber, m3/Pa; none where the rig has none.

    The bladder lifts between 0.99 and 1.01 times the precharge, absolute.
    """
    if not hasattr(rig, "gas_volume"):
        return 0.0
    precharge, index, above = rig.precharge + ATMOSPHERE, rig.polytropic_exponent, pressure - rig.precharge
    band = 0.01 * precharge
    lifted = min(max((above + band) / (2 * band), 0.0), 1.0)
    absolute = precharge + (above if above > band else band * lifted**2)
    return lifted * rig.gas_volume / (index * precharge) * (precharge / absolute) ** (1 + 1 / index)


def heated(rig, pressure, theta, arriving, beside):
    """Rates of pressure and temperature of gas that receives a flow together with a compliance beside it.

    P V = P_0 V_0 theta, with its heat capacity P_0 V_0/0.4 over the temperature of the wall; the gas stays in use.
    """
    absolute, charge = pressure + ATMOSPHERE, (rig.precharge + ATMOSPHERE) * rig.gas_volume
    volume = charge * theta / absolute
    lost = (theta - 1) / rig.time_constant
    # 1.4 q = (V/P) dP/dt + (V/theta) lost, and what the flow does not give to the gas raises the pressure beside it
    pressure_rate = (1.4 * arriving - volume / theta * lost) / (volume / absolute + 1.4 * beside)
    entering = arriving - beside * pressure_rate
    return pressure_rate, 0.4 * absolute * entering / charge - lost


def neck(rig, pressure, flow, gas_pressure, theta):
    """Rates of the flow through the neck of an accumulator and of the pressure of its gas, which its own oil is beside."""
    diameter, length, loss_coefficient = rig.neck
    section = pi / 4 * diameter**2
    resistance = 128 * rig.density * rig.viscosity * length / (pi * diameter**4)
    lost = resistance * flow + loss_coefficient * rig.density / (2 * section**2) * flow * abs(flow)
    flow_rate, own = (pressure - gas_pressure - lost) * section / (rig.density * length), section * length / rig.fluid_modulus
    if theta is None:
        return [flow_rate, flow / (gas_compliance(rig, gas_pressure) + own)], None
    pressure_rate, theta_rate = heated(rig, gas_pressure, theta, flow, own)
    return [flow_rate, pressure_rate], theta_rate


def to_tank(rig, pressure):
    """Flow from a chamber to the tank through its relief valve, less that through its check valve, m3/s."""
    if not hasattr(rig, "port_valves"):
        return 0.0
    cracking, relief, check_pressure, check, width = rig.port_valves

    def opened(excess):
        return 0.0 if excess <= -width else excess if excess >= width else (excess + width) ** 2 / (4 * width)

    above = pressure - rig.tank_pressure
    return relief * opened(above - cracking) - check * opened(-above - check_pressure)


def rates(time, state, rig, reference):
    scales = magnitudes_of(rig)
    state = state * scales
    spool, spool_rate, pressure_a, pressure_b, deflection, v, z, integral, r, r_rate = state[:10].tolist()
    has_neck, has_heat = hasattr(rig, "neck"), hasattr(rig, "time_constant")
    necks, soft_a, soft_b = [], 0.0, 0.0
    if not has_neck and not has_heat:
        soft_a, soft_b = gas_compliance(rig, pressure_a), gas_compliance(rig, pressure_b)
    theta_a, theta_b = state[-2:].tolist() if has_heat else (None, None)
    load_position, load_velocity = load(rig, time)
    position, force = load_position + deflection, rig.sensor_stiffness * deflection
    error = r - force
    wanted, filters = rig.proportional_gain * error + integral, []
    if hasattr(rig, "pressure_feedback"):
        # u = G (F r - y) - k p_h, of p_l = p w/(s + w) and p_h = p_l s/(s + w)
        gain, ratio, high_pass, low_pass = rig.pressure_feedback
        low, slow = state[10:12].tolist()
        wanted -= gain * (low - slow)
        filters = [low_pass * (pressure_a - ratio * pressure_b - low), high_pass * (low - slow)]
    command = min(max(wanted, -rig.saturation), rig.saturation)
    into_a, into_b = flows(rig, spool, pressure_a, pressure_b)
    into_a, into_b = into_a - to_tank(rig, pressure_a), into_b - to_tank(rig, pressure_b)
    if has_neck:
        flow_a, gas_a, flow_b, gas_b = state[10:14].tolist()
        into_a, into_b = into_a - flow_a, into_b - flow_b
        of_a, warming_a = neck(rig, pressure_a, flow_a, gas_a, theta_a)
        of_b, warming_b = neck(rig, pressure_b, flow_b, gas_b, theta_b)
        necks = of_a + of_b
    volume_a = rig.line_volume_a + rig.area_a * position
    volume_b = rig.line_volume_b + rig.area_b * (rig.stroke - position)
    level = rig.coulomb + (rig.static_friction - rig.coulomb) * exp(-((v / rig.stribeck_velocity) ** 2))
    z_rate = v - rig.bristle_stiffness * abs(v) / level * z
    friction = rig.bristle_stiffness * z + rig.bristle_damping * z_rate + rig.viscous * v
    oil_a, oil_b = volume_a / rig.chamber_modulus, volume_b / rig.chamber_modulus
    rate_a, rate_b = (into_a - rig.area_a * v) / (oil_a + soft_a), (into_b + rig.area_b * v) / (oil_b + soft_b)
    if has_heat and not has_neck:
        rate_a, warming_a = heated(rig, pressure_a, theta_a, into_a - rig.area_a * v, oil_a)
        rate_b, warming_b = heated(rig, pressure_b, theta_b, into_b + rig.area_b * v, oil_b)
    pull = rig.area_a * pressure_a - rig.area_b * pressure_b
    rate = [
        spool_rate,
        rig.valve_frequency**2 * (command - spool) - 2 * rig.valve_damping * rig.valve_frequency * spool_rate,
        rate_a,
        rate_b,
        v - load_velocity,
        (pull - friction - force) / rig.moving_mass,
        z_rate,
        rig.integral_gain * error,
        r_rate,
        rig.prefilter_stiffness * (reference - r) - rig.prefilter_damping * r_rate,
    ]
    return np.array(rate + necks + ([warming_a, warming_b] if has_heat else []) + filters) / scales


def force(tolerance, **changes):
    """The force each millisecond of 5 s, for the default rig with these changes."""
    rig = SimpleNamespace(**{**DEFAULTS, **changes})
    magnitudes = magnitudes_of(rig)
    state = np.zeros(len(magnitudes))
    state[2:4] = rig.start_pressure_a, rig.start_pressure_b
    if hasattr(rig, "neck"):
        state[[11, 13]] = state[2:4]
    if hasattr(rig, "time_constant"):
        state[-2:] = 1.0
    state, times, forces = state / magnitudes, np.round(np.arange(5001) * 1e-3, 6), [np.zeros(1)]
    ends = [rig.reference_time, rig.motion_start, rig.motion_start + rig.motion_duration, rig.duration]
    for start, end in zip([0.0, *ends], ends):
        wanted = np.unique([*times[(times > start + 1e-9) & (times < end + 1e-9)], end])
        given = (rig, rig.reference_force if start >= rig.reference_time else 0.0)
        solved = solve_ivp(rates, (start, end), state, "LSODA", wanted, args=given, rtol=tolerance, atol=tolerance)
        assert solved.success, solved.message
        state = solved.y[:, -1]
        forces.append(rig.sensor_stiffness * MAGNITUDES[4] * solved.y[4])
    return np.concatenate(forces)


def poles(velocity, rig=SimpleNamespace(**DEFAULTS)):
    """Of the loop linearised at the start's pressures and a piston velocity, the bristle settled."""
    level = rig.coulomb + (rig.static_friction - rig.coulomb) * exp(-((velocity / rig.stribeck_velocity) ** 2))
    settled = level / rig.bristle_stiffness * np.sign(velocity)
    point = np.array([0, 0, rig.start_pressure_a, rig.start_pressure_b, 0, velocity, settled, 0, 0, 0]) / MAGNITUDES
    steps = 1e-5 * np.eye(10)
    columns = [(rates(0, point + step, rig, 0) - rates(0, point - step, rig, 0)) / 2e-5 for step in steps]
    return np.linalg.eigvals(np.array(columns).T)


def main():
    for velocity in (0.0, 0.01, 0.05, 0.094):
        listed = ", ".join(f"{pole:.4g}" for pole in sorted(poles(velocity), key=abs))
        print(f"poles at {velocity} m/s in 1/s: {listed}")


if __name__ == "__main__":
    main()
