//! The rigs on which every key is changed.

use phea_workbench::project::{KeyEntry, Project};

const SIMULATION: &str = include_str!("../../../project/tests/valid/simulation.toml");
const ACCUMULATORS: &str = include_str!("../../../project/tests/valid/accumulators.toml");
const NECK: &str = include_str!("../../../project/tests/valid/accumulator_neck.toml");
const HEAT: &str = include_str!("../../../project/tests/valid/accumulator_heat.toml");
const PORT_VALVES: &str = include_str!("../../../project/tests/valid/port_valves.toml");
const CROSS_PORT: &str = include_str!("../../../project/tests/valid/cross_port.toml");
const SERIES: &str = include_str!("../../../project/tests/valid/series.toml");
const SERIES_COIL: &str = include_str!("../../../project/tests/valid/series_coil.toml");
const TRANSMISSION: &str = include_str!("../../../project/tests/valid/transmission.toml");
const TRANSMISSION_PIPE: &str = include_str!("../../../project/tests/valid/transmission_pipe.toml");
const VOLUMES: &str = include_str!("../../../project/tests/valid/volumes.toml");
const LINKAGE: &str = include_str!("../../../project/tests/valid/linkage.toml");
const WEIGHT: &str = include_str!("../../../project/tests/valid/linkage_weight.toml");
const FOUR_BAR: &str = include_str!("../../../project/tests/valid/linkage_four_bar.toml");
const ANGLES: &str = include_str!("../../../project/tests/valid/linkage_table.toml");
const MOTOR: &str = include_str!("../../../project/tests/valid/motor.toml");
const TURNING: &str = include_str!("../../../project/tests/valid/motor_turning.toml");
const TELESCOPIC: &str = include_str!("../../../project/tests/valid/telescopic.toml");
const ASYMMETRIC: &str = include_str!("../../../project/tests/valid/asymmetric.toml");

/// Converters that round in the computer of a controller.
const CONVERTERS: [&str; 2] = [
    "controller.sample_time=1 ms",
    "controller.quantization={ command_bits = 10, command_range = [\"-10 V\", \"10 V\"], measurement_bits = 10, measurement_range = [\"-10 kN\", \"10 kN\"] }",
];

/// Loads that move under force.
const SPRUNG: [&str; 4] =
    ["load.model=spring_mass_damper", "load.mass=100", "load.stiffness=2e5", "load.damping=500"];
const WALL: [&str; 5] =
    ["load.model=wall", "load.mass=10", "load.stiffness=1e6", "load.damping=10", "load.gap=0.001"];
/// A sensor of the load's velocity.
const SHOWN: &str = "velocity_sensor={ gain_error = \"2 %\", delay = \"1 ms\", filter_frequency = \"200 Hz\", filter_damping_ratio = 0.7, noise = \"1 mm/s\", resolution = \"0.1 mm/s\" }";

/// A virtual impedance.
const IMPEDANCE: &str = "controller.impedance={ stiffness = \"100 kN/m\", damping = \"2 kN.s/m\", mass = \"20 kg\", filter_time = \"2 ms\" }";

/// Leakage with a different shape at each edge.
const LEAKING_BY_EDGE: &str =
    "valve.leakage_shapes={ supply_to_a = 100, a_to_tank = 90, supply_to_b = 110, b_to_tank = 100 }";

/// Edges that underlap.
const LAPPED: &str = "valve.lap={ positive = -0.002, negative = -0.001 }";

/// A cylinder of unequal areas.
const UNEQUAL: &str = "cylinder={ piston_diameter = \"50 mm\", rod_diameters = [\"0 mm\", \"36 mm\"], stroke = \"500 mm\", moving_mass = \"13.1 kg\" }";

/// Pressures that are fed back.
const FED_BACK: &str = "controller.pressure_feedback={ gain = \"0.02 V/bar\", area_ratio = 0.9, high_pass = \"1 Hz\", low_pass = \"100 Hz\" }";

