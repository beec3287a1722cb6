//! The file of a certificate: written by `verify --certificate`, read by `check-certificate` and by checkers of others.

use phea_dynamics::expression::{Binary, Expression, Node, Unary};
use phea_qft::proof::{
    Certificate, CertifiedPlant, Claim, Late, Limited, Member, Panel, Quotient, Rejection, Segment, Side,
    StableBox, check,
};
use phea_qft::specification::ClosedLoop;
use serde::{Deserialize, Serialize};

use super::{ProjectAudit, closed_loop_key};
use crate::answer::{Answer, OutputFile};
use crate::project::Loaded;

/// What the file begins with.
const FORMAT: &str = "phea-certificate";
/// Of the layout.
const VERSION: u32 = 1;
/// Its name in a folder.
pub const CERTIFICATE_FILE: &str = "certificate.json";

#[derive(Serialize, Deserialize)]
struct File {
    format: String,
    version: u32,
    phea: String,
    title: String,
    project_sha256: String,
    settings: Vec<String>,
    variables: usize,
    parameters: Vec<String>,
    /// For each box, for each parameter: low, high and the variable.
    boxes: Vec<Vec<(f64, f64, Option<usize>)>>,
    operations: Vec<Operation>,
    plant: Plant,
    #[serde(default, skip_serializing_if = "is_zero")]
    delay: f64,
    /// Of the series that stands for dead time.
    terms: usize,
    feedback: Rational,
    prefilter: Rational,
    sensor: Rational,
    claims: Vec<Stated>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// One recorded operation: its name, then what it acts on.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Operation {
    Number((String, f64)),
    Two((String, usize, usize)),
}

