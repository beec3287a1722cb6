//! The answers of all commands, described for programs.

use super::check::CheckAnswer;
use super::export::ExportAnswer;
use super::refusal::RefusedAnswer;
use super::verify::VerifyAnswer;
use crate::alternatives::AlternativesAnswer;
use crate::answer::CommandAnswer;
use crate::audit::CheckCertificateAnswer;
use crate::bench::BenchAnswer;
use crate::campaign::{CampaignAnswer, CampaignRunAnswer};
use crate::design::DesignAnswer;
use crate::friction::IdentifiedFrictionAnswer;
use crate::identify::IdentifiedValveAnswer;
use crate::line_test::IdentifiedLineAnswer;
use crate::linearize::LinearizeAnswer;
use crate::report::ReportAnswer;
use crate::response::IdentifiedResponsesAnswer;
use crate::shaping::ShapeAnswer;
use crate::simulate::{CompareAnswer, SimulateAnswer};
use crate::sizing::SizeAnswer;

/// The answer of each command.
pub(super) fn answers() -> Vec<CommandAnswer> {
    vec![
        CommandAnswer::of::<CheckAnswer>("check"),
        CommandAnswer::of::<SizeAnswer>("size"),
        CommandAnswer::of::<LinearizeAnswer>("linearize"),
        CommandAnswer::of::<VerifyAnswer>("verify"),
        CommandAnswer::of::<ShapeAnswer>("shape"),
        CommandAnswer::of::<DesignAnswer>("design").named("DesignCommandAnswer"),
        CommandAnswer::of::<SimulateAnswer>("simulate"),
        CommandAnswer::of::<CompareAnswer>("compare"),
        CommandAnswer::of::<CampaignAnswer>("campaign"),
        CommandAnswer::of::<CampaignRunAnswer>("campaign"),
        CommandAnswer::of::<AlternativesAnswer>("alternatives"),
        CommandAnswer::of::<BenchAnswer>("bench"),
        CommandAnswer::of::<ExportAnswer>("export"),
        CommandAnswer::of::<ReportAnswer>("report"),
        CommandAnswer::whole::<RefusedAnswer>(None),
        CommandAnswer::whole::<CheckCertificateAnswer>(Some("check-certificate")),
        CommandAnswer::whole::<IdentifiedValveAnswer>(Some("identify")),
        CommandAnswer::whole::<IdentifiedResponsesAnswer>(Some("identify")),
        CommandAnswer::of::<IdentifiedFrictionAnswer>("identify"),
        CommandAnswer::whole::<IdentifiedLineAnswer>(Some("identify")),
    ]
}
