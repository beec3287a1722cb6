//! Dynamic lines compared with the exact line, with each other, and with conservation.

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
