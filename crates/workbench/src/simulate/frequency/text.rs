//! What a frequency response says to people.

use phea_dynamics::portable;

use super::{FrequencyResponse, Response, ResponsePoint};
use crate::answer::{significant, table};
use crate::quantity::{FORCE, LENGTH, VOLTAGE, display};

/// The tables and sentences of a frequency response.
pub(crate) fn text(found: &FrequencyResponse) -> String {
    let position = display(found.position_m, &LENGTH, 4);
    let (force, command) = (display(found.force_n, &FORCE, 4), display(found.command_v, &VOLTAGE, 4));
    let mut out = format!("Around rest at {position}, {force} on the load, a command of {command}.\n");
    out.push_str("\nOpen loop, from command to force, dB re 1 N/V\n");
    out.push_str(&response(&found.open_loop, "V"));
    match &found.closed_loop {
        Ok(closed) => {
            out.push_str("\nClosed loop, from reference to force\n");
            out.push_str(&response(closed, "N"));
        }
        Err(reason) => out.push_str(&format!("\nNo closed loop: {reason}.\n")),
    }
    if found.stopped {
        out.push_str("Stopped before its end.\n");
    }
    out
}

fn response(response: &Response, unit: &str) -> String {
    let with_machine = response.points.iter().any(|point| point.linearised_machine.is_some());
    let amplitude = format!("amplitude, {unit}");
    let mut heads = vec!["rad/s", &amplitude, "machine, dB", "phase, deg", "less linear plant, dB", "deg"];
    if with_machine {
        heads.extend(["less linearised machine, dB", "deg"]);
    }
    heads.extend(["distortion, %", "periods"]);
    let mut rows = table(&heads);
    for point in &response.points {
        let [decibels, degrees] = own(point);
        let mut cells = vec![
            significant(point.frequency_rad_per_s, 4),
            significant(point.amplitude, 3),
            rounded(decibels, 2),
            rounded(degrees, 1),
        ];
        let mut differences = vec![Some(point.linear_plant)];
        if with_machine {
            differences.push(point.linearised_machine);
        }
        for model in differences {
            let [decibels, degrees] = model.map_or([f64::NAN; 2], |model| point.differs(model));
            cells.extend([rounded(decibels, 3), rounded(degrees, 2)]);
        }
        cells.extend([rounded(100.0 * point.distortion, 2), point.periods.to_string()]);
        rows.add_row(cells);
    }
    let mut out = format!("{}\n", rows.trim_fmt());
    for point in &response.points {
        out.extend(remark(point).map(|sentence| format!("  {sentence}\n")));
    }
    out
}

/// Magnitude in dB and phase in degrees of the machine, the phase near that of the linear plant.
pub(super) fn own(point: &ResponsePoint) -> [f64; 2] {
    let [_, degrees] = point.differs(point.linear_plant);
    let plant = portable::argument(point.linear_plant).to_degrees();
    // what lies a whole turn below is told as such by the curves; here the principal value of the model leads
    [20.0 * portable::log10(portable::magnitude(point.machine)), plant + degrees]
}

/// What a reader should know of a point.
fn remark(point: &ResponsePoint) -> Option<String> {
    let at = significant(point.frequency_rad_per_s, 4);
    if let Some(word) = point.ended {
        return Some(format!("{at} rad/s: the simulation ended before the force settled ({word})"));
    }
    if !point.settled {
        let percent = significant(100.0 * point.change, 2);
        return Some(format!("{at} rad/s: not settled, the last two windows differ by {percent} %"));
    }
    (!point.reached.is_empty()).then(|| {
        format!("{at} rad/s: {} on the way, so that this is no small motion", point.reached.join(", "))
    })
}

fn rounded(value: f64, digits: usize) -> String {
    if value.is_finite() {
        let text = format!("{value:.digits$}");
        // no minus sign before zero
        if text.trim_start_matches('-').trim_matches(['0', '.']).is_empty() {
            text.replace('-', "")
        } else {
            text
        }
    } else {
        "-".to_string()
    }
}
