//! The plan of all judgements of a project: tasks that are independent of each other, each of which
//! judges one alternative.

use super::cases::JudgedLoad;
use super::front::{self, FrontPlan};
use super::{AlternativesError, AlternativesOptions};
use crate::design::DesignError;
use crate::project::{AS_DECLARED, Loaded};

/// Judgement of one alternative, by its places in an [`AlternativesPlan`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlternativeTask {
    /// An alternative under a load.
    Alternative {
        /// The load.
        load: JudgedLoad,
        /// Place of the alternative.
        place: usize,
    },
    /// An alternative at a value of the front, under the declared load.
    Point {
        /// Place of the alternative.
        place: usize,
        /// Place of the value.
        value: usize,
    },
}

impl AlternativeTask {
    /// The load under which the alternative is judged.
    pub fn load(self) -> JudgedLoad {
        match self {
            AlternativeTask::Alternative { load, .. } => load,
            AlternativeTask::Point { .. } => JudgedLoad::Declared,
        }
    }
}

/// A load case to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedCase {
    /// Name of the load case.
    pub name: String,
    /// Settings of the load case.
    pub settings: Vec<String>,
}

/// All judgements of a project.
#[derive(Clone, Debug, PartialEq)]
pub struct AlternativesPlan {
    /// Names of the declared project and of its alternatives in file order, under every load.
    pub names: Vec<String>,
    /// The load cases in file order.
    pub cases: Vec<PlannedCase>,
    /// The front over a swept key, if requested.
    pub front: Option<FrontPlan>,
    /// Frequencies at which the impedance at the load is reported, rad/s.
    pub impedance_at: Vec<f64>,
}

impl AlternativesPlan {
    /// The plan for a project.
    ///
    /// # Errors
    /// [`AlternativesError`] for a project without alternatives or specifications, and for a front
    /// that does not exist.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::alternatives::{AlternativesError, AlternativesOptions, AlternativesPlan};
    /// use phea_project::{self as project, source::Memory};
    /// let source = Memory::default().with("rig.toml", include_str!("../../../../examples/ybitu/hose.toml"));
    /// let loaded = project::read(&source, "rig.toml", &[], &[])?;
    /// let none = AlternativesPlan::new(&loaded, &AlternativesOptions::default());
    /// assert!(matches!(none, Err(AlternativesError::NoAlternative)));
    /// # Ok::<(), phea_project::Refusal>(())
    /// ```
    pub fn new(
        loaded: &Loaded,
        options: &AlternativesOptions,
    ) -> Result<AlternativesPlan, AlternativesError> {
        let project = &loaded.project;
        if project.alternatives.is_empty() {
            return Err(AlternativesError::NoAlternative);
        }
        if project.specifications.is_empty() {
            return Err(AlternativesError::NoSpecification(DesignError::NoSpecification));
        }
        let front = options.front.as_ref().map(|request| front::plan(request, project.motions()));
        let alternatives = project.alternatives.iter().map(|one| one.name.clone());
        let cases = project.load_cases.iter();
        Ok(AlternativesPlan {
            names: std::iter::once(AS_DECLARED.to_string()).chain(alternatives).collect(),
            cases: cases
                .map(|case| PlannedCase { name: case.name.clone(), settings: case.settings().collect() })
                .collect(),
            front: front.transpose()?,
            impedance_at: options.impedance_at.clone(),
        })
    }

    /// The declared load, then each load case.
    pub fn loads(&self) -> impl Iterator<Item = JudgedLoad> {
        std::iter::once(JudgedLoad::Declared).chain((0..self.cases.len()).map(JudgedLoad::Case))
    }

    /// All tasks in the order of the output: every alternative under each load, then at each value
    /// of the front.
    pub fn tasks(&self) -> Vec<AlternativeTask> {
        let places = 0..self.names.len();
        let under = |load| places.clone().map(move |place| AlternativeTask::Alternative { load, place });
        let values = self.front.as_ref().map_or(0, |front| front.values.len());
        let points = places
            .clone()
            .flat_map(|place| (0..values).map(move |value| AlternativeTask::Point { place, value }));
        self.loads().flat_map(under).chain(points).collect()
    }
}
