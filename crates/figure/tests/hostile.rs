//! Figures from meaningless numbers and words: no panic, and every rule of legibility still holds.

use crate::legibility::check;
use num_complex::Complex64;
use phea_dynamics::portable::pow;
use phea_figure::*;
use phea_qft::bound::{Bound, GainIntervals};
use phea_qft::template::{Resolution, Template, TemplatePoint};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Number over many decades, of either sign, sometimes NaN.
    fn number(&mut self) -> f64 {
        const STRANGE: [f64; 9] =
            [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, 1e-320, 5e-324];
        match self.below(12) {
            0 => STRANGE[self.below(STRANGE.len())],
            1 => -self.unit(),
            2 => pow(10.0, 60.0 * self.unit() - 30.0),
            _ => pow(10.0, 9.0 * self.unit() - 4.0),
        }
    }

    fn numbers(&mut self) -> Vec<f64> {
        let count = self.below(9);
        (0..count).map(|_| self.number()).collect()
    }

    fn complex(&mut self) -> Vec<Complex64> {
        let count = self.below(9);
        (0..count).map(|_| Complex64::new(self.number(), self.number())).collect()
    }

    fn name(&mut self) -> String {
        const NAMES: [&str; 9] = [
            "",
            "K_H",
            "<script>alert(1)</script> & \"more\"",
            "a name that goes on and on and on and on and on and on and on and on and on and on and on",
            "\u{0}\u{7}control\u{1b}[31m",
            "油圧シリンダー",
            "x_{",
            "ΑΒΓ_^^__{}{}}{",
            "line\nbreak\ttab",
        ];
        NAMES[self.below(NAMES.len())].to_string()
    }

    fn many<T>(&mut self, most: usize, of: impl Fn(&mut Random) -> T) -> Vec<T> {
        let count = self.below(most + 1);
        (0..count).map(|_| of(self)).collect()
    }

    fn maybe<T>(&mut self, of: impl Fn(&mut Random) -> T) -> Option<T> {
        (self.unit() < 0.5).then(|| of(self))
    }

    fn verdict(&mut self) -> CandidateVerdict {
        CandidateVerdict::ALL[self.below(3)]
    }

    fn words(&mut self) -> Words {
        Words::new(self.name(), self.name(), self.name())
    }

    fn frequency_series(&mut self) -> FrequencySeries {
        FrequencySeries { name: self.name(), frequencies_rad_per_s: self.numbers(), response: self.complex() }
    }

    fn mark(&mut self) -> FrequencyMark {
        FrequencyMark { label: self.name(), frequency_rad_per_s: self.number() }
    }

    fn response(&mut self) -> Complex64 {
        Complex64::new(self.number(), self.number())
    }

    /// Gains that may be negative, infinite or in the wrong order, at arbitrary phases.
    fn bound(&mut self) -> Bound {
        let phases = self.below(9);
        let phase = |r: &mut Random| if r.unit() < 0.1 { r.number() } else { -7.0 * r.unit() };
        let mut phases_rad: Vec<f64> = (0..phases).map(|_| phase(self)).collect();
        if self.unit() < 0.7 {
            phases_rad.sort_by(f64::total_cmp);
        }
        let gain = |r: &mut Random| if r.unit() < 0.2 { r.number() } else { 10.0 * r.unit() };
        let spans = |r: &mut Random| r.many(4, |r| [gain(r), gain(r)]);
        let forbidden = (0..self.below(9)).map(|_| GainIntervals::union_of(spans(self))).collect();
        Bound { frequency_rad_per_s: self.number(), phases_rad, forbidden }
    }

    fn template(&mut self) -> Template {
        let point = |r: &mut Random| TemplatePoint {
            member: r.maybe(|r| r.below(9)),
            values: r.numbers(),
            response: r.response(),
            load_motion: r.response(),
            sensor: r.response(),
        };
        Template {
            frequency_rad_per_s: self.number(),
            nominal: self.response(),
            points: self.many(9, point),
            outlines: self.many(3, Random::complex),
            resolution: Resolution::Members,
        }
    }

    fn time_series(&mut self) -> TimeSeries {
        TimeSeries { name: self.name(), times_s: self.numbers(), values: self.numbers() }
    }
}

