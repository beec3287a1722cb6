//! What every exported file says of itself.

use phea_machine::Deployed;

/// Facts on an exported controller that stand in the head of every file.
#[derive(Clone, Debug, PartialEq)]
pub struct Contract {
    /// Title of the project.
    pub title: String,
    /// Identifier that begins the name of every file, type and function.
    pub name: String,
    /// Version of phea.
    pub version: &'static str,
    /// SHA-256 of the project file.
    pub project_sha256: String,
    /// Verdict with its evidence.
    pub verdict: String,
    /// Time from a sample to its command, as it was verified, s.
    pub delay_s: f64,
    /// What the verdict does not cover, in sentences.
    pub not_covered: Vec<String>,
}

impl Contract {
    /// Lines of the head of a file.
    pub(crate) fn lines(&self, deployed: &Deployed) -> Vec<String> {
        let sample_time_s = deployed.controller.sample_time_s();
        let mut lines = vec![
            self.title.clone(),
            format!("Written by phea {} from a project with SHA-256", self.version),
            self.project_sha256.clone(),
            String::new(),
            format!("Verdict: {}", self.verdict),
            String::new(),
            format!(
                "Call the step every {sample_time_s} s; its command must act within {} s of",
                self.delay_s
            ),
            "the sample. Force in N, positive as declared; command in V.".to_string(),
        ];
        if deployed.feed_forward != 0.0 {
            lines.push("Velocity of the load in m/s.".to_string());
        }
        if deployed.controller.reads_inner() {
            lines.push("Pressure signal in Pa.".to_string());
        }
        for (what, converter) in
            [("measurement", deployed.measurement_converter), ("command", deployed.command_converter)]
        {
            if let Some(converter) = converter {
                lines.push(format!("Converter of the {what}: steps of {}.", converter.step()));
            }
        }
        if !self.not_covered.is_empty() {
            lines.push(String::new());
            lines.push("The verdict does not cover:".to_string());
            lines.extend(self.not_covered.iter().map(|sentence| format!("- {sentence}")));
        }
        lines
    }
}
