//! The layout of the file: its content, word by word, and the certificate that it represents.

mod claims;

use phea_dynamics::expression::{Binary, Expression, Node, Unary};
use phea_qft::proof::{
    Certificate, CertifiedPlant, Claim, ControlLaw, ParameterSegment, Quotient, RollOffBound, Sampling,
    Sections,
};
use serde::{Deserialize, Serialize};

use crate::project::{Loaded, word_of};
use claims::{Cover, StatedClaim, covers, panels};

/// First word of the file.
const FORMAT: &str = "phea-certificate";
/// Version of the layout.
const VERSION: u32 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    format: String,
    version: u32,
    phea: String,
    pub(super) title: String,
    pub(super) project_sha256: String,
    settings: Vec<String>,
    /// The recordings from which the plant was identified, which `project_sha256` covers too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    recordings: Vec<StatedRecording>,
    variables: usize,
    parameters: Vec<String>,
    /// A segment for each box and each parameter.
    boxes: Vec<Vec<StatedSegment>>,
    operations: Vec<Operation>,
    plant: CertificatePlant,
    #[serde(default, skip_serializing_if = "is_zero")]
    delay: f64,
    /// Terms of the series that replaces dead time.
    terms: usize,
    #[serde(default, skip_serializing_if = "is_none")]
    model_degree: usize,
    feedback: StatedLaw,
    prefilter: StatedLaw,
    sensor: CertificateRational,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sampling: Option<StatedSampling>,
    claims: Vec<StatedClaim>,
}

/// A recording from which a value of the plant comes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedRecording {
    file: String,
    sha256: String,
}

/// Low, high and the variable; a word if it varies logarithmically.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum StatedSegment {
    Straight((f64, f64, Option<usize>)),
    Named((f64, f64, usize, String)),
}

/// The word.
const BY_FACTORS: &str = "by_factors";

impl From<&ParameterSegment> for StatedSegment {
    fn from(one: &ParameterSegment) -> StatedSegment {
        let ParameterSegment { low, high, variable, by_factors } = *one;
        match variable.filter(|_| by_factors) {
            Some(variable) => StatedSegment::Named((low, high, variable, BY_FACTORS.to_string())),
            None => StatedSegment::Straight((low, high, variable)),
        }
    }
}

impl TryFrom<StatedSegment> for ParameterSegment {
    type Error = CertificateError;

    fn try_from(stated: StatedSegment) -> Result<ParameterSegment, CertificateError> {
        match stated {
            StatedSegment::Straight((low, high, variable)) => {
                Ok(ParameterSegment { low, high, variable, by_factors: false })
            }
            StatedSegment::Named((low, high, variable, word)) if word == BY_FACTORS => {
                Ok(ParameterSegment { low, high, variable: Some(variable), by_factors: true })
            }
            StatedSegment::Named((.., word)) => {
                Err(meaning(format!("`{word}` does not say how a parameter moves")))
            }
        }
    }
}

