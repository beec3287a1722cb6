//! The output of `audit`: text, JSON, files and figures.

mod answer;
mod below_design;
mod certificate;
mod document;
mod family_and_loop;
pub(crate) mod in_time;
mod margins;
mod proven;
mod remark;
mod signal_noise;
mod stability;
mod words;

pub use answer::files;
pub(crate) use answer::json;
pub(crate) use answer::{AuditAnswer, SpecificationMarginAnswer, StableAnswer, body, margin, stable};
pub use certificate::{CERTIFICATE_FILE, CertificateError, check_certificate, check_certificate_of};
pub(crate) use certificate::{CheckCertificateAnswer, certificate_of};
pub use document::output;
pub(crate) use document::{basis, document, proven, summary};
pub(crate) use family_and_loop::position_words;
pub use margins::above_one_again_words;
pub(crate) use margins::{above_one_again, crossover_cell};
pub use signal_noise::noise_sentence;
pub(crate) use stability::{stability_reason, stability_sentence};
pub(crate) use words::{closed_loop_symbol, evidence_sentence, meaning};
