//! Uncertain numbers that move the operating point, and the operating points themselves: every
//! plant of the family is that of the rig with these numbers declared.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::random::uniform;
use phea_dynamics::uncertain_plant::{PlantCoefficients, UncertainPlant};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_workbench::command::{self, Request};
use phea_workbench::family::{VisitedRange, family, visited_box};
use phea_workbench::project::{self, Project};
use phea_workbench::rig::Rig;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
/// Frequencies from below the hydraulic pole to above the piston on its load cell, rad/s.
const FREQUENCIES: [f64; 7] = [0.01, 0.3, 5.0, 80.0, 700.0, 1300.0, 6000.0];

/// The hose with other `[uncertainty]`, these lines instead of `[sizing]`, and in `[cylinder]`.
fn text(uncertainty: &str, tables: &str, cylinder: &str) -> String {
    let (start, rest) = HOSE.split_once("[sizing]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let start = start.replace("moving_mass = ", &format!("{cylinder}\nmoving_mass = "));
    format!("{start}{tables}\n[uncertainty]\n{uncertainty}\n[[specification]]{end}")
}

fn read(text: &str, settings: &[&str]) -> Result<Project, String> {
    let source = Memory::default().with("p.toml", text);
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    project::read(&source, "p.toml", &settings, &[])
        .map(|read| read.project)
        .map_err(|report| report.to_string())
}

fn loaded(text: &str) -> Project {
    read(text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn ranges(ranges: &[(&str, [f64; 3])]) -> String {
    let line = |(name, [low, nominal, high]): &(&str, [f64; 3])| {
        format!(
            "\"{name}\" = {{ nominal = {nominal:e}, minimum = {low:e}, maximum = {high:e}, points = 2 }}\n"
        )
    };
    ranges.iter().map(line).collect()
}

fn members(project: &Project) -> UncertainFamily {
    match family(&Setup::new(project).unwrap(), &Memory::default()).unwrap_or_else(|error| panic!("{error}"))
    {
        Family::Uncertain(family) => family,
        Family::Measured(_) => panic!("nothing was measured"),
    }
}

/// The rig that declares these values.
fn rebuilt(project: &Project, plant: &UncertainPlant, values: &[f64]) -> Rig {
    let mut stated = project.clone();
    stated.uncertainty.clear();
    stated.family = None;
    for (parameter, value) in plant.parameters().iter().zip(values) {
        stated = stated.with_number(&parameter.name, *value).unwrap();
    }
    Setup::rig_of(&stated).unwrap()
}

/// Largest relative difference of the two plants over the frequencies.
fn difference(one: &PlantCoefficients<f64>, other: &PlantCoefficients<f64>) -> f64 {
    let path = |plant: &PlantCoefficients<f64>, w: f64| {
        let moved = plant.disturbance.as_ref().unwrap().at_frequency(w);
        [plant.command.at_frequency(w), moved]
    };
    let at = |w: f64| {
        let pairs = path(one, w).into_iter().zip(path(other, w));
        pairs.map(|(one, other)| (one / other - 1.0).norm_sqr().sqrt()).fold(0.0, f64::max)
    };
    FREQUENCIES.into_iter().map(at).fold(0.0, f64::max)
}

/// Compares, at every member, every corner and at points drawn within the box, the recorded plant
/// with the rig rebuilt from the project. Returns the signs of the commands that were visited.
#[track_caller]
fn follows_the_rig(project: &Project) -> [usize; 2] {
    let family = members(project);
    let plant = family.plant();
    let (mut state, mut sides) = (5, [0; 2]);
    let mut drawn: Vec<Vec<f64>> = Vec::new();
    for _ in 0..60 {
        let mut within = |low: f64, high: f64| low + (high - low) * uniform(&mut state);
        drawn.push(plant.parameters().iter().map(|one| within(one.minimum, one.maximum)).collect());
    }
    for values in family.members().iter().take(300).chain(&drawn) {
        let rig = rebuilt(project, plant, values);
        let found = difference(&plant.coefficients(values).unwrap(), &rig.plant.coefficients());
        assert!(found < 1e-9, "{found} at {values:?}");
        sides[usize::from(rig.point.command > 0.0)] += 1;
    }
    sides
}

const EDGES: [(&str, [f64; 3]); 6] = [
    ("valve.flow_coefficients.supply_to_a", [2.8e-7, 3.2e-7, 3.4e-7]),
    ("valve.flow_coefficients.b_to_tank", [3e-7, 3.85e-7, 4e-7]),
    ("valve.leakage_coefficients.a_to_tank", [1.8e-9, 2.2e-9, 2.6e-9]),
    ("valve.leakage_coefficients.supply_to_b", [1.2e-9, 1.7e-9, 2.6e-9]),
    ("supply.pressure", [55e5, 70e5, 90e5]),
    ("supply.tank_pressure", [0.0, 0.0, 6e5]),
];

#[test]
fn edges_and_pressures_move_the_null_point() {
    follows_the_rig(&loaded(&text(&ranges(&EDGES), "", "")));
    let leak = ("cylinder.internal_leakage", [1e-14, 1e-13, 1e-11]);
    let leaking = [&EDGES[2..], &[leak]].concat();
    follows_the_rig(&loaded(&text(&ranges(&leaking), "", "internal_leakage = 1e-13")));
    let shape = [
        ("valve.leakage_shape", [50.0, 100.0, 200.0]),
        ("valve.transition_pressure", [5e2, 1e3, 5e3]),
        ("valve.nominal_voltage", [9.0, 10.0, 11.0]),
        ("line.volumetric_expansion_slope", [2e-12, 2.236e-12, 2.5e-12]),
        ("supply.pressure", [55e5, 70e5, 90e5]),
    ];
    follows_the_rig(&loaded(&text(&ranges(&shape), "", "")));
}

/// The operating point over both signs of the command, with numbers that move it, without and with
/// leakage across the piston.
#[test]
fn operating_points_are_those_of_the_declared_rig() {
    let region = [
        ("operating_point.position", [0.05, 0.2, 0.5]),
        ("operating_point.load_force", [-4000.0, 1000.0, 4500.0]),
        ("operating_point.velocity", [-0.05, 0.0, 0.06]),
        ("supply.pressure", [65e5, 70e5, 80e5]),
        ("valve.flow_coefficients.a_to_tank", [2e-7, 2.5e-7, 3e-7]),
    ];
    let sides = follows_the_rig(&loaded(&text(&ranges(&region), "", "")));
    assert!(sides.iter().all(|count| *count > 20), "{sides:?}");
    let leak = ("cylinder.internal_leakage", [1e-13, 1e-12, 5e-12]);
    let leaking = [&region[1..], &[leak]].concat();
    let sides = follows_the_rig(&loaded(&text(&ranges(&leaking), "", "internal_leakage = 1e-12")));
    assert!(sides.iter().all(|count| *count > 20), "{sides:?}");
    let by_pressure = [("operating_point.load_pressure", [-30e5, 5e5, 45e5]), region[2], leak];
    follows_the_rig(&loaded(&text(&ranges(&by_pressure), "", "internal_leakage = 1e-12")));
}

/// A valve between the chambers of every kind, and the numbers that it is made of.
#[test]
fn valves_between_the_chambers_follow() {
    let region = [
        ("operating_point.load_force", [-3000.0, 1000.0, 3500.0]),
        ("supply.pressure", [65e5, 70e5, 80e5]),
        ("fluid.density", [840.0, 870.0, 900.0]),
    ];
    let laminar = "[cross_port]\nkind = \"laminar\"\nconductance = 1e-12\n";
    let conductance = ("cross_port.conductance", [1e-13, 1e-12, 2e-12]);
    follows_the_rig(&loaded(&text(&ranges(&[region[0], region[1], conductance]), laminar, "")));
    let orifice = "[cross_port]\nkind = \"orifice\"\ndiameter = \"0.2 mm\"\n";
    let of_orifice = [
        ("cross_port.diameter", [1e-4, 2e-4, 3e-4]),
        ("cross_port.discharge_coefficient", [0.55, 0.6, 0.7]),
        ("cross_port.transition_pressure", [1e3, 1e4, 1e5]),
    ];
    follows_the_rig(&loaded(&text(&ranges(&[&region[..], &of_orifice].concat()), orifice, "")));
    let by_flow = "[cross_port]\nkind = \"orifice\"\nflow = \"0.2 L/min\"\npressure_drop = \"25 bar\"\n";
    let of_flow =
        [("cross_port.flow", [1e-6, 3.3e-6, 5e-6]), ("cross_port.pressure_drop", [20e5, 25e5, 30e5])];
    follows_the_rig(&loaded(&text(&ranges(&[&region[..2], &of_flow].concat()), by_flow, "")));
    let feedback = "[cross_port]\nkind = \"dynamic_pressure_feedback\"\ndiameter = \"0.5 mm\"\npiston_diameter = \"12 mm\"\nspring_stiffness = \"60 N/mm\"\n";
    let of_feedback = [
        of_orifice[1],
        of_orifice[2],
        ("cross_port.piston_diameter", [0.01, 0.012, 0.014]),
        ("cross_port.spring_stiffness", [4e4, 6e4, 8e4]),
    ];
    follows_the_rig(&loaded(&text(&ranges(&[&region[..], &of_feedback].concat()), feedback, "")));
    let stated =
        "[cross_port]\nkind = \"dynamic_pressure_feedback\"\nconductance = 1e-10\ncapacity = 1e-12\n";
    let of_stated =
        [("cross_port.conductance", [1e-11, 1e-10, 1e-9]), ("cross_port.capacity", [1e-13, 1e-12, 1e-11])];
    let equal = text(&ranges(&of_stated), stated, "");
    follows_the_rig(&loaded(&equal));
}

/// Relief and check valves: shut, within their transition and open over the region, alike or not at
/// both chambers.
#[test]
fn relief_and_check_valves_follow() {
    let region =
        [("operating_point.load_force", [-3000.0, 1000.0, 3500.0]), ("supply.pressure", [65e5, 70e5, 80e5])];
    let numbers = [
        ("port_valves.cracking_pressure", [30e5, 40e5, 50e5]),
        ("port_valves.override", [4e5, 5e5, 9e5]),
        ("port_valves.flow", [1e-6, 2e-6, 4e-6]),
        ("port_valves.transition_pressure", [1e4, 2e4, 2e5]),
    ];
    let both = "[port_valves]\ncracking_pressure = \"40 bar\"\noverride = \"5 bar\"\nflow = \"2 mL/s\"\ncheck_valve_pressure = \"0.5 bar\"\ntransition_pressure = \"0.2 bar\"\n";
    follows_the_rig(&loaded(&text(&ranges(&[&region[..], &numbers[..2]].concat()), both, "")));
    follows_the_rig(&loaded(&text(&ranges(&[&region[..1], &numbers[2..]].concat()), both, "")));
    let one = "[port_valves.a]\ncracking_pressure = \"40 bar\"\noverride = \"5 bar\"\nflow = \"2 mL/s\"\n";
    let of_a = [("port_valves.a.cracking_pressure", [30e5, 40e5, 50e5])];
    follows_the_rig(&loaded(&text(&ranges(&[&region[..], &of_a].concat()), one, "internal_leakage = 1e-12")));
}

/// Gas accumulators with a neck, and the numbers of both.
#[test]
fn necks_follow() {
    let gas = "[line.accumulator]\ngas_volume = \"14 mL\"\nprecharge_pressure = \"10 bar\"\nneck_diameter = \"6 mm\"\nneck_length = \"40 mm\"\n";
    let region = [
        ("operating_point.load_force", [-2000.0, 500.0, 2000.0]),
        ("line.accumulator.neck_diameter", [4e-3, 6e-3, 8e-3]),
        ("line.accumulator.neck_length", [0.02, 0.04, 0.06]),
        ("line.accumulator.gas_volume", [1e-5, 1.4e-5, 2e-5]),
        ("fluid.density", [840.0, 870.0, 900.0]),
    ];
    follows_the_rig(&loaded(&text(&ranges(&region), gas, "")));
}

/// Gas that exchanges heat, at temperatures that are uncertain too.
#[test]
fn heat_follows() {
    let gas = "[line.accumulator]\ngas_volume = \"14 mL\"\nprecharge_pressure = \"10 bar\"\nthermal_time_constant = \"2 s\"\n\
               precharge_temperature = \"20 degC\"\nworking_temperature = \"45 degC\"\n";
    let region = [
        ("operating_point.load_force", [-2000.0, 500.0, 2000.0]),
        ("line.accumulator.thermal_time_constant", [0.3, 2.0, 9.0]),
        ("line.accumulator.working_temperature", [10.0, 45.0, 70.0]),
        ("line.accumulator.precharge_temperature", [15.0, 20.0, 25.0]),
        ("line.accumulator.gas_volume", [1e-5, 1.4e-5, 2e-5]),
    ];
    follows_the_rig(&loaded(&text(&ranges(&region), gas, "")));
    let polytropic = [("line.accumulator.polytropic_exponent", [1.0, 1.2, 1.4])];
    let without = gas.replace("thermal_time_constant = \"2 s\"\n", "polytropic_exponent = 1.2\n");
    follows_the_rig(&loaded(&text(&ranges(&polytropic), &without, "")));
}

/// A cylinder with one rod: unequal areas, which are uncertain too; and a wall whose contact
/// depends on the force.
#[test]
fn unequal_areas_and_a_wall_follow() {
    let region = [
        ("operating_point.load_force", [-2000.0, 500.0, 6000.0]),
        ("operating_point.velocity", [-0.05, 0.01, 0.05]),
        ("cylinder.piston_diameter", [0.048, 0.05, 0.052]),
        ("cylinder.internal_leakage", [1e-14, 1e-13, 1e-12]),
    ];
    let text = text(&ranges(&region), "", "internal_leakage = 1e-13")
        .replace("rod_diameter = \"22 mm\"", "rod_diameters = [\"0 mm\", \"22 mm\"]");
    follows_the_rig(&loaded(&text));
    let wall = "[load]\nmodel = \"wall\"\nmass = 50\nstiffness = 1e6\ngap = 0.001\nrelative_damping = 0.2\n";
    let text = self::text(&ranges(&[region[0], ("load.stiffness", [1e5, 1e6, 1e7])]), wall, "");
    follows_the_rig(&loaded(&text));
}

/// A family that contains a point without equilibrium is rejected with the place and the reason,
/// and never silently wrong.
#[test]
fn points_without_balance_are_refused_with_their_name() {
    let refused = |lines: &[(&str, [f64; 3])]| {
        family(&Setup::new(&loaded(&text(&ranges(lines), "", ""))).unwrap(), &Memory::default())
            .unwrap_err()
            .to_string()
    };
    let far = refused(&[("operating_point.load_force", [0.0, 1000.0, 12e3])]);
    assert!(
        far.starts_with("no operating point at operating_point.load_force = 12 kN: a load force of 12000 N"),
        "{far}"
    );
    let both = [("operating_point.load_force", [0.0, 0.0, 8e3]), ("supply.pressure", [45e5, 70e5, 70e5])];
    let found = refused(&both);
    assert!(
        found.contains("operating_point.load_force = 8 kN") && found.contains("supply.pressure = 45 bar"),
        "{found}"
    );
    let sucked = refused(&[("operating_point.velocity", [0.0, 0.1, 0.8])]);
    assert!(
        sucked.contains(
            "operating_point.velocity = 800 mm/s: a load force of 0 N cannot be held at this velocity"
        ),
        "{sucked}"
    );
}

/// The refusal points to the key that names the point without equilibrium, with a remedy.
#[test]
fn a_point_without_balance_has_its_place_and_a_remedy() {
    let refused = |text: &str| {
        let source = Memory::default().with("p.toml", text);
        let loaded = project::read(&source, "p.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
        let request = Request::Verify { proof: false, on_machine: false };
        let error = command::answer(&source, &loaded, &[], &request).unwrap_err();
        let place = error.refusal().unwrap_or_else(|| panic!("{error}")).diagnostics[0].clone();
        let line = text.lines().nth(place.line - 1).unwrap().to_string();
        assert!(place.message.starts_with("no operating point at ") && place.help.is_some(), "{place:?}");
        (line, place.help.unwrap())
    };
    let region = "[family.operating_region]\nload_force = [\"0 N\", \"12 kN\"]\n";
    let (line, help) = refused(&text("", region, ""));
    assert_eq!(line, "load_force = [\"0 N\", \"12 kN\"]");
    assert!(help.contains("narrow the region"), "{help}");
    let (line, help) =
        refused(&text(&ranges(&[("operating_point.load_force", [0.0, 1000.0, 12e3])]), "", ""));
    assert!(line.starts_with("\"operating_point.load_force\""), "{line}");
    assert!(help.contains("narrow the range"), "{help}");
}

fn range<'a>(ranges: &'a [VisitedRange], name: &str) -> &'a VisitedRange {
    ranges.iter().find(|range| range.name == name).unwrap()
}

const REGION: &str = "[family.operating_region]\nposition = [\"0 mm\", \"500 mm\"]\nload_force = [\"-4 kN\", \"6 kN\"]\n\
                      velocity = [\"-1 m/s\", \"1 m/s\"]\n";

/// The region is a box of operating points limited to the flow of the pump; the box of linear
/// parameters encloses all of them.
#[test]
fn a_region_is_the_points_that_the_rig_visits() {
    let friction =
        "viscous_friction = { nominal = 100, minimum = 100, maximum = 3e4, points = 2, spacing = \"log\" }\n";
    let project = loaded(&text(friction, REGION, ""));
    let family = members(&project);
    assert_eq!(family.extent(), Extent::Box);
    // two frictions, three values of everything else, and the nominal plant, whose force is none of
    // these
    let (grid, crossings) = family.members().split_at(55);
    let command = |values: &Vec<f64>| {
        let names = family.plant().parameters().iter().map(|one| one.name.as_str());
        // every number except the friction, a parameter of the linear model
        let numbers: Vec<(&str, f64)> = names.zip(values.iter().copied()).skip(1).collect();
        let stated = Project { family: None, uncertainty: vec![], ..project.clone() };
        Setup::rig_of(&stated.with_numbers(&numbers).unwrap()).unwrap().point.command
    };
    assert!(grid.iter().all(|values| command(values).abs() > 1e-6));
    // then the plants on both sides of null
    for pair in crossings.chunks(2) {
        let [low, high] = [command(&pair[0]), command(&pair[1])];
        assert!(low * high < 0.0 && low.abs().max(high.abs()) < 1e-6, "{low} {high}");
    }
    assert!(crossings.len() >= 8, "{}", crossings.len());
    let velocity = &family.plant().parameters()[3];
    // ORIGIN: analytic, (9.8 L/min less 7.55e-6 m3/s)/A_u
    let reach = (9.8e-3 / 60.0 - 7.55e-6) / 1.583_362_697_4e-3;
    assert!((velocity.maximum / reach - 1.0).abs() < 1e-6 && velocity.minimum == -velocity.maximum);
    let ranges = visited_box(&Setup::new(&project).unwrap()).unwrap().unwrap();
    let friction = range(&ranges, "viscous_friction");
    assert_eq!((friction.minimum.value, friction.maximum.value), (100.0, 3e4));
    let mut state = 9;
    for _ in 0..300 {
        let mut drawn = |low: f64, high: f64| low + (high - low) * uniform(&mut state);
        let values: Vec<f64> =
            family.plant().parameters().iter().map(|one| drawn(one.minimum, one.maximum)).collect();
        let mut stated = project.clone();
        stated.family = None;
        stated.uncertainty.clear();
        // every number except the friction, a parameter of the linear model
        for (parameter, value) in family.plant().parameters().iter().zip(&values).skip(1) {
            stated = stated.with_number(&parameter.name, *value).unwrap();
        }
        let linear = Setup::rig_of(&stated).unwrap().linear;
        for (name, value) in [
            ("flow_gain", linear.flow_gain),
            ("flow_pressure_coefficient", linear.flow_pressure_coefficient),
            ("hydraulic_stiffness", linear.hydraulic_stiffness),
        ] {
            let range = range(&ranges, name);
            let (least, most) = (range.minimum.value, range.maximum.value);
            assert!(
                value >= least * (1.0 - 1e-9) && value <= most * (1.0 + 1e-9),
                "{name} {value} {least} {most}"
            );
        }
    }
}

/// The box of Table 6.3 is, with equal edges, the region of a pump of 19 L/min with up to two
/// thirds of the supply's pressure on the piston.
#[test]
fn the_box_of_the_thesis_is_that_of_an_operating_region() {
    let edges = "{ supply_to_a = 3e-7, a_to_tank = 3e-7, supply_to_b = 3e-7, b_to_tank = 3e-7 }";
    let leaks = "{ supply_to_a = 2.4e-9, a_to_tank = 2.4e-9, supply_to_b = 2.4e-9, b_to_tank = 2.4e-9 }";
    let settings = |flow: &str| {
        [
            format!("valve.flow_coefficients={edges}"),
            format!("valve.leakage_coefficients={leaks}"),
            format!("supply.flow={flow}"),
            "valve.tare_flow=0".to_string(),
        ]
    };
    let boxed = |flow: &str, velocity: f64| {
        let area = 1.583_362_697_4e-3;
        let force = 2.0 / 3.0 * 70e5 * area;
        let region = format!(
            "[family.operating_region]\nposition = [\"0 mm\", \"500 mm\"]\nload_force = [0, {force}]\nvelocity = [0, {velocity}]\n"
        );
        let settings = settings(flow);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let project = read(&text("", &region, ""), &settings).unwrap_or_else(|report| panic!("{report}"));
        visited_box(&Setup::new(&project).unwrap()).unwrap().unwrap()
    };
    // K_v/U_n sqrt(p_S/2) without load; divided by sqrt(3) with two thirds of the supply's pressure
    // on the piston
    let full = 3e-8 * 35e5_f64.sqrt();
    let speed = 10.0 * full / 3.0_f64.sqrt() / 1.583_362_697_4e-3;
    let rich = boxed("20 L/min", 0.999 * speed);
    // ORIGIN: Ledezma (2019), Table 6.3: 3.23e-5 to 5.61e-5, 6.42e-13 to 7e-11, 2.24e6 to 4.11e6
    let gain = range(&rich, "flow_gain");
    assert!((gain.minimum.value / 3.23e-5 - 1.0).abs() < 0.01, "{gain:?}");
    let coefficient = range(&rich, "flow_pressure_coefficient");
    assert!((coefficient.minimum.value / 6.42e-13 - 1.0).abs() < 0.01, "{coefficient:?}");
    assert!((coefficient.maximum.value / 7e-11 - 1.0).abs() < 0.03, "{coefficient:?}");
    let stiffness = range(&rich, "hydraulic_stiffness");
    assert!((stiffness.minimum.value / 2.24e6 - 1.0).abs() < 0.005, "{stiffness:?}");
    assert!((stiffness.maximum.value / 4.11e6 - 1.0).abs() < 0.001, "{stiffness:?}");
    // the pump of the rig reaches half of that coefficient
    let poor = boxed("9.8 L/min", 0.999 * speed);
    assert!(range(&poor, "flow_pressure_coefficient").maximum.value < 0.55 * 7e-11);
}

/// An invalid range is not an absent one: only its own error is reported.
#[test]
fn a_wrong_range_is_one_error() {
    for value in ["position = [\"1 kg\", 0.2]", "load_force = \"2 kN\"", "velocity = [0, \"fast\"]"] {
        let region = format!("[family.operating_region]\n{value}\n");
        let refused = read(&text("", &region, ""), &[]).unwrap_err();
        assert_eq!(refused.matches("error").count(), 1, "{refused}");
        assert!(!refused.contains("is empty"), "{refused}");
    }
}

/// Contradictions are rejected at the place where they are stated.
#[test]
fn contradictions_are_refused() {
    let refused = |uncertainty: &str, tables: &str| read(&text(uncertainty, tables, ""), &[]).unwrap_err();
    let force = "[family.operating_region]\nload_force = [0, 1000]\n";
    for (uncertainty, tables, word) in [
        ("", "[family.operating_region]\n", "is empty"),
        ("", "[family.operating_region]\nload_force = [1000, 0]\n", "is reversed"),
        ("", "[family.operating_region]\nposition = [0, 0.6]\n", "beyond the stroke"),
        (
            "",
            "[operating_point]\nload_force = 2000\n[family.operating_region]\nload_force = [0, 1000]\n",
            "outside",
        ),
        (
            "",
            "[operating_point]\ncommand = 1\n[family.operating_region]\nload_force = [0, 1000]\n",
            "determines its pressures",
        ),
        ("", "[operating_point]\nload_pressure = 1e5\nload_force = 100\n", "state only one of the two"),
        ("\"operating_point.load_force\" = { nominal = 0, minimum = 0, maximum = 1 }", force, "too"),
        ("flow_gain = { nominal = 5e-5, minimum = 4e-5, maximum = 6e-5 }", force, "both cannot be uncertain"),
    ] {
        let found = refused(uncertainty, tables);
        assert!(found.contains(word), "{word}: {found}");
    }
    let beyond = text("", "[family.operating_region]\nvelocity = [0.3, 0.5]\n", "");
    let error = family(&Setup::new(&loaded(&beyond)).unwrap(), &Memory::default()).unwrap_err().to_string();
    assert!(error.starts_with("[family.operating_region] `velocity`: the pump gives"), "{error}");
}
