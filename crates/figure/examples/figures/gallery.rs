//! Figures with numbers near those of Ledezma (2019): stiffness 2.2 to 4.1 MN/m over 0.5 m,
//! mechanical resonance at 2938 rad/s, valve at 1099 rad/s.

#[path = "gallery_qft.rs"]
pub(crate) mod gallery_qft;

use num_complex::Complex64;
use phea_dynamics::portable::{cos, exp, pow, sin};
use phea_figure::*;

/// Every figure once.
pub(crate) fn all() -> Vec<Figure> {
    let mut figures = vec![
        circuit(),
        asymmetric_circuit(),
        bode_of_models(),
        stiffness(),
        stiffness_against_pipe(),
        commercial_bores(),
        poles(PoleMapScale::SignedLogarithmic),
        poles(PoleMapScale::Linear),
        driving_point_impedance(),
        force_step(),
        lengths(),
        sensitivities(),
    ];
    figures.extend(gallery_qft::all());
    figures
}

fn frequencies(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from * pow(to / from, i as f64 / (count - 1) as f64)).collect()
}

fn second_order(s: Complex64, natural_frequency: f64, damping_ratio: f64) -> Complex64 {
    let w2 = natural_frequency * natural_frequency;
    w2 / (s * s + 2.0 * damping_ratio * natural_frequency * s + w2)
}

/// F_e/U_C of the full, the decomposed and the first-order model.
pub(crate) fn bode_of_models() -> Figure {
    let w = frequencies(1e-2, 1e4, 800);
    let gain = 5.4e-5 * 1.5e7 / 1.583e-3;
    let response = |model: usize| -> Vec<Complex64> {
        w.iter()
            .map(|&w| {
                let s = Complex64::new(0.0, w);
                let first = gain / (s + 0.336);
                let damping = if model == 0 { 0.00396 } else { 0.00404 };
                match model {
                    2 => first,
                    _ => first * second_order(s, 2938.0, damping) * second_order(s, 1099.0, 0.9),
                }
            })
            .collect()
    };
    let names = ["Full (6.7)", "Decomposed (6.12), corrected", "First order (6.13)"];
    let series = names
        .iter()
        .enumerate()
        .map(|(model, name)| FrequencySeries {
            name: (*name).to_string(),
            frequencies_rad_per_s: w.clone(),
            response: response(model),
        })
        .collect();
    BodeDiagram {
        quantity: "F_e/U_C".into(),
        unit: "N/V".into(),
        series,
        marks: vec![
            FrequencyMark { label: "valve".into(), frequency_rad_per_s: 1099.0 },
            FrequencyMark { label: "piston on load cell".into(), frequency_rad_per_s: 2938.0 },
        ],
    }
    .draw(&words("bode", "Frequency response of the linear models"))
}

fn words(name: &str, title: &str) -> Words {
    Words::new(name, title, format!("{title}: numbers of the example rig."))
}

const AREA: f64 = 1.58336e-3;
const STROKE: f64 = 0.5;
const OIL: f64 = 1.45e9;

fn hose_modulus(stiffening: f64) -> f64 {
    1.0 / (1.0 / OIL + 1.0 / (stiffening * 6.363e7))
}

fn chamber_stiffness(length: f64, line: f64, modulus: f64, uniform: bool) -> f64 {
    let chamber = if uniform { modulus } else { OIL };
    AREA * AREA / (AREA * length / chamber + line / modulus)
}

fn total_stiffness(x: f64, line: f64, modulus: f64, uniform: bool) -> f64 {
    chamber_stiffness(x, line, modulus, uniform) + chamber_stiffness(STROKE - x, line, modulus, uniform)
}