/// The controller by zeros, poles and gain.
fn factored(hose: &str) -> String {
    hose.replace(
        "numerator = \"0.001*s + 0.008\"\ndenominator = \"s\"",
        "gain = 0.001\nzeros = [-8]\npoles = [0]",
    )
    .replace("numerator = \"910\"\ndenominator = \"s^2 + 83*s + 910\"", "gain = 910\npoles = [-12.9, -70.1]")
}

/// Rigs that together have every key: examples, the projects of other tests, and variants with
/// other words.
pub(super) fn rigs() -> Vec<(String, Vec<&'static str>)> {
    let hose = || without_family(include_str!("../../../../examples/ybitu/hose.toml"));
    let pipe = || without_family(include_str!("../../../../examples/ybitu/pipe.toml"));
    let two_wave = ["line.model=two_wave", "line.wall={ mass_per_length = 0.21, axial_compliance = 1e-5 }"];
    let wall_of_two =
        ["line.wall.coupling_compliance=-1e-5", "line.wall.pressure_compliance=3e-9", "line.end_share=0.02"];
    let factored = factored(&hose());
    let sampled = [
        "controller.sample_time=1 ms",
        "controller.delay=0.5 ms",
        "controller.load_velocity_feed_forward={ gain = 20 }",
    ];
    let others = vec![
        (hose(), vec![]),
        (hose(), [&SPRUNG[..], &["line.compliance=by_volume"]].concat()),
        (hose(), [&two_wave[..], &wall_of_two].concat()),
        (
            hose(),
            vec![
                "line.model=segments",
                "line.segments=3",
                "line.relaxation_time=1 ms",
                "line.friction=steady",
            ],
        ),
        (hose(), sampled.to_vec()),
        (hose(), vec!["controller.sample_time=1 ms", "controller.discretization_frequency=100 rad/s"]),
        (hose(), vec!["controller.load_velocity_feed_forward={ gain = 20 }"]),
        (hose(), [&sampled[..], &[SHOWN]].concat()),
        (hose(), [&SPRUNG[..], &["controller.load_velocity_feed_forward={ gain = 20 }", SHOWN]].concat()),
        (hose(), vec![IMPEDANCE]),
        (hose(), vec![LEAKING_BY_EDGE, LAPPED, "operating_point.load_force=500"]),
        (hose(), vec![FED_BACK]),
        (hose(), vec![FED_BACK, "controller.sample_time=1 ms", "controller.pressure_feedback.noise=0.1 bar"]),
        (hose(), CONVERTERS.to_vec()),
        (factored, vec![]),
        (pipe(), [&WALL[..], &["load.relative_damping=0.1"]].concat()),
        (
            pipe(),
            vec!["line.compliance=by_volume", "operating_point.command=0.5", "fluid.entrained_air=0.01"],
        ),
        (hose(), vec!["series={ stiffness = \"2 MN/m\", damping = 100 }", "line.working_pressure=250 bar"]),
        (ASYMMETRIC.to_string(), vec!["cylinder.friction.regular_velocity=1 mm/s"]),
        (hose(), vec![UNEQUAL, "controller.pressure_feedback={ gain = \"0.02 V/bar\" }"]),
        (VOLUMES.split("[uncertainty]").next().unwrap().to_string(), vec!["load.mass=10"]),
        (
            pipe(),
            vec![
                "line.pipe={ bore = \"10.5 mm\", wall_thickness = \"2.75 mm\", youngs_modulus = \"206 GPa\", working_pressure = \"280 bar\" }",
            ],
        ),
    ];
    others
        .into_iter()
        .chain(with_accumulators())
        .chain(between_chambers(hose(), pipe()))
        .chain(on_springs())
        .collect()
}

