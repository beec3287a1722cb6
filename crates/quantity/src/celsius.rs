/// Thermodynamic temperature of 0 degC, the zero of Celsius temperatures, K.
pub const ZERO_CELSIUS: f64 = 273.15;
