//! The answers of all commands, described for programs.

use super::check::CheckAnswer;
use super::refusal::RefusedAnswer;
use super::verify::VerifyAnswer;
use crate::answer::CommandAnswer;
use crate::audit::CheckCertificateAnswer;
use crate::campaign::{CampaignAnswer, CampaignRunAnswer};
use crate::simulate::{CompareAnswer, SimulateAnswer};

/// The answer of each command.
pub(super) fn answers() -> Vec<CommandAnswer> {
    vec![
        CommandAnswer::of::<CheckAnswer>("check"),
        CommandAnswer::of::<VerifyAnswer>("verify"),
        CommandAnswer::of::<SimulateAnswer>("simulate"),
        CommandAnswer::of::<CompareAnswer>("compare"),
        CommandAnswer::of::<CampaignAnswer>("campaign"),
        CommandAnswer::of::<CampaignRunAnswer>("campaign"),
        CommandAnswer::whole::<RefusedAnswer>(None),
        CommandAnswer::whole::<CheckCertificateAnswer>(Some("check-certificate")),
    ]
}
