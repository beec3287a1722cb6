//! What of the procedures cannot be reached from the workbench, where all else of them is tested.
#![cfg(test)]

mod kernels;
