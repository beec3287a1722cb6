"""Recomputes, with fifty digits, the sampled plants and loops that tests of `discretization` and of qft's audit hold phea to.

Independent of phea: mpmath only. A plant with distinct poles is split into partial fractions; behind a hold, with a dead time tau shorter
than a sample, its step response at the samples sums up to

    P(z) = (1 - 1/z) sum of r_i exp(p_i (T - tau))/(z - exp(p_i T)),      P(s)/s = sum of r_i/(s - p_i)

and without dead time to the same with z in place of exp(p_i T) above. A closed loop is judged by the roots of its characteristic
polynomial in z, and by |S| and |T| on a dense grid.

    python comparisons/recompute_sampling.py
"""

import mpmath as mp

mp.mp.dps = 60


def check(name, value, expected, tolerance):
    print(f"{name:64s} {mp.nstr(value, 17)}")
    assert abs(value - expected) <= tolerance, f"{name}: {value} is not {expected}"


def product(factors):
    result = mp.mpc(1)
    for factor in factors:
        result *= factor
    return result


class Sampled:
    """gain prod(s - zero)/prod(s - pole) behind a hold."""

    def __init__(self, gain, zeros, poles, period, tau=0):
        self.poles, self.period, self.tau = [mp.mpc(pole) for pole in poles], mp.mpf(period), mp.mpf(tau)
        # a pole at the origin would be double with the hold's own: it is moved where it makes no difference in fifty digits
        modes = [mp.mpc(0)] + [pole if pole != 0 else mp.mpc("-1e-55") for pole in self.poles]
        self.modes = modes
        self.residues = [
            gain
            * product(mode - zero for zero in zeros)
            / product(mode - other for index, other in enumerate(modes) if index != own)
            for own, mode in enumerate(modes)
        ]
        self.images = [mp.exp(mode * self.period) for mode in modes]

    def at(self, z):
        if self.tau == 0:
            late = [z] * len(self.modes)
        else:
            late = [mp.exp(mode * (self.period - self.tau)) for mode in self.modes]
        terms = zip(self.residues, late, self.images)
        return (1 - 1 / z) * mp.fsum(r * factor / (z - image) for r, factor, image in terms)

    def numerator(self):
        """Coefficients of P(z) prod(z - image of pole), highest power first, without dead time."""
        order = len(self.poles)
        points = [mp.expjpi(mp.mpf(2 * k + 1) / (order + 1)) for k in range(order + 1)]
        values = [self.at(z) * product(z - image for image in self.images[1:]) for z in points]
        return [
            mp.fsum(value * z ** (-power) for value, z in zip(values, points)).real / (order + 1)
            for power in range(order, -1, -1)
        ]


def second_order(frequency, twice_damping):
    """Roots of s^2/w^2 + twice_damping s/w + 1."""
    w, half = mp.mpf(frequency), mp.mpf(twice_damping) / 2
    turn = mp.sqrt(1 - half**2)
    return [w * mp.mpc(-half, turn), w * mp.mpc(-half, -turn)]


def characteristic(plant, numerator, denominator):
    """prod(z - image) times the controller's denominator, plus N(z) times its numerator; coefficients highest power first."""

    def times(one, other):
        result = [mp.mpf(0)] * (len(one) + len(other) - 1)
        for i, a in enumerate(one):
            for j, b in enumerate(other):
                result[i + j] += a * b
        return result

    poles = [mp.mpc(1)]
    for image in plant.images[1:]:
        poles = times(poles, [mp.mpc(1), -image])
    left, right = times(poles, denominator), times(plant.numerator(), numerator)
    left, right = ([mp.mpf(0)] * (max(len(left), len(right)) - len(side)) + side for side in (left, right))
    return [mp.re(a) + b for a, b in zip(left, right)]


def largest_real_part(plant, numerator, denominator):
    roots = mp.polyroots(characteristic(plant, numerator, denominator), maxsteps=500, extraprec=400)
    return max(mp.log(abs(root)) for root in roots) / plant.period


def loop(plant, numerator, denominator, frequency):
    z = mp.expj(frequency * plant.period)
    return plant.at(z) * mp.polyval(numerator, z) / mp.polyval(denominator, z)


def peak(function, low, high, points=400):
    """The largest value on a grid, refined by golden section; and where it is."""
    grid = [low + (high - low) * mp.mpf(k) / points for k in range(points + 1)]
    index = max(range(points + 1), key=lambda k: function(grid[k]))
    low, high = grid[max(index - 1, 0)], grid[min(index + 1, points)]
    share = (3 - mp.sqrt(5)) / 2
    for _ in range(80):
        left, right = low + share * (high - low), high - share * (high - low)
        low, high = (low, right) if function(left) > function(right) else (left, high)
    return function((low + high) / 2), (low + high) / 2


