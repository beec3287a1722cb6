//! The chapter on the rig: its circuit, drawn from the project, and its declaration.

mod circuit;

use phea_hydraulics::series::ForceFrom;

use super::chapter::Chapter;
use crate::document::{Document, Table};
use crate::figure::{LineKind, LineSymbol};
use crate::linearize::{linkage_places, linkage_table};
use crate::project::{
    self, Component, CylinderTriangle, DeclaredSeries, LineVolume, LinkageKind, Load, Project, RatedFlow,
};
use crate::quantity::{self, AREA, Dimension, FLOW, LENGTH, MASS, PRESSURE, STIFFNESS, VOLUME};
use crate::rig::Rig;

pub(super) fn chapter(project: &Project, actuator: &project::DeclaredActuator, rig: &Rig) -> Chapter {
    let mut out = Document::default();
    out.figures([circuit::circuit(project, actuator, rig)]);
    out.table(facts(actuator, rig));
    let places = linkage_places(rig);
    if !places.is_empty() {
        out.section("The linkage over the stroke", linkage_table(&places));
        out.explanation("The load turns about a joint: with the lever arm r its torque is F r, and an inertia J acts on the rod as J/r².");
    }
    Chapter::of("rig", "The rig", out)
}

fn shown(value: f64, dimension: &Dimension) -> String {
    quantity::display(value, dimension, 4)
}

/// Text or drawing next to which the cylinder is described.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DescriptionContext {
    /// A drawing, which shows the end at which a rod comes out.
    Drawing,
    /// Words only.
    Words,
}

/// The cylinder or the motor in a few words.
fn moving_words(actuator: &project::DeclaredActuator, context: DescriptionContext) -> String {
    let Some(motor) = &actuator.motor else { return cylinder_words(&actuator.cylinder, context) };
    let displacement = shown(motor.displacement, &quantity::DISPLACEMENT);
    match motor.stroke {
        Some(stroke) => format!("{displacement}, stroke {}", shown(stroke, &quantity::ANGLE)),
        None => format!("{displacement}, continuous rotation"),
    }
}

/// Moving mass or inertia, kg or kg m2.
fn moving_mass(actuator: &project::DeclaredActuator) -> f64 {
    actuator.motor.as_ref().map_or(actuator.cylinder.moving_mass, |motor| motor.inertia)
}

