//! Medians side by side: criterion reports each benchmark alone, and never a ratio.

use comfy_table::{CellAlignment, Table as Grid, presets};
use criterion::BenchmarkGroup;
use criterion::measurement::WallTime;
use std::hint::black_box;
use std::time::Instant;

/// Keeps the samples that criterion takes, and prints their medians.
pub(crate) struct Table<'g, 'c> {
    group: &'g mut BenchmarkGroup<'c, WallTime>,
    samples: usize,
    rows: Vec<(String, f64)>,
}

impl<'g, 'c> Table<'g, 'c> {
    /// A table of the benchmarks of `group`, each of them with so many samples.
    pub(crate) fn new(group: &'g mut BenchmarkGroup<'c, WallTime>, samples: usize) -> Self {
        group.sample_size(samples);
        Self {
            group,
            samples,
            rows: Vec::new(),
        }
    }

    /// Measures `routine`, and makes it a row unless the command line leaves it out.
    pub(crate) fn bench<T>(&mut self, name: &str, mut routine: impl FnMut() -> T) {
        let mut seconds = Vec::new();
        self.group.bench_function(name, |bencher| {
            bencher.iter_custom(|iterations| {
                let start = Instant::now();
                for _ in 0..iterations {
                    black_box(routine());
                }
                let elapsed = start.elapsed();
                seconds.push(elapsed.as_secs_f64() / iterations as f64);
                elapsed
            });
        });
        // What comes before the samples is the warm-up; a check takes fewer than a measurement.
        let Some(warm_up) = seconds.len().checked_sub(self.samples) else {
            return;
        };
        let measured = &mut seconds[warm_up..];
        measured.sort_by(f64::total_cmp);
        let median = (measured[(self.samples - 1) / 2] + measured[self.samples / 2]) / 2.0;
        self.rows.push((name.to_owned(), median));
    }

    /// Prints each median and its ratio to the first.
    pub(crate) fn print(&self, title: &str) {
        let Some((reference, first)) = self.rows.first() else {
            return;
        };
        let mut grid = Grid::new();
        grid.load_style(presets::NOTHING);
        grid.set_header([title, "median", &format!("/ {reference}")]);
        for (name, median) in &self.rows {
            grid.add_row([
                name.clone(),
                format!("{:.3} ms", 1e3 * median),
                format!("{:.2}", median / first),
            ]);
        }
        for column in grid.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        println!("{grid}\n");
    }
}
