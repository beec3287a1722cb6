//! Lines in motion: against the exact line, against each other, and against conservation.

#[cfg(test)]
#[path = "line_models/driven.rs"]
mod driven;
#[cfg(test)]
#[path = "line_models/oracle.rs"]
mod oracle;
#[cfg(test)]
#[path = "line_models/single_wave.rs"]
mod single_wave;
#[cfg(test)]
#[path = "line_models/time.rs"]
mod time;
#[cfg(test)]
#[path = "line_models/two_waves.rs"]
mod two_waves;
