//! Matrices and columns in twice the working precision, processed a few numbers at a time: with the
//! vector instructions of the processor if the caller is compiled for them.

use super::double_double::{ComplexDoubleDouble, DoubleDouble};

/// Numbers processed at once.
const LANES: usize = 4;

/// A few numbers of twice the working precision, all high parts before all low ones.
#[derive(Clone, Copy, Default)]
pub(super) struct WideNumbers {
    high: [f64; LANES],
    low: [f64; LANES],
}

impl WideNumbers {
    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> DoubleDouble {
        DoubleDouble { high: self.high[lane], low: self.low[lane] }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, value: DoubleDouble) {
        (self.high[lane], self.low[lane]) = (value.high, value.low);
    }

    /// Adds the product of one number with others.
    #[inline(always)]
    pub(super) fn add_product(&mut self, left: DoubleDouble, right: &WideNumbers) {
        for lane in 0..LANES {
            self.set(lane, self.get(lane) + left * right.get(lane));
        }
    }
}

/// A square matrix in twice the working precision, row by row.
pub(super) struct Wide {
    order: usize,
    /// Groups in a row.
    groups: usize,
    entries: Vec<WideNumbers>,
}

impl Wide {
    pub(super) fn from_fn(order: usize, entry: impl Fn(usize, usize) -> DoubleDouble) -> Self {
        let mut result = Wide::zero(order);
        for i in 0..order {
            for j in 0..order {
                result.set(i, j, entry(i, j));
            }
        }
        result
    }

    #[inline(always)]
    pub(super) fn order(&self) -> usize {
        self.order
    }

    /// The numbers of a row.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> &[WideNumbers] {
        &self.entries[row * self.groups..(row + 1) * self.groups]
    }

    #[inline(always)]
    fn zero(order: usize) -> Self {
        let groups = order.div_ceil(LANES);
        Wide { order, groups, entries: vec![WideNumbers::default(); order * groups] }
    }

    #[inline(always)]
    pub(super) fn identity(order: usize) -> Self {
        Wide::zero(order).plus_identity()
    }

    #[inline(always)]
    pub(super) fn entry(&self, row: usize, column: usize) -> DoubleDouble {
        self.entries[row * self.groups + column / LANES].get(column % LANES)
    }

    #[inline(always)]
    fn set(&mut self, row: usize, column: usize, value: DoubleDouble) {
        self.entries[row * self.groups + column / LANES].set(column % LANES, value);
    }

    #[inline(always)]
    pub(super) fn times(&self, other: &Wide) -> Self {
        let mut result = Wide::zero(self.order);
        let first: Vec<usize> = (0..self.order).map(|row| other.first_group(row)).collect();
        for row in 0..self.order {
            for (k, &first) in first.iter().enumerate() {
                let left = self.entry(row, k);
                if left.high != 0.0 {
                    let sums = &mut result.entries[row * self.groups + first..(row + 1) * self.groups];
                    for (sum, right) in sums.iter_mut().zip(&other.row(k)[first..]) {
                        sum.add_product(left, right);
                    }
                }
            }
        }
        result
    }

    /// Index of the first group of a row that is not all zero.
    #[inline(always)]
    fn first_group(&self, row: usize) -> usize {
        self.row(row).iter().position(|group| group.high != [0.0; LANES]).unwrap_or(self.groups)
    }

    pub(super) fn times_column(&self, column: &[DoubleDouble]) -> Vec<DoubleDouble> {
        let row = |i: usize| {
            let terms = column.iter().enumerate().map(|(j, &entry)| self.entry(i, j) * entry);
            terms.fold(DoubleDouble::ZERO, |sum, term| sum + term)
        };
        (0..self.order).map(row).collect()
    }

    pub(super) fn is_finite(&self) -> bool {
        (0..self.order).all(|i| (0..self.order).all(|j| self.entry(i, j).value().is_finite()))
    }

    #[inline(always)]
    pub(super) fn divided_by(&self, divisor: f64) -> Self {
        let mut result = Wide::zero(self.order);
        for (quotient, entry) in result.entries.iter_mut().zip(&self.entries) {
            for lane in (0..LANES).filter(|&lane| entry.high[lane] != 0.0) {
                quotient.set(lane, entry.get(lane).divided_by(divisor));
            }
        }
        result
    }

    #[inline(always)]
    pub(super) fn plus_identity(mut self) -> Self {
        for index in 0..self.order {
            self.set(index, index, self.entry(index, index) + 1.0.into());
        }
        self
    }
}

/// A column of complex numbers in twice the working precision.
#[derive(Clone)]
pub(super) struct WideColumn {
    re: Vec<WideNumbers>,
    im: Vec<WideNumbers>,
}

impl WideColumn {
    #[inline(always)]
    pub(super) fn zero(order: usize) -> Self {
        let none = vec![WideNumbers::default(); order.div_ceil(LANES)];
        WideColumn { re: none.clone(), im: none }
    }

    #[inline(always)]
    pub(super) fn get(&self, index: usize) -> ComplexDoubleDouble {
        let (group, lane) = (index / LANES, index % LANES);
        ComplexDoubleDouble { re: self.re[group].get(lane), im: self.im[group].get(lane) }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, value: ComplexDoubleDouble) {
        let (group, lane) = (index / LANES, index % LANES);
        self.re[group].set(lane, value.re);
        self.im[group].set(lane, value.im);
    }

    /// Adds the product of one number with the first of these real ones.
    #[inline(always)]
    pub(super) fn add_product(&mut self, left: ComplexDoubleDouble, right: &[WideNumbers], count: usize) {
        let groups = count.div_ceil(LANES);
        for (group, right) in right.iter().take(groups).enumerate() {
            self.re[group].add_product(left.re, right);
            self.im[group].add_product(left.im, right);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grouped products equal those by definition, number by number, to the last bit; padding with
    /// zeros changes nothing.
    #[test]
    fn products_are_those_of_their_definition() {
        let entry = |i: usize, j: usize| {
            let (i, j) = (i as f64, j as f64);
            if i > j + 1.0 {
                DoubleDouble::ZERO
            } else {
                DoubleDouble::sum_of(1.0 / (i + 2.0 * j + 3.0), 1e-18 * j)
            }
        };
        for order in [1, 3, 4, 6, 9] {
            let matrix = Wide::from_fn(order, entry);
            let product = matrix.times(&matrix);
            let column = matrix.times_column(&vec![entry(0, 1); order]);
            for (i, found) in column.iter().enumerate() {
                let sum = |term: &dyn Fn(usize) -> DoubleDouble| {
                    (0..order).map(term).fold(DoubleDouble::ZERO, |sum, term| sum + term)
                };
                for j in 0..order {
                    assert_eq!(product.entry(i, j), sum(&|k| entry(i, k) * entry(k, j)), "{order} {i} {j}");
                }
                assert_eq!(*found, sum(&|k| entry(i, k) * entry(0, 1)), "{order} {i}");
            }
        }
    }
}
