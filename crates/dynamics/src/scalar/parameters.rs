use super::Scalar;

/// Component whose parameters are numbers of one kind, and can become numbers of another: lanes,
/// dual numbers, intervals.
///
/// [`crate::parameters!`] generates the implementation from the names of the fields.
///
/// # Example
/// ```
/// use phea_dynamics::parameters;
/// use phea_dynamics::scalar::{Interval, Parameters};
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Spring<S> {
///     stiffness: S,
///     play: Option<[S; 2]>,
///     count: usize,
/// }
/// parameters! { Spring { stiffness, play, count: kept } }
/// let spring = Spring { stiffness: 2.0, play: Some([0.0, 1.0]), count: 3 };
/// let enclosed: Spring<Interval> = spring.convert(&mut Interval::from);
/// assert_eq!(enclosed.stiffness, Interval::from(2.0));
/// assert_eq!(spring.convert(&mut |value| 10.0 * value).play, Some([0.0, 10.0]));
/// ```
pub trait Parameters: Copy {
    /// Type of the parameters.
    type Number;
    /// The component with parameters of another type.
    type Over<T: Copy>;

    /// Replaces every parameter, in a fixed order.
    fn convert<T: Copy>(&self, of: &mut impl FnMut(Self::Number) -> T) -> Self::Over<T>;
}

impl<S: Scalar> Parameters for S {
    type Number = S;
    type Over<T: Copy> = T;

    #[inline(always)]
    fn convert<T: Copy>(&self, of: &mut impl FnMut(S) -> T) -> T {
        of(*self)
    }
}

impl<P: Parameters> Parameters for Option<P> {
    type Number = P::Number;
    type Over<T: Copy> = Option<P::Over<T>>;

    #[inline(always)]
    fn convert<T: Copy>(&self, of: &mut impl FnMut(P::Number) -> T) -> Option<P::Over<T>> {
        self.map(|part| part.convert(of))
    }
}

impl<P: Parameters, const N: usize> Parameters for [P; N] {
    type Number = P::Number;
    type Over<T: Copy> = [P::Over<T>; N];

    #[inline(always)]
    fn convert<T: Copy>(&self, of: &mut impl FnMut(P::Number) -> T) -> [P::Over<T>; N] {
        std::array::from_fn(|index| self[index].convert(of))
    }
}

/// Writes [`Parameters`](crate::scalar::Parameters) for a struct over a scalar, of its fields, or
/// for an enum, of its variants. Fields are converted in the order in which they are listed here;
/// those marked `kept` are copied.
///
/// # Example
/// ```
/// use phea_dynamics::parameters;
/// use phea_dynamics::scalar::Parameters;
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// enum Damper<S> {
///     None,
///     Linear(S),
///     Orifice { coefficient: S, ports: usize },
/// }
/// parameters! {
///     Damper = Damper::None | Damper::Linear(damping) | Damper::Orifice { coefficient, ports: kept }
/// }
/// let orifice = Damper::Orifice { coefficient: 1.5, ports: 4 };
/// assert_eq!(orifice.convert(&mut |value| 2.0 * value), Damper::Orifice { coefficient: 3.0, ports: 4 });
/// ```
#[macro_export]
macro_rules! parameters {
    (@ $part:ident, $of:ident) => { $part.convert($of) };
    (@ $part:ident, $of:ident, kept) => { *$part };
    ($name:ident $(<$size:ident>)? { $($fields:tt)* }) => {
        $crate::parameters!($name $(<$size>)? = $name { $($fields)* });
    };
    ($name:ident $(<$size:ident>)? = $($($of:ident)::+ $(($inner:ident))?
        $({ $($field:ident $(: $kept:ident)?),* $(,)? })?)|+
    ) => {
        impl<$(const $size: usize,)? S: $crate::scalar::Scalar> $crate::scalar::Parameters
            for $name<$($size,)? S>
        {
            type Number = S;
            type Over<T: Copy> = $name<$($size,)? T>;

            #[inline(always)]
            fn convert<T: Copy>(&self, of: &mut impl FnMut(S) -> T) -> Self::Over<T> {
                use $crate::scalar::Parameters;
                match self {
                    $($($of)::+ $(($inner))? $({ $($field),* })? => $($of)::+
                        $(($inner.convert(of)))?
                        $({ $($field: $crate::parameters!(@ $field, of $(, $kept)?)),* })?,)+
                }
            }
        }
    };
}
