/// Hose bores on the market by dash size (sixteenths of an inch), m. Source: dealers' hose size charts for hydraulic
/// hose, which agree on these nominal inner diameters.
pub const DASH_SIZES: [(&str, f64); 8] = [
    ("-3", 4.8e-3),
    ("-4", 6.4e-3),
    ("-5", 7.9e-3),
    ("-6", 9.5e-3),
    ("-8", 12.7e-3),
    ("-10", 15.9e-3),
    ("-12", 19.0e-3),
    ("-16", 25.4e-3),
];
