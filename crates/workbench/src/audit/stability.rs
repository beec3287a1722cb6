//! Stability in words: the finding, the method, and the reason if it is undecided.

use phea_qft::stability::{Instability, Irresolution};
use phea_qft::verification::{
    ClosestApproach, Evidence, SearchedInfinity, StabilityFinding, StabilityMethod, StabilityReason, Verdict,
};

use super::words::rounded;
use crate::plant_names::{PlantNames, plant_text};
use crate::quantity::significant;

/// Sentence on the stability of the family and its evidence.
pub(crate) fn stability_sentence(stability: &StabilityFinding, names: &PlantNames) -> String {
    let plant = match &stability.reason {
        StabilityReason::AllStable { closest: Some(closest), .. } => plant_text(names, &closest.plant),
        _ => plant_text(names, &stability.plant),
    };
    let rate = |value: f64| significant(value, 3);
    match (stability.verdict, stability.largest_real_part) {
        (Verdict::Met, Some(real)) => {
            format!("every plant is stable; the slowest closed-loop pole lies at {} 1/s", rate(real))
        }
        (Verdict::Met, None) => format!("every plant is stable: {}", stability_reason(stability)),
        (Verdict::Violated, Some(real)) if real >= 0.0 => {
            format!("unstable: a closed-loop pole lies at {} 1/s, with {plant}", rate(real))
        }
        (Verdict::Violated, _) => format!("unstable, with {plant}: {}", stability_reason(stability)),
        (Verdict::NotProven, _) => {
            let moved = match &stability.reason {
                StabilityReason::NotResolved(Irresolution::InfinityOpen(found)) => {
                    format!("; what moves it: {}", moving_words(found, names))
                }
                _ => String::new(),
            };
            format!("stability is not proven: {} ({plant}{moved})", stability_reason(stability))
        }
    }
}

/// The evidence that no pole passes through infinity inside the box, if it comes from a search.
pub(super) fn infinity_sentence(stability: &StabilityFinding, names: &PlantNames) -> Option<String> {
    let found = stability.infinity.as_ref()?;
    Some(format!(
        "That no pole passes through infinity inside the box was searched for, since the enclosures of the leading \
         coefficient are too wide there: it falls to {} of its nominal value at least ({}) and depends on {}.",
        significant(found.least_fraction, 3),
        plant_text(names, &found.plant),
        moving_words(found, names)
    ))
}

/// The names of the parameters that move a leading coefficient.
fn moving_words(found: &SearchedInfinity, names: &PlantNames) -> String {
    let all = names.headings();
    let named: Vec<&str> = found.parameters.iter().filter_map(|&index| all.get(index).copied()).collect();
    if named.is_empty() { "no single parameter".to_string() } else { named.join(", ") }
}

/// Method by which stability was decided.
pub(crate) fn stability_reason(stability: &StabilityFinding) -> String {
    match &stability.reason {
        StabilityReason::Unstable(instability) => instability_words(*instability),
        StabilityReason::UnstablePrefilter => "the prefilter itself is unstable".to_owned(),
        StabilityReason::NotResolved(irresolution) => irresolution_words(irresolution),
        StabilityReason::AllStable { members, corners, between, method, closest } => {
            let folding = match between {
                0 => String::new(),
                _ => format!(" and {between} plants between them, through which modes fold,"),
            };
            let way = method_words(*method);
            let stable = match (members, corners + between) {
                (1, 0) => format!("the family is one plant, stable {way}"),
                (_, 0) => format!("all {members} plants are stable {way}"),
                (1, _) => format!("the member and {corners} corners of the box{folding} are stable {way}"),
                _ => format!(
                    "all {members} members and {corners} corners of the box{folding} are stable {way}"
                ),
            };
            let Some(ClosestApproach { distance, frequency_rad_per_s, .. }) = closest else { return stable };
            let between = if stability.evidence == Evidence::Search { " between them, too," } else { "" };
            let [distance, frequency] = [*distance, *frequency_rad_per_s].map(rounded);
            format!("{stable}; the smallest |1 + L| found{between} is {distance} (at {frequency} rad/s)")
        }
    }
}

