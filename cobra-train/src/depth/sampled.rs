//! A surface whose points are kept.

use cobra_infer::depth::{Nearby, Surface};
use nalgebra::Point3;
use std::sync::{Arc, PoisonError, RwLock};

/// A surface that hands over the points of another without making them anew for every pose: the same points
/// in the same order, and so the same bits of every check, in a fraction of the time.
pub struct SampledSurface<S> {
    surface: S,
    kept: RwLock<Vec<Sample>>,
}

#[derive(Clone)]
struct Sample {
    spacing: f32,
    points: Arc<[Point3<f32>]>,
}

impl<S: Surface> SampledSurface<S> {
    /// Over a surface; points are made when they are first asked for.
    #[must_use]
    pub fn new(surface: S) -> Self {
        Self {
            surface,
            kept: RwLock::default(),
        }
    }

    fn points(&self, spacing: f32) -> Arc<[Point3<f32>]> {
        let find = |kept: &[Sample]| {
            let sample = kept.iter().find(|sample| sample.spacing == spacing);
            sample.map(|sample| Arc::clone(&sample.points))
        };
        let kept = find(&self.kept.read().unwrap_or_else(PoisonError::into_inner));
        kept.unwrap_or_else(|| {
            let mut points = Vec::new();
            self.surface
                .sample(spacing, &mut |point| points.extend(point));
            let points: Arc<[Point3<f32>]> = points.into();
            let mut kept = self.kept.write().unwrap_or_else(PoisonError::into_inner);
            if find(&kept).is_none() {
                kept.push(Sample {
                    spacing,
                    points: Arc::clone(&points),
                });
            }
            points
        })
    }
}

impl<S: Surface> Surface for SampledSurface<S> {
    fn centre(&self) -> [f32; 3] {
        self.surface.centre()
    }

    fn radius(&self) -> f32 {
        self.surface.radius()
    }

    fn diameter(&self) -> f32 {
        self.surface.diameter()
    }

    fn noise(&self) -> f32 {
        self.surface.noise()
    }

    fn nearby(&self, point: &Point3<f32>) -> Option<Nearby> {
        self.surface.nearby(point)
    }

    fn sample(&self, spacing: f32, take: &mut impl FnMut(Option<&Point3<f32>>)) {
        self.points(spacing).iter().map(Some).for_each(take);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Counts how often its points are made.
    struct Line {
        made: Cell<u32>,
    }

    impl Surface for Line {
        fn centre(&self) -> [f32; 3] {
            [0.0; 3]
        }

        fn radius(&self) -> f32 {
            1.0
        }

        fn diameter(&self) -> f32 {
            2.0
        }

        fn noise(&self) -> f32 {
            0.1
        }

        fn nearby(&self, _: &Point3<f32>) -> Option<Nearby> {
            None
        }

        fn sample(&self, spacing: f32, take: &mut impl FnMut(Option<&Point3<f32>>)) {
            self.made.set(self.made.get() + 1);
            for step in 0..5_u8 {
                take(Some(&Point3::new(spacing * f32::from(step), 0.0, 0.0)));
            }
        }
    }

    #[test]
    fn points_of_a_spacing_are_made_once_and_stay_the_surfaces_own() {
        let collect = |surface: &SampledSurface<Line>, spacing| {
            let mut points = Vec::new();
            surface.sample(spacing, &mut |point| {
                points.extend(point.map(|point| point.x));
            });
            points
        };
        let surface = SampledSurface::new(Line { made: Cell::new(0) });
        for _ in 0..3 {
            assert_eq!(collect(&surface, 0.5), [0.0, 0.5, 1.0, 1.5, 2.0]);
            assert_eq!(collect(&surface, 1.0), [0.0, 1.0, 2.0, 3.0, 4.0]);
        }
        assert_eq!(surface.surface.made.get(), 2);
    }
}