fn is_none(degree: &usize) -> bool {
    *degree == 0
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A recorded operation: its name, then its operands.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Operation {
    Number((String, f64)),
    Two((String, usize, usize)),
    Four((String, usize, usize, usize, usize)),
}

/// Operations on one number.
const UNARY: [(&str, Unary); 5] = [
    ("negate", Unary::Negate),
    ("sqrt", Unary::SquareRoot),
    ("exp", Unary::Exponential),
    ("ln", Unary::Logarithm),
    ("abs", Unary::Magnitude),
];
const BINARY: [(&str, Binary); 4] = [
    ("add", Binary::Add),
    ("subtract", Binary::Subtract),
    ("multiply", Binary::Multiply),
    ("divide", Binary::Divide),
];
/// The third operand if the first is less than the second, otherwise the fourth.
const SELECT: &str = "select";

fn named<T: Copy>(table: &[(&str, T)], name: &str) -> Option<T> {
    table.iter().find(|(known, _)| *known == name).map(|(_, operation)| *operation)
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CertificatePlant {
    numerator: Vec<usize>,
    denominator: Vec<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    disturbance_numerator: Option<Vec<usize>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    disturbance_denominator: Option<Vec<usize>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dead_time: Option<usize>,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CertificateRational {
    numerator: Vec<f64>,
    denominator: Vec<f64>,
}

/// A controller or prefilter: in s, or in sections of z - 1.
#[derive(Clone, Serialize, Deserialize)]
#[serde(untagged)]
enum StatedLaw {
    Continuous(CertificateRational),
    Sampled(StatedSections),
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedSections {
    gain: f64,
    numerator: Vec<Vec<f64>>,
    denominator: Vec<Vec<f64>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedSampling {
    sample_time: f64,
    #[serde(default, skip_serializing_if = "is_zero")]
    sensor_delay: f64,
    images: usize,
    /// Bounds for each box.
    bounds: Vec<Vec<StatedBound>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedBound {
    order: usize,
    ratio: f64,
    panels: Vec<Cover>,
}

/// Reason why a file is not a certificate.
#[derive(Debug, thiserror::Error)]
pub enum CertificateError {
    /// No JSON of this layout.
    #[error("not a certificate: {0}")]
    Layout(#[from] serde_json::Error),
    /// Another format or version.
    #[error("this is `{format}` version {version}; `{FORMAT}` version {VERSION} is known")]
    Version {
        /// Format stated in the file.
        format: String,
        /// Version stated in the file.
        version: u32,
    },
    /// A word, a position or a number without a meaning.
    #[error("{0}")]
    Meaning(String),
}

fn meaning(text: impl Into<String>) -> CertificateError {
    CertificateError::Meaning(text.into())
}

/// A number of the text that is not zero and would be read as zero.
fn vanishing(text: &str) -> Option<&str> {
    let outside = outside_of_strings(text);
    let mut tokens =
        outside.into_iter().flat_map(|part| part.split(|sign: char| "[]{}:, \n\r\t".contains(sign)));
    tokens.find(|token| {
        let digits = token.split(['e', 'E']).next().unwrap_or_default();
        let is_zero = token.parse::<f64>().is_ok_and(|value| value == 0.0);
        is_zero && digits.contains(|digit: char| ('1'..='9').contains(&digit))
    })
}

/// The parts of a JSON text outside its strings.
fn outside_of_strings(text: &str) -> Vec<&str> {
    let mut out = vec![];
    let mut rest = text;
    while let Some((before, string)) = rest.split_once('"') {
        out.push(before);
        let mut is_escaped = false;
        let end = string.find(|sign: char| {
            let ends = sign == '"' && !is_escaped;
            is_escaped = sign == '\\' && !is_escaped;
            ends
        });
        rest = end.and_then(|end| string.get(end + 1..)).unwrap_or_default();
    }
    out.push(rest);
    out
}

fn recordings(loaded: &Loaded) -> Vec<StatedRecording> {
    let files = loaded.recorded.iter().flat_map(|recorded| &recorded.files);
    files.map(|one| StatedRecording { file: one.path.clone(), sha256: one.sha256.clone() }).collect()
}

impl File {
    pub(super) fn of(loaded: &Loaded, certificate: &Certificate) -> File {
        let plant = &certificate.plant;
        let mut results = plant.coefficients.results().iter().copied();
        let mut parts =
            plant.lengths.iter().map(|&length| results.by_ref().take(length).collect::<Vec<usize>>());
        File {
            format: FORMAT.to_string(),
            version: VERSION,
            phea: env!("CARGO_PKG_VERSION").to_string(),
            title: loaded.project.title.clone(),
            project_sha256: loaded.sha256.clone(),
            settings: loaded.settings.clone(),
            recordings: recordings(loaded),
            variables: plant.variables,
            parameters: plant.parameters.clone(),
            boxes: plant.boxes.iter().map(|one| one.iter().map(StatedSegment::from).collect()).collect(),
            operations: plant.coefficients.nodes().iter().filter_map(Operation::of).collect(),
            plant: CertificatePlant {
                numerator: parts.next().unwrap_or_default(),
                denominator: parts.next().unwrap_or_default(),
                disturbance_numerator: parts.next(),
                disturbance_denominator: parts.next(),
                dead_time: plant
                    .has_dead_time
                    .then(|| plant.coefficients.results().last().copied().unwrap_or(0)),
            },
            delay: plant.delay_s,
            terms: plant.dead_time_terms,
            model_degree: plant.model_degree,
            feedback: (&certificate.feedback).into(),
            prefilter: (&certificate.prefilter).into(),
            sensor: (&certificate.sensor).into(),
            sampling: certificate.sampling.as_ref().map(StatedSampling::from),
            claims: certificate.claims.iter().map(StatedClaim::from).collect(),
        }
    }

    pub(super) fn read(text: &str) -> Result<File, CertificateError> {
        let file: File = serde_json::from_str(text)?;
        if let Some(number) = vanishing(text) {
            return Err(meaning(format!("`{number}` is less than any number that can be computed with")));
        }
        if file.plant.disturbance_numerator.is_some() != file.plant.disturbance_denominator.is_some() {
            return Err(meaning("the disturbance has a numerator or a denominator alone"));
        }
        match file.format == FORMAT && file.version == VERSION {
            true => Ok(file),
            false => Err(CertificateError::Version { format: file.format, version: file.version }),
        }
    }

    pub(super) fn certificate(self) -> Result<Certificate, CertificateError> {
        let file = self;
        let nodes = file.operations.iter().map(Operation::node).collect::<Result<Vec<Node>, _>>()?;
        let CertificatePlant {
            numerator,
            denominator,
            disturbance_numerator,
            disturbance_denominator,
            dead_time,
        } = file.plant;
        let mut parts = vec![numerator, denominator];
        parts
            .extend(disturbance_numerator.zip(disturbance_denominator).into_iter().flat_map(|(n, d)| [n, d]));
        let lengths = parts.iter().map(Vec::len).collect();
        let mut results = parts.concat();
        results.extend(dead_time);
        let coefficients = Expression::from_nodes(file.parameters.clone(), nodes, results)
            .ok_or_else(|| meaning("an operation acts on a value that is not defined before it"))?;
        let segments = |one: Vec<StatedSegment>| one.into_iter().map(ParameterSegment::try_from).collect();
        let boxes =
            file.boxes.into_iter().map(segments).collect::<Result<Vec<Vec<ParameterSegment>>, _>>()?;
        Ok(Certificate {
            plant: CertifiedPlant {
                parameters: file.parameters,
                variables: file.variables,
                boxes,
                coefficients,
                lengths,
                has_dead_time: dead_time.is_some(),
                delay_s: file.delay,
                dead_time_terms: file.terms,
                model_degree: file.model_degree,
            },
            feedback: file.feedback.into(),
            prefilter: file.prefilter.into(),
            sensor: file.sensor.into(),
            sampling: file.sampling.map(Sampling::try_from).transpose()?,
            claims: file.claims.into_iter().map(Claim::try_from).collect::<Result<_, _>>()?,
        })
    }
}

impl Operation {
    fn of(node: &Node) -> Option<Operation> {
        let one = |name: &str, value: f64| Some(Operation::Number((name.to_string(), value)));
        match *node {
            Node::Parameter(index) => one("parameter", index as f64),
            Node::Constant(value) => one("number", value),
            Node::Unary(unary, x) => one(word_of(&UNARY, &unary), x as f64),
            Node::Binary(binary, x, y) => Some(Operation::Two((word_of(&BINARY, &binary).to_string(), x, y))),
            Node::Select(x, y, if_less, otherwise) => {
                Some(Operation::Four((SELECT.to_string(), x, y, if_less, otherwise)))
            }
        }
    }

    fn node(&self) -> Result<Node, CertificateError> {
        let index = |value: f64| match value >= 0.0 && value == value.trunc() && value < 1e9 {
            true => Ok(value as usize),
            false => Err(meaning(format!("{value} is not the place of an operation"))),
        };
        match self {
            Operation::Number((name, value)) => match name.as_str() {
                "parameter" => Ok(Node::Parameter(index(*value)?)),
                "number" => Ok(Node::Constant(*value)),
                name => match named(&UNARY, name) {
                    Some(unary) => Ok(Node::Unary(unary, index(*value)?)),
                    None => Err(meaning(format!("`{name}` is not an operation on one number"))),
                },
            },
            Operation::Four((name, x, y, if_less, otherwise)) if name == SELECT => {
                Ok(Node::Select(*x, *y, *if_less, *otherwise))
            }
            Operation::Four((name, ..)) => {
                Err(meaning(format!("`{name}` is not an operation on four numbers")))
            }
            Operation::Two((name, x, y)) => match named(&BINARY, name) {
                Some(binary) => Ok(Node::Binary(binary, *x, *y)),
                None => Err(meaning(format!("`{name}` is not an operation on two numbers"))),
            },
        }
    }
}

impl From<&ControlLaw> for StatedLaw {
    fn from(law: &ControlLaw) -> StatedLaw {
        match law {
            ControlLaw::Continuous(quotient) => StatedLaw::Continuous(quotient.into()),
            ControlLaw::Sampled(Sections { gain, numerator, denominator }) => {
                StatedLaw::Sampled(StatedSections {
                    gain: *gain,
                    numerator: numerator.clone(),
                    denominator: denominator.clone(),
                })
            }
        }
    }
}

impl From<StatedLaw> for ControlLaw {
    fn from(stated: StatedLaw) -> ControlLaw {
        match stated {
            StatedLaw::Continuous(quotient) => ControlLaw::Continuous(quotient.into()),
            StatedLaw::Sampled(StatedSections { gain, numerator, denominator }) => {
                ControlLaw::Sampled(Sections { gain, numerator, denominator })
            }
        }
    }
}

impl From<&Sampling> for StatedSampling {
    fn from(sampling: &Sampling) -> StatedSampling {
        let bound = |one: &RollOffBound| StatedBound {
            order: one.order,
            ratio: one.ratio,
            panels: covers(&one.panels),
        };
        let bounds = sampling.bounds.iter().map(|of_box| of_box.iter().map(bound).collect()).collect();
        StatedSampling {
            sample_time: sampling.sample_time_s,
            sensor_delay: sampling.sensor_delay_s,
            images: sampling.images,
            bounds,
        }
    }
}

impl TryFrom<StatedSampling> for Sampling {
    type Error = CertificateError;

    fn try_from(stated: StatedSampling) -> Result<Sampling, CertificateError> {
        let bound = |one: StatedBound| {
            Ok(RollOffBound { order: one.order, ratio: one.ratio, panels: panels(one.panels)? })
        };
        let of_box = |bounds: Vec<StatedBound>| bounds.into_iter().map(bound).collect();
        let bounds = stated.bounds.into_iter().map(of_box).collect::<Result<_, CertificateError>>()?;
        let StatedSampling { sample_time, sensor_delay, images, .. } = stated;
        Ok(Sampling { sample_time_s: sample_time, sensor_delay_s: sensor_delay, images, bounds })
    }
}

impl From<&Quotient> for CertificateRational {
    fn from(one: &Quotient) -> CertificateRational {
        CertificateRational { numerator: one.numerator.clone(), denominator: one.denominator.clone() }
    }
}

impl From<CertificateRational> for Quotient {
    fn from(one: CertificateRational) -> Quotient {
        Quotient { numerator: one.numerator, denominator: one.denominator }
    }
}