fn method_words(method: StabilityMethod) -> &'static str {
    match method {
        StabilityMethod::Poles => "by their closed-loop poles",
        StabilityMethod::Turns => "by the turns of their characteristic function",
        StabilityMethod::Enclosed => {
            "by Nyquist's count, 1 + L of the nominal plant enclosed from each frequency to the next"
        }
        StabilityMethod::Points => "by Nyquist's count on points of their responses",
        StabilityMethod::MeasuredPoints => "by Nyquist's count on the points of their responses",
    }
}

fn instability_words(instability: Instability) -> String {
    match instability {
        Instability::Pole { real_part } => {
            format!("a closed-loop pole has the real part {real_part:.3e} 1/s")
        }
        Instability::Poles { count } => {
            format!("{count} unstable closed-loop pole{}", if count == 1 { "" } else { "s" })
        }
        Instability::GainAtInfinity => {
            "dead time in a loop whose gain stays above one at every high frequency".to_string()
        }
    }
}

fn irresolution_words(irresolution: &Irresolution) -> String {
    match irresolution {
        Irresolution::Linear(error) => error.to_string(),
        Irresolution::NearBoundary { frequency_rad_per_s } => format!(
                "a closed-loop pole near {} rad/s cannot be distinguished from the boundary of stability",
                rounded(*frequency_rad_per_s)
            ),
        Irresolution::Budget { frequency_rad_per_s } => format!(
                "the turns of the characteristic function could not be counted beyond {} rad/s",
                rounded(*frequency_rad_per_s)
            ),
        Irresolution::Coarse { from_rad_per_s, to_rad_per_s, turn_deg } => format!(
                "1 + L turns by {turn_deg:.0} degrees between {} and {} rad/s; the measurement is too coarse there",
                rounded(*from_rad_per_s),
                rounded(*to_rad_per_s)
            ),
        Irresolution::HighEnd { frequency_rad_per_s, gain } => format!(
                "the response is known up to {} rad/s, where |L| = {gain:.2} is not well below one",
                rounded(*frequency_rad_per_s)
            ),
        Irresolution::LowEnd { frequency_rad_per_s, slope } => {
            let begins = rounded(*frequency_rad_per_s);
            let slope = slope.map_or(String::new(), |[low, high]| {
                format!(" (|L| follows w to the power {low:.2} to {high:.2} there)")
            });
            format!("below {begins} rad/s, where the measurement begins, the loop's integrators cannot be identified{slope}: points over a factor of two must show them, or `integrators` in [family] states them")
        }
        Irresolution::Integrators { frequency_rad_per_s, integrators } => format!(
                "the slope of |L| above {} rad/s contradicts the {integrators} integrators that `integrators` in [family] makes of the loop",
                rounded(*frequency_rad_per_s)
            ),
        Irresolution::Confidence { frequency_rad_per_s, distance, radius } => format!(
                "at {} rad/s |1 + L| = {distance:.3}, and the confidence disc of the measurement has the radius {radius:.3} there: it decides on neither side of -1",
                rounded(*frequency_rad_per_s)
            ),
        Irresolution::Count { count } => format!(
                "the turns of 1 + L add up to {count:.2} unstable poles, which is not a number of poles"
            ),
        Irresolution::GainAtInfinity => {
            "with dead time and a gain of one at infinite frequency, poles approach the boundary of stability".to_string()
        }
        Irresolution::PoleThroughInfinity => {
            "the leading coefficient of the characteristic equation changes its sign inside the box, so that a pole passes through infinity".to_string()
        }
        Irresolution::Folding => {
            "modes beyond half of the sampling rate pass through the band while parameters move, too often to be followed".to_string()
        }
        Irresolution::FoldingUnknown => {
            "which modes beyond half of the sampling rate fold into the band between one plant and the next is not known where lines move".to_string()
        }
        Irresolution::InfinityOpen(found) => format!(
                "it could not be shown that no pole passes through infinity inside the box: the leading coefficient of the characteristic equation falls to {} of its nominal value",
                rounded(found.least_fraction)
            ),
        Irresolution::UndampedController => {
            "controller or sensor has poles on the boundary of stability, which measured points cannot go around".to_string()
        }
        Irresolution::OpenLoopPoles => "how many unstable poles the plant has by itself is not known".to_string(),
        Irresolution::Points => "there are fewer than two points to count turns between".to_string(),
    }
}
