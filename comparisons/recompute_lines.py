"""Fits and recomputes what the dynamic line models of hydraulics embed or are compared with.

Independent of phea: NumPy and SciPy only, exact lines with Bessel functions of complex argument. Four parts, each of which
asserts what it computes:

- the weights of the attenuation of a wave, a table over the root of the dissipation number, fitted with weights that
  cannot be negative to exp(sT - Gamma(s)), and how near the line built of them comes to the exact one, and that it is passive;
- the weights of the unsteady laminar friction, fitted to the exact friction factor;
- numbers of the exact line for the tests;
- the two waves of a hose, from the exponential of the 4x4 line equations.

    python comparisons/recompute_lines.py
"""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import nnls
from scipy.special import ive, jn_zeros

CORNERS = np.array([1.0, 6.0, 20.0, 100.0])
DISSIPATION = np.array([1e-5, 1e-4, 5e-4, 1e-3, 2e-3, 3e-3, 5e-3, 8e-3, 0.012, 0.018, 0.025, 0.035, 0.05, 0.07, 0.1])
FRICTION_CORNERS = 26.3744 * 5.0 ** np.arange(5)


def friction_factor(viscous):
    """N = I0(z)/I2(z) with z^2 = s R^2/nu: apparent over true mass of the laminar fluid."""
    z = np.sqrt(viscous + 0j)
    return ive(0, z) / ive(2, z)


def exact(dissipation, frequency):
    """sT, root of N and propagation Gamma at frequencies in units of 1/T."""
    s = 1j * frequency
    root = np.sqrt(friction_factor(s / dissipation))
    return s, root, s * root


def not_negative(columns, target, weight, total=None):
    """Least squares over complex rows with weights that are not negative and, if asked, of this sum."""
    matrix = np.vstack([(columns * weight[:, None]).real, (columns * weight[:, None]).imag])
    right = np.concatenate([(target * weight).real, (target * weight).imag])
    if total is not None:
        heavy = 1e5 * np.sqrt(len(right))
        matrix, right = np.vstack([matrix, heavy * np.ones(matrix.shape[1])]), np.append(right, heavy * total)
    return nnls(matrix, right)[0]


def attenuation_weights(dissipation):
    frequency = np.geomspace(0.3, 40, 150)
    s, _, propagation = exact(dissipation, frequency)
    columns = np.column_stack([np.ones_like(s)] + [corner / (s + corner) for corner in CORNERS])
    weights = not_negative(columns, np.exp(s - propagation), np.ones_like(frequency), 1.0)
    return weights / weights.sum()


def attenuation_table():
    """One row a node: what arrives undelayed by the filters, and their weights; the sum of a row is one exactly."""
    weights = np.vstack([[0, 0, 0, 0]] + [np.round(attenuation_weights(d)[1:], 6) for d in DISSIPATION])
    return np.column_stack([1 - weights.sum(axis=1), weights])


def interpolated(table, dissipation):
    nodes = np.concatenate([[0], np.sqrt(DISSIPATION)])
    return np.array([np.interp(np.sqrt(dissipation), nodes, column) for column in table.T])


def modal_impedances(weights, dissipation, frequency):
    """Impedances of the fitted line with both ends in phase and in opposition, in units of Z_c."""
    s = 1j * frequency
    attenuation = weights[0] + sum(w * b / (s + b) for w, b in zip(weights[1:], CORNERS))
    impedance = 1 + sum(w / (s + b) for w, b in zip(weights[1:], CORNERS))
    resistance = 4 * dissipation / (1 + s)
    wave = np.exp(-s) * attenuation
    return resistance + impedance * (1 + wave) / (1 - wave), resistance + impedance * (1 - wave) / (1 + wave)


def transfer_errors(weights, dissipation):
    """Root mean square errors of t11, t12, t21 up to sT = 30j, over the root mean square of the exact ones."""
    frequency = np.linspace(1e-2, 30, 3000)
    _, root, propagation = exact(dissipation, frequency)
    even, odd = modal_impedances(weights, dissipation, frequency)
    self_impedance, mutual = (even + odd) / 2, (even - odd) / 2
    pairs = [
        (self_impedance / mutual, np.cosh(propagation)),
        (even * odd / mutual, root * np.sinh(propagation)),
        (1 / mutual, np.sinh(propagation) / root),
    ]
    return [np.sqrt(np.mean(abs(a - b) ** 2) / np.mean(abs(b) ** 2)) for a, b in pairs]


def attenuation():
    table = attenuation_table()
    print("attenuation: root of the dissipation number, weights at 1, 6, 20, 100 over T")
    for node, row in zip(np.concatenate([[0], np.sqrt(DISSIPATION)]), table):
        print(f"    ({node:.9f}, [{', '.join(f'{value:.6f}' for value in row[1:])}]),")
    for dissipation, limits in ((1e-3, (3e-3, 5e-3, 3e-3)), (3.1e-3, (5e-3, 8e-3, 5e-3)), (1e-2, (1.2e-2, 2e-2, 1.2e-2)),
                                (3e-2, (4e-2, 5e-2, 4e-2)), (0.1, (0.15, 0.2, 0.15))):
        errors = transfer_errors(interpolated(table, dissipation), dissipation)
        print(f"dissipation {dissipation:g}: errors of t11, t12, t21", *(f"{error:.2e}" for error in errors))
        assert all(error < limit for error, limit in zip(errors, limits)), "further from the exact line than stated"
    frequency = np.geomspace(1e-4, 1e3, 20001)
    for dissipation in np.geomspace(1e-7, 0.1, 40):
        even, odd = modal_impedances(interpolated(table, dissipation), dissipation, frequency)
        assert min(even.real.min(), odd.real.min()) > 0, f"not passive at dissipation {dissipation:g}"
    # what the lags alone would give back is at most l^2/(1 + l) over 1 + (wT)^2: lines in series may share a resistance
    frequency = np.geomspace(1e-2, 300, 20001)
    for dissipation in np.geomspace(1e-7, 0.1, 40):
        weights = interpolated(table, dissipation)
        even, odd = modal_impedances(weights, 0.0, frequency)
        lag = np.sum(weights[1:] / CORNERS)
        needed = lag**2 / (1 + lag) / (1 + frequency**2)
        assert np.all(even.real > -needed) and np.all(odd.real > 0), f"gives back too much at dissipation {dissipation:g}"


