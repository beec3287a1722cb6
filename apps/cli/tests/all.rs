//! The command from outside: what it prints, writes and returns.
#![cfg(test)]

mod campaign;
mod exit_status;
mod stories;
