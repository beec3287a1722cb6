//! The claims of a certificate and their panels, as the file has them.

use phea_engineering::specification::closed_loop_key;
use phea_qft::proof::{
    CertificateMember, CertificateSide, Claim, FrequencyPanel, Late, LimitOf, LimitedLoop, PoleCount,
    StableBox,
};
use serde::{Deserialize, Serialize};

use super::{CertificateError, CertificateRational, meaning};

use crate::project::{SPECIFICATION_KINDS, SpecificationKind};

#[derive(Serialize, Deserialize)]
#[serde(tag = "claim", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum StatedClaim {
    Stable {
        boxes: Vec<StatedBox>,
    },
    Unstable {
        #[serde(rename = "box")]
        of_box: usize,
        member: Vec<f64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        count: Option<StatedCount>,
    },
    Limited {
        closed_loop: String,
        side: String,
        limit: StatedLimit,
        band: [FrequencyEnd; 2],
        ratio: f64,
        boxes: Vec<Vec<Cover>>,
    },
    Reached {
        closed_loop: String,
        side: String,
        limit: StatedLimit,
        band: [FrequencyEnd; 2],
        ratio: f64,
        frequency: FrequencyEnd,
        #[serde(rename = "box")]
        of_box: usize,
        member: Vec<f64>,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatedBox {
    member: Vec<f64>,
    panels: Vec<Cover>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    delays: Vec<Cover>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    count: Option<StatedCount>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatedCount {
    characteristic: Vec<Cover>,
    denominator: Vec<Cover>,
    beyond: Vec<Cover>,
}

impl From<&PoleCount> for StatedCount {
    fn from(count: &PoleCount) -> StatedCount {
        let PoleCount { characteristic, denominator, beyond } = count;
        let [characteristic, denominator, beyond] =
            [characteristic, denominator, beyond].map(|one| covers(one));
        StatedCount { characteristic, denominator, beyond }
    }
}

impl TryFrom<StatedCount> for PoleCount {
    type Error = CertificateError;

    fn try_from(stated: StatedCount) -> Result<PoleCount, CertificateError> {
        let StatedCount { characteristic, denominator, beyond } = stated;
        let (characteristic, denominator) = (panels(characteristic)?, panels(denominator)?);
        Ok(PoleCount { characteristic, denominator, beyond: panels(beyond)? })
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Cover {
    from: FrequencyEnd,
    to: FrequencyEnd,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    late: Option<Lateness>,
    tree: String,
}

/// A quotient, or a table.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum StatedLimit {
    Quotient(CertificateRational),
    Table(StatedTable),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatedTable {
    /// Frequency in rad/s, and magnitude.
    table: Vec<(f64, f64)>,
}

impl From<&LimitOf> for StatedLimit {
    fn from(limit: &LimitOf) -> StatedLimit {
        match limit {
            LimitOf::Quotient(quotient) => StatedLimit::Quotient(quotient.into()),
            LimitOf::Table(points) => StatedLimit::Table(StatedTable { table: points.clone() }),
        }
    }
}

impl From<StatedLimit> for LimitOf {
    fn from(stated: StatedLimit) -> LimitOf {
        match stated {
            StatedLimit::Quotient(quotient) => LimitOf::Quotient(quotient.into()),
            StatedLimit::Table(StatedTable { table }) => LimitOf::Table(table),
        }
    }
}

/// The angle around which dead time turns, or a word.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum Lateness {
    Turns(f64),
    Any(String),
}

/// A frequency in rad/s, or "inf".
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum FrequencyEnd {
    Finite(f64),
    Infinite(String),
}

impl From<f64> for FrequencyEnd {
    fn from(value: f64) -> FrequencyEnd {
        if value.is_finite() {
            FrequencyEnd::Finite(value)
        } else {
            FrequencyEnd::Infinite("inf".to_string())
        }
    }
}

impl FrequencyEnd {
    fn value(&self) -> Result<f64, CertificateError> {
        match self {
            FrequencyEnd::Finite(value) => Ok(*value),
            FrequencyEnd::Infinite(word) if word == "inf" => Ok(f64::INFINITY),
            FrequencyEnd::Infinite(word) => Err(meaning(format!("`{word}` is not a frequency"))),
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

pub(super) fn covers(panels: &[FrequencyPanel]) -> Vec<Cover> {
    let hexadecimal = |tree: &[u8]| tree.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let cover = |panel: &FrequencyPanel| Cover {
        from: panel.from.into(),
        to: panel.to.into(),
        late: lateness(panel.late),
        tree: hexadecimal(&panel.tree),
    };
    panels.iter().map(cover).collect()
}

pub(super) fn panels(covers: Vec<Cover>) -> Result<Vec<FrequencyPanel>, CertificateError> {
    let bytes = |text: &str| -> Result<Vec<u8>, CertificateError> {
        let digits = text.chars().map(|digit| digit.to_digit(16)).collect::<Option<Vec<u32>>>();
        let digits = digits.filter(|digits| digits.len() % 2 == 0);
        let digits = digits.ok_or_else(|| meaning("a tree is written in pairs of hexadecimal digits"))?;
        Ok(digits.chunks(2).map(|pair| (16 * pair[0] + pair[1]) as u8).collect())
    };
    let panel = |cover: Cover| {
        let (from, to) = (cover.from.value()?, cover.to.value()?);
        Ok(FrequencyPanel { from, to, late: late(cover.late)?, tree: bytes(&cover.tree)? })
    };
    covers.into_iter().map(panel).collect()
}

fn side_key(side: CertificateSide) -> String {
    match side {
        CertificateSide::Upper => "upper",
        CertificateSide::Lower => "lower",
    }
    .to_string()
}

fn limited(
    closed_loop: &str,
    side: &str,
    limit: StatedLimit,
    band: &[FrequencyEnd; 2],
) -> Result<LimitedLoop, CertificateError> {
    let known = SPECIFICATION_KINDS.iter().find(|(key, _)| *key == closed_loop).map(|(_, known)| *known);
    let found = match known {
        Some(SpecificationKind::ClosedLoop(known)) => Some(known),
        Some(SpecificationKind::Step) | None => None,
    };
    Ok(LimitedLoop {
        closed_loop: found.ok_or_else(|| meaning(format!("`{closed_loop}` is not a closed loop")))?,
        side: match side {
            "upper" => CertificateSide::Upper,
            "lower" => CertificateSide::Lower,
            _ => return Err(meaning(format!("`{side}` is not a side of a limit"))),
        },
        limit: limit.into(),
        band_rad_per_s: [band[0].value()?, band[1].value()?],
    })
}

impl From<&Claim> for StatedClaim {
    fn from(claim: &Claim) -> StatedClaim {
        let of = |limited: &LimitedLoop| {
            let key = closed_loop_key(limited.closed_loop).to_string();
            let band = limited.band_rad_per_s.map(FrequencyEnd::from);
            (key, side_key(limited.side), StatedLimit::from(&limited.limit), band)
        };
        match claim {
            Claim::Stable(boxes) => {
                let stated = |one: &StableBox| StatedBox {
                    member: one.member.clone(),
                    panels: covers(&one.panels),
                    delays: covers(&one.delays),
                    count: one.count.as_ref().map(StatedCount::from),
                };
                StatedClaim::Stable { boxes: boxes.iter().map(stated).collect() }
            }
            Claim::Unstable { member, count } => {
                let count = count.as_ref().map(StatedCount::from);
                StatedClaim::Unstable { of_box: member.of_box, member: member.variables.clone(), count }
            }
            Claim::Limited { limited, ratio, boxes } => {
                let (closed_loop, side, limit, band) = of(limited);
                let boxes = boxes.iter().map(|panels| covers(panels)).collect();
                StatedClaim::Limited { closed_loop, side, limit, band, ratio: *ratio, boxes }
            }
            Claim::Reached { limited, ratio, frequency_rad_per_s, member } => {
                let (closed_loop, side, limit, band) = of(limited);
                let (frequency, of_box) = (FrequencyEnd::from(*frequency_rad_per_s), member.of_box);
                let member = member.variables.clone();
                StatedClaim::Reached {
                    closed_loop,
                    side,
                    limit,
                    band,
                    ratio: *ratio,
                    frequency,
                    of_box,
                    member,
                }
            }
        }
    }
}

impl TryFrom<StatedClaim> for Claim {
    type Error = CertificateError;

    fn try_from(stated: StatedClaim) -> Result<Claim, CertificateError> {
        Ok(match stated {
            StatedClaim::Stable { boxes } => {
                let stable = |one: StatedBox| {
                    let (panels, delays) = (panels(one.panels)?, panels(one.delays)?);
                    let count = one.count.map(PoleCount::try_from).transpose()?;
                    Ok(StableBox { member: one.member, panels, delays, count })
                };
                Claim::Stable(boxes.into_iter().map(stable).collect::<Result<_, CertificateError>>()?)
            }
            StatedClaim::Unstable { of_box, member, count } => {
                let count = count.map(PoleCount::try_from).transpose()?;
                Claim::Unstable { member: CertificateMember { of_box, variables: member }, count }
            }
            StatedClaim::Limited { closed_loop, side, limit, band, ratio, boxes } => Claim::Limited {
                limited: limited(&closed_loop, &side, limit, &band)?,
                ratio,
                boxes: boxes.into_iter().map(panels).collect::<Result<_, _>>()?,
            },
            StatedClaim::Reached { closed_loop, side, limit, band, ratio, frequency, of_box, member } => {
                Claim::Reached {
                    limited: limited(&closed_loop, &side, limit, &band)?,
                    ratio,
                    frequency_rad_per_s: frequency.value()?,
                    member: CertificateMember { of_box, variables: member },
                }
            }
        })
    }
}
