//! Tests of the command from outside: its output, its files and its exit status.
#![cfg(test)]

#[path = "../../../crates/workbench/tests/answer_schema.rs"]
mod answer_schema;
mod campaign;
mod campaign_killed;
mod exit_status;
mod export;
mod full_disk;
mod inputs_protected;
mod installation;
mod stories;
mod streamed_rows;
