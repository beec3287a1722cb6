//! Listed sources of the parameters of the linear model, compared with the effects of changing a
//! number.

use phea_workbench::project::KeyEntry;

use super::{LINEAR_PARAMETERS, Moved};

/// Relative change of a parameter above which a change of a number by a hundredth counts.
const COUNTS: f64 = 1e-3;

/// Numbers that are not listed although they change a parameter: a range of the parameter does not
/// count their uncertainty twice.
const NOT_LISTED: &[(&str, &[&str])] = &[
    // through the pressures of the operating point and the command that holds it
    ("flow_gain", &["cylinder.internal_leakage", "cylinder.piston_diameter", "operating_point.position"]),
    ("flow_gain", &["port_valves.cracking_pressure", "port_valves.flow", "port_valves.override"]),
    (
        "flow_pressure_coefficient",
        &[
            "cross_port.flow",
            "cylinder.internal_leakage",
            "cylinder.piston_diameter",
            "cylinder.rod_diameter",
            "operating_point.position",
            "port_valves.cracking_pressure",
            "port_valves.flow",
            "port_valves.override",
            "port_valves.transition_pressure",
        ],
    ),
    (
        "hydraulic_stiffness",
        &[
            "operating_point.command",
            "operating_point.load_force",
            "operating_point.load_pressure",
            "operating_point.velocity",
            "valve.tare_flow",
        ],
    ),
    // stated K_qU has no sides
    ("flow_gain", &["operating_point.spool_side"]),
    // through the stiffnesses by which the flows of both chambers are weighted
    ("flow_gain", &["cylinder.stroke", "line.length"]),
    // only for a telescopic cylinder
    ("piston_area", &["operating_point.position"]),
];

/// Numbers that are listed but change nothing if the spool is on the other side of null.
const OF_THE_OTHER_SIDE: [&str; 2] =
    ["valve.flow_coefficients.a_to_tank", "valve.flow_coefficients.supply_to_b"];

/// Every listed number changes the parameter on some rig, and every number whose relative effect on
/// it is a tenth or more is listed.
pub(super) fn linear_parameters_follow_from_what_is_listed(moved: &Moved, keys: &[KeyEntry]) {
    let is_number =
        |path: &str| keys.iter().any(|entry| entry.path == path && entry.takes == entry.key.dimension.name);
    let mut wrong = Vec::new();
    for parameter in &LINEAR_PARAMETERS {
        let name = parameter.key.name;
        for (path, changes) in moved.iter().filter(|(path, _)| is_number(path)) {
            let change = changes.linear.get(name).copied().unwrap_or(0.0);
            let apart = NOT_LISTED.iter().any(|(of, paths)| *of == name && paths.contains(&path.as_str()));
            let other_side = OF_THE_OTHER_SIDE.contains(&path.as_str());
            match parameter.follows_from(path) {
                true if change == 0.0 && !other_side => {
                    wrong.push(format!("{name} does not depend on {path}"))
                }
                true if apart => wrong.push(format!("{name} is listed twice with {path}")),
                false if change > COUNTS && !apart => {
                    wrong.push(format!("{name} depends on {path}: {change:.1e}"))
                }
                _ => {}
            }
        }
        let unknown = parameter.depends_on.iter().filter(|path| !moved.contains_key(**path));
        wrong.extend(unknown.map(|path| format!("{name} is listed with {path}, which no rig states")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
