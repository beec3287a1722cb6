//! Differences between a certificate and a project, in words.

use phea_engineering::audit::audit_request;
use phea_engineering::robust::RobustProblem;
use phea_qft::proof::{Certificate, CertificateDifference, CertificateSide, differences};

use crate::specification::stated;

/// A sentence without its full stop for each difference.
pub(super) fn words(certificate: &Certificate, problem: &RobustProblem) -> Vec<String> {
    let found = differences(certificate, &audit_request(problem, &problem.family));
    found.iter().map(|one| sentence(one, problem)).collect()
}

fn sentence(difference: &CertificateDifference, problem: &RobustProblem) -> String {
    let differs = |what: &str| format!("{what} of the certificate is not that of the project");
    match difference {
        CertificateDifference::Plant => differs("the plant"),
        CertificateDifference::Box => differs("the box of uncertain numbers"),
        CertificateDifference::Feedback => differs("the controller"),
        CertificateDifference::Prefilter => differs("the prefilter"),
        CertificateDifference::Sensor => differs("the sensor"),
        CertificateDifference::Sampling => differs("the sampling"),
        CertificateDifference::Stability => {
            "the certificate does not claim that every plant is stable".to_string()
        }
        CertificateDifference::Specification { index, side } => {
            let limit = match side {
                CertificateSide::Upper => "limit",
                CertificateSide::Lower => "lower limit",
            };
            format!("the certificate does not claim the {limit} of {}", stated(problem.named(*index)))
        }
        CertificateDifference::NotStated(_) => {
            "no certificate can be of the loop of this project".to_string()
        }
    }
}
