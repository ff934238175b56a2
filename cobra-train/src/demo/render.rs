//! Renders an observed object and an estimate of its pose, one over the other, by ray casting.
//!
//! Owns shading and outlines. It samples each pixel once, at its centre: whoever wants smooth
//! edges renders larger and reduces ([`RgbImage::reduced`]).

use nalgebra::{Isometry3, Point3, UnitVector3, Vector3};
use rayon::prelude::*;

use super::RgbImage;
use super::camera::Camera;
use crate::surface::{Mesh, RayCaster};

/// How a rendering looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The estimate's colour.
    pub estimate: [u8; 3],
    /// What is seen where nothing is hit.
    pub background: [u8; 3],
    /// Width of the estimate's silhouette in pixels; inner lines are drawn thinner.
    pub pen: f64,
}

/// Renders one mesh in many poses.
pub struct Renderer {
    caster: RayCaster,
    /// A step between neighbouring samples that counts as a jump to another surface.
    jump: f64,
}

#[derive(Clone, Copy)]
struct Sample {
    point: Point3<f64>,
    normal: UnitVector3<f64>,
    light: f64,
}

#[derive(Clone, Copy)]
enum Line {
    Silhouette,
    Crease,
}

const OBSERVED: [f64; 3] = [226.0, 228.0, 232.0];
/// Opacity of the estimate's surface.
const TINT: f64 = 0.36;
const OBSERVED_LINES: [f64; 3] = [70.0, 74.0, 82.0];

impl Renderer {
    /// Prepares a mesh for rendering.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            caster: RayCaster::new(mesh),
            jump: 0.02 * mesh.bounding_sphere().radius,
        }
    }

    /// The object at `observed` in shaded grey, and over it the object at `estimate` as a
    /// translucent tint with its silhouette and creases. Both poses map the object's frame to the
    /// camera's, in the mesh's unit.
    #[must_use]
    pub fn render(
        &self,
        camera: &Camera,
        observed: &Isometry3<f64>,
        estimate: &Isometry3<f64>,
        look: &Look,
    ) -> RgbImage {
        let (width, height) = (camera.width as usize, camera.height as usize);
        let mut canvas = vec![look.background.map(f64::from); width * height];
        let colour = look.estimate.map(f64::from);

        let samples = self.sample(camera, observed, true);
        for (pixel, sample) in canvas.iter_mut().zip(&samples) {
            if let Some(sample) = sample {
                *pixel = OBSERVED.map(|value| value * sample.light);
            }
        }
        let inks = Inks {
            colour: OBSERVED_LINES,
            silhouette: (0.6 * look.pen, 0.75),
            crease: (0.4 * look.pen, 0.3),
        };
        inks.draw(&mut canvas, width, &self.lines(&samples, width));

        let samples = self.sample(camera, estimate, false);
        for (pixel, sample) in canvas.iter_mut().zip(&samples) {
            if let Some(sample) = sample {
                let lit = colour.map(|value| value + (255.0 - value) * 0.35 * sample.light);
                *pixel = mixed(*pixel, lit, TINT);
            }
        }
        let inks = Inks {
            colour,
            silhouette: (look.pen, 1.0),
            crease: (0.4 * look.pen, 0.65),
        };
        inks.draw(&mut canvas, width, &self.lines(&samples, width));
        RgbImage {
            width: camera.width,
            height: camera.height,
            pixels: canvas
                .into_iter()
                .flatten()
                .map(|value| value.round().clamp(0.0, 255.0) as u8)
                .collect(),
        }
    }

    /// What each pixel sees. A tint shows no shadows: they are cast on request only.
    fn sample(&self, camera: &Camera, pose: &Isometry3<f64>, shadows: bool) -> Vec<Option<Sample>> {
        let to_object = pose.inverse();
        let eye = to_object * Point3::origin();
        // From above the viewer's left shoulder, as drawings are lit.
        let lamp = to_object * Vector3::new(-0.45, -0.75, -0.6).normalize();
        let width = camera.width as usize;
        (0..width * camera.height as usize)
            .into_par_iter()
            .map(|at| {
                let ray = to_object * camera.ray(at % width, at / width).normalize();
                let hit = self.caster.cast(&eye, &ray)?;
                let raised = hit.point + hit.normal.into_inner() * (0.05 * self.jump);
                let towards_lamp = hit.normal.dot(&lamp).max(0.0);
                let shaded =
                    shadows && towards_lamp > 0.0 && self.caster.cast(&raised, &lamp).is_some();
                let key = if shaded {
                    0.25 * towards_lamp
                } else {
                    towards_lamp
                };
                Some(Sample {
                    point: pose * hit.point,
                    normal: UnitVector3::new_unchecked(pose * hit.normal.into_inner()),
                    light: 0.46 + 0.2 * hit.normal.dot(&-ray).max(0.0) + 0.36 * key,
                })
            })
            .collect()
    }

    /// Where the surface ends or folds: pixels whose right or lower neighbour sees another surface
    /// (or none), or the same surface turned by more than 20°.
    fn lines(&self, samples: &[Option<Sample>], width: usize) -> Vec<(Line, usize)> {
        let fold = libm::cos(20_f64.to_radians());
        let between = |a: &Option<Sample>, b: &Option<Sample>| match (a, b) {
            (None, None) => None,
            (Some(a), Some(b)) => {
                let step = b.point - a.point;
                let apart = step.dot(&a.normal).abs().min(step.dot(&b.normal).abs());
                if apart > self.jump {
                    Some(Line::Silhouette)
                } else if a.normal.dot(&b.normal) < fold {
                    Some(Line::Crease)
                } else {
                    None
                }
            }
            _ => Some(Line::Silhouette),
        };
        (0..samples.len())
            .filter_map(|at| {
                let right =
                    ((at + 1) % width != 0).then(|| between(&samples[at], &samples[at + 1]));
                let below = samples.get(at + width).map(|b| between(&samples[at], b));
                match (right.flatten(), below.flatten()) {
                    (Some(Line::Silhouette), _) | (_, Some(Line::Silhouette)) => {
                        Some((Line::Silhouette, at))
                    }
                    (Some(Line::Crease), _) | (_, Some(Line::Crease)) => Some((Line::Crease, at)),
                    (None, None) => None,
                }
            })
            .collect()
    }
}

