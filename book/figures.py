"""Draws the figures of the theory pages from `curves.py` into book/src/images.

    pip install -r book/requirements.txt
    python book/figures.py            # all of them
    python book/figures.py friction   # those whose name contains the word

Colours are those of phea's own figures, distinguishable with every kind of colour vision; dashes and markers carry the same distinction into a grey
print. Letters are outlines, so a figure looks alike wherever it is shown. The same versions draw the same bytes.
"""

import math
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import curves  # noqa: E402

IMAGES = pathlib.Path(__file__).resolve().parent / "src" / "images"
BLUE, ORANGE, GREEN, VIOLET, PINK, BROWN, BLACK = (
    "#045dfb", "#dc6115", "#036553", "#7a3aaa", "#bd4685", "#8b5b00", "#20293a",
)
MUTED = "#5a6675"
BAR, LITRES, MILLI = 1e-5, 6e4, 1e3
WIDTH = 5.9  # inches

plt.rcParams.update({
    "svg.fonttype": "path", "svg.hashsalt": "phea", "font.family": "DejaVu Sans", "font.size": 9,
    "axes.edgecolor": "#46515f", "axes.labelcolor": "#1a222c", "xtick.color": "#46515f", "ytick.color": "#46515f",
    "xtick.labelcolor": "#1a222c", "ytick.labelcolor": "#1a222c", "axes.grid": True, "grid.color": "#d5dbe3",
    "grid.linewidth": 0.7, "axes.axisbelow": True, "lines.linewidth": 1.8, "legend.frameon": False,
    "legend.fontsize": 8.5, "axes.titlesize": 9, "axes.titlelocation": "left", "figure.constrained_layout.use": True,
})


def save(figure, name):
    figure.savefig(IMAGES / f"{name}.svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)


def above(axes, columns):
    """The legend over the panel, where no curve runs."""
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=columns, borderaxespad=0.2, handlelength=2.6)


def valve_leakage():
    volts = np.linspace(-0.5, 0.5, 501)
    four, single = np.array([curves.leakage(u) for u in volts]).T
    figure, axes = plt.subplots(figsize=(WIDTH, 3.0))
    axes.plot(volts, (four + curves.TARE) * LITRES, color=BLUE, label="four edges, each with its sech")
    axes.plot(volts, (single + curves.TARE) * LITRES, color=ORANGE, ls="--", label="one curve, 4.14")
    axes.axhline(curves.TARE * LITRES, color=GREEN, ls=":", label="tare flow alone")
    axes.set(xlabel="Spool position U (V of 10 V)", ylabel="Flow from the supply (L/min)", xlim=(-0.5, 0.5), ylim=(0, 1.1))
    above(axes, 2)
    save(figure, "valve_leakage")


def valve_flow():
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.2))
    volts = np.linspace(-10, 10, 401)
    left.plot(volts, [curves.unloaded(u) * LITRES for u in volts], color=BLUE, label="edges of Table 5.1")
    equal = 2.97e-7 / 10 * math.sqrt(curves.SUPPLY / 2) * LITRES
    left.plot(volts, equal * volts, color=ORANGE, ls="--", lw=1.4, label="equal edges, 2.97e-7")
    for side in (1, -1):
        left.axhline(side * curves.PUMP * LITRES, color=MUTED, ls=":", lw=1.2, label="what the pump gives" if side > 0 else None)
    left.set(xlabel="Spool position U (V)", ylabel="Flow, unloaded (L/min)", xlim=(-10, 10))
    above(left, 1)
    volts = np.linspace(0.0, 0.5, 501)
    for load, colour in ((0.0, BLUE), (25e5, ORANGE)):
        printed, gain, _ = np.array([curves.equal_edges(u, load) for u in volts]).T
        right.plot(volts, gain * LITRES, color=colour, label=f"{load * BAR:.0f} bar of load pressure")
        if load:
            right.plot(volts, printed * LITRES, color=colour, ls="--", lw=1.3, label="the same as 4.21 is printed")
            held = curves.holding_command(load)
            right.plot(held, curves.equal_edges(held, load)[1] * LITRES, "o", color=colour, ms=6, label="holds this load, ports shut")
    right.set(xlabel="Spool position U (V)", ylabel="Flow gain $K_{qU}$ (L/(min V))", xlim=(0, 0.5), ylim=(2.5, 3.5))
    above(right, 1)
    save(figure, "valve_flow")


