//! Facts that every exported file states about itself.

use phea_dynamics::controller::Converter;
use phea_machine::Deployed;

use super::DeployedSignal;
use crate::quantity::{FORCE, MotionKind};

/// Facts on an exported controller that stand in the head of every file.
#[derive(Clone, Debug, PartialEq)]
pub struct Contract {
    /// Title of the project.
    pub title: String,
    /// Version of phea.
    pub version: &'static str,
    /// SHA-256 of the project file.
    pub project_sha256: String,
    /// Settings that replaced values of that file, each `path=value`.
    pub settings: Vec<String>,
    /// Verdict with its evidence.
    pub verdict: String,
    /// Time from a sample to its command, as it was verified, s.
    pub delay_s: f64,
    /// Motion of the rig; `None` for a plant without units.
    pub motion: Option<MotionKind>,
    /// Effects that the verdict does not cover, in sentences.
    pub not_covered: Vec<String>,
}

impl Contract {
    /// Lines of the head of a file.
    pub(super) fn lines(&self, deployed: &Deployed) -> Vec<String> {
        let mut lines = vec![
            self.title.clone(),
            String::new(),
            format!("Written by phea {} from a project with SHA-256", self.version),
            self.project_sha256.clone(),
        ];
        lines.extend(self.settings.iter().map(|setting| format!("with {setting}")));
        lines.extend([String::new(), format!("Verdict: {}", self.verdict), String::new()]);
        let acts = match self.delay_s == 0.0 {
            true => "The verdict assumes that the command acts at its sample, without delay.".to_string(),
            false => format!(
                "The verdict holds for a command that acts {} s after its sample, neither later nor earlier.",
                self.delay_s
            ),
        };
        lines.push(format!("Sample time: {} s. {acts}", deployed.controller.sample_time_s()));
        lines.push(String::new());
        let signals = DeployedSignal::of(deployed);
        lines.extend(signals.into_iter().map(|one| format!("{}: {}", one.name(), one.meaning(self.motion))));
        let limit = deployed.controller.command_limit();
        let volt = self.motion.map_or("", |_| " V");
        let limited = if limit.is_finite() {
            format!(", limited to -{limit}{volt} to {limit}{volt}")
        } else {
            String::new()
        };
        let command = self.motion.map_or("input of the plant", |_| "command of the valve in V");
        lines.push(format!("command: {command}{limited}"));
        lines.extend(self.converters(deployed));
        if !self.not_covered.is_empty() {
            lines.extend([String::new(), "The verdict does not cover:".to_string()]);
            lines.extend(self.not_covered.iter().map(|sentence| format!("- {sentence}")));
        }
        lines
    }

    /// Lines on the converters.
    fn converters(&self, deployed: &Deployed) -> Vec<String> {
        let force = self.motion.map_or(String::new(), |motion| format!(" {}", motion.dimension(&FORCE).si));
        let volts = self.motion.map_or(String::new(), |_| " V".to_string());
        let of = |what: &str, unit: &str, converter: Option<Converter>| {
            let converter = converter?;
            let ([minimum, maximum], step) = (converter.range(), converter.step());
            Some(format!(
                "Converter of the {what}: {minimum}{unit} to {maximum}{unit} in steps of {step}{unit}."
            ))
        };
        let both = [
            of("measurement", &force, deployed.measurement_converter),
            of("command", &volts, deployed.command_converter),
        ];
        both.into_iter().flatten().collect()
    }
}