pub(crate) fn stiffness() -> Figure {
    let positions: Vec<f64> = (0..=100).map(|i| STROKE * f64::from(i) / 100.0).collect();
    let along = |r: f64, uniform: bool| -> Vec<f64> {
        positions.iter().map(|x| total_stiffness(*x, 1.9e-4, hose_modulus(r), uniform)).collect()
    };
    let curve = |name: &str, uniform: bool| StiffnessCurve {
        name: name.to_string(),
        places: positions.clone(),
        stiffness_n_per_m: along(5.0, uniform),
        minimum_n_per_m: along(4.0, uniform),
        maximum_n_per_m: along(6.0, uniform),
    };
    StiffnessDiagram {
        curves: vec![
            curve("1.5 m of hose, modulus by volume", false),
            curve("1.5 m of hose, one modulus (uniform)", true),
        ],
        operating_point: Some(0.25),
        band_label: "stiffening 4 to 6".to_string(),
        ..StiffnessDiagram::default()
    }
    .draw(&words("stiffness", "Hydraulic stiffness over the stroke"))
}

/// A stiff pipe next to the hose: the axis becomes logarithmic.
pub(crate) fn stiffness_against_pipe() -> Figure {
    let places: Vec<f64> = (0..=100).map(|i| STROKE * f64::from(i) / 100.0).collect();
    let curve = |name: &str, line: f64, modulus: f64, uniform: bool| StiffnessCurve {
        name: name.to_string(),
        stiffness_n_per_m: places.iter().map(|x| total_stiffness(*x, line, modulus, uniform)).collect(),
        places: places.clone(),
        ..StiffnessCurve::default()
    };
    StiffnessDiagram {
        curves: vec![
            curve("hose, by volume", 1.9e-4, hose_modulus(5.0), false),
            curve("hose, uniform", 1.9e-4, hose_modulus(5.0), true),
            curve("pipe", 3.03e-5, OIL, true),
        ],
        operating_point: None,
        band_label: String::new(),
        ..StiffnessDiagram::default()
    }
    .draw(&words("stiffness-pipe", "Hose against pipe"))
}

pub(crate) fn commercial_bores() -> Figure {
    let bore = |dash: &str, millimetres: f64, verdict| NomographBore {
        bore_m: 1e-3 * millimetres,
        label: dash.to_string(),
        verdict,
    };
    Nomograph {
        bores: vec![
            bore("-3", 4.8, CandidateVerdict::Rejected),
            bore("-4", 6.4, CandidateVerdict::Rejected),
            bore("-5", 7.9, CandidateVerdict::Accepted),
            bore("-6", 9.5, CandidateVerdict::Accepted),
            bore("-8", 12.7, CandidateVerdict::Warned),
            bore("-10", 15.9, CandidateVerdict::Warned),
            bore("-12", 19.0, CandidateVerdict::Warned),
            bore("-16", 25.4, CandidateVerdict::Warned),
        ],
        design_flow_m3_per_s: 9.8e-3 / 60.0,
        velocity_range_m_per_s: (2.1, 4.6),
    }
    .draw(&words("nomograph", "Commercial bores for the design flow"))
}

pub(crate) fn poles(scale: PoleMapScale) -> Figure {
    let pair = |re: f64, im: f64| [Complex64::new(re, im), Complex64::new(re, -im)];
    let real = |re: f64| Complex64::new(re, 0.0);
    let series = |name: &str, slow: f64, damping: f64| PoleSeries {
        name: name.to_string(),
        poles: [real(slow)].into_iter().chain(pair(damping, 2938.0)).chain(pair(-989.1, 479.0)).collect(),
        zeros: vec![],
    };
    let mut full = series("full model (6.7)", -2.96, -11.64);
    full.zeros = vec![real(-1.9)];
    let mut chart = PoleMap {
        series: vec![
            full,
            series("decomposed (6.12), corrected", -2.96, -11.7),
            PoleSeries { name: "first order (6.13)".into(), poles: vec![real(-2.96)], zeros: vec![] },
        ],
        scale,
        damping_ratios: vec![0.1, 0.7],
        natural_frequencies_rad_per_s: vec![1099.0, 2938.0],
    };
    if scale == PoleMapScale::Linear {
        chart.series.truncate(2);
        chart.damping_ratios = vec![0.2, 0.4, 0.6, 0.8];
        chart.natural_frequencies_rad_per_s = vec![1000.0, 2000.0, 3000.0];
        return chart.draw(&words("pole-map-linear", "Poles and zeros, linear scale"));
    }
    chart.draw(&words("pole-map", "Poles and zeros of the linear models"))
}

