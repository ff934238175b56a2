//! The check of one pose.
//!
//! Owns the order of what is done and which pixels are used; each part has a file of its own.

use super::cause::turn_squares;
use super::error::DepthError;
use super::observed::{DepthImage, DepthPixel};
use super::pulse::Pulse;
use super::refine::Equations;
use super::report::DepthReport;
use super::reverse::{Evidence, Sight, look_up};
use super::settings::{DepthSettings, positive};
use super::surface::{Nearby, Surface, TemplateSurface};
use super::zbuffer::{Cell, Window, ZBuffer};
use crate::camera::Camera;
use crate::math::{self, Real};
use crate::pose::Pose;
use crate::template::Template;
use crate::trace;
use nalgebra::Point3;

/// Points of the surface lie this share of a cell of the depth buffer apart at the object's middle, and up to a
/// whole one where an object three radii away is nearest to the camera. It does not depend on the pose, so
/// that a host may keep them.
const SPACING_IN_CELLS: f32 = 0.7;

/// The displacement is a mean over points of the surface this share of the radius apart.
const DISPLACEMENT_SPACING: f32 = 0.25;

/// Which pixels show the object.
#[derive(Clone, Copy, Debug)]
pub enum Observed<'a> {
    /// These: what a mask says.
    Pixels(&'a [DepthPixel]),
    /// Those in which the pose itself says that it is seen, and nothing else hides it.
    Silhouette,
}

/// Checks poses of one surface, seen by one camera.
#[derive(Clone, Debug)]
pub struct DepthCheck<'s, S> {
    surface: &'s S,
    camera: Camera,
    settings: DepthSettings,
}

impl<'s, S: Surface> DepthCheck<'s, S> {
    /// Takes the settings but for their noise, which the surface brings with it.
    ///
    /// # Errors
    /// [`DepthError`] where a setting, or the surface's noise, is out of its range.
    pub fn new(
        surface: &'s S,
        camera: &Camera,
        settings: &DepthSettings,
    ) -> Result<Self, DepthError> {
        settings.check()?;
        positive(surface.noise())?;
        Ok(Self {
            surface,
            camera: *camera,
            settings: *settings,
        })
    }

    /// Checks a pose; `cells` is scratch memory, at least [`DepthSettings::cells`] of them, whatever they
    /// hold. `alive` is called at least once every 64 pixels, cells, or places where a point of the surface
    /// may be: where a watchdog can be fed.
    ///
    /// # Errors
    /// [`DepthError::Cells`] where the scratch memory is too small.
    pub fn run(
        &self,
        pose: &Pose,
        observed: Observed<'_>,
        image: &impl DepthImage,
        cells: &mut [Cell],
        alive: &mut impl FnMut(),
    ) -> Result<DepthReport, DepthError> {
        let noise = self.noise();
        let pulse = &mut Pulse::new(alive);
        let mut report = DepthReport::behind_camera(pose, noise);
        let Some(buffer) = self.depth_buffer(pose, cells, pulse)? else {
            report.depth_ratio = self.depth_ratio(pose, observed, pulse);
            trace::pose_checked(&report);
            return Ok(report);
        };
        let mut evidence = Evidence::default();
        buffer.visible(pulse, &mut |visible| {
            let sight = look_up(image, visible, noise);
            evidence.add(visible, sight, noise, self.surface.diameter());
        });
        report.take(&evidence);
        if matches!(observed, Observed::Pixels(_)) {
            report.depth_ratio = self.depth_ratio(pose, observed, pulse);
        }
        let pixels = Pixels {
            observed,
            buffer: &buffer,
            image,
            noise,
        };
        self.refine(pose, &pixels, &mut report, pulse);
        report.conclude(&self.settings);
        trace::pose_checked(&report);
        Ok(report)
    }

    /// σ_m.
    pub(super) fn noise(&self) -> f32 {
        self.surface.noise()
    }

