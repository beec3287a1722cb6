/// Number with this many significant digits, as an engineer writes it: plain between 0.001 and 100
/// 000, otherwise with a power of ten.
///
/// # Example
/// ```
/// use phea_quantity::significant;
/// assert_eq!(significant(2_233_412.0, 4), "2.233e6");
/// assert_eq!(significant(0.27349, 3), "0.273");
/// assert_eq!(significant(-9.9996, 4), "-10.00");
/// assert_eq!(significant(0.0, 4), "0");
/// ```
pub fn significant(value: f64, digits: usize) -> String {
    let decimals = digits.saturating_sub(1);
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return if value.is_nan() { "-".to_string() } else { format!("{value}") };
    }
    // rounding first decides the exponent: 9.9996 has four digits as 10.00
    let scientific = format!("{value:.decimals$e}");
    let exponent = scientific.split_once('e').and_then(|(_, power)| power.parse::<i32>().ok()).unwrap_or(0);
    match exponent {
        -3..=4 => {
            let places = decimals as i32 - exponent;
            format!("{value:.*}", usize::try_from(places).unwrap_or(0))
        }
        _ => scientific,
    }
}