pub(crate) fn driving_point_impedance() -> Figure {
    let w = frequencies(1e-2, 1e5, 900);
    let (mass, sensor, hydraulic, viscous, leak) = (13.1, 2e7, 2.233e6, 100.0, 6.42e-13);
    let response = |gain: f64, integral: f64| -> Vec<Complex64> {
        w.iter()
            .map(|&w| {
                let s = Complex64::new(0.0, w);
                let hydraulics = 1.0 / (s / hydraulic + leak / (AREA * AREA));
                let valve = second_order(s, 1099.0, 0.9);
                let control = (gain + integral / s) * 5.4e-5 / AREA * valve;
                let piston = mass * s + viscous + hydraulics;
                let inner = (piston) / (1.0 + control * hydraulics);
                1.0 / (s / sensor + 1.0 / inner)
            })
            .collect()
    };
    let series = |name: &str, response: Vec<Complex64>| FrequencySeries {
        name: name.to_string(),
        frequencies_rad_per_s: w.clone(),
        response,
    };
    let line = |label: &str, coefficient: f64, exponent: i32, from: f64, to: f64| AsymptoteLine {
        label: label.to_string(),
        coefficient,
        exponent,
        from_rad_per_s: from,
        to_rad_per_s: to,
    };
    let damper = (AREA * AREA + viscous * leak) / leak;
    let equivalent = 1.0 / (1.0 / sensor + 1.0 / hydraulic);
    ImpedanceDiagram {
        motion: MotionKind::Linear,
        series: vec![
            series("open loop", response(0.0, 0.0)),
            series("closed loop, PI", response(1e-3, 8e-3)),
        ],
        asymptotes: vec![
            line("damper (A^2 + f_v K_c)/K_c", damper, 0, 1e-2, 2.0),
            line("spring K_eq", equivalent, -1, 0.2, 2e3),
            line("spring K_S", sensor, -1, 1e3, 1e5),
            line("mass A/(K_qU K_i)", AREA / (5.4e-5 * 8e-3), 1, 1e-2, 30.0),
        ],
        corners: vec![FrequencyMark { label: "√(K_H/M)".into(), frequency_rad_per_s: 413.0 }],
        non_passive_bands_rad_per_s: vec![(447.0, 921.0)],
        with_phase: true,
    }
    .draw(&words("impedance", "Driving-point impedance"))
}

fn sampled(end: f64, of: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..=600).map(|i| end * f64::from(i) / 600.0).map(|t| (t, of(t))).collect()
}

