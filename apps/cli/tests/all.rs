//! The command from outside: what it prints, writes and returns.
#![cfg(test)]

mod campaign;
mod campaign_killed;
mod exit_status;
mod full_disk;
mod inputs_kept;
mod stories;
mod streamed_rows;