def friction():
    viscous = 1j * np.geomspace(0.5, 3e4, 400)
    factor = friction_factor(viscous)
    columns = np.column_stack([4 / (viscous + corner) for corner in FRICTION_CORNERS])
    weights = not_negative(columns, factor - 1 - 8 / viscous, 1 / abs(factor))
    fitted = 1 + 8 / viscous + columns @ weights
    error = max(abs(fitted / factor - 1))
    print("friction weights", *(f"({c:.6g}, {w:.6f})" for c, w in zip(FRICTION_CORNERS, weights)), f"error {error:.2e}")
    assert error < 5e-3
    roots = jn_zeros(2, 400) ** 2
    print("squared zeros of J2", *(f"{root:.4f}" for root in roots[:5]), "sum of inverses", np.sum(1 / roots))
    for tau in (1e-3, 1e-2, 0.1):
        series, fit = np.exp(-roots * tau).sum(), np.sum(weights * np.exp(-FRICTION_CORNERS * tau))
        print(f"W({tau:g}) exact {series:.6g} fitted {fit:.6g}")


def exact_line():
    """1.5 m of the thesis' hose at 35 bar: the oil its bore then holds, its dynamic wall, 870 kg/m3, 46 cSt."""
    length, density, viscosity = 1.5, 870.0, 46e-6
    held = np.pi / 4 * 0.0127**2 + 1.56e-5 - 2.236e-12 * 35e5
    radius, modulus = np.sqrt(held / np.pi), 1 / (1 / 1.45e9 + 2.236e-12 / 5 / held)
    print(f"modulus {modulus:.8g} bore {2 * radius:.8g}")
    speed, area = np.sqrt(modulus / density), np.pi * radius**2
    delay, impedance = length / speed, density * speed / area
    print(f"speed {speed:.6g} delay {delay:.6g} impedance {impedance:.6g} dissipation {viscosity * delay / radius**2:.6g}")
    for frequency in (10.0, 300.0, 3000.0):
        s = 1j * frequency
        root = np.sqrt(friction_factor(s * radius**2 / viscosity))
        gamma = s * delay * root
        print(f"at {frequency:g} rad/s: N {root**2:.8g} t11 {np.cosh(gamma):.8g} t12 {impedance * root * np.sinh(gamma):.8g}")


def two_waves():
    """A hose of round numbers: wave speeds, modal ratios and the transfer matrix with the wall held at both ends."""
    length, radius, density, viscosity, mass = 1.5, 6.35e-3, 870.0, 46e-6, 0.2
    area = np.pi * radius**2
    fluid, c_pp, c_pf, c_ff = 1 / 1.45e9, 3.0e-9, -6.0e-6, 2.0e-5
    lf, lw = density * (fluid + c_pp), mass * c_ff
    slowness = np.roots([1, -(lf + lw), lf * lw - area * density * mass * c_pf**2]).real
    slowness = np.sort(slowness)[::-1]
    ratio = (lf - slowness) / (c_pf * mass)
    print("two waves: speeds", *(f"{c:.8g}" for c in 1 / np.sqrt(slowness)), "ratios", *(f"{n:.8g}" for n in ratio))
    assert abs(ratio[0] * ratio[1] / (-density * area / mass) - 1) < 1e-12
    for loss in (False, True):
        for frequency in (100.0, 1000.0):
            s = 1j * frequency
            extra = friction_factor(s * radius**2 / viscosity) - 1 if loss else 0
            # d/dx of (p, F, v, u)
            momentum = s * np.array([[-density * (1 + extra), density * extra],
                                     [-density * area * extra, mass + density * area * extra]])
            strain = -s * np.array([[fluid + c_pp, c_pf], [-area * c_pf, -c_ff]])
            transition = expm(np.block([[np.zeros((2, 2)), momentum], [strain, np.zeros((2, 2))]]) * length)
            # u = 0 at both ends: eliminate the tension at x = 0
            p_to_u, f_to_u, v_to_u = transition[3, 0], transition[3, 1], transition[3, 2]
            rows = [transition[0], transition[2]]
            matrix = np.array([[row[0] - row[1] * p_to_u / f_to_u, row[2] - row[1] * v_to_u / f_to_u] for row in rows])
            matrix = matrix * np.array([[1, 1 / area], [area, 1]])
            assert abs(np.linalg.det(matrix) - 1) < 1e-9
            print(f"loss {loss} at {frequency:g} rad/s: (p, q) at L from (p, q) at 0", *(f"{x:.8g}" for x in matrix.ravel()))


if __name__ == "__main__":
    attenuation()
    friction()
    exact_line()
    two_waves()
