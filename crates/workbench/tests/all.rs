//! The procedures from outside: what a project says, what is answered, and what is drawn.
#![cfg(test)]

mod ask;
mod benchmark;
mod campaign;
mod derived_statements;
mod design_contract;
mod design_truth;
mod family;
mod family_measured;
mod feed_forward;
mod figure_colours;
mod figure_gallery;
mod figure_hostile;
mod figure_primitives;
mod figure_qft;
mod frequency_response;
#[path = "../examples/figures/gallery.rs"]
mod gallery;
mod golden_ybitu;
mod json_contract;
mod legibility;
mod linearize_and_derived;
mod lines_in_motion;
mod malformed;
mod mutation;
mod noise;
mod project;
mod project_formula;
mod project_quantity;
mod report_design;
mod report_page;
mod report_simulation;
mod rest;
mod scenarios;
mod sensor;
mod shaping;
mod simulate;
mod simulation_check;
mod simulation_columns;
mod simulation_equivalences;
mod simulation_measured;
mod simulation_robustness;
mod sizing_catalogue;
mod sizing_laws;
mod specification;
mod verify_contract;