def db(value):
    return 20 * mp.log10(value)


def responses():
    """Stiff plants at the frequencies of the table in crates/dynamics/tests/held_plants.rs."""
    for name, gain, zeros, poles, period, tau, angles in PLANTS:
        plant = Sampled(mp.mpf(gain), [mp.mpc(zero) for zero in zeros], poles, period, tau)
        for angle in angles:
            value = plant.at(mp.expj(mp.mpf(angle)))
            print(f"{name:28s} {angle:5.2f}  {float(value.real)!r:>24s} {float(value.imag)!r:>24s}")


PLANTS = [
    ("two fast poles", 6800.0 * 3740.0, [], [-6800.0, -3740.0], 0.01, 0.0, [0.01, 1.0, 3.0]),
    ("the same, late", 6800.0 * 3740.0, [], [-6800.0, -3740.0], 0.01, 0.0099, [0.01, 1.0, 3.0]),
    ("ten thousand to one", 300.0, [-0.5], [-0.05, -2.0, -500.0], 1.0, 0.0, [0.01, 1.0, 3.0]),
    (
        "light, fast and slow",
        1e8,
        [mp.mpc(-0.01, 0.7), mp.mpc(-0.01, -0.7)],
        [mp.mpc(-0.02, 0.5), mp.mpc(-0.02, -0.5), mp.mpc(-3.0, 90.0), mp.mpc(-3.0, -90.0), -400.0, -450.0],
        1.0,
        0.25,
        [0.01, 1.0, 3.0],
    ),
    ("unstable and fast", 50.0, [], [2.0, -700.0], 0.5, 0.1, [0.01, 1.0, 3.0]),
]


def loops():
    """The loops of crates/qft/tests/audit_truths.rs."""
    integrator = ([mp.mpf("0.6")], [mp.mpf(1), mp.mpf(-1)])
    plant = Sampled(mp.mpf(6800 * 3740), [], [-6800, -3740], mp.mpf("0.01"))
    sensitivity = lambda w: abs(1 / (1 + loop(plant, *integrator, w)))
    largest, where = peak(sensitivity, mp.mpf(1), mp.pi / plant.period)
    check("two fast poles: |S| over 1.6, dB", db(largest / mp.mpf("1.6")), 4.794366012, 1e-8)
    check("two fast poles: at, rad/s", where, 91.132177, 1e-6)

    integrator = ([mp.mpf("0.5")], [mp.mpf(1), mp.mpf(-1)])
    plant = Sampled(mp.mpf(15000 * 5550), [], [-15000, -5550], mp.mpf("0.01"))
    check("faster poles: largest real part", largest_real_part(plant, *integrator), -34.65735902800, 1e-9)
    sensitivity = lambda w: abs(1 / (1 + loop(plant, *integrator, w)))
    largest, _ = peak(sensitivity, mp.mpf(1), mp.pi / plant.period)
    check("faster poles: |S|, dB", db(largest), 6.838056807, 1e-8)

    integrator = ([mp.mpf("0.2931")], [mp.mpf(1), mp.mpf(-1)])
    poles = [-mp.mpf("375.266")] + second_order("391.422", "1.6264") + second_order("0.606991", "0.4916")
    gain = -product(poles)
    plant = Sampled(gain, [], poles, 1)
    check("slow resonance: largest real part", largest_real_part(plant, *integrator), 0.01811556760671, 1e-12)

    # the modes are undamped enough for the worst frequency to be sharp
    tustin = ([mp.mpf("0.15"), mp.mpf("0.15")], [mp.mpf(1), mp.mpf(-1)])

    def folded(w):
        poles = [mp.mpf("-0.5")] + second_order(w, "0.01")
        plant = Sampled(w**2 / 2, [], poles, 1)
        complementary = lambda v: abs(1 - 1 / (1 + loop(plant, *tustin, v)))
        return peak(complementary, mp.mpf("0.25"), mp.mpf("0.4"), 40)[0]

    mp.mp.dps = 30
    largest, where = peak(folded, mp.mpf("6.6"), mp.mpf("6.66"), 12)
    mp.mp.dps = 60
    check("folded mode: |T| over 1.4, dB", db(largest / mp.mpf("1.4")), 1.3757410549, 1e-9)
    check("folded mode: w", where, 6.6310676, 1e-6)

    gain = mp.mpf("0.09582725209259761") / 2
    tustin = ([gain, gain], [mp.mpf(1), mp.mpf(-1)])
    w = mp.mpf("62.451")
    plant = Sampled(w**2, [], second_order(w, "0.0014"), 1)
    check("folded unstable mode: real part", largest_real_part(plant, *tustin), 0.00417, 1e-5)


if __name__ == "__main__":
    responses()
    loops()
