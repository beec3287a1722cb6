use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;

use super::Linkage;
use super::chebyshev::ChebyshevSeries;

/// Standard acceleration of free fall, m/s2.
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Weight of a load that turns about a joint.
///
/// ```text
/// U = m g d h(theta),   h = sin(theta - theta_l)          d from the joint to the centre of mass
/// tau_g = -m g d h'(theta),   k_w = -d tau_g/d theta = m g d h''(theta)
/// ```
///
/// At theta_l the centre of mass is level with the joint and rises with the angle. Like the linkage
/// itself, h is a polynomial over the angles of the linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkedWeight<S = f64> {
    /// Moment m g d, N m.
    moment: S,
    /// Height h(theta).
    height: ChebyshevSeries<S>,
}

/// Weight at one angle. Units: J, N m, N m/rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightAt<S = f64> {
    /// Potential energy U, zero when the centre of mass is level with the joint.
    pub energy: S,
    /// Torque tau_g, positive when it helps the rod to extend.
    pub torque: S,
    /// Stiffness k_w: positive when the load hangs, negative when it stands above its joint.
    pub stiffness: S,
}

impl Linkage {
    /// Linkage with a load whose centre of mass is level with the joint at this angle in rad; its
    /// moment is 1 N m until [`Linkage::with_moment`] sets it.
    ///
    /// # Example
    /// A load of 2 kg at half a metre, level at the angle zero, where its weight has the whole
    /// lever arm:
    /// ```
    /// use phea_hydraulics::linkage::{LinkageGeometry, LinkageTable, STANDARD_GRAVITY};
    /// let table = LinkageTable { extensions: vec![0.0, 0.1], angles: vec![-1.0, 1.0], tolerance: 1e-6 };
    /// let linkage = LinkageGeometry::Table(table).reduced(0.1, 0.0)?.linkage;
    /// let linkage = linkage.level_at(0.0).with_moment(2.0 * 0.5 * STANDARD_GRAVITY);
    /// let [level, above] = [0.0_f64, 0.6].map(|angle| linkage.weight_at(angle).unwrap());
    /// assert!((level.torque + 9.80665).abs() < 1e-12 && level.energy.abs() < 1e-12);
    /// assert!((above.energy - 9.80665 * 0.6_f64.sin()).abs() < 1e-12);
    /// assert!((above.stiffness + 9.80665 * 0.6_f64.sin()).abs() < 1e-9);
    /// # Ok::<(), phea_hydraulics::linkage::LinkageError>(())
    /// ```
    #[must_use]
    pub fn level_at(&self, level_angle: f64) -> Linkage {
        let ChebyshevSeries { middle, half_width, .. } = self.extension;
        let height = ChebyshevSeries::through([middle - half_width, middle + half_width], |angle| {
            Ok::<f64, std::convert::Infallible>(portable::sin(angle - level_angle))
        });
        let weight = height.ok().map(|height| LinkedWeight { moment: 1.0, height });
        Linkage { weight, ..*self }
    }
}

impl<S: Scalar> Linkage<S> {
    /// Linkage with this moment m g d of its weight in N m, if it has one.
    #[must_use]
    pub fn with_moment(&self, moment: S) -> Linkage<S> {
        Linkage { weight: self.weight.map(|weight| LinkedWeight { moment, ..weight }), ..*self }
    }

    /// Weight of the load at an angle in rad; `None` for a load without weight.
    pub fn weight_at(&self, angle: S) -> Option<WeightAt<S>> {
        let weight = self.weight.as_ref()?;
        Some(WeightAt::of(weight.moment, weight.height.at(angle)))
    }

    /// Weight as in [`Linkage::weight_at`], as part of a machine of many states.
    ///
    /// Separate function, so that machines without a weight do not contain its code.
    #[inline(never)]
    pub(crate) fn weight_of<T: Scalar + From<S>>(&self, angle: T) -> Option<WeightAt<T>> {
        let weight = self.weight.as_ref()?;
        Some(WeightAt::of(T::from(weight.moment), T::local(&weight.height, [angle])))
    }

    /// Force of the rod in N that holds the weight with the piston at a position in m; `yields`
    /// returns the shortening of the rod in m by a force in N, and its slope in m/N. `None` without
    /// a weight.
    ///
    /// ```text
    /// F = -tau_g(theta)/g'(theta),   g(theta) + d(F) = x             by Newton's steps in theta
    /// dF/dtheta = (k_g + tau_g g''/g')/g'                            k_g = -dtau_g/dtheta
    /// ```
    pub fn holding_force(&self, position: S, yields: impl Fn(S) -> [S; 2]) -> Option<S> {
        self.weight.as_ref()?;
        let force_at = |angle: S| {
            let (end, weight) = (self.end(angle), self.weight_at(angle)?);
            let force = -(weight.torque / end.lever_arm);
            let slope = (weight.stiffness + weight.torque * end.lever_slope / end.lever_arm) / end.lever_arm;
            Some((end, force, slope))
        };
        let mut angle = self.angle(position);
        for _ in 0..HOLDING_STEPS {
            let (end, force, slope) = force_at(angle)?;
            let [shortened, compliance] = yields(force);
            let beyond = end.position + shortened - position;
            angle = angle - beyond / (end.lever_arm + compliance * slope);
        }
        Some(force_at(angle)?.1)
    }
}

/// Number of Newton steps: a stiff rod needs two, one as soft as its weight five.
const HOLDING_STEPS: usize = 6;

impl<S: Scalar> WeightAt<S> {
    /// Weight with this moment m g d in N m, from h and its two derivatives with respect to the
    /// angle.
    fn of(moment: S, [height, slope, curvature]: [S; 3]) -> WeightAt<S> {
        WeightAt { energy: moment * height, torque: -(moment * slope), stiffness: moment * curvature }
    }
}

phea_dynamics::parameters! { LinkedWeight { moment, height } }