def pressure_sensitivity():
    volts = np.linspace(-0.3, 0.3, 601)
    pressure_a, pressure_b = np.array([curves.blocked(u) for u in volts]).T * BAR
    figure, axes = plt.subplots(figsize=(WIDTH, 3.2))
    axes.plot(volts, pressure_a, color=BLUE, label="$p_A$")
    axes.plot(volts, pressure_b, color=ORANGE, ls="--", label="$p_B$")
    axes.plot(volts, pressure_a - pressure_b, color=GREEN, lw=2.2, label="$p_L = p_A - p_B$")
    equal = np.linspace(-66e5, 66e5, 201)
    axes.plot([curves.holding_command(p) for p in equal], equal * BAR, color=MUTED, ls=":", label="$p_L$, equal edges")
    axes.set(xlabel="Spool position U (V of 10 V)", ylabel="Pressure at shut ports (bar)", xlim=(-0.3, 0.3), ylim=(-72, 75))
    above(axes, 4)
    save(figure, "pressure_sensitivity")


def friction_map():
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.2), sharey=True)
    speed = np.concatenate([np.linspace(1e-7, 0.01, 400), np.linspace(0.01, 0.06, 200)])
    for sign in (1, -1):
        told = dict(label="steady, 4.33") if sign > 0 else {}
        left.plot(sign * speed * MILLI, curves.steady(sign * speed), color=BLUE, **told)
    left.plot([0, 0], [-curves.BREAKAWAY, curves.BREAKAWAY], color=BLUE, lw=1.0)
    every = np.linspace(-0.06, 0.06, 2401)
    left.plot(every * MILLI, curves.smoothed(every, 1e-3), color=ORANGE, ls="--", lw=1.4, label="smoothed, $v_r$ = 1 mm/s")
    left.plot(every * MILLI, curves.VISCOUS * every, color=GREEN, ls=":", label="viscous part")
    left.set(xlabel="Velocity (mm/s)", ylabel="Friction (N)", xlim=(-60, 60), ylim=(-140, 140))
    above(left, 1)
    for frequency, colour, style in ((0.2, BLUE, "-"), (2.0, ORANGE, "--"), (20.0, VIOLET, "-.")):
        velocity, force = curves.bristles(0.02, frequency)
        right.plot(velocity * MILLI, force, color=colour, ls=style, lw=1.5, label=f"LuGre at {frequency:g} Hz")
    right.set(xlabel="Velocity (mm/s)", xlim=(-21, 21))
    above(right, 1)
    save(figure, "friction_map")


def hose_expansion():
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.1))
    pressure = np.linspace(0, 100e5, 201)
    left.plot(pressure * BAR, curves.expansion(pressure) * 1e6, color=BLUE, label="$E(p)$, slope ε")
    left.plot(68.95, 4.7 / 0.3048, "s", color=ORANGE, ms=6, label="catalogue: 4.7 mL/ft at 1000 psi")
    left.plot(35, curves.expansion(35e5) * 1e6, "o", color=GREEN, ms=6, label="where the rig works, 35 bar")
    left.set(xlabel="Pressure (bar)", ylabel="Expansion of a metre (mL/m)", xlim=(0, 100), ylim=(0, 24))
    above(left, 1)
    scale = 1e6 / BAR
    held = (curves.bore_area() + curves.expansion(pressure)) / curves.OIL * scale
    right.fill_between(pressure * BAR, curves.SLOPE / 4 * scale, curves.SLOPE / 5 * scale, color=BLUE, alpha=0.35, lw=0,
                       label="wall worked quickly, $r_β$ 4 to 5")
    right.axhline(curves.SLOPE * scale, color=BLUE, label="wall at rest, ε")
    right.plot(pressure * BAR, held, color=ORANGE, ls="--", label="oil, $(A_{ho} + E)/β_0$")
    right.set(xlabel="Pressure (bar)", ylabel="Compliance (mL/(m bar))", xlim=(0, 100), ylim=(0, 0.25))
    above(right, 1)
    save(figure, "hose_expansion")


