//! Quantities in text through the public interface.
#![cfg(test)]

mod text;
