/// Hose bores on the market by dash size (sixteenths of an inch), m. Source: dealers' hose size
/// charts for hydraulic hose, which agree on these nominal inner diameters.
pub const DASH_SIZES: [(&str, f64); 8] = [
    ("dash 3", 4.8e-3),
    ("dash 4", 6.4e-3),
    ("dash 5", 7.9e-3),
    ("dash 6", 9.5e-3),
    ("dash 8", 12.7e-3),
    ("dash 10", 15.9e-3),
    ("dash 12", 19.0e-3),
    ("dash 16", 25.4e-3),
];
