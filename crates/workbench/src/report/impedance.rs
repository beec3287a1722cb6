//! The chapter on the driving-point impedance: the impedance at the load, its asymptotes, and
//! passivity.

use phea_dynamics::linear::LinearError;
use phea_dynamics::time_response::TimeResponseError;
use phea_engineering::linearize::{HidingMass, Linearization, PortView, frequency_grid};
use phea_engineering::setup::Setup;
use phea_hydraulics::impedance::AsymptoteKind;

use super::chapter::Chapter;
use super::load_motion::{self, Moved, what_moves};
use crate::answer::significant;
use crate::document::{Document, Table};
use crate::figure::{AsymptoteLine, Figure, FrequencyMark, FrequencySeries, ImpedanceDiagram, Words};
use crate::linearize::{
    hiding_mass_words, impedance_at_joint, no_closed_impedance_words, passivity_sentence,
    required_impedance_sentence, required_impedance_table,
};
use crate::project::DeclaredSeries;
use crate::quantity::{DAMPING, DisplayUnit, MASS, MotionKind, STIFFNESS};

pub(super) fn chapter(
    setup: &Setup<'_>,
    linearization: &Linearization,
) -> Result<Chapter, TimeResponseError> {
    let project = setup.project;
    let forces = load_motion::forces(project, &views(linearization))?;
    let hidden = significant(linearization.compliance_hidden_above_rad_per_s, 4);
    let units = project.units;
    let mut out = Document::default();
    let motion = linearization.motion;
    let words = motion.words();
    out.equations(vec![format!("Z = {}", motion.symbols().impedance)]);
    let met = match project.actuator.as_ref().and_then(|actuator| actuator.series.as_ref()) {
        None => "the sensor's stiffness alone",
        Some(DeclaredSeries::Transmission(_)) => {
            "the inertia of the oil, and above all resonances only the compliance of that at its own piston, k_{N+1}/s"
        }
        Some(DeclaredSeries::Spring(_)) => {
            "sensor and series spring alone, whose stiffnesses in series stand for K_S in the straight lines"
        }
    };
    let hiding = hiding_mass_words(linearization.hidden_by, motion);
    out.explanation(format!(
        "The driving-point impedance Z is the resistance to a load that moves the {}: a damper, spring or {}, depending on frequency. Above {hidden} rad/s {hiding} hides the hydraulic compliance, and the load meets {met}.",
        words.rod, words.mass
    ));
    out.explanations(impedance_at_joint(linearization).map(|sentence| format!("{sentence}.")));
    out.left_out(setup);
    out.figures([figure(linearization)?]);
    out.heading("Passivity");
    out.explanation("A passive port stays stable against every passive load (poles not in the right half plane, simple ones with positive residue on the axis, Re Z not negative).");
    out.marked(views(linearization).into_iter().map(|(name, view)| {
        let sentence = format!("{name}: {}", passivity_sentence(&view.passivity));
        (Some(view.passivity.passive.into()), sentence)
    }));
    out.sentences(
        linearization
            .closed_loop_absent
            .map(|reason| format!("closed loop: {}", no_closed_impedance_words(reason))),
    );
    out.append(required(linearization));
    out.heading("The load moves");
    out.figures([load_motion::figure(project, &forces)]);
    out.explanation(format!("Largest change of the {}: {}.", words.force, peaks(&forces, units.force)));
    let of = what_moves(project, forces.iter().any(|moved| moved.moves_ground));
    let step = units.position.text(1e-3, 3);
    let remaining: Vec<String> = views(linearization)
        .iter()
        .map(|(name, view)| format!("{name} {}", remains(view, units.force)))
        .collect();
    out.explanation(format!("Proposition 6.2: with leakage or feedback the zero at the origin makes the {} return. After a step of {of} by {step} there remains, {}.", words.force, remaining.join(", ")));
    out.heading("Asymptotes");
    out.table(asymptotes(linearization));
    Ok(Chapter::of("impedance", "The impedance at the load", out))
}

/// The virtual impedance; empty if the project states none.
fn required(linearization: &Linearization) -> Document {
    let mut out = Document::default();
    let Some(required) = &linearization.required_impedance else { return out };
    let motion = linearization.motion;
    out.heading("The virtual impedance");
    let equations = motion.either(
        ["U_C = G (F F_{ref} - y)", "y = F_e + (M_v s^2 + B_v s + K_v)/(τ s + 1)^n (X_L - X_0)"],
        ["U_C = G (F T_{ref} - y)", "y = T_e + (M_v s^2 + B_v s + K_v)/(τ s + 1)^n (Θ_L - Θ_0)"],
    );
    out.equations(equations.map(str::to_string).to_vec());
    out.explanation(format!(
        "The impedance that the loop is required to show to a load that moves its port, and the one that it shows: Z = M_v s + B_v + K_v/s against {} of the nominal plant, waves, samples and delay included.",
        motion.symbols().impedance
    ));
    out.table(required_impedance_table(required, motion));
    out.sentences([format!("closed loop: {}", required_impedance_sentence(required))]);
    out
}