    /// The points that a camera sees at the pose; `None` where the object does not lie in front of it.
    pub(super) fn depth_buffer<'m>(
        &self,
        pose: &Pose,
        cells: &'m mut [Cell],
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> Result<Option<ZBuffer<'m>>, DepthError> {
        let (expected, found) = (self.settings.cells(), cells.len());
        let cells = cells
            .get_mut(..expected)
            .ok_or(DepthError::Cells { expected, found })?;
        let window = self.window(pose);
        Ok(window.map(|window| self.visible(pose, window, cells, pulse)))
    }

    /// What the observed pixels say of the object's depth.
    fn depth_ratio(
        &self,
        pose: &Pose,
        observed: Observed<'_>,
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> f32 {
        let Observed::Pixels(pixels) = observed else {
            return 0.0;
        };
        let [x, y, z] = self.surface.centre();
        let expected = pose.to_camera(&Point3::new(x, y, z)).z;
        let mut evidence = Evidence::default();
        for pixel in pixels {
            pulse.beat();
            if pixel.is_measured() {
                evidence.compare(pixel.depth, expected);
            }
        }
        evidence.depth_ratio()
    }

    /// The square around the projected bounding sphere, and the depths it lies between; `None` where it
    /// reaches behind the camera.
    fn window(&self, pose: &Pose) -> Option<Window> {
        let [x, y, z] = self.surface.centre();
        let middle = pose.to_camera(&Point3::new(x, y, z));
        let radius = self.surface.radius();
        let near = middle.z - radius;
        // Also what is not finite is not in front of the camera.
        if !(near > 0.0 && near.is_finite()) {
            return None;
        }
        let (middle, half) = self.camera.square_around(&middle, radius);
        Some(Window {
            middle,
            half,
            near,
            range: 2.0 * radius,
        })
    }

    #[inline(never)]
    fn visible<'m>(
        &self,
        pose: &Pose,
        window: Window,
        cells: &'m mut [Cell],
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> ZBuffer<'m> {
        let mut buffer = ZBuffer::new(cells, self.settings.side, window, self.surface.diameter());
        let cell = 2.0 * self.surface.radius() / f32::from(self.settings.side);
        self.surface.sample(SPACING_IN_CELLS * cell, &mut |point| {
            pulse.beat();
            let Some(point) = point else {
                return;
            };
            let seen = pose.to_camera(point);
            if let Some(pixel) = self.camera.project(&seen) {
                buffer.insert(pixel, seen.z);
            }
        });
        buffer
    }

    /// The first look at all pixels gives the forward likelihood; the steps look at some of them.
    #[inline(never)]
    fn refine(
        &self,
        pose: &Pose,
        pixels: &Pixels<'_, impl DepthImage>,
        report: &mut DepthReport,
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) {
        // The settings were checked, which is not seen from here.
        let step_pixels = u32::from(self.settings.step_pixels.max(1));
        let every = pixels.count(pulse).div_ceil(step_pixels).max(1);
        let (all, mut equations) = self.first_look(pose, pixels, every, pulse);
        report.pixels = all.count();
        report.silent = all.silent();
        report.forward = all.likelihood();
        for _ in 0..self.settings.steps {
            let Some(next) = equations.step(&report.refined) else {
                break;
            };
            report.refined = next;
            equations = self.equations(&next, pixels, every, pulse);
        }
        report.residual = equations.residual();
        report.displacement = self.displacement(pose, &report.refined, pulse);
    }

    /// The equations of all pixels, and of every so many-th: what a pixel comes to is asked once for both.
    fn first_look(
        &self,
        pose: &Pose,
        pixels: &Pixels<'_, impl DepthImage>,
        every: u32,
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> (Equations, Equations) {
        let (mut all, mut some) = (Equations::new(self.surface), Equations::new(self.surface));
        let mut turn = Turn::new(every);
        pixels.each(1, pulse, &mut |pixel| {
            let nearby = self.look_back(pose, pixel);
            all.add(nearby);
            if turn.comes() {
                some.add(nearby);
            }
        });
        (all, some)
    }

    fn equations(
        &self,
        pose: &Pose,
        pixels: &Pixels<'_, impl DepthImage>,
        every: u32,
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> Equations {
        let mut equations = Equations::new(self.surface);
        pixels.each(every, pulse, &mut |pixel| {
            equations.add(self.look_back(pose, pixel));
        });
        equations
    }

    /// A pixel put back into the object's frame, and what the surface says of it; `None` where that is nothing.
    #[inline(never)]
    pub(super) fn look_back(
        &self,
        pose: &Pose,
        pixel: &DepthPixel,
    ) -> Option<(Point3<f32>, Nearby)> {
        // What is infinitely far away lies on no surface.
        let point = self
            .camera
            .back_project_depth(pose, &pixel.pixel(), pixel.depth)?;
        Some((point, self.surface.nearby(&point)?))
    }

    /// ADD between two poses, over points of the surface.
    #[inline(never)]
    fn displacement(
        &self,
        pose: &Pose,
        refined: &Pose,
        pulse: &mut Pulse<'_, impl FnMut()>,
    ) -> f32 {
        let (mut sum, mut count) = (0.0_f32, 0_u32);
        let radius = self.surface.radius();
        self.surface
            .sample(DISPLACEMENT_SPACING * radius, &mut |point| {
                pulse.beat();
                let Some(point) = point else {
                    return;
                };
                count = count.saturating_add(1);
                let (a, b) = (pose.to_camera(point), refined.to_camera(point));
                let moved = [a.x - b.x, a.y - b.y, a.z - b.z];
                sum += math::dot(moved, moved).square_root();
            });
        if count == 0 {
            // So few points are asked for that a small surface may have none: no point moves farther.
            let middle = Point3::from(self.surface.centre());
            let (a, b) = (pose.to_camera(&middle), refined.to_camera(&middle));
            let moved = [a.x - b.x, a.y - b.y, a.z - b.z];
            let turned = (0.5 * turn_squares(pose, refined)).square_root();
            return math::dot(moved, moved).square_root() + turned * radius;
        }
        sum / count as f32
    }
}

/// Every so many-th, from the first on.
struct Turn {
    every: u32,
    next: u32,
}

impl Turn {
    fn new(every: u32) -> Self {
        Self { every, next: 0 }
    }

    #[inline]
    fn comes(&mut self) -> bool {
        let comes = self.next == 0;
        if comes {
            self.next = self.every;
        }
        self.next = self.next.saturating_sub(1);
        comes
    }
}

/// The observed pixels, wherever they come from.
struct Pixels<'a, I> {
    observed: Observed<'a>,
    buffer: &'a ZBuffer<'a>,
    image: &'a I,
    noise: f32,
}

