//! Results of tasks as bytes: every number bit for bit, infinities and NaN too.

use phea_engineering::alternatives::ColumnKey;
use serde::{Deserialize, Serialize};

use super::PrintedTask;
use crate::error::TaskResultError;

/// A result with the place of its task in the plan.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct EncodedTask {
    pub(crate) place: usize,
    pub(crate) task: PrintedTask,
}

/// The bytes of a result.
///
/// # Errors
/// [`TaskResultError::NotEncoded`].
pub(crate) fn encoded(task: &EncodedTask) -> Result<Vec<u8>, TaskResultError> {
    postcard::to_allocvec(task).map_err(TaskResultError::NotEncoded)
}

/// The result of these bytes.
///
/// # Errors
/// [`TaskResultError::NotDecoded`].
pub(crate) fn decoded(bytes: &[u8]) -> Result<EncodedTask, TaskResultError> {
    postcard::from_bytes(bytes).map_err(TaskResultError::NotDecoded)
}

/// Keys of numbers, by their places among all.
pub(super) mod column_key {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Error as _, Serialize, Serializer};

    use super::ColumnKey;

    pub(crate) fn serialize<S: Serializer>(key: &ColumnKey, serializer: S) -> Result<S::Ok, S::Error> {
        let place = ColumnKey::ALL.iter().position(|known| known == key);
        place.ok_or_else(|| S::Error::custom("unlisted column"))?.serialize(serializer)
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(deserializer: D) -> Result<ColumnKey, D::Error> {
        let place = usize::deserialize(deserializer)?;
        ColumnKey::ALL.get(place).copied().ok_or_else(|| D::Error::custom(format!("no column {place}")))
    }
}

/// Worst values, as the numbers of an alternative are encoded.
pub(super) mod worst_columns {
    use phea_engineering::alternatives::{ColumnKey, WorstColumn, WorstColumns};
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::{Serialize, Serializer};

    use crate::quantity::DisplayUnit;

    #[derive(serde::Serialize, serde::Deserialize)]
    struct EncodedColumn {
        #[serde(with = "super::column_key")]
        key: ColumnKey,
        #[serde(with = "crate::unit_encoding")]
        unit: DisplayUnit,
        digits: usize,
        value: Option<f64>,
    }

    pub(crate) fn serialize<S: Serializer>(all: &WorstColumns, serializer: S) -> Result<S::Ok, S::Error> {
        let encoded = |&WorstColumn { key, unit, digits, value }: &WorstColumn| EncodedColumn {
            key,
            unit,
            digits,
            value,
        };
        all.0.iter().map(encoded).collect::<Vec<_>>().serialize(serializer)
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(deserializer: D) -> Result<WorstColumns, D::Error> {
        let all = <Vec<EncodedColumn>>::deserialize(deserializer)?.into_iter();
        let decoded = |EncodedColumn { key, unit, digits, value }| WorstColumn { key, unit, digits, value };
        Ok(WorstColumns(all.map(decoded).collect()))
    }
}
