//! The words of the conditions that begin and end in a run.

use phea_engineering::simulate::{COMMAND_LIMIT, ERRORS_AMPLIFIED, LINE_OCCURRENCES, REPEATED};

use crate::answer::{Word, describe_words};
use phea_hydraulics::machine::INDICATORS;

/// The word for a condition of a machine or of its command.
#[derive(Clone, Copy)]
pub(crate) struct OccurrenceKind(pub(crate) &'static str);

impl Word for OccurrenceKind {
    fn word(&self) -> &'static str {
        self.0
    }
}

describe_words! {
    ["Condition of a machine or of its command, of which those of a line only begin."]
    OccurrenceKind all INDICATORS.into_iter().chain([COMMAND_LIMIT]).chain(LINE_OCCURRENCES).collect()
}

/// The word for a condition of a run of a campaign.
#[derive(Clone, Copy)]
pub(crate) struct CampaignOccurrenceKind(pub(crate) &'static str);

impl Word for CampaignOccurrenceKind {
    fn word(&self) -> &'static str {
        self.0
    }
}

describe_words! {
    ["Condition of a machine or of its command in a run, a run that was repeated until its metrics agreed, or one whose errors may be visible."]
    CampaignOccurrenceKind all INDICATORS
        .into_iter()
        .chain([COMMAND_LIMIT, ERRORS_AMPLIFIED, REPEATED])
        .chain(LINE_OCCURRENCES)
        .collect()
}
