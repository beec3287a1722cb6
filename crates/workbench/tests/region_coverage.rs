//! Random operating regions compared with dense samples of them: every printed box encloses its
//! region, and every margin is the least of the region or on the safe side.

#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::print_stdout, reason = "how many regions were judged is worth reading")]

use crate::run_command::HOSE;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::verification::{Audit, AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict};
use phea_workbench::family::{VisitedRange, family, visited_box};
use phea_workbench::project::{self, Project};
use phea_workbench::rig::Rig;
use phea_workbench::robust::robust_problem;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

/// Number of points of a region that are drawn evenly, and of those at which the spool is next to
/// null.
const EVENLY: usize = 150;
const NEAR_NULL: usize = 25;
/// Distances from null at which plants are sampled, fractions of the range of velocity or force.
const NEXT_TO_NULL: [f64; 7] = [-3e-2, -5e-3, -1e-9, 1e-9, 1e-3, 5e-3, 3e-2];
/// Number of plants whose loops are judged.
const JUDGED: usize = 160;
/// Largest error of a margin on the unsafe side, dB.
const ERROR_DB: f64 = 0.01;
/// Largest relative error of an end of a printed box.
const ERROR: f64 = 1e-4;

/// A quantity of a rig that changes its sign where an equation switches.
type RigSign = Box<dyn Fn(&Rig) -> f64>;

/// Points at which the equations switch, in addition to null of the spool.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Choosing {
    Nothing,
    /// A wall that the load leaves when the force pulls.
    Wall,
    /// Gas at both chambers that is shut off below its precharge.
    Gas,
    /// A pump with a relief valve that closes when the valve takes all of its flow.
    Pump,
}

#[test]
fn boxes_and_margins_of_regions_are_those_of_dense_samples() {
    // ORIGIN: analytic, the first regions of the soak
    assert!(covered(0..6, Choosing::Nothing) > 3);
}

