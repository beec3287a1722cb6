//! Eigenvalues, without eigenvectors, of a small matrix in working precision: by elimination to
//! Hessenberg form (Martin and Wilkinson 1968), then by the iteration of Francis (1961) with double
//! shifts. Restricted to coupled blocks, it takes a quarter of the work of a Schur form, which is
//! its reference.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::eigenvalues::of_two_by_two;

/// Largest number of sweeps for one eigenvalue; every tenth has exceptional shifts, so that no
/// cycle is endless.
const SWEEPS: usize = 40;
const EXCEPTIONAL: usize = 10;

/// Eigenvalues, unsorted; `None` if the iteration did not converge.
pub(super) fn eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex64>> {
    reduce(&mut matrix);
    let h = &mut matrix;
    let norm = h.iter().map(|entry| entry.abs()).sum::<f64>();
    let mut values = Vec::with_capacity(h.nrows());
    let (mut end, mut sweeps) = (h.nrows(), 0);
    while end > 0 {
        let start = (1..end).rev().find(|&row| is_apart(h, row, norm)).unwrap_or(0);
        match end - start {
            1 => values.push(Complex64::new(h[(start, start)], 0.0)),
            2 => {
                let [a, b] = [h[(start, start)], h[(start, start + 1)]];
                let [c, d] = [h[(start + 1, start)], h[(start + 1, start + 1)]];
                values.extend(of_two_by_two(a, b, c, d));
            }
            _ if sweeps == SWEEPS => return None,
            _ => {
                sweeps += 1;
                sweep(h, start, end, sweeps % EXCEPTIONAL == 0);
                continue;
            }
        }
        (end, sweeps) = (start, 0);
    }
    values.iter().all(|value| value.is_finite()).then_some(values)
}

/// Reduces the matrix to zeros below the first subdiagonal, by multiples of the row with the
/// largest pivot and the inverse operations on the columns.
fn reduce(a: &mut DMatrix<f64>) {
    let order = a.nrows();
    for column in 0..order.saturating_sub(2) {
        let row = column + 1;
        let larger =
            |best: usize, i: usize| if a[(i, column)].abs() > a[(best, column)].abs() { i } else { best };
        let pivot_row = (row..order).fold(row, larger);
        a.swap_rows(row, pivot_row);
        a.swap_columns(row, pivot_row);
        let pivot = a[(row, column)];
        for i in row + 1..order {
            let factor = a[(i, column)] / pivot;
            // a column of zeros has no pivot
            if a[(i, column)] == 0.0 {
                continue;
            }
            a[(i, column)] = 0.0;
            let columns = a.as_mut_slice();
            for column in columns.chunks_exact_mut(order).skip(row) {
                column[i] -= factor * column[row];
            }
            let (before, from) = columns.split_at_mut(i * order);
            for (entry, other) in before[row * order..].iter_mut().zip(&from[..order]) {
                *entry += factor * other;
            }
        }
    }
}

/// True if the entry below the diagonal in this row is negligible compared with its neighbours.
fn is_apart(h: &DMatrix<f64>, row: usize, norm: f64) -> bool {
    let beside = h[(row - 1, row - 1)].abs() + h[(row, row)].abs();
    h[(row, row - 1)].abs() <= f64::EPSILON * if beside == 0.0 { norm } else { beside }
}

/// One step of the iteration with both eigenvalues of the last two rows as shifts, on the rows and
/// columns from start to end.
fn sweep(h: &mut DMatrix<f64>, start: usize, end: usize, exceptional: bool) {
    // first column of (H - x)(H - y) - w, divided by its last factor
    let (mut x, mut y, mut w) =
        (h[(end - 1, end - 1)], h[(end - 2, end - 2)], h[(end - 1, end - 2)] * h[(end - 2, end - 1)]);
    if exceptional {
        let size = h[(end - 1, end - 2)].abs() + h[(end - 2, end - 3)].abs();
        (x, y, w) = (x + 0.75 * size, x + 0.75 * size, -0.4375 * size * size);
    }
    let first = h[(start, start)];
    let mut column = [
        ((first - x) * (first - y) - w) / h[(start + 1, start)] + h[(start, start + 1)],
        h[(start + 1, start + 1)] + first - x - y,
        h[(start + 2, start + 1)],
    ];
    for k in start..end - 1 {
        let count = (end - k).min(3);
        if k > start {
            column = [h[(k, k - 1)], h[(k + 1, k - 1)], if count == 3 { h[(k + 2, k - 1)] } else { 0.0 }];
        } else if count < 3 {
            column[2] = 0.0;
        }
        let Some(mirror) = Mirror::of(column) else { continue };
        if k > start {
            h[(k, k - 1)] = mirror.image;
            (k + 1..k + count).for_each(|row| h[(row, k - 1)] = 0.0);
        }
        match count {
            3 => mirror.reflect::<3>(h, k, [start, end]),
            _ => mirror.reflect::<2>(h, k, [start, end]),
        }
    }
}

