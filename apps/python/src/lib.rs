//! The extension of the Python package `phea`: projects, requests and answers as Python objects.
//!
//! It converts and computes nothing: `phea_workbench` answers, and the modules in `python/phea`
//! give every answer its class. The interface is described in `python/phea/_native.pyi`.

mod alternatives;
mod answer;
mod bounds;
mod chunks;
mod columns;
mod command_line;
mod examples;
mod failure;
mod linear;
mod project;
mod request;
mod rig_values;
mod several;
mod units;
mod watch;

/// The extension module.
#[pyo3::pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use crate::alternatives::{alternative_judged, alternatives_joined, alternatives_tasks};
    #[pymodule_export]
    use crate::answer::{FinishedAnswer, png_of};
    #[pymodule_export]
    use crate::bounds::templates_and_bounds;
    #[pymodule_export]
    use crate::chunks::{CampaignTable, campaign_lines};
    #[pymodule_export]
    use crate::columns::columns;
    #[pymodule_export]
    use crate::command_line::run_command;
    #[pymodule_export]
    use crate::examples::examples;
    #[pymodule_export]
    use crate::failure::Refused;
    #[pymodule_export]
    use crate::linear::{PlantFamily, transfer_functions};
    #[pymodule_export]
    use crate::project::HeldProject;
    #[pymodule_export]
    use crate::rig_values::{impedance, stiffness};
    #[pymodule_export]
    use crate::several::{check_certificate, compare, identify};
    #[pymodule_export]
    use crate::units::unit_of;

    /// Version of phea.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