#[derive(Serialize, Deserialize)]
struct Plant {
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
struct Rational {
    numerator: Vec<f64>,
    denominator: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(tag = "claim", rename_all = "snake_case", deny_unknown_fields)]
enum Stated {
    Stable {
        boxes: Vec<StatedBox>,
    },
    Unstable {
        #[serde(rename = "box")]
        of_box: usize,
        member: Vec<f64>,
    },
    Limited {
        closed_loop: String,
        side: String,
        limit: Rational,
        band: [End; 2],
        ratio: f64,
        boxes: Vec<Vec<Cover>>,
    },
    Reached {
        closed_loop: String,
        side: String,
        limit: Rational,
        band: [End; 2],
        ratio: f64,
        frequency: End,
        #[serde(rename = "box")]
        of_box: usize,
        member: Vec<f64>,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedBox {
    member: Vec<f64>,
    panels: Vec<Cover>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    delays: Vec<Cover>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cover {
    from: End,
    to: End,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    late: Option<Lateness>,
    tree: String,
}

/// The angle around which dead time turns, or a word.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Lateness {
    Turns(f64),
    Any(String),
}

/// A frequency in rad/s, or "inf".
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum End {
    Finite(f64),
    Infinite(String),
}

/// Why a file is no certificate.
#[derive(Debug, thiserror::Error)]
pub enum CertificateError {
    /// No JSON of this layout.
    #[error("not a certificate: {0}")]
    Layout(#[from] serde_json::Error),
    /// Another format or version.
    #[error("this is `{format}` version {version}; `{FORMAT}` version {VERSION} is known")]
    Version {
        /// What it says it is.
        format: String,
        /// Its version.
        version: u32,
    },
    /// A word, a place or a number that means nothing.
    #[error("{0}")]
    Meaning(String),
}

fn meaning(text: impl Into<String>) -> CertificateError {
    CertificateError::Meaning(text.into())
}

/// The file of what was proven of an audit, with this name; `None` where nothing was.
pub(crate) fn certificate_of(loaded: &Loaded, view: &ProjectAudit, name: &str) -> Option<OutputFile> {
    let certificate = view.proof.as_ref()?.certificate.as_ref()?;
    Some(OutputFile { name: name.to_string(), ..file(loaded, certificate) })
}

/// The file of a certificate.
fn file(loaded: &Loaded, certificate: &Certificate) -> OutputFile {
    let plant = &certificate.plant;
    let mut results = plant.coefficients.results().iter().copied();
    let mut parts = plant.lengths.iter().map(|&length| results.by_ref().take(length).collect::<Vec<usize>>());
    let file = File {
        format: FORMAT.to_string(),
        version: VERSION,
        phea: env!("CARGO_PKG_VERSION").to_string(),
        title: loaded.project.title.clone(),
        project_sha256: loaded.sha256.clone(),
        settings: loaded.settings.clone(),
        variables: plant.variables,
        parameters: plant.parameters.clone(),
        boxes: plant
            .boxes
            .iter()
            .map(|one| one.iter().map(|Segment { low, high, variable }| (*low, *high, *variable)).collect())
            .collect(),
        operations: plant.coefficients.nodes().iter().filter_map(Operation::of).collect(),
        plant: Plant {
            numerator: parts.next().unwrap_or_default(),
            denominator: parts.next().unwrap_or_default(),
            disturbance_numerator: parts.next(),
            disturbance_denominator: parts.next(),
            dead_time: plant.has_dead_time.then(|| plant.coefficients.results().last().copied().unwrap_or(0)),
        },
        delay: plant.delay_s,
        terms: plant.dead_time_terms,
        feedback: (&certificate.feedback).into(),
        prefilter: (&certificate.prefilter).into(),
        sensor: (&certificate.sensor).into(),
        claims: certificate.claims.iter().map(Stated::from).collect(),
    };
    // only finite numbers and string keys
    let text = serde_json::to_string(&file).unwrap_or_default();
    OutputFile { name: CERTIFICATE_FILE.to_string(), bytes: format!("{text}\n").into_bytes() }
}

/// Reads the file of a certificate.
///
/// # Errors
/// [`CertificateError`].
pub fn read_certificate(text: &str) -> Result<Certificate, CertificateError> {
    let file: File = serde_json::from_str(text)?;
    if file.format != FORMAT || file.version != VERSION {
        return Err(CertificateError::Version { format: file.format, version: file.version });
    }
    certificate(file)
}

fn certificate(file: File) -> Result<Certificate, CertificateError> {
    let nodes = file.operations.iter().map(Operation::node).collect::<Result<Vec<Node>, _>>()?;
    let Plant { numerator, denominator, disturbance_numerator, disturbance_denominator, dead_time } =
        file.plant;
    let mut parts = vec![numerator, denominator];
    parts.extend(disturbance_numerator.zip(disturbance_denominator).into_iter().flat_map(|(n, d)| [n, d]));
    let lengths = parts.iter().map(Vec::len).collect();
    let mut results = parts.concat();
    results.extend(dead_time);
    let coefficients = Expression::from_nodes(file.parameters.clone(), nodes, results)
        .ok_or_else(|| meaning("an operation acts on what does not stand before it"))?;
    let segments = |one: Vec<(f64, f64, Option<usize>)>| {
        one.into_iter().map(|(low, high, variable)| Segment { low, high, variable }).collect()
    };
    Ok(Certificate {
        plant: CertifiedPlant {
            parameters: file.parameters,
            variables: file.variables,
            boxes: file.boxes.into_iter().map(segments).collect(),
            coefficients,
            lengths,
            has_dead_time: dead_time.is_some(),
            delay_s: file.delay,
            dead_time_terms: file.terms,
        },
        feedback: file.feedback.into(),
        prefilter: file.prefilter.into(),
        sensor: file.sensor.into(),
        claims: file.claims.into_iter().map(Claim::try_from).collect::<Result<_, _>>()?,
    })
}

/// Checks the file of a certificate: the answer is yes where every claim holds.
///
/// # Errors
/// [`CertificateError`] for a file that is no certificate.
pub fn check_certificate(text: &str) -> Result<Answer, CertificateError> {
    let file: File = serde_json::from_str(text)?;
    let (title, project_sha256) = (file.title.clone(), file.project_sha256.clone());
    let certificate = read_certificate(text)?;
    let rejected = check(&certificate).err();
    Ok(answer(&title, &project_sha256, &certificate, rejected.as_ref()))
}

#[derive(Serialize)]
struct CheckBody<'a> {
    schema: u32,
    version: &'static str,
    command: &'static str,
    title: &'a str,
    project_sha256: &'a str,
    valid: bool,
    claims: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rejected_claim: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

fn answer(
    title: &str,
    project_sha256: &str,
    certificate: &Certificate,
    rejected: Option<&(usize, Rejection)>,
) -> Answer {
    let claims: Vec<String> = certificate.claims.iter().map(sentence).collect();
    let mut text = format!("{title}\n");
    for (index, claim) in claims.iter().enumerate() {
        let word = match rejected {
            Some((number, _)) if *number == index + 1 => "rejected",
            Some((number, _)) if *number < index + 1 => "not checked",
            _ => "holds",
        };
        text.push_str(&format!("  {word}: {claim}\n"));
    }
    match rejected {
        Some((number, reason)) => {
            text.push_str(&format!("The certificate is rejected at claim {number}: {reason}.\n"))
        }
        None => text.push_str(&format!("Every claim holds: {}.\n", claims.len())),
    }
    let body = CheckBody {
        schema: crate::answer::SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        command: "check-certificate",
        title,
        project_sha256,
        valid: rejected.is_none(),
        claims,
        rejected_claim: rejected.map(|(number, _)| *number),
        reason: rejected.map(|(_, reason)| reason.to_string()),
    };
    let json = serde_json::to_string_pretty(&body).unwrap_or_default();
    Answer { text, json, files: vec![], affirmative: rejected.is_none() }
}

/// A claim in a sentence without its end.
fn sentence(claim: &Claim) -> String {
    let decibels = |ratio: f64| format!("{:+.4} dB", 20.0 * phea_dynamics::portable::log10(ratio));
    let of = |limited: &Limited| match limited.side {
        Side::Upper => format!("{} over its limit", closed_loop_key(limited.closed_loop)),
        Side::Lower => format!("lower limit over {}", closed_loop_key(limited.closed_loop)),
    };
    match claim {
        Claim::Stable(_) => "every plant of the box is stable in the loop".to_string(),
        Claim::Unstable(_) => "a plant of the box is not stable in the loop".to_string(),
        Claim::Limited { limited, ratio, .. } => {
            format!(
                "{} is at most {} for every plant and every frequency of the band",
                of(limited),
                decibels(*ratio)
            )
        }
        Claim::Reached { limited, ratio, frequency_rad_per_s, .. } => format!(
            "{} is at least {} with a plant of the box at {frequency_rad_per_s} rad/s",
            of(limited),
            decibels(*ratio)
        ),
    }
}

impl Operation {
    fn of(node: &Node) -> Option<Operation> {
        let one = |name: &str, value: f64| Some(Operation::Number((name.to_string(), value)));
        let two = |name: &str, x: usize, y: usize| Some(Operation::Two((name.to_string(), x, y)));
        match *node {
            Node::Parameter(index) => one("parameter", index as f64),
            Node::Constant(value) => one("number", value),
            Node::Unary(Unary::Negate, x) => one("negate", x as f64),
            Node::Binary(Binary::Add, x, y) => two("add", x, y),
            Node::Binary(Binary::Subtract, x, y) => two("subtract", x, y),
            Node::Binary(Binary::Multiply, x, y) => two("multiply", x, y),
            Node::Binary(Binary::Divide, x, y) => two("divide", x, y),
            Node::Unary(..) | Node::Select(..) => None,
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
                "negate" => Ok(Node::Unary(Unary::Negate, index(*value)?)),
                _ => Err(meaning(format!("`{name}` is not an operation on one number"))),
            },
            Operation::Two((name, x, y)) => match name.as_str() {
                "add" => Ok(Node::Binary(Binary::Add, *x, *y)),
                "subtract" => Ok(Node::Binary(Binary::Subtract, *x, *y)),
                "multiply" => Ok(Node::Binary(Binary::Multiply, *x, *y)),
                "divide" => Ok(Node::Binary(Binary::Divide, *x, *y)),
                _ => Err(meaning(format!("`{name}` is not an operation on two numbers"))),
            },
        }
    }
}

impl From<&Quotient> for Rational {
    fn from(one: &Quotient) -> Rational {
        Rational { numerator: one.numerator.clone(), denominator: one.denominator.clone() }
    }
}

impl From<Rational> for Quotient {
    fn from(one: Rational) -> Quotient {
        Quotient { numerator: one.numerator, denominator: one.denominator }
    }
}

impl From<f64> for End {
    fn from(value: f64) -> End {
        if value.is_finite() { End::Finite(value) } else { End::Infinite("inf".to_string()) }
    }
}

impl End {
    fn value(&self) -> Result<f64, CertificateError> {
        match self {
            End::Finite(value) => Ok(*value),
            End::Infinite(word) if word == "inf" => Ok(f64::INFINITY),
            End::Infinite(word) => Err(meaning(format!("`{word}` is not a frequency"))),
        }
    }
}

fn lateness(late: Late) -> Option<Lateness> {
    match late {
        Late::Not => None,
        Late::Turns(angle) => Some(Lateness::Turns(angle)),
        Late::Less => Some(Lateness::Any("less".to_string())),
        Late::More => Some(Lateness::Any("more".to_string())),
    }
}

fn late(lateness: Option<Lateness>) -> Result<Late, CertificateError> {
    match lateness {
        None => Ok(Late::Not),
        Some(Lateness::Turns(angle)) => Ok(Late::Turns(angle)),
        Some(Lateness::Any(word)) if word == "less" => Ok(Late::Less),
        Some(Lateness::Any(word)) if word == "more" => Ok(Late::More),
        Some(Lateness::Any(word)) => Err(meaning(format!("`{word}` does not say how dead time is taken"))),
    }
}

fn covers(panels: &[Panel]) -> Vec<Cover> {
    let hexadecimal = |tree: &[u8]| tree.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let cover = |panel: &Panel| Cover {
        from: panel.from.into(),
        to: panel.to.into(),
        late: lateness(panel.late),
        tree: hexadecimal(&panel.tree),
    };
    panels.iter().map(cover).collect()
}

fn panels(covers: Vec<Cover>) -> Result<Vec<Panel>, CertificateError> {
    let bytes = |text: &str| -> Result<Vec<u8>, CertificateError> {
        let digits = text.chars().map(|digit| digit.to_digit(16)).collect::<Option<Vec<u32>>>();
        let digits = digits.filter(|digits| digits.len() % 2 == 0);
        let digits = digits.ok_or_else(|| meaning("a tree is written in pairs of hexadecimal digits"))?;
        Ok(digits.chunks(2).map(|pair| (16 * pair[0] + pair[1]) as u8).collect())
    };
    let panel = |cover: Cover| {
        let (from, to) = (cover.from.value()?, cover.to.value()?);
        Ok(Panel { from, to, late: late(cover.late)?, tree: bytes(&cover.tree)? })
    };
    covers.into_iter().map(panel).collect()
}

fn side_key(side: Side) -> String {
    match side {
        Side::Upper => "upper",
        Side::Lower => "lower",
    }
    .to_string()
}

fn limited(
    closed_loop: &str,
    side: &str,
    limit: Rational,
    band: &[End; 2],
) -> Result<Limited, CertificateError> {
    let known = [
        ClosedLoop::RobustStability,
        ClosedLoop::Sensitivity,
        ClosedLoop::PlantInputDisturbance,
        ClosedLoop::ControlEffort,
        ClosedLoop::LoadMotion,
        ClosedLoop::Tracking,
    ];
    let found = known.into_iter().find(|one| closed_loop_key(*one) == closed_loop);
    Ok(Limited {
        closed_loop: found.ok_or_else(|| meaning(format!("`{closed_loop}` is not a closed loop")))?,
        side: match side {
            "upper" => Side::Upper,
            "lower" => Side::Lower,
            _ => return Err(meaning(format!("`{side}` is not a side of a limit"))),
        },
        limit: limit.into(),
        band_rad_per_s: [band[0].value()?, band[1].value()?],
    })
}

impl From<&Claim> for Stated {
    fn from(claim: &Claim) -> Stated {
        let of = |limited: &Limited| {
            let key = closed_loop_key(limited.closed_loop).to_string();
            let band = limited.band_rad_per_s.map(End::from);
            (key, side_key(limited.side), Rational::from(&limited.limit), band)
        };
        match claim {
            Claim::Stable(boxes) => {
                let stated = |one: &StableBox| StatedBox {
                    member: one.member.clone(),
                    panels: covers(&one.panels),
                    delays: covers(&one.delays),
                };
                Stated::Stable { boxes: boxes.iter().map(stated).collect() }
            }
            Claim::Unstable(member) => {
                Stated::Unstable { of_box: member.of_box, member: member.variables.clone() }
            }
            Claim::Limited { limited, ratio, boxes } => {
                let (closed_loop, side, limit, band) = of(limited);
                let boxes = boxes.iter().map(|panels| covers(panels)).collect();
                Stated::Limited { closed_loop, side, limit, band, ratio: *ratio, boxes }
            }
            Claim::Reached { limited, ratio, frequency_rad_per_s, member } => {
                let (closed_loop, side, limit, band) = of(limited);
                let (frequency, of_box) = (End::from(*frequency_rad_per_s), member.of_box);
                let member = member.variables.clone();
                Stated::Reached { closed_loop, side, limit, band, ratio: *ratio, frequency, of_box, member }
            }
        }
    }
}

impl TryFrom<Stated> for Claim {
    type Error = CertificateError;

    fn try_from(stated: Stated) -> Result<Claim, CertificateError> {
        Ok(match stated {
            Stated::Stable { boxes } => {
                let stable = |one: StatedBox| {
                    let (panels, delays) = (panels(one.panels)?, panels(one.delays)?);
                    Ok(StableBox { member: one.member, panels, delays })
                };
                Claim::Stable(boxes.into_iter().map(stable).collect::<Result<_, CertificateError>>()?)
            }
            Stated::Unstable { of_box, member } => Claim::Unstable(Member { of_box, variables: member }),
            Stated::Limited { closed_loop, side, limit, band, ratio, boxes } => Claim::Limited {
                limited: limited(&closed_loop, &side, limit, &band)?,
                ratio,
                boxes: boxes.into_iter().map(panels).collect::<Result<_, _>>()?,
            },
            Stated::Reached { closed_loop, side, limit, band, ratio, frequency, of_box, member } => {
                Claim::Reached {
                    limited: limited(&closed_loop, &side, limit, &band)?,
                    ratio,
                    frequency_rad_per_s: frequency.value()?,
                    member: Member { of_box, variables: member },
                }
            }
        })
    }
}
