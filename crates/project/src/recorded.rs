//! Values from recordings that replace declared ones.

/// File with its hash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HashedFile {
    /// Name in the project.
    pub path: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// Identified number. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedNumber {
    /// Path in the project, such as `valve.leakage_shape`.
    pub path: String,
    /// Unit.
    pub unit: &'static str,
    /// Value in place of the declared one.
    pub value: f64,
    /// Confidence interval of 95 %.
    pub interval: [f64; 2],
    /// Declared value; absent if none is declared.
    pub declared: Option<f64>,
}

/// Number that remains as declared, because the recordings do not determine it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnchangedNumber {
    /// Path of the number in the project.
    pub path: String,
    /// Reason.
    pub reason: UnchangedReason,
}

/// Reason why a number remains as declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnchangedReason {
    /// The recordings do not determine it.
    NotIdentifiable,
    /// The confidence interval contains zero.
    MayVanish,
}

/// Family that replaces the declared one: the directions of the project.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedFamily {
    /// Largest relative change of K_qU and K_c along each direction, from its middle to an end.
    pub effects: Vec<f64>,
    /// Number of omitted directions.
    pub left_out: usize,
    /// Largest relative change of K_qU or K_c from the omitted directions together.
    pub effect_left_out: f64,
    /// Standard deviations to either side.
    pub deviations: f64,
}

/// Values from recordings that replace declared ones.
#[derive(Clone, Debug, PartialEq)]
pub struct FromRecordings {
    /// Hash of the project file without recordings.
    pub project_sha256: String,
    /// Recordings, in the order of the project.
    pub files: Vec<HashedFile>,
    /// Identified numbers.
    pub numbers: Vec<IdentifiedNumber>,
    /// Numbers that remain as declared.
    pub unchanged: Vec<UnchangedNumber>,
    /// Pressure drops from supply to tank at which the tare flow is stated, Pa: of the recordings,
    /// and as declared.
    pub tare_pressures: [f64; 2],
    /// Remaining uncertainty, if in use.
    pub family: Option<IdentifiedFamily>,
    /// Equivalent `path=value` settings, applied to the file before those of the user.
    pub settings: Vec<String>,
}
