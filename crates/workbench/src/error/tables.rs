//! The tables and keys of a project that an error names, in the order of its message.

use phea_engineering::alternatives::AlternativesError;
use phea_engineering::audit::AuditError;
use phea_engineering::bench::BenchError;
use phea_engineering::campaign::CampaignError;
use phea_engineering::deployed::DeployedError;
use phea_engineering::design::DesignError;
use phea_engineering::family::ProjectFamilyError;
use phea_engineering::rig::RigError;
use phea_engineering::setup::ControlError;
use phea_engineering::simulate::SimulateError;
use phea_engineering::sizing::SizingError;

use super::CommandError;

/// The paths of the tables and keys; empty for an error that names none.
pub(super) fn tables(error: &CommandError) -> Vec<String> {
    let fixed: &[&str] = match error {
        CommandError::Rig(error) => return rig(error),
        CommandError::Control(error) => return control(error),
        CommandError::Family(error) => return family(error),
        CommandError::Simulate(error) => return simulate(error),
        CommandError::Campaign(error) => return campaign(error),
        CommandError::Audit(error) => audit(error),
        CommandError::Sizing(SizingError::Rig(error)) | CommandError::Bench(BenchError::Rig(error)) => {
            return rig(error);
        }
        CommandError::Deployed(error) => return deployed(error),
        CommandError::UpdateRate => &["controller.sample_time", "controller"],
        CommandError::NoIdentifier => &["title"],
        CommandError::Sizing(error) => sizing(error),
        CommandError::Bench(error) => bench(error),
        CommandError::Design(DesignError::NoSpecification) => &["specification"],
        CommandError::Alternatives(AlternativesError::NoAlternative) => &["alternative"],
        CommandError::NothingToReport => &["plant", "specification", "valve", "cylinder", "line"],
        CommandError::OfCylinders { .. } => &["cylinder", "motor"],
        _ => &[],
    };
    owned(fixed)
}

fn owned(paths: &[&str]) -> Vec<String> {
    paths.iter().map(ToString::to_string).collect()
}

fn rig(error: &RigError) -> Vec<String> {
    owned(match error {
        RigError::NoActuator => &["plant", "valve", "cylinder", "line"],
        RigError::OperatingPoint(_) => &["operating_point"],
        RigError::Line(_) => &["line"],
        RigError::Actuator(_) | RigError::Accumulator(_) => &[],
    })
}

fn deployed(error: &DeployedError) -> Vec<String> {
    owned(match error {
        DeployedError::Control(error) => return control(error),
        DeployedError::Rig(error) => return rig(error),
        DeployedError::NoController | DeployedError::Continuous => &["controller.sample_time", "controller"],
        DeployedError::VirtualImpedance => &["controller.impedance", "controller"],
        DeployedError::ContinuousPrefilter => &["prefilter.continuous", "prefilter"],
    })
}

fn control(error: &ControlError) -> Vec<String> {
    let table = match error {
        ControlError::Formula { place, .. }
        | ControlError::Linear { place, .. }
        | ControlError::Gain { place }
        | ControlError::SampleTime { place } => place.table(),
        ControlError::Quantization(_) => Some("controller.quantization"),
    };
    table.into_iter().map(str::to_string).collect()
}

fn family(error: &ProjectFamilyError) -> Vec<String> {
    use ProjectFamilyError as Error;
    let fixed: &[&str] = match error {
        Error::Rig(error) => return rig(error),
        Error::Path { path, .. } => return vec![format!("uncertainty.{path}")],
        Error::Linear { .. } => &["uncertainty", "linear"],
        Error::Plant(_) | Error::Members(_) => &["uncertainty"],
        Error::Delay { .. } => &["plant.delay"],
        Error::Formula(_) => &["plant"],
        Error::Measurement(_) | Error::Measured(_) => &["family.measured"],
        Error::Line { .. } => &["line"],
        Error::Region { .. } => &["family.operating_region.velocity"],
        Error::NotPassive { .. } | Error::LoadMotion(_) | Error::OperatingPoint { .. } => &[],
    };
    owned(fixed)
}

fn audit(error: &AuditError) -> &'static [&'static str] {
    match error {
        AuditError::NoController | AuditError::NoLaw => &["controller"],
        AuditError::NoSpecification => &["specification"],
        AuditError::Robust(_) | AuditError::Stopped(_) => &[],
    }
}

fn simulate(error: &SimulateError) -> Vec<String> {
    let fixed: &[&str] = match error {
        SimulateError::Rig(error) => return rig(error),
        SimulateError::Control(error) => return control(error),
        SimulateError::NoScenario => &["scenario"],
        SimulateError::NoController => &["controller"],
        SimulateError::Loop(_) => &["controller", "prefilter", "sensor"],
        SimulateError::LoadMass(_) => &["load"],
        SimulateError::Line(_) => &["line"],
        _ => &[],
    };
    owned(fixed)
}

fn campaign(error: &CampaignError) -> Vec<String> {
    let fixed: &[&str] = match error {
        CampaignError::Simulate(error) => return simulate(error),
        CampaignError::Absent | CampaignError::Nothing => &["campaign", "campaign.parameters"],
        CampaignError::NoScenario => &["scenario"],
        CampaignError::NoSuchScenario { .. }
        | CampaignError::Unknown { .. }
        | CampaignError::NoStart { .. }
        | CampaignError::SavedStart { .. }
        | CampaignError::NotStated { .. }
        | CampaignError::NoLogarithm { .. } => &["campaign"],
        CampaignError::Specification(_) => &["specification"],
        _ => &[],
    };
    owned(fixed)
}

fn sizing(error: &SizingError) -> &'static [&'static str] {
    match error {
        SizingError::Absent => &["sizing"],
        SizingError::Accumulator => &["line.accumulator"],
        SizingError::Capacity => &["cross_port.kind"],
        SizingError::Stages => &["cylinder.stage"],
        SizingError::Rig(_) | SizingError::NoHose => &[],
    }
}

fn bench(error: &BenchError) -> &'static [&'static str] {
    match error {
        BenchError::TooManyRows { .. } => &["bench"],
        BenchError::Line(_) => &["bench.line"],
        BenchError::NoBristles => &["bench.friction", "cylinder.friction"],
        BenchError::BeyondStroke { .. } => &["bench.friction"],
        BenchError::ShakenTooFast { .. } | BenchError::NothingShaken { .. } => &["bench.friction.shaken"],
        BenchError::Rig(_) | BenchError::Stopped => &[],
    }
}