fn peaks(forces: &[Moved], unit: DisplayUnit) -> String {
    let one = |moved: &Moved| match &moved.force {
        Some(force) => format!("{} {}", unit.text(force.peak_n, 3), moved.name),
        None => format!("none {} (unstable)", moved.name),
    };
    forces.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn remains(view: &PortView, unit: DisplayUnit) -> String {
    match view.final_force_n {
        Some(force) => unit.text(force, 3),
        None => "no final value (unstable)".to_string(),
    }
}

fn views(linearization: &Linearization) -> Vec<(&'static str, &PortView)> {
    let mut views = vec![("open loop", &linearization.open_loop)];
    views.extend(linearization.closed_loop.as_ref().map(|view| ("closed loop", view)));
    views
}

fn behaviour(power: i32, motion: MotionKind) -> &'static str {
    match power {
        -1 => "spring",
        0 => "damper",
        1 => motion.words().mass,
        _ => "of higher order",
    }
}

fn asymptotes(linearization: &Linearization) -> Table {
    let mut rows = Table::new(["loop", "regime", "behaves as", "size", "between, rad/s"]);
    for (name, view) in views(linearization) {
        for asymptote in &view.asymptotes {
            let regime = match asymptote.kind {
                AsymptoteKind::LowFrequency => "low frequency",
                AsymptoteKind::CompliancePlateau => "compliance plateau K_eq",
                AsymptoteKind::SensorLimit => "limit K_S",
                AsymptoteKind::OilLimit => "limit: oil at the load's piston",
            };
            let unit = match asymptote.power {
                -1 => linearization.motion.dimension(&STIFFNESS).si,
                0 => linearization.motion.dimension(&DAMPING).si,
                1 => linearization.motion.dimension(&MASS).si,
                _ => "SI",
            };
            rows.row([
                name.to_string(),
                regime.to_string(),
                behaviour(asymptote.power, linearization.motion).to_string(),
                format!("{} {}", significant(asymptote.coefficient, 4), unit),
                between(asymptote.from, asymptote.to),
            ]);
        }
    }
    rows
}

/// The frequency above which a mass hides the compliance.
fn hidden_label(by: HidingMass, motion: MotionKind) -> &'static str {
    match by {
        HidingMass::Piston => motion.either("√(K_H/M)", "√(K_θ/J)"),
        HidingMass::Oil => "√(K_eq/m)",
    }
}

/// The impedance with its asymptotes.
pub(super) fn figure(linearization: &Linearization) -> Result<Figure, LinearError> {
    let grid = frequency_grid(&linearization.full.command)?;
    let (first, last) = (grid.first().copied().unwrap_or(0.01), grid.last().copied().unwrap_or(1e4));
    let mut lines: Vec<AsymptoteLine> = Vec::new();
    for (name, view) in views(linearization) {
        for asymptote in &view.asymptotes {
            // Plateau and limit are equal for both loops; one line is enough.
            if name != "open loop" && asymptote.kind != AsymptoteKind::LowFrequency {
                continue;
            }
            lines.push(AsymptoteLine {
                label: match asymptote.kind {
                    AsymptoteKind::LowFrequency => {
                        format!("{}, {name}", behaviour(asymptote.power, linearization.motion))
                    }
                    AsymptoteKind::CompliancePlateau => "K_eq/s".to_string(),
                    AsymptoteKind::SensorLimit => "K_S/s".to_string(),
                    AsymptoteKind::OilLimit => "k_{N+1}/s".to_string(),
                },
                coefficient: asymptote.coefficient,
                exponent: asymptote.power,
                from_rad_per_s: asymptote.from.max(first),
                to_rad_per_s: asymptote.to.min(last),
            });
        }
    }
    let bands =
        linearization.closed_loop.as_ref().map(|view| view.passivity.bands.as_slice()).unwrap_or_default();
    let chart = ImpedanceDiagram {
        motion: linearization.motion,
        series: views(linearization)
            .iter()
            .map(|(name, view)| FrequencySeries::new(*name, &grid, |at| view.impedance.at_frequency(at)))
            .collect(),
        asymptotes: lines,
        corners: vec![FrequencyMark {
            label: hidden_label(linearization.hidden_by, linearization.motion).to_string(),
            frequency_rad_per_s: linearization.compliance_hidden_above_rad_per_s,
        }],
        non_passive_bands_rad_per_s: bands
            .iter()
            .map(|band| (band.from_rad_per_s.max(first), band.to_rad_per_s.min(last)))
            .collect(),
        with_phase: true,
    };
    let caption = match bands {
        [] => "Magnitude and phase of Z with its asymptotes; a passive port stays between the lines at ±90°.",
        _ => {
            "Magnitude and phase of Z with its asymptotes; a passive port stays between the lines at ±90°; shaded where the closed loop is not passive."
        }
    };
    Ok(chart.draw(&Words::new("impedance", "Driving-point impedance", caption)))
}

/// A range of frequencies; its upper end may be infinite.
fn between(from: f64, to: f64) -> String {
    let [low, high] = [from, to].map(|frequency| significant(frequency, 3));
    match (from > 0.0, to.is_finite()) {
        (true, true) => format!("{low} to {high}"),
        (true, false) => format!("from {low}"),
        (false, true) => format!("to {high}"),
        (false, false) => "all".to_string(),
    }
}
