"""Derives with SymPy what the theory pages state about the linear models, and stops where page and derivation differ.

Each `same` states a formula of the book; both sides must be equal for every value of the symbols.
"""

import sympy as sp

s, w, xi, K_S, M, f_v, G = sp.symbols("s w xi K_S M f_v G", positive=True)
A, K_c, K_H, K_q = sp.symbols("A K_c K_H K_q", positive=True)
m, c, k = sp.symbols("m c k", positive=True)
A_A, A_B, C_A, C_B, K_cA, K_cB, K_qA, K_qB = sp.symbols("A_A A_B C_A C_B K_cA K_cB K_qA K_qB", positive=True)
V = s**2 + 2 * xi * w * s + w**2
FAILURES = []


def same(what, found, stated):
    numerator = sp.fraction(sp.together(found - stated))[0]
    fine = sp.expand(numerator) == 0 or (not numerator.is_polynomial() and sp.simplify(numerator) == 0)
    print(f"{'ok  ' if fine else 'FAIL'} {what}")
    if not fine:
        FAILURES.append(what)


def coefficients(expression):
    """Of s, lowest power first."""
    return sp.Poly(sp.expand(expression), s).all_coeffs()[::-1]


def force(chambers):
    """F_e by U_C and by X_L from the equations of the page, one below the other, pressures among the unknowns."""
    U_C, X_L, U, X, F_e = sp.symbols("U_C X_L U X F_e")
    pressures, equations, F_h = chambers(U, X)
    system = [V * U - w**2 * U_C, *equations, (M * s**2 + f_v * s) * X - F_h + F_e, F_e - K_S * (X - X_L)]
    (found,) = sp.linsolve(system, [F_e, U, X, *pressures])
    return [sp.cancel(found[0].subs({U_C: 1 - other, X_L: other})) for other in (0, 1)]


def load_pressure(U, X):
    p_L = sp.Symbol("p_L")
    flow = K_q * U - (K_c + G) * p_L
    return [p_L], [A**2 / K_H * s * p_L - flow + A * s * X], A * p_L


def two_pressures(U, X):
    p_A, p_B = sp.symbols("p_A p_B")
    across = G * (p_A - p_B)
    into_a = C_A * s * p_A - K_qA * U + K_cA * p_A + A_A * s * X + across
    into_b = C_B * s * p_B + K_qB * U + K_cB * p_B - A_B * s * X - across
    return [p_A, p_B], [into_a, into_b], A_A * p_A - A_B * p_B


def chambers():
    """D, N_u and N_v of both forms."""
    K = K_c + G
    one = (A**2 * s + K * K_H, A * K_H * K_q, A**2 * K_H)
    Y_A, Y_B = C_A * s + K_cA, C_B * s + K_cB
    two = (
        Y_A * Y_B + G * (Y_A + Y_B),
        A_A * K_qA * Y_B + A_B * K_qB * Y_A + G * (A_A - A_B) * (K_qA - K_qB),
        A_A**2 * Y_B + A_B**2 * Y_A + G * (A_A - A_B) ** 2,
    )
    return one, two


def plant():
    for name, form, (D, N_u, N_v) in zip(("load pressure", "two pressures"), (load_pressure, two_pressures), chambers()):
        command, motion = force(form)
        Q = (M * s**2 + f_v * s) * D + N_v * s
        same(f"F_e/U_C, {name}", command, K_S * w**2 * N_u / (V * (Q + K_S * D)))
        same(f"F_e/X_L, {name}", motion, -K_S * V * Q / (V * (Q + K_S * D)))
    one, two = chambers()
    C = sp.Symbol("C", positive=True)
    equal = {A_A: A, A_B: A, C_A: C, C_B: C, K_cA: 2 * K_c, K_cB: 2 * K_c, K_qA: K_q, K_qB: K_q}
    stiffness = {K_H: 2 * A**2 / C}
    for which in (1, 2):
        same(
            f"equal chambers: both forms are one, {which}",
            (two[which] / two[0]).subs(equal),
            (one[which] / one[0]).subs(stiffness),
        )


