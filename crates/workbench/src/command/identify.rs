//! `identify`: the valve that explains recorded tests.

use crate::answer::Answer;
use crate::identify::{
    self, IdentifyError, Known, SMALLEST_EFFECT, Search, identify, joint_region, recordings,
};
use crate::project::Loaded;
use crate::source::Source;
use phea_hydraulics::servovalve::LeakageModel;

use super::Watch;

/// What a valve is identified from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IdentifyRequest {
    /// Recorded tests, CSV files.
    pub files: Vec<String>,
    /// Starting points of the search; absent: 6.
    pub starts: Option<usize>,
    /// Seed of the starting points and of the bootstrap.
    pub seed: u32,
    /// Repetitions of the bootstrap; zero makes none.
    pub bootstrap: usize,
    /// The model of the leakage; absent: the one that the recordings support.
    pub leakage_model: Option<LeakageModel>,
}

/// Identifies a valve from files, with what a project says of it: nominal voltage, supply pressure,
/// tank pressure, transition pressure and the drop at which the tare flow is stated.
///
/// # Errors
/// [`IdentifyError`] for files that are not tests, and recordings that no valve explains.
pub fn identify_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    asked: &IdentifyRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let known = loaded.map_or(Known::default(), known);
    let recorded = recordings(source, &asked.files, &known).map_err(IdentifyError::Files)?;
    let usual = Search::default();
    let search = Search {
        starts: asked.starts.unwrap_or(usual.starts),
        seed: asked.seed,
        leakage_model: asked.leakage_model,
        bootstrap: asked.bootstrap,
    };
    let found = identify(recorded, &known, search, watch)?;
    let rig = loaded.filter(|loaded| loaded.project.actuator.is_some());
    let region = rig.map(|rig| joint_region(&found, &rig.project, SMALLEST_EFFECT));
    let mut files = identify::files(&found);
    files.extend(region.iter().flatten().map(|region| identify::file(&found, region)));
    Ok(Answer {
        text: identify::text(&found, region.as_ref()),
        json: identify::json(loaded, &found, region.as_ref()),
        files,
        affirmative: found.has_converged() && found.untold.is_empty(),
    })
}

fn known(loaded: &Loaded) -> Known {
    let Some(actuator) = &loaded.project.actuator else { return Known::default() };
    Known {
        nominal_voltage: actuator.valve.nominal_voltage,
        transition_pressure: actuator.valve.transition_pressure,
        supply_pressure: Some(actuator.supply.pressure),
        tank_pressure: actuator.supply.tank_pressure,
        tare_pressure: actuator.valve.tare_pressure,
        leakage_model: actuator.valve.leakage_model,
    }
}