impl<I: DepthImage> Pixels<'_, I> {
    /// How many have a depth.
    fn count(&self, pulse: &mut Pulse<'_, impl FnMut()>) -> u32 {
        let mut count = 0_u32;
        self.each(1, pulse, &mut |_| count = count.saturating_add(1));
        count
    }

    /// Every so many-th that has a depth.
    fn each(
        &self,
        every: u32,
        pulse: &mut Pulse<'_, impl FnMut()>,
        act: &mut impl FnMut(&DepthPixel),
    ) {
        let mut turn = Turn::new(every);
        let mut take = |pixel: &DepthPixel| {
            if pixel.is_measured() && turn.comes() {
                act(pixel);
            }
        };
        match self.observed {
            Observed::Pixels(pixels) => {
                for pixel in pixels {
                    pulse.beat();
                    take(pixel);
                }
            }
            Observed::Silhouette => {
                self.buffer.visible(pulse, &mut |visible| {
                    if let Sight::Measured(pixel, _) = look_up(self.image, visible, self.noise) {
                        take(&pixel);
                    }
                });
            }
        }
    }
}

/// Checks one pose of a template of at most `COMPONENTS` components.
///
/// # Errors
/// [`DepthError`]: a setting out of its range, a template without validity or with too many components, too
/// little memory.
pub fn check_depth<const COMPONENTS: usize>(
    template: &Template<'_>,
    camera: &Camera,
    pose: &Pose,
    settings: &DepthSettings,
    observed: Observed<'_>,
    image: &impl DepthImage,
    cells: &mut [Cell],
) -> Result<DepthReport, DepthError> {
    // Used inside its result: moved out, it would lie on the stack twice.
    let surface = TemplateSurface::<COMPONENTS>::at_pose(template, settings, pose);
    let surface = match &surface {
        Ok(surface) => surface,
        Err(error) => return Err(*error),
    };
    let check = DepthCheck::new(surface, camera, settings)?;
    check.run(pose, observed, image, cells, &mut || {})
}
