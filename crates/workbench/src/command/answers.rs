//! The answers of all commands, described for programs.

use super::check::CheckAnswer;
use super::refusal::RefusedAnswer;
use super::verify::VerifyAnswer;
use crate::answer::CommandAnswer;
use crate::audit::CheckCertificateAnswer;
use crate::linearize::LinearizeAnswer;

/// The answer of each command.
pub(super) fn answers() -> Vec<CommandAnswer> {
    vec![
        CommandAnswer::of::<CheckAnswer>("check"),
        CommandAnswer::of::<LinearizeAnswer>("linearize"),
        CommandAnswer::of::<VerifyAnswer>("verify"),
        CommandAnswer::whole::<RefusedAnswer>(None),
        CommandAnswer::whole::<CheckCertificateAnswer>(Some("check-certificate")),
    ]
}