fn shown_in_millimetres(length: f64) -> String {
    let text = quantity::DisplayUnit::MILLIMETRE.number(length, 4);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

fn cylinder_words(cylinder: &project::DeclaredCylinder, context: DescriptionContext) -> String {
    let millimetres = shown_in_millimetres;
    let piston = cylinder.piston_diameter_m();
    let [rod_a, rod_b] = cylinder.rod_diameters_m();
    let rods = match [rod_a, rod_b] {
        [0.0, 0.0] => " mm without rod".to_string(),
        [a, b] if a == b => format!("/{} mm", millimetres(a)),
        [rod, 0.0] | [0.0, rod] if context == DescriptionContext::Drawing => {
            format!("/{} mm", millimetres(rod))
        }
        [0.0, b] => format!("/{} mm, rod through B", millimetres(b)),
        [a, 0.0] => format!("/{} mm, rod through A", millimetres(a)),
        [a, b] => format!("/{} (A)/{} (B) mm", millimetres(a), millimetres(b)),
    };
    let stroke = shown(cylinder.stroke, &LENGTH);
    let stroke = match cylinder.stages.len() {
        0 => format!("stroke {stroke}"),
        further => format!("{stroke} in {} stages", further + 1),
    };
    format!("{}{rods}, {stroke}", millimetres(piston))
}

fn single_line(declared: &project::DeclaredLine) -> LineSymbol {
    let (kind, rows) = match &declared.component {
        Component::Pipe { pipe, length } => {
            (LineKind::Pipe, [format!("pipe {}", shown(pipe.bore, &LENGTH)), shown(*length, &LENGTH)])
        }
        Component::Hose { properties, length, .. } => {
            (LineKind::Hose, [format!("hose {}", shown(properties.bore, &LENGTH)), shown(*length, &LENGTH)])
        }
        Component::Volume(LineVolume { volume, effective_bulk_modulus }) => {
            let modulus = format!("β {}", shown(*effective_bulk_modulus, &PRESSURE));
            (LineKind::Pipe, [shown(*volume, &VOLUME), modulus])
        }
    };
    LineSymbol::new(kind, rows.to_vec())
}

/// The load in a few words.
pub(super) fn load_words(actuator: &project::DeclaredActuator) -> String {
    let not_zero = |value: f64| Some(value).filter(|value| *value != 0.0);
    let cell = shown(actuator.force_sensor.stiffness, actuator.motion().dimension(&STIFFNESS));
    let motion = actuator.load_motion();
    let of_load = |value, dimension| shown(value, motion.dimension(dimension));
    let words = |mass: Option<f64>, stiffness: f64, damping: f64, gap: f64| {
        let parts = [
            mass.map(|mass| of_load(mass, &MASS)),
            Some(of_load(stiffness, &STIFFNESS)),
            not_zero(damping).map(|damping| of_load(damping, &quantity::DAMPING)),
            not_zero(gap).map(|gap| format!("gap {}", of_load(gap, &LENGTH))),
        ];
        parts.into_iter().flatten().collect::<Vec<String>>().join(", ")
    };
    let load = match actuator.load {
        Load::Prescribed => {
            format!("moves as prescribed, behind {cell}")
        }
        Load::SpringMassDamper { mass, stiffness, damping } => {
            let mass_words = if motion.is_rotary() { "inertia" } else { "mass" };
            format!("spring, {mass_words} and damper: {}", words(Some(mass), stiffness, damping, 0.0))
        }
        Load::Wall { mass, damping, stiffness, gap, .. } => {
            format!("a wall: {}", words(mass, stiffness, damping, gap))
        }
    };
    let load = match &actuator.linkage {
        None => load,
        Some(linkage) => {
            let weight = linkage.weight.map_or(String::new(), |weight| {
                let [mass, distance] = [shown(weight.mass, &MASS), shown(weight.centre_distance, &LENGTH)];
                format!("; weighs {mass}, {distance} from its joint")
            });
            format!("{load}; turns behind {}{weight}", linkage_words(linkage))
        }
    };
    match &actuator.series {
        None => load,
        Some(series) => {
            let [name, words] = series_words(series);
            format!("{load}; {name} {words}")
        }
    }
}

/// The linkage between rod and joint in a few words.
fn linkage_words(linkage: &project::DeclaredLinkage) -> String {
    let mm = |length: f64| shown(length, &LENGTH);
    let between = |triangle: &CylinderTriangle| {
        format!(
            "pivots {} and {} from its joint, {} apart when retracted",
            mm(triangle.cylinder_pivot),
            mm(triangle.rod_pivot),
            mm(triangle.retracted_length)
        )
    };
    match &linkage.kind {
        LinkageKind::Triangle(triangle) => format!("a triangle: {}", between(triangle)),
        LinkageKind::FourBar { triangle, links } => {
            let sides = [links.fixed_link, links.input_link, links.coupler, links.output_link].map(mm);
            format!("a four-bar of {}, turned by a triangle: {}", sides.join(", "), between(triangle))
        }
        LinkageKind::Table { angles, .. } => format!("a linkage by a table of {} rows", angles.len()),
    }
}

/// The part between force sensor and load: its name, and its description in a few words.
fn series_words(series: &DeclaredSeries) -> [String; 2] {
    match series {
        DeclaredSeries::Spring(spring) => ["series spring".to_string(), spring_words(spring)],
        DeclaredSeries::Transmission(transmission) => {
            ["hydraulic transmission".to_string(), transmission_words(transmission)]
        }
    }
}

fn transmission_words(transmission: &project::DeclaredTransmission) -> String {
    let name = transmission.line.hose_name().map(str::to_string);
    let pistons = format!("pistons of {}", shown(transmission.piston_area, &AREA));
    let filled = format!("filled with {}", shown(transmission.filling_pressure, &PRESSURE));
    let own = Some(transmission.end_volume).filter(|volume| *volume > 0.0);
    let own = own.map(|volume| format!("{} at either end", shown(volume, &VOLUME)));
    let segments = match transmission.segments {
        1 => "1 segment".to_string(),
        count => format!("{count} segments"),
    };
    let line = name.into_iter().chain(single_line(&transmission.line).rows).chain([segments]);
    [pistons, filled].into_iter().chain(own).chain(line).collect::<Vec<String>>().join(", ")
}

fn spring_words(series: &project::DeclaredSpring) -> String {
    let measured = (series.force_from == ForceFrom::Deflection).then(|| "measures the force".to_string());
    let progressive = |fraction: f64| format!("{} % progressive", quantity::significant(100.0 * fraction, 3));
    let parts = [
        Some(shown(series.stiffness, &STIFFNESS)),
        series.damping.map(|damping| shown(damping, &quantity::DAMPING)),
        series.mass.map(|mass| shown(mass, &MASS)),
        series.travel.map(|travel| format!("±{}", shown(travel, &LENGTH))),
        series.progression.map(progressive),
        measured,
    ];
    parts.into_iter().flatten().collect::<Vec<String>>().join(", ")
}

/// The declared lines in a few words.
pub(super) fn lines_words(actuator: &project::DeclaredActuator) -> String {
    let words = |line: &project::DeclaredLine| {
        let name = line.hose_name().or_else(|| line.pipe()?.model.as_deref());
        let name = name.map(|name| format!("{name}, "));
        let gas = if line.accumulator.is_some() { ", accumulator" } else { "" };
        format!("{}{}{gas}", name.unwrap_or_default(), single_line(line).rows.join(", "))
    };
    let (a, b) = (words(&actuator.line.a), words(&actuator.line.b));
    if a == b { format!("{a} each") } else { format!("A {a}; B {b}") }
}

fn facts(actuator: &project::DeclaredActuator, rig: &Rig) -> Table {
    let components = rig.actuator.components();
    let (motion, words) = (actuator.motion(), actuator.motion().words());
    let moving = |value, dimension| shown(value, motion.dimension(dimension));
    let mut rows = vec![
        (
            "supply",
            format!(
                "{}, tank at {}",
                shown(actuator.supply.pressure, &PRESSURE),
                shown(actuator.supply.tank_pressure, &PRESSURE)
            ),
        ),
        (
            "fluid",
            format!(
                "bulk modulus {}, density {}",
                shown(actuator.fluid.bulk_modulus, &PRESSURE),
                shown(actuator.fluid.density, &quantity::DENSITY)
            ),
        ),
        ("servovalve", valve_words(actuator)),
        (words.cylinder, moving_words(actuator, DescriptionContext::Words)),
        (motion.either("moving mass", "inertia"), moving(moving_mass(actuator), &MASS)),
        (words.force_sensor, moving(actuator.force_sensor.stiffness, &STIFFNESS)),
    ];
    let series = actuator.series.as_ref().map(series_words);
    rows.extend(series.as_ref().map(|[name, words]| (name.as_str(), words.clone())));
    rows.extend(actuator.linkage.as_ref().map(|linkage| ("linkage", linkage_words(linkage))));
    if components.line_a == components.line_b {
        rows.push(("each line", circuit::line_words(&actuator.line.a)));
    } else {
        rows.push(("line A", circuit::line_words(&actuator.line.a)));
        rows.push(("line B", circuit::line_words(&actuator.line.b)));
    }
    rows.extend(circuit::chamber_valve_rows(rig));
    Table::new(["component", "declared"]).with(rows.into_iter().map(|(name, text)| [name.to_string(), text]))
}

fn valve_words(actuator: &project::DeclaredActuator) -> String {
    let valve = &actuator.valve;
    let name = match (&valve.model, valve.flow.rating()) {
        (Some(model), _) => model.clone(),
        (None, Some(RatedFlow { flow, pressure_drop })) => {
            format!("{} at a drop of {}", shown(*flow, &FLOW), shown(*pressure_drop, &PRESSURE))
        }
        _ => "by coefficients".to_string(),
    };
    format!(
        "{name}, {} and damping {}",
        shown(valve.natural_frequency, &quantity::ANGULAR_FREQUENCY),
        valve.damping_ratio
    )
}
