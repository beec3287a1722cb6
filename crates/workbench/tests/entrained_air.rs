//! Fluid with entrained air, or gas, makes the plant depend on the pressures of its chambers: over
//! a range of supply pressures its stability is decided nevertheless.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::against_the_load::RIG;
use crate::run_command::{json, number};
use phea_workbench::command::Request;

const LOOP: &str = r#"
[load]
model = "spring_mass_damper"
mass = "250 kg"
stiffness = "15 kN/mm"
damping = "3 kN.s/m"
[uncertainty]
"supply.pressure" = { nominal = "200 bar", minimum = "180 bar", maximum = "220 bar", points = 3 }
[[specification]]
kind = "robust_stability"
limit = 1.3
frequencies = [0.1, 1, 5, 10, 20, 50, 100, 200, 400]
[controller]
sample_time = "1 ms"
delay = "1 ms"
elements = [{ kind = "pi", proportional_gain = 3e-5, integral_gain = 4.5e-5 }]
"#;

/// Air under a load and at null, gas at the chambers, and neither of them.
#[test]
fn stability_is_decided_over_a_range_of_supply_pressures() {
    let verify = Request::Verify { proof: false, on_machine: false };
    let air = "fluid.entrained_air=0.005";
    let gas = "line.accumulator={ gas_volume = \"20 mL\", precharge_pressure = \"30 bar\" }";
    let null = "operating_point={ position = \"150 mm\" }";
    let pump: &[&str] =
        &["supply.model=\"pump_limited\"", "supply.flow=\"40 L/min\"", "supply.volume=\"2 L\""];
    let [yields, moves] = [&[air][..], &[air, MOVING]].map(|own| [own, pump].concat());
    let settings: [&[&str]; 7] = [&[], &[air], &[air, null], &[gas], &yields, &[air, MOVING], &moves];
    let margins = settings.map(|settings| {
        let found = json(&format!("{RIG}{LOOP}"), settings, &[], &verify);
        assert_eq!(found["stable"], true, "{settings:?}: {found}");
        number(&found, "delay_margin_s")
    });
    // half a percent of air is three percent of the stiffness: the margin is nearly that without
    // air
    assert!((margins[1] / margins[0] - 1.0).abs() < 0.05, "{margins:?}");
    // the override of the pump's relief valve takes a fortieth of a bar of the pressure
    assert!((margins[4] / margins[1] - 1.0).abs() < 1e-2, "{margins:?}");
}

const MOVING: &str = "operating_point.velocity=\"20 mm/s\"";

/// The enclosures of the pressures are too wide while the piston moves: a search decides, and names
/// the parameters that move the leading coefficient.
#[test]
fn if_a_search_decides_the_parameters_are_named() {
    let verify = Request::Verify { proof: false, on_machine: false };
    let settings = ["fluid.entrained_air=0.005", MOVING];
    let found = json(&format!("{RIG}{LOOP}"), &settings, &[], &verify);
    let searched = &found["stability"]["leading_coefficient"];
    assert_eq!(searched["parameters"][0], "supply.pressure", "{searched}");
    // the stiffer the oil, the smaller: at the highest pressure, by one percent for so little air
    assert_eq!(searched["plant"]["supply.pressure"], 220e5, "{searched}");
    let fraction = number(searched, "least_fraction_of_nominal");
    assert!((0.95..1.0).contains(&fraction), "{searched}");
    // if the enclosures decide, nothing is searched for
    let still = json(&format!("{RIG}{LOOP}"), &settings[..1], &[], &verify);
    assert!(still["stability"]["leading_coefficient"].is_null());
}

/// Stability over other ranges, of air itself and of the force, and with a continuous controller:
/// as in a dense sample of the range.
#[test]
fn stability_is_decided_over_other_ranges_of_a_fluid_with_air() {
    let verify = Request::Verify { proof: false, on_machine: false };
    let text = format!("{RIG}{LOOP}");
    let air = "fluid.entrained_air=0.005";
    let continuous = "controller={ numerator = \"3e-5*s + 4.5e-5\", denominator = \"s\" }";
    let cases: [(&str, [f64; 2], &[&str]); 4] = [
        ("operating_point.load_force", [1e4, 6e4], &[]),
        ("fluid.entrained_air", [1e-3, 1e-2], &[]),
        ("operating_point.position", [0.05, 0.25], &[]),
        ("supply.pressure", [180e5, 220e5], &[continuous]),
    ];
    for (name, [low, high], more) in cases {
        let range = |low: f64, high: f64| {
            let nominal = 0.5 * (low + high);
            format!(
                "uncertainty={{ \"{name}\" = {{ nominal = {nominal}, minimum = {low}, maximum = {high}, points = 2 }} }}"
            )
        };
        let margin = |low: f64, high: f64| {
            let own = range(low, high);
            let found = json(&text, &[&[air, own.as_str()], more].concat(), &[], &verify);
            assert_eq!(found["stable"], true, "{name}: {found}");
            number(&found, "delay_margin_s")
        };
        let whole = margin(low, high);
        let pieces = [0.0, 0.25, 0.5, 0.75].map(|part| {
            let at = |part: f64| low + part * (high - low);
            margin(at(part), at(part + 0.25))
        });
        let least = pieces.into_iter().fold(f64::INFINITY, f64::min);
        assert!((whole / least - 1.0).abs() < 1e-3, "{name}: {whole} {pieces:?}");
    }
}