/// The force at a wall, between contact and none, occurs at no corner: the plants on both sides of
/// it are members, from which every search starts.
#[test]
fn both_sides_of_a_jump_are_members() {
    // ORIGIN: analytic, a wall is in contact if the force presses on it
    let wall = "[load]\nmodel = \"wall\"\nmass = 50\nstiffness = 1e6\ngap = 0.001\n";
    let region = "[family.operating_region]\nload_force = [-2000, 6000]\nposition = [0.1, 0.4]\n";
    let (start, rest) = HOSE.split_once("[sizing]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let text = format!("{start}{wall}{region}[[specification]]{end}");
    let project = project::read(&Memory::default().with("p.toml", text), "p.toml", &[], &[]).unwrap().project;
    let Family::Uncertain(found) = family(&Setup::new(&project).unwrap(), &Memory::default()).unwrap() else {
        panic!("a box")
    };
    let force = found.plant().parameters().iter().position(|one| one.name.ends_with("load_force")).unwrap();
    let next_to: Vec<f64> =
        found.members().iter().map(|values| values[force]).filter(|force| force.abs() < 1e-3).collect();
    let presses = next_to.iter().filter(|force| **force > 0.0).count();
    let pulls = next_to.len() - presses;
    assert!(pulls >= 2 && presses >= 2, "{next_to:?}");
}

/// Regions with a wall that the load leaves satisfy the conditions of those without.
#[test]
fn regions_across_a_jump_are_those_of_dense_samples() {
    // ORIGIN: analytic, the first regions of the soak
    assert!(covered(0..2, Choosing::Wall) > 0);
}

/// Random regions: three hundred, by `cargo xtask ci soak`.
#[test]
#[ignore = "takes minutes"]
fn soak_three_hundred_regions_agree_with_dense_samples() {
    let judged = covered(0..380, Choosing::Nothing);
    println!("{judged} regions");
    assert!(judged >= 300);
}

/// Random regions: thirty, in which a wall, gas or a pump makes the equations switch.
#[test]
#[ignore = "takes minutes"]
fn soak_regions_across_jumps_against_dense_samples() {
    let all =
        [Choosing::Wall, Choosing::Gas, Choosing::Pump].map(|choosing| (choosing, judged(0..30, choosing)));
    let mut wrong = Vec::new();
    for (choosing, (judged, faults)) in all {
        println!("{choosing:?}: {judged} regions");
        assert!(judged > 5, "{choosing:?}");
        wrong.extend(faults.into_iter().map(|fault| format!("{choosing:?}: {fault}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Compares the regions of these seeds, and returns the number of those that have an operating
/// point everywhere.
fn covered(seeds: std::ops::Range<u64>, choosing: Choosing) -> usize {
    let (judged, wrong) = judged(seeds, choosing);
    assert!(wrong.is_empty(), "{} of {judged}\n{}", wrong.len(), wrong.join("\n"));
    judged
}

/// The number of regions of these seeds that have an operating point everywhere, and the failures.
fn judged(seeds: std::ops::Range<u64>, choosing: Choosing) -> (usize, Vec<String>) {
    let (mut judged, mut wrong) = (0, Vec::new());
    for seed in seeds {
        let Some(region) = Region::drawn(seed, choosing) else { continue };
        judged += 1;
        for fault in region.faults() {
            println!("{choosing:?} {seed}: {fault}");
            wrong.push(format!("region {seed}: {fault}"));
        }
    }
    (judged, wrong)
}

/// A random rig in a random region.
struct Region {
    project: Project,
    family: UncertainFamily,
    state: u64,
    choosing: Choosing,
}

impl Region {
    /// Returns `None` if some corner of it has no operating point.
    fn drawn(seed: u64, choosing: Choosing) -> Option<Region> {
        let mut state = stream(48, seed);
        let text = text(&mut state, choosing);
        let project = project::read(&Memory::default().with("p.toml", text.as_str()), "p.toml", &[], &[]);
        let project = project.unwrap_or_else(|report| panic!("{report}\n{text}")).project;
        let setup = Setup::new(&project).ok()?;
        match family(&setup, &Memory::default()) {
            Ok(Family::Uncertain(family)) => Some(Region { project, family, state, choosing }),
            _ => None,
        }
    }

    fn faults(mut self) -> Vec<String> {
        let samples = self.samples();
        let mut faults = match self.choosing {
            Choosing::Gas => vec![],
            _ => self.outside_of_box(&samples),
        };
        faults.extend(self.better_than_found(&samples));
        faults
    }

    /// Points drawn evenly, and points next to null.
    fn samples(&mut self) -> Vec<Vec<f64>> {
        let mut samples: Vec<Vec<f64>> = (0..EVENLY).map(|_| self.point()).collect();
        let movers: Vec<usize> = (0..self.family.plant().parameters().len())
            .filter(|&index| {
                let name = &self.family.plant().parameters()[index].name;
                name.ends_with("velocity") || name.ends_with("load_force")
            })
            .collect();
        for number in 0..NEAR_NULL {
            let Some(&along) = movers.get(number % movers.len().max(1)) else { break };
            let from = self.point();
            samples.extend(self.next_to(&from, along, |rig| rig.point.command));
            let next_to_jumps: Vec<Vec<f64>> =
                self.signs().iter().flat_map(|sign| self.next_to(&from, along, sign)).collect();
            samples.extend(next_to_jumps);
        }
        samples
    }

    /// Draws a point; each number is at one of its ends in half of the cases.
    fn point(&mut self) -> Vec<f64> {
        let state = &mut self.state;
        let mut drawn = |low: f64, high: f64| match (4.0 * uniform(state)) as u8 {
            0 => low,
            1 => high,
            _ => low + (high - low) * uniform(state),
        };
        self.family.plant().parameters().iter().map(|one| drawn(one.minimum, one.maximum)).collect()
    }

    /// Quantities that change their sign where an equation switches.
    fn signs(&self) -> Vec<RigSign> {
        let gas = self.project.actuator.as_ref().and_then(|declared| declared.line.a.accumulator.as_ref());
        let precharge = gas.map_or(0.0, |gas| gas.precharge_pressure);
        let pump_flow = self.project.actuator.as_ref().and_then(|declared| declared.supply.flow());
        match self.choosing {
            Choosing::Nothing => vec![],
            Choosing::Wall => vec![Box::new(|rig| rig.point.hydraulic_force)],
            Choosing::Gas => vec![
                Box::new(move |rig| rig.point.pressure_a - precharge),
                Box::new(move |rig| rig.point.pressure_b - precharge),
            ],
            Choosing::Pump => {
                vec![Box::new(move |rig| rig.supply.map_or(1.0, |found| pump_flow.unwrap() - found.taken))]
            }
        }
    }

    /// The points around the place along one number where a quantity changes its sign; none if it
    /// does not.
    fn next_to(&self, from: &[f64], along: usize, sign: impl Fn(&Rig) -> f64) -> Vec<Vec<f64>> {
        let one = &self.family.plant().parameters()[along];
        let at = |value: f64| {
            let mut values = from.to_vec();
            values[along] = value.clamp(one.minimum, one.maximum);
            values
        };
        let command = |value: f64| sign(&self.rig(&at(value)));
        let (mut low, mut high) = (one.minimum, one.maximum);
        let rises = command(low) < command(high);
        if (command(low) > 0.0) == (command(high) > 0.0) {
            return Vec::new();
        }
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            if (command(middle) > 0.0) == rises {
                high = middle;
            } else {
                low = middle;
            }
        }
        NEXT_TO_NULL.iter().map(|part| at(low + part * (one.maximum - one.minimum))).collect()
    }

    /// The rig that declares these numbers; without gas, which changes no pressure at rest and is
    /// rejected in a rig where it is shut off.
    fn rig(&self, values: &[f64]) -> Rig {
        let mut stated = self.project.clone();
        if let Some(declared) = &mut stated.actuator {
            (declared.line.a.accumulator, declared.line.b.accumulator) = (None, None);
        }
        stated.uncertainty.clear();
        stated.family = None;
        let names = self.family.plant().parameters().iter().map(|one| one.name.as_str());
        let numbers: Vec<(&str, f64)> = names.zip(values.iter().copied()).collect();
        Setup::rig_of(&stated.with_numbers(&numbers).unwrap()).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Rigs whose parameters are outside the printed box.
    fn outside_of_box(&self, samples: &[Vec<f64>]) -> Vec<String> {
        let ranges = visited_box(&Setup::new(&self.project).unwrap()).unwrap().unwrap_or_default();
        let sampled: Vec<_> = samples.iter().map(|values| self.rig(values).linear).collect();
        let of = |range: &VisitedRange| {
            let all = sampled.iter().map(|linear| match range.name {
                "flow_gain" => linear.flow_gain,
                "flow_pressure_coefficient" => linear.flow_pressure_coefficient,
                "hydraulic_stiffness" => linear.hydraulic_stiffness,
                _ => linear.viscous_friction,
            });
            let [low, high] =
                all.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], one| [low.min(one), high.max(one)]);
            let (least, most) = (range.minimum.value, range.maximum.value);
            let outside = low < least * (1.0 - ERROR) || high > most * (1.0 + ERROR);
            outside.then(|| format!("{} {least:e} to {most:e}, sampled {low:e} to {high:e}", range.name))
        };
        ranges.iter().filter_map(of).collect()
    }

    /// Margins of the samples that are less than those of the audit of the region.
    fn better_than_found(&self, samples: &[Vec<f64>]) -> Vec<String> {
        let problem = robust_problem(&Memory::default(), &Setup::new(&self.project).unwrap()).unwrap();
        let step = samples.len().div_ceil(JUDGED).max(1);
        let members = samples.iter().rev().step_by(step).cloned().collect();
        let (plant, coordinates) = (self.family.plant().clone(), self.family.coordinates().to_vec());
        let sampled = UncertainFamily::new(plant, coordinates, members, Extent::Members).unwrap();
        let audited = |family: &Family| {
            let problem = AuditProblem {
                family,
                compensation: &problem.compensation,
                specifications: &problem.specifications,
                tracking: TrackingJudgement::Magnitude,
                tolerance_db: TOLERANCE_DB,
            };
            audit(&problem, &mut unwatched).unwrap()
        };
        compared(&audited(&problem.family), &audited(&Family::Uncertain(sampled)))
    }
}

fn compared(found: &Audit, sampled: &Audit) -> Vec<String> {
    if found.stability.verdict == Verdict::Violated {
        return Vec::new();
    }
    if sampled.stability.verdict == Verdict::Violated {
        return vec!["an unstable plant was missed".to_string()];
    }
    let mut faults = Vec::new();
    let delay = |audit: &Audit| audit.delay_margin.as_ref().map(|margin| margin.delay_s);
    if let (Some(found), Some(sampled)) = (delay(found), delay(sampled))
        && 20.0 * (found / sampled).log10() > ERROR_DB
    {
        faults.push(format!("delay margin {found:e} s, sampled {sampled:e} s"));
    }
    for (one, other) in found.specifications.iter().zip(&sampled.specifications) {
        let margins = one.worst.as_ref().zip(other.worst.as_ref());
        if let Some((one, other)) = margins.filter(|(one, other)| one.margin_db > other.margin_db + ERROR_DB)
        {
            faults.push(format!(
                "margin {:.4} dB, sampled {:.4} dB at {} rad/s, {:?} against {:?}",
                one.margin_db, other.margin_db, other.frequency_rad_per_s, one.plant, other.plant
            ));
        }
    }
    faults
}

/// The table of the part that switches, and the keys of the supply; `fraction` places the switch,
/// for this supply pressure in Pa and flow in m3/s.
fn chosen(choosing: Choosing, fraction: f64, supply: f64, flow: f64) -> [String; 2] {
    let constant = "model = \"constant\"\n".to_string();
    match choosing {
        Choosing::Nothing => [String::new(), constant],
        Choosing::Wall => {
            let keys = "mass = 50\nstiffness = 1e6\ngap = 0.001\nrelative_damping = 0.2\n";
            [format!("[load]\nmodel = \"wall\"\n{keys}"), constant]
        }
        Choosing::Gas => {
            let precharge = (0.25 + 0.15 * fraction) * supply;
            let keys = format!("gas_volume = \"14 mL\"\nprecharge_pressure = {precharge:e}\n");
            [format!("[line.accumulator]\n{keys}"), constant]
        }
        Choosing::Pump => {
            let flow = (0.3 + 0.9 * fraction) * flow;
            let keys = format!("flow = {flow:e}\nrelief_override = \"10 bar\"\nvolume = \"1 L\"\n");
            [String::new(), format!("model = \"pump_limited\"\n{keys}")]
        }
    }
}

/// A rig and a region of it.
fn text(state: &mut u64, choosing: Choosing) -> String {
    let mut drawn = |low: f64, high: f64| low + (high - low) * uniform(state);
    let equal = drawn(0.0, 1.0) < 0.2;
    let first = drawn(2e-7, 4e-7);
    let flow: [f64; 4] = std::array::from_fn(|_| if equal { first } else { drawn(1.8e-7, 4.2e-7) });
    let leak: [f64; 4] = std::array::from_fn(|_| drawn(0.8e-9, 5e-9));
    let [supply, tank] = [drawn(50e5, 180e5), if drawn(0.0, 1.0) < 0.5 { 0.0 } else { drawn(0.0, 6e5) }];
    let rods = [["22 mm", "22 mm"], ["0 mm", "22 mm"], ["28 mm", "10 mm"]][drawn(0.0, 2.999) as usize];
    let area = 1.6e-3;
    let mut range = |low: f64, high: f64| {
        let (one, other) = (drawn(low, high), drawn(low, high));
        format!("[{:e}, {:e}]", one.min(other), one.max(other))
    };
    let force = 0.45 * supply * area;
    let speed = 0.25 * first * (supply / 2.0).sqrt() / area;
    let forces = format!("load_force = {}\n", range(-force, force));
    let speeds = format!("velocity = {}\n", range(-speed, speed));
    let positions = format!("position = {}\n", range(0.02, 0.48));
    let which = uniform(state);
    let region = match (10.0 * which) as u8 {
        0 | 1 => forces,
        2 | 3 => speeds,
        4 => positions,
        5 | 6 => positions + &forces,
        _ => positions + &forces + &speeds,
    };
    let mut drawn = |low: f64, high: f64| low + (high - low) * uniform(state);
    let (gain, shape) = (drawn(0.2, 1.2), drawn(20.0, 250.0));
    let sampled = if drawn(0.0, 1.0) < 0.3 { "sample_time = \"1 ms\"\ndelay = \"0.5 ms\"\n" } else { "" };
    let leakage = match drawn(0.0, 1.0) < 0.3 {
        true => format!("internal_leakage = {:e}\n", drawn(1e-13, 3e-12)),
        false => String::new(),
    };
    let (start, rest) = HOSE.split_once("[sizing]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let (specifications, _) = end.split_once("[[specification]]\nkind = \"tracking\"").unwrap();
    let (head, _) = start.split_once("[supply]").unwrap();
    let (_, cylinder) = start.split_once("[cylinder] ").unwrap();
    let cylinder = cylinder
        .replace("rod_diameter = \"22 mm\"", &format!("rod_diameters = [\"{}\", \"{}\"]", rods[0], rods[1]))
        .replace("moving_mass = ", &format!("{leakage}moving_mass = "));
    let [chooses, model] = chosen(choosing, drawn(0.0, 1.0), supply, speed * area);
    format!(
        "{head}[supply]\n{model}pressure = {supply:e}\ntank_pressure = {tank:e}\n\
         [valve]\nnominal_voltage = \"10 V\"\nnatural_frequency = \"1099 rad/s\"\ndamping_ratio = 0.9\n\
         leakage_shape = {shape}\ntare_flow = 0\nflow_coefficients = {flow:?}\nleakage_coefficients = {leak:?}\n\
         [cylinder] {cylinder}\n{chooses}[family.operating_region]\n{region}\n[[specification]]{specifications}\n\
         [controller]\nnumerator = \"{gain}*(0.001*s + 0.008)\"\ndenominator = \"s\"\n{sampled}"
    )
}
