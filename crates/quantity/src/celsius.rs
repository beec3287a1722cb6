/// Thermodynamic temperature of 0 degC, in K: what a Celsius temperature is counted from.
pub const ZERO_CELSIUS: f64 = 273.15;
