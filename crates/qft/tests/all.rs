//! The method from outside: closed forms, properties of random problems, and published designs.
#![cfg(test)]

mod audit_plants;
mod audit_truths;
mod bound;
mod closed_loop;
mod design;
mod design_diagnosis;
mod family;
mod fed_back;
mod inner_feedback;
mod kernels;
mod manual_shaping;
mod measured_discs;
mod prefilter;
mod proof;
mod proof_budget;
mod proof_curved;
mod proof_sampled;
mod proof_trap;
mod quantization;
mod responding;
mod rig;
mod sample_stability;
mod search;
mod shaping;
mod specification_kinds;
mod specification_margins;
mod specification_spread;
mod specification_time_domain;
mod stability_dead_time;
mod stability_family;
mod stability_measured;
mod stability_published;
mod stability_sampled;
mod template;
mod verification;