/// Rigs with accumulators, the machine without them, and a telescopic one.
fn with_accumulators() -> Vec<(String, Vec<&'static str>)> {
    vec![
        (TELESCOPIC.to_string(), vec![]),
        (SIMULATION.to_string(), vec![]),
        (ACCUMULATORS.to_string(), vec![]),
        (NECK.to_string(), vec![]),
        (
            NECK.to_string(),
            vec![
                "line.accumulator={ gas_volume = \"14 mL\", precharge_pressure = \"15 bar\", adjustment = { kind = \"gas\", gas_volume = \"20 mL\", precharge_pressure = \"12 bar\", setting = 0.25 } }",
            ],
        ),
        (
            NECK.to_string(),
            vec![
                "line.accumulator={ gas_volume = \"14 mL\", precharge_pressure = \"15 bar\", adjustment = { kind = \"valve\", diameter = \"3 mm\", discharge_coefficient = 0.7, setting = 0.5 } }",
            ],
        ),
        (
            NECK.to_string(),
            vec![
                "line.accumulator={ gas_volume = \"14 mL\", precharge_pressure = \"15 bar\", adjustment = { kind = \"valve\", flow = \"20 L/min\", pressure_drop = \"5 bar\", transition_pressure = \"0.1 bar\", dead_volume = \"0.2 mL\", setting = 0.5 } }",
            ],
        ),
        (SIMULATION.to_string(), vec!["operating_point.load_force=2 kN"]),
        (SIMULATION.to_string(), vec!["cylinder.dead_volume=30 mL"]),
        (
            SIMULATION.to_string(),
            vec![
                "cylinder.friction.retracting={ coulomb = \"95 N\", static = \"150 N\", viscous = \"120 N.s/m\" }",
            ],
        ),
        (HEAT.to_string(), vec![]),
        (
            HEAT.to_string(),
            vec![
                "line.accumulator.precharge_temperature=20 degC",
                "line.accumulator.working_temperature=45 degC",
            ],
        ),
    ]
}

/// Rigs with a spring on the rod, and with a motor instead of the cylinder.
fn on_springs() -> Vec<(String, Vec<&'static str>)> {
    let springs = [
        (without_uncertainty(SERIES), vec!["operating_point.load_force=2 kN"]),
        (without_uncertainty(SERIES_COIL), vec![]),
        (
            without_uncertainty(TRANSMISSION),
            vec!["fluid.kinematic_viscosity=46 cSt", "cylinder.dead_length=300 mm"],
        ),
        // the mass of the line follows from that of its wall
        (
            TRANSMISSION_PIPE.replace(
                "mass = \"0.4 kg\"\nmass_per_length = \"0.3 kg/m\"",
                "working_pressure = \"280 bar\"",
            ),
            vec![],
        ),
        (ASYMMETRIC.to_string(), vec!["series={ stiffness = \"20 MN/m\" }"]),
    ];
    springs.into_iter().chain(with_motors()).chain(with_linkages()).collect()
}

/// Rigs with a linkage between rod and load.
fn with_linkages() -> Vec<(String, Vec<&'static str>)> {
    vec![
        (without_uncertainty(LINKAGE), vec![]),
        (FOUR_BAR.to_string(), vec!["operating_point.load_force=2 kN"]),
        (ANGLES.to_string(), vec![]),
        (without_uncertainty(WEIGHT), vec![]),
        (
            ANGLES.to_string(),
            vec![
                "load={ model = \"spring_mass_damper\", mass = 0.6, stiffness = 900, damping = 8 }",
                "operating_point.load_force=2 kN",
            ],
        ),
    ]
}

/// Rigs with a motor instead of the cylinder.
fn with_motors() -> Vec<(String, Vec<&'static str>)> {
    let vane = without_uncertainty(&MOTOR.replace("moving_mass = \"0.03 kg.m2\"", ""));
    vec![(vane, vec![]), (TURNING.to_string(), vec![])]
}

/// Rigs with a valve between the chambers.
fn between_chambers(hose: String, pipe: String) -> Vec<(String, Vec<&'static str>)> {
    vec![
        (CROSS_PORT.to_string(), vec![]),
        (PORT_VALVES.to_string(), vec!["port_valves.cracking_pressure=20 bar"]),
        (
            hose,
            vec![
                "cross_port={ kind = \"orifice\", flow = \"0.2 L/min\", pressure_drop = \"25 bar\" }",
                "operating_point.load_force=2 kN",
            ],
        ),
        (ASYMMETRIC.to_string(), vec!["cross_port={ kind = \"laminar\", conductance = 1e-12 }"]),
        (
            ASYMMETRIC.to_string(),
            vec!["cross_port={ kind = \"orifice\", flow = \"0.2 L/min\", pressure_drop = \"25 bar\" }"],
        ),
        (
            ASYMMETRIC.to_string(),
            vec!["cross_port={ kind = \"orifice\", diameter = \"0.5 mm\", discharge_coefficient = 0.62 }"],
        ),
        (
            pipe,
            vec![
                "cross_port={ kind = \"dynamic_pressure_feedback\", conductance = 1e-10, capacity = 1e-12 }",
            ],
        ),
    ]
}