fn repeat(seed: u64, of: impl Fn(&mut Random) -> Figure) {
    let mut random = Random(seed);
    for turn in 0..400 {
        let figure = of(&mut random);
        check(&figure);
        if turn % 100 == 0 {
            assert!(figure.to_png(0.5).is_ok(), "the rasteriser refuses {}", figure.to_svg_standalone());
        }
    }
}

#[test]
fn bode_diagrams() {
    repeat(1, |r| {
        let chart = BodeDiagram {
            quantity: r.name(),
            unit: r.name(),
            series: r.many(10, Random::frequency_series),
            marks: r.many(6, Random::mark),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn stiffness_curves() {
    repeat(2, |r| {
        let curve = |r: &mut Random| StiffnessCurve {
            name: r.name(),
            places: r.numbers(),
            stiffness_n_per_m: r.numbers(),
            minimum_n_per_m: r.numbers(),
            maximum_n_per_m: r.numbers(),
        };
        let chart = StiffnessDiagram {
            curves: r.many(9, curve),
            over: if r.unit() < 0.5 { StiffnessOver::Force } else { StiffnessOver::Stroke },
            operating_point: r.maybe(Random::number),
            band_label: r.name(),
            units: phea_quantity::Units::customary(if r.unit() < 0.5 {
                MotionKind::Rotary
            } else {
                MotionKind::Linear
            }),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn nomographs() {
    repeat(3, |r| {
        let bore =
            |r: &mut Random| NomographBore { bore_m: r.number(), label: r.name(), verdict: r.verdict() };
        let chart = Nomograph {
            bores: r.many(12, bore),
            design_flow_m3_per_s: r.number(),
            velocity_range_m_per_s: (r.number(), r.number()),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn pole_maps() {
    repeat(4, |r| {
        let series = |r: &mut Random| PoleSeries { name: r.name(), poles: r.complex(), zeros: r.complex() };
        let chart = PoleMap {
            series: r.many(6, series),
            scale: if r.unit() < 0.5 { PoleMapScale::Linear } else { PoleMapScale::SignedLogarithmic },
            damping_ratios: r.numbers(),
            natural_frequencies_rad_per_s: r.numbers(),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn impedances() {
    repeat(5, |r| {
        let asymptote = |r: &mut Random| AsymptoteLine {
            label: r.name(),
            coefficient: r.number(),
            exponent: r.below(5) as i32 - 2,
            from_rad_per_s: r.number(),
            to_rad_per_s: r.number(),
        };
        let chart = ImpedanceDiagram {
            motion: if r.unit() < 0.5 { MotionKind::Linear } else { MotionKind::Rotary },
            series: r.many(4, Random::frequency_series),
            asymptotes: r.many(6, asymptote),
            corners: r.many(5, Random::mark),
            non_passive_bands_rad_per_s: r.many(4, |r| (r.number(), r.number())),
            with_phase: r.unit() < 0.5,
        };
        chart.draw(&r.words())
    });
}

#[test]
fn curves_in_panels() {
    repeat(6, |r| {
        let curve = |r: &mut Random| {
            let style = match r.below(4) {
                0 => CurveStyle::Line(r.below(9)),
                1 => CurveStyle::Dots(r.below(9)),
                2 => CurveStyle::Reference,
                _ => CurveStyle::Limit,
            };
            Curve { points: r.numbers().into_iter().zip(r.numbers()).collect(), style }
        };
        let panel = |r: &mut Random| CurvePanel {
            title: r.name(),
            height: 60.0 + 200.0 * r.unit(),
            curves: r.many(9, curve),
            range: match r.below(3) {
                0 => CurveRange::Fitted,
                1 => CurveRange::WithZero,
                _ => CurveRange::Between([r.number(), r.number()]),
            },
            marked: r.many(5, |r| (r.number(), r.name())),
            zero_line: r.unit() < 0.5,
            settling_band: r.maybe(|r| SettlingBand { level: r.number(), percent: r.number() }),
            named: r.many(4, |r| (r.name(), CurveStyle::Line(r.below(9)))),
        };
        let chart = CurveChart {
            x_title: r.name(),
            x_range: [r.number(), r.number()],
            panels: r.many(4, panel),
            legend: r.many(4, |r| (r.name(), CurveStyle::Line(r.below(9)))),
        };
        if r.unit() < 0.5 { chart.draw(&r.words()) } else { chart.draw_over_decades(&r.words()) }
    });
}

#[test]
fn sizing_charts() {
    repeat(7, |r| {
        let curve = |r: &mut Random| SizingCurve {
            name: r.name(),
            lengths_m: r.numbers(),
            stiffness_n_per_m: r.numbers(),
            gain_v_per_n: r.numbers(),
        };
        let candidate = |r: &mut Random| SizingCandidate {
            label: r.name(),
            length_m: r.number(),
            stiffness_n_per_m: r.number(),
            gain_v_per_n: r.number(),
            verdict: r.verdict(),
        };
        let chart = SizingChart {
            curves: r.many(5, curve),
            candidates: r.many(20, candidate),
            length_range_m: r.maybe(|r| (r.number(), r.number())),
            minimum_gain_v_per_n: r.maybe(Random::number),
            pole_gain_v_per_n: r.maybe(Random::number),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn tornadoes() {
    repeat(8, |r| {
        let bar = |r: &mut Random| TornadoBar {
            parameter: r.name(),
            low_setting: r.name(),
            high_setting: r.name(),
            low_value: r.number(),
            high_value: r.number(),
        };
        let chart = Tornado {
            quantity: r.name(),
            unit: DisplayUnit::MEGANEWTON_PER_METRE,
            nominal: r.number(),
            bars: r.many(8, bar),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn circuits() {
    repeat(9, |r| {
        let accumulators =
            [AccumulatorSymbol::Fixed, AccumulatorSymbol::Adjusted, AccumulatorSymbol::ThroughValve];
        let line = |r: &mut Random| LineSymbol {
            kind: if r.unit() < 0.5 { LineKind::Hose } else { LineKind::Pipe },
            accumulator: r.maybe(|r| accumulators[r.below(3)]),
            has_relief: r.unit() < 0.5,
            has_check: r.unit() < 0.5,
            rows: r.many(9, Random::name),
        };
        let controller = |r: &mut Random| ControllerSymbol {
            has_prefilter: r.unit() < 0.5,
            rows: r.many(5, Random::name),
        };
        let series = [SeriesKind::Spring, SeriesKind::DampedSpring, SeriesKind::Transmission];
        let chart = Schematic {
            cross_port: r
                .maybe(|r| CrossPortSymbol { has_capacity: r.unit() < 0.5, rows: r.many(4, Random::name) }),
            motion: if r.unit() < 0.5 { MotionKind::Rotary } else { MotionKind::Linear },
            further_stages: r.below(5),
            linkage: r.maybe(|r| LinkageSymbol { rows: r.many(5, Random::name) }),
            supply: if r.unit() < 0.5 { SupplyKind::Pump } else { SupplyKind::ConstantPressure },
            supply_rows: r.many(4, Random::name),
            tank: r.name(),
            valve_rows: r.many(4, Random::name),
            line_a: line(r),
            line_b: line(r),
            rods: if r.unit() < 0.5 { Rods::Both } else { Rods::TowardsLoad },
            load_at_b: r.unit() < 0.5,
            cylinder: r.name(),
            mass: r.name(),
            load_cell: r.maybe(|r| r.many(4, Random::name)),
            series: r.maybe(|r| SeriesSymbol { kind: series[r.below(3)], words: r.name() }),
            environment: [Environment::PrescribedMotion, Environment::Wall, Environment::SpringMassDamper]
                [r.below(3)]
            .clone(),
            environment_rows: r.many(4, Random::name),
            controller: r.maybe(controller),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn nichols_charts() {
    repeat(10, |r| {
        let bounds = r.many(4, |r| r.many(5, Random::bound));
        let templates = r.many(4, Random::template);
        let violation = |r: &mut Random| OpenLoopViolation {
            frequency_rad_per_s: r.number(),
            open_loop: r.response(),
            text: r.name(),
        };
        let chart = NicholsChart {
            loops: r.many(3, Random::frequency_series),
            design_frequencies_rad_per_s: r.numbers(),
            bounds: bounds.iter().map(|bounds| BoundGroup { name: r.name(), bounds }).collect(),
            templates: &templates,
            violations: r.many(3, violation),
            contours_db: r.numbers(),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn template_charts() {
    repeat(11, |r| templates(&r.words(), &r.many(6, Random::template)));
}

#[test]
fn families_over_frequency() {
    repeat(12, |r| {
        let curve =
            |r: &mut Random| MagnitudeCurve { frequencies_rad_per_s: r.numbers(), magnitudes: r.numbers() };
        let mark = |r: &mut Random| MagnitudeMark {
            frequency_rad_per_s: r.number(),
            magnitude: r.number(),
            text: r.name(),
            is_violation: r.unit() < 0.5,
        };
        let envelope =
            |r: &mut Random| FamilyEnvelope { name: r.name(), greatest: curve(r), least: r.maybe(curve) };
        let chart = FamilyMagnitude {
            envelopes: r.many(3, envelope),
            quantity: r.name(),
            upper_limit: r.maybe(curve),
            lower_limit: r.maybe(curve),
            members: r.many(4, curve),
            design_frequencies_rad_per_s: r.numbers(),
            tolerance_db: r.number(),
            marks: r.many(3, mark),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn prefilters_in_their_band() {
    repeat(14, |r| {
        let point = |r: &mut Random| PrefilterPoint {
            frequency_rad_per_s: r.number(),
            least_db: r.number(),
            greatest_db: r.number(),
            prefilter_db: Some(r.number()),
        };
        let panel = |r: &mut Random| PrefilterPanel { name: r.name(), points: r.many(6, point) };
        prefilter_band(&r.words(), &r.many(3, panel))
    });
}

#[test]
fn families_over_time() {
    repeat(13, |r| {
        let band =
            |r: &mut Random| TimeBand { name: r.name(), upper: r.time_series(), lower: r.time_series() };
        let chart = FamilySteps {
            quantity: r.name(),
            band: r.maybe(band),
            members: r.many(4, Random::time_series),
            nominal: r.maybe(Random::time_series),
            named: r.many(2, Random::time_series),
        };
        chart.draw(&r.words())
    });
}

#[test]
fn fans_of_runs() {
    repeat(15, |r| {
        let band =
            |r: &mut Random| TimeBand { name: r.name(), upper: r.time_series(), lower: r.time_series() };
        let chart = FanChart {
            quantity: r.name(),
            unit: DisplayUnit::KILONEWTON,
            bands: r.many(3, band),
            middle: r.time_series(),
            single: r.maybe(Random::time_series),
            reference: r.maybe(Random::time_series),
            events: r.many(4, |r| (r.number(), r.name())),
            span_s: [r.number(), r.number()],
        };
        chart.draw(&r.words())
    });
}

#[test]
fn measured_and_estimated_responses() {
    repeat(16, |r| {
        let measured = MeasuredResponse {
            quantity: r.name(),
            unit: r.name(),
            models: r.many(3, Random::frequency_series),
            measured: r.frequency_series(),
            model: r.complex(),
            distortion_percent: r.numbers(),
        };
        let estimated = EstimatedResponse {
            quantity: r.name(),
            unit: r.name(),
            estimate: r.frequency_series(),
            radii: r.numbers(),
            coherence: r.numbers(),
            least_coherence: r.number(),
            models: r.many(3, Random::frequency_series),
        };
        if r.unit() < 0.5 { measured.draw(&r.words()) } else { estimated.draw(&r.words()) }
    });
}
