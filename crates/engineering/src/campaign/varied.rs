//! Numbers that a campaign varies, read from its project.

use super::CampaignError;
use super::range::VariedRange;
use crate::project::{Campaign, DIRECTION, Distribution, Project, Scenario, UncertaintyDirection, Varied};

/// Ranges of all varied numbers, in file order: those that the campaign names, then the directions
/// of the project, each standard normal.
///
/// # Errors
/// [`CampaignError`] if a spread has no declared number to spread around, or a logarithm does not
/// exist.
pub(super) fn ranges(
    project: &Project,
    campaign: &Campaign,
    scenario: &Scenario,
) -> Result<Vec<VariedRange>, CampaignError> {
    if campaign.parameters.is_empty() && project.directions.is_empty() {
        return Err(CampaignError::Nothing);
    }
    let known = project.listed_numbers();
    let along = |direction: &UncertaintyDirection| VariedRange {
        path: direction.name.clone(),
        distribution: Distribution::Normal,
        // two standard deviations from the middle
        minimum: -2.0,
        maximum: 2.0,
        key: DIRECTION,
    };
    let range = |varied: &Varied| {
        let path = varied.path.clone();
        let Some((key, stated)) = known.get(&path).copied() else {
            return Err(CampaignError::Unknown { path });
        };
        let stated = match path.strip_prefix("start.") {
            Some(_) if scenario.start.is_none() => return Err(CampaignError::NoStart { path }),
            Some(_) if scenario.start.as_ref().is_some_and(|start| start.file.is_some()) => {
                return Err(CampaignError::SavedStart { path });
            }
            Some(state) => scenario.start.as_ref().and_then(|start| start.number(state)).or(Some(0.0)),
            None => stated,
        };
        let (minimum, maximum) = match (varied.spread, varied.minimum, varied.maximum, stated) {
            (None, Some(minimum), Some(maximum), _) => (minimum, maximum),
            (Some(spread), _, _, Some(value)) if value != 0.0 => {
                (value - spread * value.abs(), value + spread * value.abs())
            }
            _ => return Err(CampaignError::NotStated { path }),
        };
        let distribution = varied.distribution.unwrap_or(campaign.distribution);
        if distribution == Distribution::LogUniform && minimum <= 0.0 {
            return Err(CampaignError::NoLogarithm { path, minimum });
        }
        Ok(VariedRange { path, distribution, minimum, maximum, key })
    };
    let own = campaign.parameters.iter().map(range);
    own.chain(project.directions.iter().map(|direction| Ok(along(direction)))).collect()
}
