//! Simulated systems compared with closed forms, published solutions and independent methods.
#![cfg(test)]

mod carried;
mod closed_loop;
mod delays;
mod events;
mod explicit;
mod frozen;
mod growth;
mod kinks;
mod lanes;
mod laws;
mod order;
mod restarts;
mod samples;
mod statuses;
mod stiff;
