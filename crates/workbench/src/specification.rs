//! From the specifications of a project to those of robust design.

use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_qft::specification::{Limit, LimitError, LimitTable, Requirement, Specification};

use crate::control::from_formulas;
use crate::project::{self, FormulaError, Project, SpecificationKind};

/// Why a declared specification cannot be judged by.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("[[specification]] {number}, `{key}`: {reason}")]
pub struct SpecificationError {
    /// Its place in the file, from 1.
    pub number: usize,
    /// `limit`, `upper` or `lower`.
    pub key: &'static str,
    /// What is wrong with it.
    pub reason: SpecificationProblem,
}

/// What is wrong with a limit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpecificationProblem {
    /// It is not there.
    #[error("this kind of specification needs it")]
    Missing,
    /// The text is no ratio of polynomials.
    #[error("{message}", message = .0.message)]
    Formula(FormulaError),
    /// The polynomials make no transfer function.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// The table is none.
    #[error(transparent)]
    Table(#[from] LimitError),
}

/// The specifications of a project, in file order.
///
/// # Errors
/// [`SpecificationError`] for a limit that is absent or no function of frequency.
///
/// # Example
/// ```
/// use phea_workbench::source::Memory;
/// let text = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s\"\n\
///             [[specification]]\nkind = \"sensitivity\"\nlimit = \"s/(s + 15)\"\nfrequencies = [1, 15]\n";
/// let source = Memory::default().with("servo.toml", text);
/// let project = phea_workbench::project::read(&source, "servo.toml", &[], &[])?.project;
/// let specifications = phea_workbench::specification::specifications(&project)?;
/// assert_eq!(specifications[0].band_rad_per_s, [1.0, 15.0]); // the span of the frequencies
/// let phea_qft::specification::Requirement::Sensitivity(limit) = &specifications[0].requirement else { panic!() };
/// assert!((limit.magnitude(15.0).unwrap() - 0.5_f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn specifications(project: &Project) -> Result<Vec<Specification>, SpecificationError> {
    let numbered = project.specifications.iter().enumerate();
    numbered.map(|(index, declared)| specification(declared, index + 1)).collect()
}

fn specification(
    declared: &project::Specification,
    number: usize,
) -> Result<Specification, SpecificationError> {
    let limit_of = |key: &'static str, limit: &Option<project::Limit>| {
        let found = limit.as_ref().ok_or(SpecificationProblem::Missing).and_then(limit_over_frequency);
        found.map_err(|reason| SpecificationError { number, key, reason })
    };
    let limit = || limit_of("limit", &declared.limit);
    let requirement = match declared.kind {
        SpecificationKind::RobustStability => Requirement::RobustStability(limit()?),
        SpecificationKind::Sensitivity => Requirement::Sensitivity(limit()?),
        SpecificationKind::PlantInputDisturbance => Requirement::PlantInputDisturbance(limit()?),
        SpecificationKind::ControlEffort => Requirement::ControlEffort(limit()?),
        SpecificationKind::LoadMotion => Requirement::LoadMotion(limit()?),
        SpecificationKind::Tracking => Requirement::Tracking {
            lower: limit_of("lower", &declared.lower)?,
            upper: limit_of("upper", &declared.upper)?,
        },
    };
    Ok(Specification {
        requirement,
        frequencies_rad_per_s: declared.frequencies.clone(),
        band_rad_per_s: declared.band_rad_per_s(),
    })
}

fn limit_over_frequency(limit: &project::Limit) -> Result<Limit, SpecificationProblem> {
    Ok(match limit {
        project::Limit::Constant(value) => Limit::Constant(*value),
        project::Limit::Text(formula) => {
            let ratio = formula.numbers().map_err(SpecificationProblem::Formula)?;
            let [numerator, denominator] = [ratio.numerator, ratio.denominator].map(Polynomial::new);
            Limit::Rational(TransferFunction::from_polynomials(&numerator, &denominator)?)
        }
        project::Limit::Rational(rational) => {
            let function = from_formulas(&rational.numerator, &rational.denominator);
            Limit::Rational(function.map_err(SpecificationProblem::Formula)??)
        }
        project::Limit::Table(table) => {
            let points = table.frequencies.iter().copied().zip(table.values.iter().copied());
            Limit::Table(LimitTable::new(points.collect())?)
        }
    })
}
