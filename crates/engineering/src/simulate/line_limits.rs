//! Limits of lines and chambers: vapour pressure, the permissible pressures of hoses and pipes, and
//! the Reynolds number up to which their friction is that of the equations. They are monitored at
//! every node of a line, over its whole length if waves travel along it, in necks and in the line
//! of a transmission, over the solution itself, between its rows too.
//!
//! ```text
//! Re = 4 |q|/(pi d nu)          laminar up to 2300
//! ```

mod waves;

use phea_dynamics::simulation::{Quartic, Stretch};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use phea_hydraulics::line::Line;
use phea_hydraulics::series::SeriesElement;
use phea_hydraulics::signal::Signal;

use super::bench::ControlledMachine;
use super::exceeded::{Exceeded, LimitPlace, RigLimit, WatchedLimit};
use super::sum::SignalSum;
use crate::project::{DeclaredLine, LineMotion, Project};
use waves::{WaveLine, WithinBounds, WithinLine, WithinSearch};

/// Reynolds number above which flow in a round pipe is no longer laminar.
pub const LAMINAR_UP_TO: f64 = 2300.0;

/// Permissible pressures of a line, and the nodes of its model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineLimits {
    nodes: LineNodes,
    /// Working pressure of its hose or pipe, Pa, if stated.
    working_pa: Option<f64>,
    burst_pa: Option<f64>,
    /// Diameter of the neck of its accumulator, m.
    neck_m: Option<f64>,
}

/// Nodes of a line in addition to its chamber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum LineNodes {
    /// The line has one pressure, without a further node.
    #[default]
    Lumped,
    /// Beginning of each of this many segments.
    Segments(usize),
    /// End of the line at the valve.
    Waves,
}

impl LineLimits {
    /// Limits of both lines of a project.
    pub fn of(project: &Project) -> [LineLimits; 2] {
        let lines = project.actuator.as_ref().map(|actuator| &actuator.line);
        lines.map_or([LineLimits::default(); 2], |lines| [&lines.a, &lines.b].map(LineLimits::of_line))
    }

    fn of_line(line: &DeclaredLine) -> LineLimits {
        let nodes = match &line.motion {
            LineMotion::Automatic | LineMotion::Lumped | LineMotion::Creeping { .. } => LineNodes::Lumped,
            LineMotion::Segments(segments) => LineNodes::Segments(segments.count() as usize),
            LineMotion::TransmissionLine { .. } | LineMotion::TwoWave { .. } => LineNodes::Waves,
        };
        let of_hose = line.hose().map(|hose| [hose.working_pressure, hose.burst_pressure]);
        let of_pipe = line.pipe().map(|pipe| [pipe.working_pressure, pipe.burst_pressure]);
        let [working_pa, burst_pa] = of_hose.or(of_pipe).unwrap_or_default();
        let neck_m = line.accumulator.and_then(|gas| Some(gas.neck?.diameter));
        LineLimits { nodes, working_pa, burst_pa, neck_m }
    }

    /// True if more than the pressure of the chamber is monitored.
    fn is_watched(&self) -> bool {
        self.nodes != LineNodes::Lumped || self.working_pa.is_some() || self.burst_pa.is_some()
    }

    /// Indices of the line's states that are pressures and flows; the pressures with the fraction
    /// of the length from the valve.
    fn states(&self, count: usize) -> (Vec<(usize, f64)>, Vec<usize>) {
        match self.nodes {
            LineNodes::Lumped => (vec![], vec![]),
            LineNodes::Segments(segments) => {
                let pressures = (0..segments).map(|node| (node, node as f64 / segments as f64));
                (pressures.collect(), (segments..2 * segments).collect())
            }
            // the flow into either end that friction resists
            LineNodes::Waves => (vec![(0, 0.0)], vec![1, 1 + (count - 1) / 2]),
        }
    }
}

/// A signal of the machine with its limits.
struct WatchedPoint {
    signal: SignalSum<'static>,
    /// Factor of the signal.
    scale: f64,
    place: LimitPlace,
    /// Indices of the limits.
    limits: Vec<usize>,
}

/// A line along which waves travel, with the limits of its pressure and flow.
struct WatchedWaves {
    line: WaveLine,
    own: LimitsOfWaves,
}

/// Limits of a line along which waves travel.
struct LimitsOfWaves {
    side: char,
    length_m: f64,
    /// Ratio of Reynolds number to flow, s/m3.
    scale: f64,
    /// Indices of the limits of the pressure, and of that of the flow.
    pressures: Vec<usize>,
    flow: usize,
}

/// Monitor of chambers and lines.
#[derive(Default)]
pub(crate) struct LineWatch {
    limits: Vec<WatchedLimit>,
    points: Vec<WatchedPoint>,
    waves: Vec<WatchedWaves>,
}

impl LineWatch {
    /// Monitor of both sides of a machine, from these observed states.
    pub(crate) fn of(bench: &ControlledMachine, wanted: &[usize]) -> LineWatch {
        let mut watch = LineWatch::default();
        for side in [0, 1] {
            watch.side(bench, wanted, side);
            watch.neck(bench, wanted, side);
        }
        watch.transmission(bench, wanted);
        watch
    }