pub(crate) fn force_step() -> Figure {
    let start = 0.05;
    let slow = |t: f64| 1.0 - (70.0 * exp(-13.0 * t) - 13.0 * exp(-70.0 * t)) / 57.0;
    let quick = |t: f64| 1.0 - exp(-18.0 * t) * (cos(24.0 * t) + 0.75 * sin(24.0 * t));
    let after = |of: &dyn Fn(f64) -> f64| sampled(0.6, |t| if t < start { 0.0 } else { 4.0 * of(t - start) });
    let bound = |rate: f64| after(&|t| 1.0 - exp(-rate * t));
    let command = |of: &dyn Fn(f64) -> f64| sampled(0.6, |t| if t < start { 0.0 } else { of(t - start) });
    let apart = |points, style| Curve { points, style };
    let marked = |words: [&str; 2]| [0.367, 0.262].into_iter().zip(words.map(String::from)).collect();
    let force = CurvePanel {
        settling_band: Some(SettlingBand { level: 4.0, percent: 2.0 }),
        marked: marked(["t_s(2 %) = 317 ms", "t_s(2 %) = 212 ms"]),
        ..CurvePanel::new(
            DisplayUnit::KILONEWTON.title("Force F_e"),
            250.0,
            vec![
                apart(bound(40.0), CurveStyle::Limit),
                apart(bound(8.0), CurveStyle::Limit),
                apart(after(&|_| 1.0), CurveStyle::Reference),
                Curve::line(after(&slow), 0),
                Curve::line(after(&quick), 1),
            ],
        )
    };
    let control = CurvePanel {
        range: CurveRange::WithZero,
        marked: marked(["", ""]),
        ..CurvePanel::new(
            DisplayUnit::VOLT.title("Control U_C"),
            110.0,
            vec![
                Curve::line(command(&|t| 1.9 * (exp(-13.0 * t) - exp(-70.0 * t))), 0),
                Curve::line(command(&|t| 4.0 * exp(-18.0 * t) * cos(20.0 * t)), 1),
            ],
        )
    };
    let legend = [
        ("with prefilter", CurveStyle::Line(0)),
        ("without prefilter", CurveStyle::Line(1)),
        ("reference", CurveStyle::Reference),
        ("tracking bounds", CurveStyle::Limit),
    ];
    let chart = CurveChart {
        x_title: "Time (s)".into(),
        x_range: [0.0, 0.6],
        panels: vec![force, control],
        legend: legend.map(|(name, style)| (name.to_string(), style)).to_vec(),
    };
    chart.draw(&words("step", "Force step of the linear loop"))
}

pub(crate) fn lengths() -> Figure {
    let bore_area = 1.2668e-4;
    let lengths_m = frequencies(0.1, 20.0, 200);
    let stiffness_at = |length: f64, uniform: bool| {
        total_stiffness(0.5 * STROKE, bore_area * length, hose_modulus(5.0), uniform)
    };
    let gain_at = |stiffness: f64| {
        let equivalent = 1.0 / (1.0 / stiffness + 1.0 / 2e7);
        (AREA / (0.05 * equivalent) - 6.42e-13 / AREA) / 5.62e-5
    };
    let curve = |name: &str, uniform: bool| {
        let stiffness_n_per_m: Vec<f64> = lengths_m.iter().map(|l| stiffness_at(*l, uniform)).collect();
        SizingCurve {
            name: name.to_string(),
            lengths_m: lengths_m.clone(),
            gain_v_per_n: stiffness_n_per_m.iter().map(|k| gain_at(*k)).collect(),
            stiffness_n_per_m,
        }
    };
    let candidate = |label: &str, length_m: f64, verdict| {
        let stiffness_n_per_m = stiffness_at(length_m, true);
        SizingCandidate {
            label: label.to_string(),
            length_m,
            stiffness_n_per_m,
            gain_v_per_n: gain_at(stiffness_n_per_m),
            verdict,
        }
    };
    SizingChart {
        curves: vec![curve("3130-08, uniform", true), curve("3130-08, by volume", false)],
        candidates: vec![
            candidate("K_p 0.25 mV/N", 1.07, CandidateVerdict::Accepted),
            candidate("3130-08, 1.5 m", 1.5, CandidateVerdict::Accepted),
            candidate("K_p 0.5 mV/N", 5.66, CandidateVerdict::Warned),
            candidate("K_p 1 mV/N", 14.84, CandidateVerdict::Rejected),
        ],
        length_range_m: Some((0.3, 3.0)),
        minimum_gain_v_per_n: Some(1e-4),
        pole_gain_v_per_n: Some(2.1e-5),
    }
    .draw(&words("sizing", "Length, stiffness and gain"))
}

