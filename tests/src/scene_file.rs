//! Writes what `cobra_agreement::depth` reads, and renders what a depth camera would see.

use cobra_infer::depth::{Surface, TemplateSurface};
use cobra_infer::nalgebra::Point3;
use cobra_infer::{Camera, Pose, Template};
use std::error::Error;

/// A camera's matrix and the size of its image.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// K, row-major.
    pub camera: [f32; 9],
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// Points of the surface lie this share of the radius apart; each covers the four pixels around it.
const SPACING: f32 = 0.01;

impl View {
    /// The z-depth of the template's surface at a pose, row by row; infinite where it is not seen.
    ///
    /// # Errors
    /// Where camera, pose or template cannot be used.
    pub fn render(
        &self,
        template: &Template<'_>,
        pose: &[f32; 12],
    ) -> Result<Vec<f32>, Box<dyn Error>> {
        let camera = Camera::from_matrix(self.camera)?;
        let [r0, r1, r2, r3, r4, r5, r6, r7, r8, x, y, z] = *pose;
        let pose = Pose::from_row_major([r0, r1, r2, r3, r4, r5, r6, r7, r8], [x, y, z])?;
        let surface = TemplateSurface::<64>::new(template, 1.0)?;
        let mut depths = vec![f32::INFINITY; self.width * self.height];
        let mut splat = |point: Option<&Point3<f32>>| {
            let Some(seen) = point.map(|point| pose.to_camera(point)) else {
                return;
            };
            let Some(pixel) = camera.project(&seen) else {
                return;
            };
            let inside = |t: f32, size: usize| t >= 0.0 && t < size as f32;
            for column in [pixel.x.floor(), pixel.x.ceil()] {
                for row in [pixel.y.floor(), pixel.y.ceil()] {
                    if inside(column, self.width) && inside(row, self.height) {
                        let depth = &mut depths[row as usize * self.width + column as usize];
                        *depth = depth.min(seen.z);
                    }
                }
            }
        };
        surface.sample(SPACING * template.radius(), &mut splat);
        Ok(depths)
    }
}

/// A scene: poses in turn, and the pixels of a mask as column and row.
#[must_use]
pub fn scene_file(view: &View, scale: f32, poses: &[[f32; 12]], pixels: &[[u16; 2]]) -> Vec<u8> {
    let count = |n: usize| (n as u32).to_le_bytes().to_vec();
    let numbers = |all: &[f32]| {
        let bytes = all.iter().flat_map(|x| x.to_le_bytes());
        bytes.collect::<Vec<u8>>()
    };
    [
        numbers(&view.camera),
        count(view.width),
        numbers(&[scale]),
        count(poses.len()),
        numbers(poses.as_flattened()),
        count(pixels.len()),
        image_file(pixels.as_flattened()),
    ]
    .concat()
}

/// Words, little-endian.
#[must_use]
pub fn image_file(words: &[u16]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
