//! Effects of spring, load, supply and friction, and steps that the rig does not reach.

use phea_engineering::caveat::{LoopWithRig, OutsideFamily};
use phea_engineering::rig::OutsideParameter;
use phea_engineering::specification::SpecificationName;
use phea_hydraulics::series::MOST_SEGMENTS;

use crate::quantity::{DAMPING, DisplayUnit, MotionKind, Units, display, significant};
use crate::specification::subject_words;

pub(super) const TRANSMISSION_AS_SPRING: &str = "inertia and resistance of the transmission are counted in the plant and its impedance alone: the other models have \
     its oil as a spring in series with the force sensor";

pub(super) const WALL_WITHOUT_MASS: &str = "load.model = \"wall\" is not included without load.mass: this is the loop with a load that does not move";

pub(super) const CONSTANT_SUPPLY: &str = "supply.model = \"pump_limited\" is counted in the plant alone: the other models have the pressure at which it settles, held \
     constant";

pub(super) fn blocked_piston(force: f64, units: &Units) -> String {
    let words = units.motion.words();
    format!(
        "family.operating_region has {} alone: its plants are those of a {} blocked at null, which pushes with {}, and not \
         of zero {}, for which operating_point.load_force = 0 is stated",
        words.positions,
        words.piston,
        units.force.short(force, 4),
        words.force
    )
}

pub(super) fn progressive_spring(counted: f64, at_rest: f64, stiffest: f64) -> String {
    let stiffness = |value: f64| DisplayUnit::MEGANEWTON_PER_METRE.text(value, 3);
    format!(
        "series.progression is counted for small motions, with the {} that the spring has at the operating point: it has {} at rest and \
         {} at the end of its travel, and only a simulation shows a large step through both",
        stiffness(counted),
        stiffness(at_rest),
        stiffness(stiffest)
    )
}

pub(super) fn transmission_segments(segments: u32, right_to: f64) -> String {
    format!(
        "the line of the transmission is counted in segments, here {segments}, whose waves are right to 3 % up to {} rad/s: a margin beyond that may \
         be that of its segments{}{}",
        significant(right_to, 3),
        if (segments as usize) < MOST_SEGMENTS { "; `--on-machine` tries more" } else { "" },
        if segments > PROVEN_SEGMENTS { "; `--prove` encloses two segments, and no more" } else { "" }
    )
}

/// Segments up to which the polynomials of the plant can be enclosed.
const PROVEN_SEGMENTS: u32 = 2;

pub(super) fn series_parts(damping: bool, mass: bool) -> String {
    let keys = match (damping, mass) {
        (true, true) => "series.damping and series.mass are",
        (true, false) => "series.damping is",
        (false, _) => "series.mass is",
    };
    format!(
        "{keys} counted in the plant and its impedance alone: the other models have the series spring without it, in series with the \
         force sensor"
    )
}

pub(super) fn telescopic_stages(moves: bool) -> &'static str {
    match moves {
        false => {
            "cylinder.stage is counted with the areas at each operating point: only a simulation shows a motion from one stage to the next"
        }
        true => {
            "cylinder.stage is counted with the areas at each operating point, and not with their change at a steady velocity through a \
             transition: only a simulation shows it"
        }
    }
}

pub(super) fn lines_in_motion(key: &str, model: &str) -> String {
    format!(
        "{key} = \"{model}\" is not counted in these models, which have lumped lines: verify, design and simulate count it"
    )
}

pub(super) fn limited_pump(pressure: f64, taken: f64, delivered: f64, units: &Units) -> String {
    let settles = taken < delivered;
    let [taken, delivered] = [taken, delivered].map(|flow| units.flow.text(flow, 3));
    let pressure = units.pressure.text(pressure, 4);
    match settles {
        true => format!(
            "supply.model = \"pump_limited\" is included for small motions, at {pressure} where the valve takes {taken} of the \
             pump's {delivered}: only a simulation shows what a large step takes beyond that"
        ),
        false => format!(
            "supply.model = \"pump_limited\" has no equilibrium at the operating point, where the valve takes {taken} and the pump gives \
             {delivered}: the plant is that at {pressure}, where the relief valve shuts"
        ),
    }
}

pub(super) fn friction_directions(extending: f64, retracting: f64, motion: MotionKind) -> String {
    let (rod, unit) = (motion.words().rod, motion.dimension(&DAMPING).si);
    let [low, high] = [extending.min(retracting), extending.max(retracting)];
    let [extending, retracting, low, high] =
        [extending, retracting, low, high].map(|number| significant(number, 4));
    format!(
        "the viscous friction is {extending} {unit} while the {rod} extends and {retracting} {unit} while it retracts \
         (cylinder.friction.retracting.viscous), and no plant of the family has one of them: state `viscous_friction` from {low} to {high} \
         {unit} in [uncertainty]"
    )
}

/// A rig that its own family does not contain, and its loop.
pub(super) fn outside_family(found: &OutsideFamily) -> String {
    let with_rig = match &found.with_rig {
        LoopWithRig::Satisfied => "the loop with it is stable and satisfies every specification".to_string(),
        LoopWithRig::Unstable => "the loop with it is unstable".to_string(),
        LoopWithRig::Violates(violated) => {
            let words =
                |(number, name): &(usize, SpecificationName)| format!("{number} {}", subject_words(*name));
            let violated: Vec<String> = violated.iter().map(words).collect();
            format!("the loop with it violates {}", violated.join(", "))
        }
        LoopWithRig::NotProven => "nothing is proven of the loop with it".to_string(),
    };
    format!("{}: {with_rig}", outside(&found.parameters))
}

/// The parameters of the rig that its family does not contain.
pub(crate) fn outside(parameters: &[OutsideParameter]) -> String {
    format!("the family does not contain the rig as it is derived ({})", outside_parameters(parameters))
}

/// Values of the rig outside their bounds.
pub(crate) fn outside_parameters(parameters: &[OutsideParameter]) -> String {
    let of = |one: &OutsideParameter| {
        let number = |value: f64| match one.dimension {
            Some(dimension) => display(value, dimension, 4),
            None => value.to_string(),
        };
        let [least, most] = one.bounds.map(number);
        format!("{} is {}, the box has {least} to {most}", one.name, number(one.value))
    };
    parameters.iter().map(of).collect::<Vec<_>>().join("; ")
}
