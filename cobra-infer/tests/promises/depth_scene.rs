//! A sphere of radius 40 before a camera 500 away: what comes of checking it can be computed by hand.

use crate::content::{Content, Valid};
use crate::scene::camera;
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthImage, DepthPixel, DepthReport, DepthSettings, Noise, Observed,
    Thresholds, check_depth,
};
use cobra_infer::{Pose, Template};
use nalgebra::Point2;

/// Of the sphere.
pub(crate) const RADIUS: f32 = 40.0;

/// σ_m: 8 % of 80.
pub(crate) const SIGMA: f32 = 6.4;

/// A sphere that speaks in every direction, its template's own σ next to nothing.
pub(crate) fn sphere() -> Content {
    let mut content = Content::sphere(RADIUS, 1e-3);
    for part in &mut content.parts {
        part.validity = Some(Valid {
            side: 32,
            cells: vec![true; 32 * 32],
            ..Valid::everywhere()
        });
    }
    content
}

/// What a depth camera sees of a sphere before a background, and of a wall that ends at a column.
#[derive(Clone, Copy)]
pub(crate) struct Scene {
    pub(crate) centre: [f32; 3],
    pub(crate) background: Option<f32>,
    pub(crate) wall: Option<(u16, f32)>,
}

impl Scene {
    pub(crate) fn at(x: f32, z: f32) -> Self {
        Self {
            centre: [x, 0.0, z],
            background: Some(f32::INFINITY),
            wall: None,
        }
    }

    fn sphere_depth(&self, column: u16, row: u16) -> Option<f32> {
        let ray = camera().ray(&Point2::new(f32::from(column), f32::from(row)));
        let centre = nalgebra::Vector3::from(self.centre);
        let (a, b) = (ray.norm_squared(), ray.dot(&centre));
        let rest = b * b - a * (centre.norm_squared() - RADIUS * RADIUS);
        (rest > 0.0).then(|| (b - cobra_infer::math::Real::square_root(rest)) / a)
    }

    /// The pixels that show the sphere.
    pub(crate) fn mask(&self) -> Vec<DepthPixel> {
        let all = (0..480_u16).flat_map(|row| (0..640_u16).map(move |column| (column, row)));
        all.step_by(7)
            .filter_map(|(column, row)| {
                let depth = self.sphere_depth(column, row)?;
                (self.depth(column, row) == Some(depth)).then_some(DepthPixel {
                    column,
                    row,
                    depth,
                })
            })
            .collect()
    }
}

impl DepthImage for Scene {
    fn width(&self) -> u16 {
        640
    }

    fn height(&self) -> u16 {
        480
    }

    fn depth(&self, column: u16, row: u16) -> Option<f32> {
        match self.wall {
            Some((end, depth)) if column < end => Some(depth),
            _ => self.sphere_depth(column, row).or(self.background),
        }
    }
}

pub(crate) fn settings() -> DepthSettings {
    DepthSettings {
        noise: Noise::Share(0.08),
        thresholds: Some(Thresholds {
            accept: 0.6,
            reject: 0.3,
        }),
        ..DepthSettings::DEFAULT
    }
}

pub(crate) fn run(
    pose: &Pose,
    scene: &Scene,
    masked: bool,
    settings: &DepthSettings,
) -> DepthReport {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mask = scene.mask();
    let observed = if masked {
        Observed::Pixels(&mask)
    } else {
        Observed::Silhouette
    };
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    check_depth::<8>(
        &template,
        &camera(),
        pose,
        settings,
        observed,
        scene,
        &mut cells,
    )
    .unwrap()
}

pub(crate) fn cause(pose: &Pose, report: &DepthReport) -> Cause {
    report.cause(&Correction::between(pose, &report.refined, [0.0; 3]))
}