def load():
    """The load that yields, X_L eliminated, and its denominator power by power."""
    U, X, X_L, X_0, F_e, U_C = sp.symbols("U X X_L X_0 F_e U_C")
    Z = m * s**2 + c * s + k
    D, N_u, N_v = chambers()[0]
    Q = (M * s**2 + f_v * s) * D + N_v * s
    F_h = (N_u * U - N_v * s * X) / D
    system = [
        V * U - w**2 * U_C,
        (M * s**2 + f_v * s) * X - F_h + F_e,
        F_e - K_S * (X - X_L),
        Z * X_L - F_e - (c * s + k) * X_0,
    ]
    ((found, *_),) = sp.linsolve(system, [F_e, U, X, X_L])
    R = Q * (Z + K_S) + K_S * Z * D
    same("load that yields", found, K_S * (Z * w**2 * N_u * U_C - (c * s + k) * V * Q * X_0) / (V * R))
    K = (K_c + G) * K_H
    q1, q2, q3 = K * f_v + A**2 * K_H, A**2 * f_v + K * M, A**2 * M
    stated = [
        K_S * k * K,
        (k + K_S) * q1 + K_S * (c * K + k * A**2),
        c * q1 + (k + K_S) * q2 + K_S * (m * K + c * A**2),
        m * q1 + c * q2 + (k + K_S) * q3 + K_S * m * A**2,
        m * q2 + c * q3,
        m * q3,
    ]
    for power, (found, formula) in enumerate(zip(coefficients(R), stated, strict=True)):
        same(f"r_{power}", found, formula)
    free = (Z * N_u * K_S / R).subs({m: 0, c: 0})
    series = sp.Symbol("series", positive=True)
    held = (series * N_u / (Q + series * D)).subs(series, k * K_S / (k + K_S))
    same("a massless spring behind the sensor is in series with it", free, held)


def fifth_order():
    D, N_u, N_v = chambers()[0]
    K = (K_c + G) * K_H
    Q = (M * s**2 + f_v * s) * D + N_v * s
    a = [
        w**2 * K * K_S,
        w**2 * A**2 * (K_H + K_S) + K * (2 * xi * w * K_S + w**2 * f_v),
        2 * xi * w * A**2 * (K_H + K_S) + w**2 * A**2 * f_v + K * (2 * xi * w * f_v + w**2 * M + K_S),
        2 * xi * w * A**2 * f_v + w**2 * A**2 * M + K * (2 * xi * w * M + f_v) + A**2 * (K_H + K_S),
        2 * xi * w * A**2 * M + A**2 * f_v + K * M,
        A**2 * M,
    ]
    b = [
        w**2 * A**2 * K_H + w**2 * f_v * K,
        2 * xi * w * A**2 * K_H + w**2 * A**2 * f_v + K * (2 * xi * w * f_v + w**2 * M),
        2 * xi * w * A**2 * f_v + w**2 * A**2 * M + A**2 * K_H + K * (2 * xi * w * M + f_v),
        a[4],
        a[5],
    ]
    for power, (found, stated) in enumerate(zip(coefficients(V * (Q + K_S * D)), a, strict=True)):
        same(f"a_{power} of 6.7", found, stated)
    for power, (found, stated) in enumerate(zip(coefficients(V * Q / s), b, strict=True)):
        same(f"b_{power} of 6.7", found, stated)
    same("c_0 of 6.7", K_S * w**2 * N_u, A * K_H * K_q * K_S * w**2)