/// The rig without its stated linear model.
fn without_family(text: &str) -> String {
    let (before, rest) = text.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    format!("{before}[[specification]]{after}")
}

/// The rig without its uncertainty.
fn without_uncertainty(text: &str) -> String {
    let (before, rest) = text.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[controller]").unwrap();
    format!("{before}[controller]{after}")
}

/// Values of keys that may be absent, or are not numbers.
const STATED: [(&str, &str); 91] = [
    ("cross_port.mass", "1 kg"),
    ("cross_port.price", "100 EUR"),
    ("port_valves.mass", "1 kg"),
    ("port_valves.price", "100 EUR"),
    ("line.accumulator.mass", "1 kg"),
    ("line.accumulator.price", "100 EUR"),
    ("line.mass", "1 kg"),
    ("line.mass_per_length", "1 kg/m"),
    ("line.price", "100 EUR"),
    ("line.price_per_length", "100 EUR/m"),
    ("line.pipe.burst_pressure", "900 bar"),
    ("line.pipe.mass", "1 kg"),
    ("line.pipe.mass_per_length", "1 kg/m"),
    ("line.pipe.price", "100 EUR"),
    ("line.pipe.price_per_length", "100 EUR/m"),
    ("line.pipe.outer_diameter", "16 mm"),
    ("line.pipe.wall_density", "7850 kg/m3"),
    ("line.pipe.working_pressure", "300 bar"),
    ("series.price", "100 EUR"),
    ("series.spring_mass", "1 kg"),
    ("series.segments", "4"),
    ("series.line.dynamic_stiffening", "4.8"),
    ("series.line.price", "100 EUR"),
    ("series.line.price_per_length", "100 EUR/m"),
    ("series.line.pipe.burst_pressure", "900 bar"),
    ("series.line.pipe.outer_diameter", "16 mm"),
    ("series.line.pipe.working_pressure", "300 bar"),
    ("series.line.pipe.mass", "0.4 kg"),
    ("series.line.pipe.mass_per_length", "0.3 kg/m"),
    ("series.line.pipe.price", "100 EUR"),
    ("series.line.pipe.price_per_length", "100 EUR/m"),
    ("valve.mass", "1 kg"),
    ("valve.price", "100 EUR"),
    ("linkage.extensions", "[0, 0.0205, 0.04, 0.06, 0.08]"),
    ("linkage.angles", "[0.08, 0.5, 0.95, 1.4, 1.9]"),
    ("operating_point.position", "200 mm"),
    ("operating_point.command", "1 V"),
    ("operating_point.load_pressure", "10 bar"),
    ("operating_point.load_force", "2 kN"),
    ("operating_point.velocity", "20 mm/s"),
    ("operating_point.spool_side", "1"),
    ("controller.numerator", "0.002*s + 0.01"),
    ("controller.denominator", "s*(0.001*s + 1)"),
    ("controller.gain", "0.002"),
    ("controller.zeros", "[-9]"),
    ("controller.poles", "[0, -900]"),
    ("controller.saturation", "9 V"),
    ("controller.sample_time", "2 ms"),
    ("controller.delay", "1 ms"),
    ("controller.discretization_frequency", "120 rad/s"),
    ("controller.load_velocity_feed_forward.gain", "21"),
    ("controller.impedance.stiffness", "101 kN/m"),
    ("controller.impedance.damping", "2.1 kN.s/m"),
    ("controller.impedance.mass", "21 kg"),
    ("controller.impedance.filter_time", "2.1 ms"),
    ("controller.pressure_feedback.gain", "0.03 V/bar"),
    ("controller.pressure_feedback.area_ratio", "0.8"),
    ("controller.pressure_feedback.high_pass", "2 Hz"),
    ("controller.pressure_feedback.low_pass", "90 Hz"),
    ("controller.pressure_feedback.noise", "0.2 bar"),
    ("controller.quantization.command_bits", "9"),
    ("controller.quantization.command_range", "[\"-9 V\", \"9 V\"]"),
    ("controller.quantization.measurement_bits", "9"),
    ("controller.quantization.measurement_range", "[\"-9 kN\", \"9 kN\"]"),
    ("prefilter.numerator", "900"),
    ("prefilter.denominator", "s^2 + 80*s + 900"),
    ("prefilter.gain", "900"),
    ("prefilter.zeros", "[-100]"),
    ("prefilter.poles", "[-10, -80]"),
    ("cylinder.internal_leakage", "1e-12"),
    ("fluid.kinematic_viscosity", "30 mm2/s"),
    ("valve.rate_limit", "100 V/s"),
    ("line.segments", "4"),
    ("line.dynamic_stiffening", "4.8"),
    ("line.pipe.wall_thickness", "3 mm"),
    ("line.pipe.youngs_modulus", "190 GPa"),
    ("line.volume", "2e-4"),
    ("line.effective_bulk_modulus", "8e8"),
    ("cylinder.dead_length", "300 mm"),
    ("line.minimum_bend_radius", "150 mm"),
    ("line.working_pressure", "260 bar"),
    ("line.burst_pressure", "1200 bar"),
    ("linear.viscous_friction", "150"),
    ("linear.flow_gain", "5e-5"),
    ("linear.flow_pressure_coefficient", "6e-13"),
    ("linear.hydraulic_stiffness", "3e6"),
    ("linear.valve_natural_frequency", "1000"),
    ("linear.valve_damping_ratio", "0.8"),
    ("linear.moving_mass", "15"),
    ("linear.piston_area", "1.6e-3"),
    ("linear.sensor_stiffness", "1.5e7"),
];

