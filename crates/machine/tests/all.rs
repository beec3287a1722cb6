//! The machine in motion, by the methods that are compiled for it here.
#![cfg(test)]

mod driven;
mod lines;
mod robustness;