    /// States that the monitor needs if it covers more than the chambers' vapour pressure.
    pub(crate) fn states(bench: &ControlledMachine) -> Vec<usize> {
        let of_side = |side: usize| {
            let (chamber, line) = places(bench, side);
            let (pressures, flows) = bench.line_limits[side].states(line.len());
            let lines = bench.machine.lines();
            let late = lines.get(side).map_or(vec![], |line| line.smearing()).into_iter().flatten();
            let own = pressures.into_iter().map(|(number, _)| number).chain(flows);
            let own = own.chain(late.map(|(number, _)| number));
            let own = own.filter_map(|number| line.get(number).copied());
            let watched = bench.line_limits[side].is_watched();
            chamber.into_iter().chain(own).filter(|_| watched).collect::<Vec<usize>>()
        };
        let necks = [0, 1].into_iter().filter_map(|side| neck(bench, side));
        let oil = transmission_flows(bench).into_iter();
        [0, 1].into_iter().flat_map(of_side).chain(necks).chain(oil).collect()
    }

    fn side(&mut self, bench: &ControlledMachine, wanted: &[usize], side: usize) {
        let name = ['a', 'b'][side];
        let own = &bench.line_limits[side];
        let components = bench.rig.actuator.components();
        let [length_m, bore_m] = size(&[components.line_a, components.line_b][side]);
        let vapour_pa = components.fluid.vapour_pressure_absolute - ATMOSPHERIC_PRESSURE_ABSOLUTE;
        let above = |limit, value: f64| WatchedLimit::new(limit, [f64::NEG_INFINITY, value]);
        let below = |value: f64| WatchedLimit::new(RigLimit::VapourPressure, [value, f64::INFINITY]);
        let [in_chamber, in_line] = [self.add(below(vapour_pa)), self.add(below(vapour_pa))];
        let borne = [(RigLimit::WorkingPressure, own.working_pa), (RigLimit::BurstPressure, own.burst_pa)];
        let borne: Vec<usize> =
            borne.into_iter().filter_map(|(limit, value)| Some(self.add(above(limit, value?)))).collect();
        let (chamber, line) = places(bench, side);
        let (pressures, flows) = own.states(line.len());
        let at = |place: usize| SignalSum::of(wanted, bench.control.size(), move |state, _| state[place]);
        self.points.extend(chamber.map(|place| WatchedPoint {
            signal: at(place),
            scale: 1.0,
            place: LimitPlace::Chamber(name),
            limits: [&[in_chamber], &borne[..]].concat(),
        }));
        for (number, part) in pressures {
            let Some(place) = line.get(number).copied() else { continue };
            let distance_m = part * length_m;
            let limits = [&[in_line], &borne[..]].concat();
            let place_m = LimitPlace::Line { side: name, distance_m };
            self.points.push(WatchedPoint { signal: at(place), scale: 1.0, place: place_m, limits });
        }
        if flows.is_empty() {
            return;
        }
        let laminar = self.add(laminar());
        let limits = vec![laminar];
        let scale = reynolds_over_flow(bench, bore_m);
        let count = flows.len();
        if let (LineNodes::Waves, [at_valve, at_chamber]) = (own.nodes, &flows[..]) {
            self.waves.extend(WaveLine::of(bench, side, wanted, [*at_valve, *at_chamber]).map(|line| {
                let pressures = [&[in_line], &borne[..]].concat();
                let own = LimitsOfWaves { side: name, length_m, scale, pressures, flow: laminar };
                WatchedWaves { line, own }
            }));
        }
        for (index, number) in flows.into_iter().enumerate() {
            let Some(place) = line.get(number).copied() else { continue };
            let distance_m = match own.nodes {
                LineNodes::Waves => length_m * index as f64,
                LineNodes::Lumped | LineNodes::Segments(_) => length_m * (index as f64 + 0.5) / count as f64,
            };
            let place_m = LimitPlace::Line { side: name, distance_m };
            self.points.push(WatchedPoint {
                signal: at(place),
                scale,
                place: place_m,
                limits: limits.clone(),
            });
        }
    }

    /// Adds the flow through the neck of an accumulator.
    fn neck(&mut self, bench: &ControlledMachine, wanted: &[usize], side: usize) {
        let Some((place, diameter_m)) = neck(bench, side).zip(bench.line_limits[side].neck_m) else { return };
        let limits = vec![self.add(laminar())];
        let signal = SignalSum::of(wanted, bench.control.size(), move |state, _| state[place]);
        let scale = reynolds_over_flow(bench, diameter_m);
        self.points.push(WatchedPoint { signal, scale, place: LimitPlace::Neck(['a', 'b'][side]), limits });
    }