/// Other values of a key that the rig states: each other word, a number a hundredth larger or, if
/// that is rejected, smaller; true if one accepted value is enough.
pub(super) fn others(entry: &KeyEntry, project: &Project) -> (Vec<String>, bool) {
    if let Some(words) = entry.takes.strip_prefix("one of ") {
        return (words.split(", ").map(|word| word.trim_matches('"').to_string()).collect(), false);
    }
    if entry.takes == "true or false" {
        return (vec!["true".to_string(), "false".to_string()], false);
    }
    let values = match stated(entry, project) {
        Some(0.0) => vec!["1e-3".to_string()],
        Some(value) => vec![format!("{:?}", value * 1.01), format!("{:?}", value * 0.99)],
        None => {
            let stated = STATED.iter().filter(|(path, _)| *path == entry.path);
            stated.map(|(_, value)| (*value).to_string()).collect()
        }
    };
    (values, true)
}

/// The number that a rig states, that of side A if it states one for each side.
pub(super) fn stated(entry: &KeyEntry, project: &Project) -> Option<f64> {
    let of_one_side = || {
        let (table, rest) = entry.path.split_once('.')?;
        let has_sides = matches!(table, "line" | "port_valves");
        has_sides.then(|| project.number(&format!("{table}.a.{rest}")))?
    };
    project.number(&entry.path).or_else(of_one_side)
}

/// Tables that a rig may lack, with keys that are rejected in that case.
const TABLES: [&str; 9] = [
    "series.",
    "cross_port.",
    "port_valves.",
    "linkage.",
    "motor.",
    "velocity_sensor.",
    "line.accumulator.",
    "line.pipe.",
    "supply.accumulator.",
];

/// Tables of which a rig states no number.
pub(super) fn absent_tables(keys: &[KeyEntry], project: &Project) -> Vec<&'static str> {
    let has = |table: &str| {
        keys.iter().any(|entry| entry.path.starts_with(table) && stated(entry, project).is_some())
    };
    TABLES.into_iter().filter(|table| !has(table)).collect()
}

/// True if a key is in one of these tables.
pub(super) fn is_within(entry: &KeyEntry, tables: &[&str]) -> bool {
    tables.iter().any(|table| entry.path.starts_with(table))
}
