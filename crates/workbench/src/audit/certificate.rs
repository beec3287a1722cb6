//! The file of a certificate: written by `verify --certificate`, read by `check-certificate` and by
//! independent checkers.

mod comparison;
mod layout;

use phea_dynamics::portable;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::robust::RobustProblem;
use phea_engineering::specification::closed_loop_key;
use phea_qft::proof::{Certificate, CertificateSide, Claim, LimitedLoop, Rejection, check};

use crate::answer::{Answer, Body, OutputFile, SCHEMA, VERSION};
use crate::document::Document;
use crate::project::Loaded;
use crate::quantity::MotionKind;
pub use layout::CertificateError;
use layout::File;

/// Answer of `check-certificate`.
#[derive(Answer)]
pub(crate) struct CheckCertificateAnswer {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command.
    command: &'static str,
    /// Title of the project that was proven.
    title: String,
    /// SHA-256 of the project file that was proven.
    project_sha256: String,
    /// True if every claim holds.
    valid: bool,
    /// Claims of the certificate, in words.
    claims: Vec<String>,
    /// True if the certificate claims that every plant is stable.
    stability_claimed: bool,
    /// Differences between the certificate and the given project, if there is one.
    #[answer(optional)]
    differences: Option<Vec<String>>,
    /// Numbers of the specifications with a requirement in time, about which nothing is claimed.
    not_claimed_in_time: Vec<usize>,
    /// Number of the claim that is rejected, from 1.
    #[answer(optional)]
    rejected_claim: Option<usize>,
    /// Reason for which it is rejected.
    #[answer(optional)]
    reason: Option<String>,
}

/// Its name in a folder.
pub const CERTIFICATE_FILE: &str = "certificate.json";

/// The file with the proof of an audit, with this name; `None` if nothing was proven.
pub(crate) fn certificate_of(loaded: &Loaded, view: &ProjectAudit, name: &str) -> Option<OutputFile> {
    let certificate = view.proof.as_ref()?.certificate.as_ref()?;
    Some(OutputFile { name: name.to_string(), ..file(loaded, certificate) })
}

/// The file of a certificate.
fn file(loaded: &Loaded, certificate: &Certificate) -> OutputFile {
    // contains only finite numbers and string keys
    let text = serde_json::to_string(&File::of(loaded, certificate)).unwrap_or_default();
    OutputFile { name: CERTIFICATE_FILE.to_string(), bytes: format!("{text}\n").into_bytes() }
}

/// Checks the file of a certificate: the answer is yes if every claim holds.
///
/// # Errors
/// [`CertificateError`] for a file that is not a certificate.
pub fn check_certificate(text: &str) -> Result<Answer, CertificateError> {
    checked(text, None)
}

/// Checks the file of a certificate, and that it belongs to this problem: the answer is yes if
/// every claim holds, and plant, box, laws and specifications are those of the problem.
///
/// # Errors
/// Errors of [`check_certificate`].
pub fn check_certificate_of(text: &str, problem: &RobustProblem) -> Result<Answer, CertificateError> {
    checked(text, Some(problem))
}

fn checked(text: &str, problem: Option<&RobustProblem>) -> Result<Answer, CertificateError> {
    let file = File::read(text)?;
    let (title, project_sha256) = (file.title.clone(), file.project_sha256.clone());
    let certificate = file.certificate()?;
    let rejected = check(&certificate).err();
    let compared = problem.map(|problem| comparison::words(&certificate, problem));
    let in_time = problem.map_or(vec![], in_time);
    Ok(answer((&title, &project_sha256), &certificate, rejected.as_ref(), (compared, &in_time)))
}

/// The specifications, by their number in the file, that have requirements in time; a certificate
/// makes no claim on these.
fn in_time(problem: &RobustProblem) -> Vec<usize> {
    let required = problem.in_time.iter().filter(|required| required.follows);
    required.map(|required| required.number).collect()
}