def stiffness_over_stroke():
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 3.5), sharey=True)
    place = np.linspace(0, curves.STROKE, 401)
    styles = ((0.5, VIOLET, ":"), (1.0, ORANGE, "--"), (1.5, BLUE, "-"), (2.0, GREEN, "-."), (3.0, BROWN, (0, (5, 1, 1, 1, 1, 1))))
    handles = []
    for axes, model in zip(panels, ("uniform", "by_volume")):
        for length, colour, style in styles:
            value = [curves.stiffness(length, x, model) / 1e6 for x in place]
            (line,) = axes.plot(place * MILLI, value, color=colour, ls=style, label=f"{length:g} m a side")
            handles.append(line)
        axes.set(xlabel="Piston position (mm)", xlim=(0, 500), ylim=(0, 13), title=model)
    panels[0].set(ylabel="Hydraulic stiffness $K_H$ (MN/m)")
    figure.legend(handles=handles[:5], loc="outside upper left", ncols=5, handlelength=2.6, columnspacing=1.0)
    save(figure, "stiffness_over_stroke")


def poles_over_stiffness():
    leak = 5.9295e-13  # K_c of the example's valve at null, as derived
    stiffness = np.geomspace(1e5, 1e8, 301)
    slow, pair = zip(*(curves.poles(k, leak) for k in stiffness))
    pair = np.array(pair)
    hoses = np.linspace(0.5, 3.0, 6)
    marks = [curves.stiffness(length, curves.STROKE / 2, "uniform") for length in hoses]
    marked = [curves.poles(k, leak) for k in marks]
    figure, panels = plt.subplots(3, 1, figsize=(WIDTH, 5.8), sharex=True)
    rows = (
        (-np.array(slow), [-s for s, _ in marked], "Slow pole (1/s)"),
        (np.abs(pair), [abs(p) for _, p in marked], "Piston: frequency (rad/s)"),
        (-pair.real / np.abs(pair), [-p.real / abs(p) for _, p in marked], "Piston: damping ratio"),
    )
    for axes, (curve, points, label) in zip(panels, rows):
        axes.plot(stiffness / 1e6, curve, color=BLUE, lw=4.0, alpha=0.45, label="6.7")
        axes.plot(np.array(marks) / 1e6, points, "o", color=ORANGE, ms=5, label="hoses of 3, 2.5, 2, 1.5, 1 and 0.5 m a side (from the left)")
        axes.set(ylabel=label, xscale="log")
    series = stiffness * curves.SENSOR / (stiffness + curves.SENSOR)
    panels[0].plot(stiffness / 1e6, leak * series / curves.AREA**2, color=BLACK, ls="--", lw=1.2, label="$K_c K_{eq}/A^2$")
    panels[1].plot(stiffness / 1e6, np.sqrt((stiffness + curves.SENSOR) / curves.MASS), color=BLACK, ls="--", lw=1.2,
                   label=r"$\sqrt{(K_H + K_S)/M}$")
    panels[1].axhline(curves.SPOOL, color=MUTED, ls=":", label="spool")
    panels[2].plot(stiffness / 1e6, curves.FRICTION / curves.MASS / 2 / np.abs(pair), color=BLACK, ls="--", lw=1.2,
                   label="of friction alone (6.12 as printed)")
    panels[0].set(yscale="log")
    panels[2].set_xticks([0.1, 1, 10, 100], ["0.1", "1", "10", "100"])
    panels[1].set(ylim=(0, 3200))
    panels[2].set(ylim=(0, 0.006), xlabel="Hydraulic stiffness $K_H$ (MN/m)", xlim=(0.1, 100))
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles[:2], labels[:2], loc="outside upper left", ncols=2)
    for axes, places in zip(panels, ("lower right", "upper left", "lower left")):
        own = [h for h in axes.get_lines() if h.get_label() not in labels[:2] and not h.get_label().startswith("_")]
        axes.legend(handles=own, loc=places)
    save(figure, "poles_over_stiffness")