def decomposition():
    """6.12: the slow root and the pair to first order in K_c and f_v, and 6.13."""
    e, K_eq = sp.Symbol("e"), K_H * K_S / (K_H + K_S)
    d_0, d_1 = (K_H + K_S) / M, f_v / M + K_c * K_H**2 / (A**2 * (K_H + K_S))
    cubic = sp.expand(((M * s**2 + f_v * s + K_S) * (A**2 * s + K_c * K_H) + A**2 * K_H * s) / (A**2 * M))
    small = cubic.subs({K_c: e * K_c, f_v: e * f_v}, simultaneous=True)
    product = sp.expand((s + e * K_c * K_eq / A**2) * (s**2 + e * d_1 * s + d_0))
    rest = sp.Poly(sp.expand(sp.simplify(small - product)), s, e)
    same("6.12 corrected is right to first order in leakage and friction", min(p[1] for p in rest.monoms()), 2)
    same("d_1 by Vieta", f_v / M + K_c * K_H / A**2 - K_c * K_eq / A**2, d_1)
    left = small - sp.expand((s + e * K_c * K_eq / A**2) * (s**2 + e * f_v / M * s + d_0))
    first = sp.Poly(sp.expand(sp.simplify(left)), s, e).coeff_monomial(s**2 * e)
    same("what the printed d_1 leaves out", first, K_c * K_H**2 / (A**2 * (K_H + K_S)))
    full = A * K_H * K_q * K_S / (A**2 * M) / cubic
    same("static gain of 6.7 and 6.13", full.subs(s, 0), (K_q * K_eq / A) / (K_c * K_eq / A**2))
    massless = sp.limit(sp.cancel(full.subs(f_v, 0)), M, 0)
    same("6.13 is 6.7 without mass, friction and spool", massless, (K_q * K_eq / A) / (s + K_c * K_eq / A**2))
    K_p, tau = sp.symbols("K_p tau", positive=True)
    closed = K_p * K_q * K_eq / A / (s + K_c * K_eq / A**2 + K_p * K_q * K_eq / A)
    stated = A * K_p * K_q / (K_c + A * K_p * K_q)
    tau_d = A * (K_H + K_S) / (K_H * K_S * (K_c / A + K_p * K_q))
    same("6.14 and 6.15", closed, stated / (tau_d * s + 1))
    same("6.16", sp.solve(tau_d - tau, K_H)[0], K_S * A**2 / (K_S * tau * (K_c + A * K_p * K_q) - A**2))
    same("6.27", sp.solve(tau_d - tau, K_p)[0], (A * (K_H + K_S) / (tau * K_H * K_S) - K_c / A) / K_q)


def reduction():
    """Two pressures to one: what K_H, K_qU and K_c keep, and when nothing is lost."""
    two = [part.subs(G, 0) for part in chambers()[1]]
    A_u = (A_A + A_B) / 2
    H = A_A**2 / C_A + A_B**2 / C_B
    gain = A_u / H * (A_A * K_qA / C_A + A_B * K_qB / C_B)
    leak = A_u**2 / (A_A**2 / K_cA + A_B**2 / K_cB)
    swap = {A: A_u, K_H: H, K_q: gain, K_c: leak, G: 0}
    one = [part.subs(swap, simultaneous=True) for part in chambers()[0]]
    fast = lambda parts, which: sp.limit(sp.cancel(s * parts[which] / parts[0]), s, sp.oo)
    same("fast motion feels K_H", fast(two, 2), H)
    same("fast command, two pressures", fast(two, 1), fast(one, 1))
    same("slow motion feels the damper", (two[2] / two[0]).subs(s, 0), (one[2] / one[0]).subs(s, 0))
    ratio = (one[1] / one[0]).subs(s, 0) / (two[1] / two[0]).subs(s, 0)
    corner = sp.Symbol("corner", positive=True)
    one_corner = {K_cA: corner * C_A, K_cB: corner * C_B}
    for which in (1, 2):
        same(
            f"one corner frequency: exact for any areas, {which}",
            (one[which] / one[0]).subs(one_corner),
            (two[which] / two[0]).subs(one_corner),
        )
    equal = {K_qA: K_q, K_qB: K_q, K_cA: 2 * K_c, K_cB: 2 * K_c, A_A: A, A_B: A}
    stated = 1
    same("equal areas and edges, unequal chambers: the static gain stays", ratio.subs(equal), stated)
    wide = {K_qA: K_q, K_qB: K_q, K_cA: 2 * K_c, K_cB: 2 * K_c}
    stated = (A_A**2 + A_B**2) * (A_A / C_A + A_B / C_B) / ((A_A + A_B) * (A_A**2 / C_A + A_B**2 / C_B))
    same("unequal areas, equal edges: static gain over that of two pressures", 1 / ratio.subs(wide), 1 / stated)