fn answer(
    (title, project_sha256): (&str, &str),
    certificate: &Certificate,
    rejected: Option<&(usize, Rejection)>,
    (differences, in_time): (Option<Vec<String>>, &[usize]),
) -> Answer {
    let claims: Vec<String> = certificate.claims.iter().map(|claim| sentence(certificate, claim)).collect();
    let mut out = Document::default();
    out.line(title);
    out.sentences(claims.iter().enumerate().map(|(index, claim)| {
        let word = match rejected {
            Some((number, _)) if *number == index + 1 => "rejected",
            Some((number, _)) if *number < index + 1 => "not checked",
            _ => "holds",
        };
        format!("{word}: {claim}")
    }));
    out.line(match rejected {
        Some((number, reason)) => format!("The certificate is rejected at claim {number}: {reason}."),
        None => format!("Every claim holds: {}.", claims.len()),
    });
    if !certificate.claims_stability() {
        out.line("Nothing is claimed of stability: without it no magnitude describes a response.");
    }
    if let Some(found) = &differences {
        out.line(match found.as_slice() {
            [] if in_time.is_empty() => {
                "It is the certificate of this project: plant, box, laws and specifications agree."
            }
            [] => {
                "It is the certificate of this project: plant, box, laws and the limits over frequency agree."
            }
            _ => "It is not the certificate of this project:",
        });
        out.sentences(found.iter().cloned());
    }
    out.sentences(in_time.iter().map(|number| {
        format!("Not claimed: what specification {number} requires in time, which `verify` searches for.")
    }));
    let is_of_project = differences.as_ref().is_none_or(Vec::is_empty);
    let body = CheckCertificateAnswer {
        schema: SCHEMA,
        version: VERSION,
        command: "check-certificate",
        title: title.to_string(),
        project_sha256: project_sha256.to_string(),
        valid: rejected.is_none(),
        claims,
        stability_claimed: certificate.claims_stability(),
        differences,
        not_claimed_in_time: in_time.to_vec(),
        rejected_claim: rejected.map(|(number, _)| *number),
        reason: rejected.map(|(_, reason)| reason.to_string()),
    };
    Answer {
        document: out,
        json: body.into_object().print(MotionKind::default()),
        files: vec![],
        affirmative: rejected.is_none() && is_of_project,
    }
}

/// The frequencies of a claim.
fn band(certificate: &Certificate, limited: &LimitedLoop) -> String {
    let [from, to] = limited.band_rad_per_s;
    let end =
        certificate.sampling.as_ref().map_or(f64::INFINITY, |own| std::f64::consts::PI / own.sample_time_s);
    match to.min(end) {
        f64::INFINITY => format!("from {from} rad/s on"),
        to => format!("from {from} to {} rad/s", portable::rounded(to, 6)),
    }
}

/// A claim in a sentence without its full stop.
fn sentence(certificate: &Certificate, claim: &Claim) -> String {
    let decibels = |ratio: f64| format!("{:+.4} dB", 20.0 * phea_dynamics::portable::log10(ratio));
    let of = |limited: &LimitedLoop| match limited.side {
        CertificateSide::Upper => format!("{} over its limit", closed_loop_key(limited.closed_loop)),
        CertificateSide::Lower => format!("lower limit over {}", closed_loop_key(limited.closed_loop)),
    };
    match claim {
        Claim::Stable(_) => "every plant of the box is stable in the loop".to_string(),
        Claim::Unstable { .. } => {
            "a plant of the box is not stable in the loop, or the prefilter is not".to_string()
        }
        Claim::Limited { limited, ratio, .. } => {
            format!(
                "{} is at most {} for every plant {}",
                of(limited),
                decibels(*ratio),
                band(certificate, limited)
            )
        }
        Claim::Reached { limited, ratio, frequency_rad_per_s, .. } => format!(
            "{} is at least {} with a plant of the box at {frequency_rad_per_s} rad/s",
            of(limited),
            decibels(*ratio)
        ),
    }
}