    /// Adds the flow through the line of a transmission.
    fn transmission(&mut self, bench: &ControlledMachine, wanted: &[usize]) {
        let series = bench.rig.actuator.components().series;
        let Some(SeriesElement::Transmission(transmission)) = series else { return };
        let [length_m, bore_m] = size(&transmission.line);
        let flows = transmission_flows(bench);
        let limits = vec![self.add(laminar())];
        let scale = transmission.piston_area * reynolds_over_flow(bench, bore_m);
        let count = flows.len();
        for (plug, place) in flows.into_iter().enumerate() {
            let signal = SignalSum::of(wanted, bench.control.size(), move |state, _| state[place]);
            let distance_m = length_m * (plug as f64 + 0.5) / count as f64;
            let place = LimitPlace::Transmission { distance_m };
            self.points.push(WatchedPoint { signal, scale, place, limits: limits.clone() });
        }
    }

    fn add(&mut self, limit: WatchedLimit) -> usize {
        self.limits.push(limit);
        self.limits.len() - 1
    }

    /// Takes a step.
    pub(crate) fn follow(&mut self, stretch: &Stretch<'_>) {
        let times_s = [stretch.start_s(), stretch.end_s()];
        for WatchedPoint { signal, scale, place, limits } in &self.points {
            let value = Quartic::constant(0.0).plus(*scale, &signal.over(stretch.states));
            for limit in limits {
                if let Some(limit) = self.limits.get_mut(*limit) {
                    limit.follow(times_s, &value, *place);
                }
            }
        }
        for WatchedWaves { line, own } in &mut self.waves {
            line.search(stretch, &mut WavesWatch { own, limits: &mut self.limits });
        }
    }

    /// Limits that were exceeded.
    pub(crate) fn found(&self) -> impl Iterator<Item = Exceeded> + '_ {
        self.limits.iter().filter_map(WatchedLimit::found)
    }
}

/// The limits of a line while it is searched.
struct WavesWatch<'a> {
    own: &'a LimitsOfWaves,
    limits: &'a mut [WatchedLimit],
}

impl WithinSearch for WavesWatch<'_> {
    fn wants(&self, bounds: &WithinBounds) -> bool {
        let exceeds = |limit: &usize, bounds: [f64; 2]| {
            self.limits.get(*limit).is_some_and(|limit| limit.may_exceed(bounds))
        };
        let flow = bounds.flow.map(|flow| flow.map(|flow| self.own.scale * flow));
        self.own.pressures.iter().any(|limit| exceeds(limit, bounds.pressure))
            || flow.is_some_and(|flow| exceeds(&self.own.flow, flow))
    }

    fn take(&mut self, found: &WithinLine) {
        let LimitsOfWaves { side, length_m, scale, pressures, flow } = self.own;
        let place = LimitPlace::Line { side: *side, distance_m: found.part * length_m };
        for limit in pressures {
            if let Some(limit) = self.limits.get_mut(*limit) {
                limit.follow(found.times_s, &found.pressure, place);
            }
        }
        let reynolds = found.flow.map(|flow| Quartic::constant(0.0).plus(*scale, &flow));
        if let (Some(reynolds), Some(limit)) = (reynolds, self.limits.get_mut(*flow)) {
            limit.follow(found.times_s, &reynolds, place);
        }
    }
}

/// The limit of laminar flow in a round pipe, in both directions.
fn laminar() -> WatchedLimit {
    WatchedLimit::new(RigLimit::LaminarFlow, [-LAMINAR_UP_TO, LAMINAR_UP_TO])
}

/// Ratio of Reynolds number to flow, 4/(pi d nu), s/m3.
fn reynolds_over_flow(bench: &ControlledMachine, bore_m: f64) -> f64 {
    let viscosity = bench.rig.actuator.components().fluid.kinematic_viscosity;
    4.0 / (std::f64::consts::PI * bore_m * viscosity)
}

/// Index of the flow through the neck at a chamber in the state.
fn neck(bench: &ControlledMachine, side: usize) -> Option<usize> {
    let wanted = ["neck_flow_a_m3_per_s", "neck_flow_b_m3_per_s"][side];
    bench.machine.state_names().iter().position(|name| name == wanted)
}

/// Indices of the velocities of the oil in a transmission, from the rod on.
fn transmission_flows(bench: &ControlledMachine) -> Vec<usize> {
    let names = bench.machine.state_names();
    let velocity = |name: &str| name.starts_with("transmission_velocity");
    names.iter().enumerate().filter(|(_, name)| velocity(name)).map(|(place, _)| place).collect()
}

/// Length and bore of a filled line, m; NaN for a volume.
fn size(line: &Line) -> [f64; 2] {
    match line.filled() {
        Line::Hose { hose, length } => [length, hose.bore],
        Line::Pipe { pipe, length } => [length, pipe.bore],
        Line::Volume { .. } => [f64::NAN; 2],
    }
}

/// Index of the pressure of a chamber in the state, and those of its line.
fn places(bench: &ControlledMachine, side: usize) -> (Option<usize>, Vec<usize>) {
    let (chamber, line) = [(Signal::PressureA, "line_a_"), (Signal::PressureB, "line_b_")][side];
    let names = bench.machine.state_names();
    let named = |known: &dyn Fn(&str) -> bool| {
        names.iter().enumerate().filter(|(_, name)| known(name)).map(|(place, _)| place).collect::<Vec<_>>()
    };
    (named(&|name| name == chamber.name()).first().copied(), named(&|name| name.starts_with(line)))
}
