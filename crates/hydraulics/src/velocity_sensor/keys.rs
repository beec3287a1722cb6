//! Table `[velocity_sensor]`.

use phea_quantity::{ANGULAR_FREQUENCY, RATIO, TIME, VELOCITY};
use phea_table::{TableNumber, Visitor, key};

/// Sensor of the load velocity, which a controller may feed forward.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredVelocitySensor<S = f64> {
    /// Ratio of measured to true velocity, less one; absent if zero.
    pub gain_error: Option<S>,
    /// Delay of the measured velocity, s.
    pub delay: S,
    /// Corner frequency of its filter, rad/s; no filter if absent.
    pub filter_frequency: Option<S>,
    /// Damping ratio of a second-order filter; first order if absent.
    pub filter_damping_ratio: Option<S>,
    /// Root mean square of the white noise at a sampled controller, m/s.
    pub noise: S,
    /// Resolution at a sampled controller, m/s; zero without rounding.
    pub resolution: S,
}

impl<S: TableNumber> DeclaredVelocitySensor<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("gain_error", &RATIO, "Shown velocity over the true one, less one.").above(-1.0);
        v.unless_zero(k.or(0.0), &mut self.gain_error);
        let k = key("delay", &TIME, "From the velocity until it is shown.").not_negative();
        v.quantity(k.or(0.0), &mut self.delay);
        let doc = "Corner frequency of its low-pass filter; absent: it has none.";
        v.optional(key("filter_frequency", &ANGULAR_FREQUENCY, doc).positive(), &mut self.filter_frequency);
        let doc = "Damping ratio of a filter of second order; absent: it is of first order.";
        v.optional(key("filter_damping_ratio", &RATIO, doc).positive(), &mut self.filter_damping_ratio);
        let doc = "Root mean square of the white noise in what a sampled controller sees.";
        v.quantity(key("noise", &VELOCITY, doc).of_motion().not_negative().or(0.0), &mut self.noise);
        let doc = "Step to which a sampled controller sees it rounded; 0: not at all.";
        v.quantity(
            key("resolution", &VELOCITY, doc).of_motion().not_negative().or(0.0),
            &mut self.resolution,
        );
    }
}
