//! What recordings gave in place of what a project declares.

/// A file as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HashedFile {
    /// As the project names it.
    pub path: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// A number that was identified. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedNumber {
    /// Of the project, such as `valve.leakage_shape`.
    pub path: String,
    /// Its unit.
    pub unit: &'static str,
    /// In place of the declared one.
    pub value: f64,
    /// Its 95 % confidence interval.
    pub interval: [f64; 2],
    /// What the project declares; absent where it declares none.
    pub declared: Option<f64>,
}

/// A number that stays as declared, because the recordings do not determine it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptNumber {
    /// Path of the number in the project.
    pub path: String,
    /// Why.
    pub reason: KeptReason,
}

/// Reason for which a number stays as declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptReason {
    /// The recordings do not determine it.
    NotIdentifiable,
    /// Its interval contains zero.
    MayVanish,
}

/// The family that takes the place of the declared one: the directions of the project.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedFamily {
    /// Largest relative change of K_qU and K_c that each direction makes from its middle to an end.
    pub effects: Vec<f64>,
    /// Directions that were left out.
    pub left_out: usize,
    /// Largest relative change of K_qU or K_c that those make together.
    pub effect_left_out: f64,
    /// Standard deviations to either side.
    pub deviations: f64,
}

/// What recordings gave in place of what the project declares.
#[derive(Clone, Debug, PartialEq)]
pub struct FromRecordings {
    /// Hash of the project file alone.
    pub project_sha256: String,
    /// The recordings, in the order of the project.
    pub files: Vec<HashedFile>,
    /// What they determine.
    pub numbers: Vec<IdentifiedNumber>,
    /// What they do not determine.
    pub kept: Vec<KeptNumber>,
    /// Pa, drops from supply to tank at which the tare flow is stated: of the recordings, and as
    /// declared.
    pub tare_pressures: [f64; 2],
    /// What they leave uncertain, where it is in use.
    pub family: Option<IdentifiedFamily>,
    /// The same as `path=value` texts that make the project of its file, before the user's.
    pub settings: Vec<String>,
}