/// How the lines of one pose are drawn: the width in pixels and the opacity of each kind.
struct Inks {
    colour: [f64; 3],
    silhouette: (f64, f64),
    crease: (f64, f64),
}

impl Inks {
    fn draw(&self, canvas: &mut [[f64; 3]], width: usize, lines: &[(Line, usize)]) {
        // Round nibs overlap: each pixel takes the strongest ink once.
        let mut opacity = vec![0.0_f64; canvas.len()];
        let height = canvas.len() / width;
        for &(line, at) in lines {
            let (pen, strength) = match line {
                Line::Silhouette => self.silhouette,
                Line::Crease => self.crease,
            };
            let radius = pen / 2.0;
            let reach = radius.floor() as usize;
            let (column, row) = (at % width, at / width);
            for y in row.saturating_sub(reach)..=(row + reach).min(height - 1) {
                for x in column.saturating_sub(reach)..=(column + reach).min(width - 1) {
                    let (dx, dy) = (x.abs_diff(column) as f64, y.abs_diff(row) as f64);
                    if dx * dx + dy * dy <= radius * radius {
                        opacity[y * width + x] = opacity[y * width + x].max(strength);
                    }
                }
            }
        }
        for (pixel, opacity) in canvas.iter_mut().zip(opacity) {
            *pixel = mixed(*pixel, self.colour, opacity);
        }
    }
}

fn mixed(under: [f64; 3], over: [f64; 3], opacity: f64) -> [f64; 3] {
    std::array::from_fn(|i| under[i] + (over[i] - under[i]) * opacity)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOOK: Look = Look {
        estimate: [0, 128, 120],
        background: [255, 255, 255],
        pen: 1.0,
    };

    const CAMERA: Camera = Camera {
        fx: 60.0,
        fy: 60.0,
        cx: 19.5,
        cy: 14.5,
        width: 40,
        height: 30,
    };

    fn cube() -> Mesh {
        let corners = (0..8)
            .map(|i| {
                let side = |bit: i32| if i & bit == 0 { -10.0 } else { 10.0 };
                Point3::new(side(1), side(2), side(4))
            })
            .collect();
        let triangles = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        Mesh::new(corners, triangles).unwrap()
    }

    fn pixel(image: &RgbImage, column: u32, row: u32) -> [u8; 3] {
        image.pixels.as_chunks::<3>().0[(row * image.width + column) as usize]
    }

    #[test]
    fn the_observed_object_is_grey_and_the_estimate_tints_it() {
        let (left, right) = (
            Isometry3::translation(-14.0, 0.0, 100.0),
            Isometry3::translation(14.0, 0.0, 100.0),
        );
        let image = Renderer::new(&cube()).render(&CAMERA, &left, &right, &LOOK);
        let [red, green, blue] = pixel(&image, 11, 15);
        assert!(red.abs_diff(green) < 8 && green.abs_diff(blue) < 8);
        let [red, green, _] = pixel(&image, 28, 15);
        assert!(red + 30 < green, "{red} {green}");
        assert_eq!(pixel(&image, 19, 15), LOOK.background);
    }

    #[test]
    fn a_silhouette_has_the_pure_colour() {
        let pose = Isometry3::translation(0.0, 0.0, 100.0);
        let image = Renderer::new(&cube()).render(&CAMERA, &pose, &pose, &LOOK);
        let pure = image
            .pixels
            .as_chunks::<3>()
            .0
            .iter()
            .filter(|&p| *p == LOOK.estimate);
        assert!(pure.count() >= 40);
    }
}
