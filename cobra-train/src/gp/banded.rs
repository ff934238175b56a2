//! Symmetric matrices of which only a band around the diagonal is not 0.
//!
//! Owns their factorisation: a map's normal equations have some forty entries a row whatever its size,
//! and a dense solve of them would be most of what baking takes.

/// A symmetric positive definite matrix; of each row, what lies at most `band` left of the diagonal.
#[derive(Clone, Debug)]
pub(super) struct Banded {
    size: usize,
    band: usize,
    /// Row by row, from the diagonal to the left.
    entries: Vec<f64>,
}

impl Banded {
    /// Of zeros.
    pub(super) fn new(size: usize, band: usize) -> Self {
        let band = band.min(size.saturating_sub(1));
        Self {
            size,
            band,
            entries: vec![0.0; size * (band + 1)],
        }
    }

    fn place(&self, row: usize, left: usize) -> usize {
        row * (self.band + 1) + left
    }

    /// The entry of a row and a column that are no farther apart than the band is wide.
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[self.place(row.max(column), row.abs_diff(column))]
    }

    /// Adds to an entry on or left of the diagonal; what is right of it is the same entry.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        if column <= row {
            let place = self.place(row, row - column);
            self.entries[place] += value;
        }
    }

    /// The rows whose entries in this one's column are not all 0.
    pub(super) fn beside(&self, row: usize) -> std::ops::Range<usize> {
        row.saturating_sub(self.band)..(row + self.band + 1).min(self.size)
    }

    /// x with Ax = b, by A = LLᵀ. `None` where A is not positive definite.
    pub(super) fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        let mut lower = self.clone();
        for row in 0..self.size {
            let first = row.saturating_sub(self.band);
            for column in first..=row {
                let from = first.max(column.saturating_sub(self.band));
                let mut sum = lower.at(row, column);
                for k in from..column {
                    sum -= lower.at(row, k) * lower.at(column, k);
                }
                let value = if column < row {
                    sum / lower.at(column, column)
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
                let place = lower.place(row, row - column);
                lower.entries[place] = value;
            }
        }
        let mut x = b.to_vec();
        for row in 0..self.size {
            for k in row.saturating_sub(self.band)..row {
                x[row] -= lower.at(row, k) * x[k];
            }
            x[row] /= lower.at(row, row);
        }
        for row in (0..self.size).rev() {
            for k in row + 1..(row + self.band + 1).min(self.size) {
                x[row] -= lower.at(k, row) * x[k];
            }
            x[row] /= lower.at(row, row);
        }
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::Banded;

    #[test]
    fn a_band_is_solved() {
        let (size, band) = (9, 3);
        let mut matrix = Banded::new(size, band);
        for row in 0..size {
            matrix.add(row, row, 4.0 + row as f64);
            for left in 1..=band.min(row) {
                matrix.add(row, row - left, 0.3 * left as f64 - 0.5);
            }
        }
        let x: Vec<f64> = (0..size).map(|i| 1.0 - 0.3 * i as f64).collect();
        let b: Vec<f64> = (0..size)
            .map(|row| matrix.beside(row).map(|k| matrix.at(row, k) * x[k]).sum())
            .collect();
        for (found, expected) in matrix.solve(&b).unwrap().iter().zip(&x) {
            assert!((found - expected).abs() < 1e-12);
        }
        matrix.add(4, 4, -20.0);
        assert_eq!(matrix.solve(&b), None);
    }
}
