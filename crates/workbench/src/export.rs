//! Files that run the controller of a project elsewhere, as it was verified.
//!
//! ```text
//! Deployed, Contract, vectors -> ExportedController -> ExportKind::files -> NAME.h, NAME.c, ...
//! ```

pub mod c;
mod contract;
mod kind;
mod name;
pub mod ros2;
pub mod script;
mod signal;
pub mod structured_text;
mod vectors;

use phea_machine::Deployed;

use crate::plant_values::Factors;

pub use contract::Contract;
pub use kind::ExportKind;
pub use name::identifier;
pub use signal::DeployedSignal;
pub use vectors::{TestVector, VectorOperation, test_vectors};

/// Longest line of the head of a file.
const WIDTH: usize = 96;

/// A controller with everything that its files state.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedController {
    /// Identifier with which the names of files, types and functions begin.
    pub name: String,
    /// The controller as its computer executes it.
    pub deployed: Deployed,
    /// Facts in the head of every file.
    pub contract: Contract,
    /// Samples with the outputs that the controller must give.
    pub vectors: Vec<TestVector>,
    /// Names of the uncertain parameters.
    pub parameters: Vec<String>,
    /// Plants of the family that have polynomials, the nominal one first.
    pub plants: Vec<ExportedPlant>,
}

/// A plant of a family, from the command to the measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedPlant {
    /// Values of its parameters.
    pub values: Vec<f64>,
    /// Its transfer function.
    pub factors: Factors,
}

impl ExportedController {
    /// Signals that the controller reads at a sample.
    pub fn signals(&self) -> Vec<DeployedSignal> {
        DeployedSignal::of(&self.deployed)
    }

    /// Lines of the head of a file.
    pub(crate) fn head(&self) -> Vec<String> {
        let lines = self.contract.lines(&self.deployed);
        let wrapped = |line: &String| {
            let indent = if line.starts_with("- ") { "  " } else { "" };
            let options = textwrap::Options::new(WIDTH).subsequent_indent(indent);
            textwrap::wrap(line, options).into_iter().map(String::from).collect::<Vec<_>>()
        };
        lines.iter().flat_map(wrapped).collect()
    }
}