pub(crate) fn sensitivities() -> Figure {
    let bar = |parameter: &str, low: (&str, f64), high: (&str, f64)| TornadoBar {
        parameter: parameter.to_string(),
        low_setting: low.0.to_string(),
        high_setting: high.0.to_string(),
        low_value: 1e6 * low.1,
        high_value: 1e6 * high.1,
    };
    Tornado {
        quantity: "Hydraulic stiffness K_H".into(),
        unit: DisplayUnit::MEGANEWTON_PER_METRE,
        nominal: 2.233e6,
        bars: vec![
            bar("bulk modulus β_0", ("1.3 GPa", 2.19), ("1.6 GPa", 2.27)),
            bar("stiffening r_β", ("4", 1.85), ("6", 2.59)),
            bar("expansion E", ("+10 %", 2.05), ("−10 %", 2.43)),
            bar("entrained air", ("0 %", 2.233), ("2 %", 2.02)),
            bar("piston position x_p", ("0 mm", 4.109), ("500 mm", 4.0)),
        ],
    }
    .draw(&words("tornado", "Sensitivity of the hydraulic stiffness"))
}

pub(crate) fn circuit() -> Figure {
    circuit_of_hoses().draw(&words("schematic", "The rig"))
}

/// Content of the figure.
pub(crate) fn circuit_of_hoses() -> Schematic {
    let hose = LineSymbol {
        kind: LineKind::Hose,
        accumulator: None,
        has_relief: false,
        has_check: false,
        rows: vec!["Synflex 3130-08".into(), "12.7 mm × 1.5 m".into(), "β_e 261 MPa".into()],
    };
    Schematic {
        cross_port: None,
        motion: MotionKind::Linear,
        further_stages: 0,
        linkage: None,
        supply: SupplyKind::ConstantPressure,
        supply_rows: vec!["70 bar".into(), "9.8 L/min".into()],
        tank: "0 bar".into(),
        valve_rows: vec!["Moog 760 C263-A".into(), "1099 rad/s, ζ 0.9".into()],
        line_a: hose.clone(),
        line_b: hose,
        rods: Rods::Both,
        load_at_b: true,
        cylinder: "50/22 mm, stroke 500 mm".into(),
        mass: "13.1 kg".into(),
        load_cell: Some(vec!["load cell".into(), "98.1 MN/m".into()]),
        series: None,
        environment: Environment::PrescribedMotion,
        environment_rows: vec!["K_S 20 MN/m".into()],
        controller: Some(ControllerSymbol {
            has_prefilter: true,
            rows: vec!["G = (0.001 s + 0.008)/s".into(), "F = 910/(s^2 + 83 s + 910)".into()],
        }),
    }
}

pub(crate) fn asymmetric_circuit() -> Figure {
    let pipe = LineSymbol {
        kind: LineKind::Pipe,
        accumulator: Some(AccumulatorSymbol::Fixed),
        has_relief: false,
        has_check: false,
        rows: vec!["pipe 10.5 mm".into(), "0.35 m".into(), "14.2 mL, 15 bar".into()],
    };
    Schematic {
        cross_port: None,
        motion: MotionKind::Linear,
        further_stages: 0,
        linkage: None,
        supply: SupplyKind::Pump,
        supply_rows: vec!["210 bar".into(), "38 L/min".into()],
        tank: "0 bar".into(),
        valve_rows: vec!["a servovalve with a rather long name".into()],
        line_a: pipe.clone(),
        line_b: pipe,
        rods: Rods::TowardsLoad,
        load_at_b: true,
        cylinder: "63/36 mm, stroke 300 mm".into(),
        mass: "25 kg".into(),
        load_cell: Some(vec!["load cell".into(), "50 MN/m".into()]),
        series: Some(SeriesSymbol { kind: SeriesKind::DampedSpring, words: "2.24 MN/m".into() }),
        environment: Environment::SpringMassDamper,
        environment_rows: vec!["5 kg, 2 MN/m, 100 N·s/m".into()],
        controller: Some(ControllerSymbol {
            has_prefilter: false,
            rows: vec!["G = 0.0005 + 0.002/s".into()],
        }),
    }
    .draw(&words("schematic-asymmetric", "An asymmetric cylinder on pipes"))
}
