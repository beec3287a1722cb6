//! Lines in motion: against the exact line, against each other, and against conservation.

#[cfg(test)]
mod blocked;
#[cfg(test)]
mod driven;
#[cfg(test)]
mod oracle;
#[cfg(test)]
mod single_wave;
#[cfg(test)]
mod time;
#[cfg(test)]
mod two_waves;