def stiffness():
    """6.18, 6.19 and 6.25 from 6.3, and 6.19's place."""
    x, L, V_0, beta = sp.symbols("x L V_0 beta", positive=True)
    K = beta * A**2 * (1 / (A * x + V_0) + 1 / (A * (L - x) + V_0))
    same("6.18", K.subs(x, 0), beta * A**2 * (A * L + 2 * V_0) / (V_0 * (A * L + V_0)))
    same("6.19", K.subs(x, L / 2), 4 * beta * A**2 / (A * L + 2 * V_0))
    same("6.19 is where the slope vanishes", sp.diff(K, x).subs(x, L / 2), 0)
    D, E, eps, r, b0, wanted, length = sp.symbols("D E eps r b0 K L_ho", positive=True)
    wall = r * (sp.pi * D**2 + 4 * E) / (4 * eps)
    effective = wall * b0 / (wall + b0)
    solved = sp.solve(K.subs(x, L / 2).subs({V_0: sp.pi * D**2 / 4 * length, beta: effective}) - wanted, length)[0]
    bore = sp.pi * D**2 + 4 * E
    printed = 8 * A**2 * r * b0 * bore / (sp.pi * D**2 * wanted * (4 * eps * b0 + r * bore)) - 2 * A * L / (sp.pi * D**2)
    same("6.25", solved, printed)
    per_metre, held = eps / r, sp.pi * D**2 / 4
    volume = A * L / 2 / b0 + length * (per_metre + (held + E) / b0)
    solved = sp.solve(2 * A**2 / volume - wanted, length)[0]
    stated = (2 * A**2 / wanted - A * L / (2 * b0)) / (eps / r + (held + E) / b0)
    same("length by volume", solved, stated)


def control_flow():
    """4.21 and 4.22 by differentiating 4.18 with sech on its leakage, and 4.18 from the edges."""
    U, U_n, K_v, K_i, lam, p_S, p_T, p_L = sp.symbols("U U_n K_v K_i lambda p_S p_T p_L", positive=True)
    for sign in (1, -1):
        opening, shut = K_v * U / U_n, K_i / sp.cosh(lam * U / U_n)
        inner, outer = (sp.sqrt((p_S - p_T - side * sign * p_L) / 2) for side in (1, -1))
        p_A, p_B = (p_S + p_T + p_L) / 2, (p_S + p_T - p_L) / 2
        plus, minus = (opening + shut, shut) if sign > 0 else (shut, opening + shut)
        q_A = plus * sp.sqrt(p_S - p_A) - minus * sp.sqrt(p_A - p_T)
        q_B = minus * sp.sqrt(p_S - p_B) - plus * sp.sqrt(p_B - p_T)
        flow = sign * ((opening + shut) * inner - shut * outer)
        same(f"4.18 from the edges, U {'>' if sign > 0 else '<'} 0", (q_A - q_B) / 2, flow)
        # The spool's position is sign U: a slope over it is sign times that over U.
        tangent = sp.tanh(lam * U / U_n)
        gain = K_v / U_n * inner + lam / U_n * shut * tangent * (outer - inner)
        same("4.21 corrected", sp.diff(flow, U).rewrite(sp.exp) * sign, gain.rewrite(sp.exp))
        drop = lambda side: sp.sqrt(8 * (p_S - p_T - side * sign * p_L))
        same("4.22 corrected", -sp.diff(flow, p_L), (opening + shut) / drop(1) + shut / drop(-1))