def passivity():
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(WIDTH, 4.9), sharex=True)
    omega = np.geomspace(0.1, 1e4, 4001)
    band = curves.active_band(curves.STIFFNESS)
    cases = (
        ("held command", BLUE, "-", dict(gain=0.0, integral=0.0)),
        ("published controller, $f_v$ = 100 N s/m", ORANGE, "--", {}),
        ("the same, 299 N s/m", GREEN, "-.", dict(friction=299.0)),
    )
    for label, colour, style, settings in cases:
        impedance = 1 / curves.admittance(omega, curves.STIFFNESS, **settings)
        top.loglog(omega, np.abs(impedance), color=colour, ls=style, label=label)
        bottom.semilogx(omega, np.degrees(np.angle(impedance)), color=colour, ls=style)
    for axes in (top, bottom):
        axes.axvspan(*band, color=PINK, alpha=0.22, lw=0)
    for side in (90, -90):
        bottom.axhline(side, color=BLACK, lw=1.0)
    bottom.set(yticks=range(-135, 181, 45), ylim=(-120, 150), xlabel="Frequency (rad/s)", ylabel="Phase of Z (degrees)", xlim=(0.1, 1e4))
    bottom.text(band[0] * 0.93, 128, "Re Z < 0", ha="right", va="center", color=PINK)
    top.set(ylabel="|Z| (N s/m)")
    figure.legend(loc="outside upper left", ncols=3, handlelength=2.6, columnspacing=1.2)
    save(figure, "passivity")


def passivity_over_stiffness():
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 3.4))
    stiffness = np.geomspace(4e5, 1.5e7, 61)
    ends = [curves.active_band(k, friction=0.0) or (math.nan, math.nan) for k in stiffness]
    held = [curves.active_band(k) or (math.nan, math.nan) for k in stiffness]
    low, high = np.array(ends).T
    left.fill_between(stiffness / 1e6, low, high, color=BLUE, alpha=0.22, lw=0, label="Re Z < 0 without friction")
    low, high = np.array(held).T
    left.fill_between(stiffness / 1e6, low, high, color=ORANGE, alpha=0.5, lw=0, label="with $f_v$ = 100 N s/m")
    left.plot(stiffness / 1e6, np.sqrt(stiffness / curves.MASS), color=BLACK, ls="--", lw=1.3, label=r"$\sqrt{K_H/M}$")
    left.axhline(curves.SPOOL, color=GREEN, ls=":", label="spool")
    left.set(xlabel="Hydraulic stiffness $K_H$ (MN/m)", ylabel="Frequency (rad/s)", xscale="log", ylim=(0, 1250), xlim=(0.4, 15))
    above(left, 1)
    fixed = [curves.friction_for_passivity(k) for k in stiffness]
    tuned = []
    for k in stiffness:
        gain = curves.tuned_gain(k)
        tuned.append(curves.friction_for_passivity(k, gain=gain, integral=8 * gain))
    right.plot(stiffness / 1e6, fixed, color=ORANGE, label="published controller")
    right.plot(stiffness / 1e6, tuned, color=BLUE, ls="--", label="gain of 6.27 for 50 ms, $K_i = 8 K_p$")
    right.axhline(100, color=MUTED, ls=":", label="least $f_v$ of Table 6.3")
    right.set(xlabel="Hydraulic stiffness $K_H$ (MN/m)", ylabel="Least $f_v$ for Re Z ≥ 0 (N s/m)", xscale="log", xlim=(0.4, 15), ylim=(0, 320))
    above(right, 1)
    for axes in (left, right):
        axes.set_xticks([0.5, 1, 2, 5, 10], ["0.5", "1", "2", "5", "10"])
        axes.minorticks_off()
    save(figure, "passivity_over_stiffness")


def main():
    word = sys.argv[1] if len(sys.argv) > 1 else ""
    IMAGES.mkdir(exist_ok=True)
    drawn = (
        valve_leakage, valve_flow, pressure_sensitivity, friction_map, hose_expansion, stiffness_over_stroke,
        poles_over_stiffness, passivity, passivity_over_stiffness,
    )
    for draw in drawn:
        if word in draw.__name__:
            draw()
            print(IMAGES / f"{draw.__name__}.svg")


if __name__ == "__main__":
    main()
