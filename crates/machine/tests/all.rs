//! Tests of the machine in motion, by the methods compiled for it in this crate.
#![cfg(test)]

mod driven;
mod lines;
mod robustness;