/// Reflection I - u v^T, which reduces a column to its first entry; u is v times v_0.
struct Mirror {
    image: f64,
    /// Vector v, with first entry one.
    across: [f64; 3],
    /// Vector u.
    along: [f64; 3],
}

impl Mirror {
    /// Reflection of a column; `None` for a column of zeros.
    fn of(column: [f64; 3]) -> Option<Mirror> {
        let scale = column.iter().map(|entry| entry.abs()).sum::<f64>();
        if scale == 0.0 {
            return None;
        }
        let [p, q, r] = column.map(|entry| entry / scale);
        let length = (p * p + q * q + r * r).sqrt();
        let norm = if p < 0.0 { -length } else { length };
        let sum = p + norm;
        Some(Mirror {
            image: -norm * scale,
            across: [1.0, q / sum, r / sum],
            along: [sum / norm, q / norm, r / norm],
        })
    }

    /// Applies the reflection from both sides, to `COUNT` rows and columns from k on, within the
    /// coupled block.
    fn reflect<const COUNT: usize>(&self, h: &mut DMatrix<f64>, k: usize, [start, end]: [usize; 2]) {
        let (v, u) = (&self.across, &self.along);
        let order = h.nrows();
        let columns = h.as_mut_slice();
        for column in columns[k * order..end * order].chunks_exact_mut(order) {
            let rows = &mut column[k..k + COUNT];
            let sum: f64 = v.iter().zip(&*rows).map(|(v, entry)| v * entry).sum();
            rows.iter_mut().zip(u).for_each(|(entry, u)| *entry -= u * sum);
        }
        let rows = start..(k + 4).min(end);
        let mut columns = columns[k * order..].chunks_exact_mut(order);
        let mut columns: [&mut [f64]; COUNT] =
            std::array::from_fn(|_| columns.next().map_or(&mut [][..], |column| &mut column[rows.clone()]));
        for row in 0..rows.len() {
            let sum: f64 = u.iter().zip(&columns).map(|(u, column)| u * column[row]).sum();
            for (column, v) in columns.iter_mut().zip(v) {
                column[row] -= v * sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest distance from a value of one list to the nearest of the other.
    fn farthest(found: &[Complex64], expected: &[Complex64]) -> f64 {
        let mut open = expected.to_vec();
        let mut most: f64 = 0.0;
        for value in found {
            let distance = |one: &Complex64| (one - value).norm_sqr();
            let nearest = (0..open.len()).min_by(|&a, &b| distance(&open[a]).total_cmp(&distance(&open[b])));
            most = most.max(distance(&open.swap_remove(nearest.unwrap())).sqrt());
        }
        most
    }

    /// Eigenvalues equal the diagonal of the Schur form: full matrices, chains of lags whose matrix
    /// is nearly triangular, and cycles that do not end without exceptional shifts.
    #[test]
    fn those_of_the_schur_form() {
        let mut seed = 5_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for trial in 0..400 {
            let order = 3 + trial % 14;
            let matrix = DMatrix::from_fn(order, order, |i, j| match trial % 4 {
                0 => random(),
                1 if i + 1 < j || i > j + 2 => 0.0,
                1 => 10.0 * random(),
                2 if i == (j + 1) % order => 1.0,
                2 => 0.0,
                _ if random() < 0.2 => 0.0,
                _ => random() * if i < j { 100.0 } else { 1.0 },
            });
            let expected: Vec<Complex64> = matrix.complex_eigenvalues().iter().copied().collect();
            let found = eigenvalues(matrix.clone()).unwrap();
            let size = matrix.norm();
            assert_eq!(found.len(), order);
            assert!(farthest(&found, &expected) <= 1e-7 * size, "{trial}: {found:?} {expected:?}");
            let trace: Complex64 = found.iter().sum();
            assert!((trace.re - matrix.trace()).abs() <= 1e-12 * size, "{trial}");
        }
    }
}