def impedance():
    """The closed loop's admittance part by part, and its real part without leakage."""
    N = sp.Symbol("Gamma")  # (K_qU/A) G(s) V(s), the controller and the spool
    D, N_u, N_v = A**2 * s + K_c * K_H, A * K_H * K_q, A**2 * K_H
    Q = (M * s**2 + f_v * s) * D + N_v * s
    loop = N * A / K_q  # G(s) V(s)
    Z = K_S * Q / s / (Q + K_S * D + loop * K_S * N_u)
    fluid, piston = 1 / (s / K_H + K_c / A**2), M * s + f_v
    same("1/Z: sensor in series with piston, fluid and feedback", 1 / Z, s / K_S + (1 + fluid * N) / (fluid + piston))
    o, x, y = sp.symbols("omega x y", real=True)
    on_axis = {K_c: 0, s: sp.I * o}
    conjugate = f_v - sp.I * M * o + sp.I * K_H / o
    same("conjugate", conjugate, (fluid + piston).subs({K_c: 0, s: -sp.I * o}))
    real = sp.re(sp.expand((1 + fluid.subs(on_axis) * (x + sp.I * y)) * conjugate))
    stated = f_v * (1 + K_H * y / o) + K_H * M * (K_H / (M * o**2) - 1) * x
    same("its real part's sign without valve leakage", real, stated)
    K_p, K_i = sp.symbols("K_p K_i", positive=True)
    G_s = K_q / A * (K_p + K_i / s)
    open_loop = sp.cancel(Z.subs(N, 0)).subs(s, 0)
    same("open loop at rest", open_loop, (A**2 + f_v * K_c) / K_c)
    integral = sp.limit(sp.cancel(Z.subs(N, G_s) / s), s, 0)
    same("integral action: a mass", integral, (A + f_v * K_c / A) / (K_q * K_i))
    same("high frequency: the sensor", sp.limit(sp.cancel(s * Z.subs(N, 0)), s, sp.oo), K_S)


def energy():
    """Storage functions: what the port takes less what is stored never falls below zero in open loop; LuGre."""
    p_A, p_B, p_L, v, v_L, F, z, g, s0, s1, s2 = sp.symbols("p_A p_B p_L v v_L F z g s0 s1 s2", real=True)
    kinetic = v * (A_A * p_A - A_B * p_B - f_v * v - F) + F * (v - v_L)
    rates = p_A * (-K_cA * p_A - A_A * v - G * (p_A - p_B)) + p_B * (-K_cB * p_B + A_B * v + G * (p_A - p_B))
    lost = f_v * v**2 + K_cA * p_A**2 + K_cB * p_B**2 + G * (p_A - p_B) ** 2
    same("two pressures: stored energy", kinetic + rates, -F * v_L - lost)
    one = v * (A * p_L - f_v * v - F) + p_L * (-(K_c + G) * p_L - A * v) + F * (v - v_L)
    same("load pressure: stored energy", one, -F * v_L - f_v * v**2 - (K_c + G) * p_L**2)
    rate = v - s0 * v * z / g  # v > 0
    friction = s0 * z + s1 * rate + s2 * v
    surplus = friction * v - s0 * z * rate
    same("LuGre: power less storage", surplus, v * (s0 * z) ** 2 / g + v**2 * (s1 + s2 - s1 * s0 * z / g))


for check in (plant, load, fifth_order, decomposition, reduction, stiffness, control_flow, impedance, energy):
    check()
if FAILURES:
    raise SystemExit(f"{len(FAILURES)} formulae of the book part from their derivation: " + "; ".join(FAILURES))
