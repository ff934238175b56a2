//! A template of one's own, checked against a depth image: instructions of each part, and the host's bits.
//!
//! Reads `object.cobra`, `object.scene`, `object.image` and `object.checked` from the folder that the emulator
//! was started in; `tests/examples/object-scene.rs` writes them. The parts are told apart from outside: by what
//! is asked of the surface, and by checks without pixels or steps.

use crate::object::{Room, failed, read};
use crate::{Board, Failed, stack};
use cobra_agreement::depth::{self, Memory, NO_PIXEL, Scene};
use cobra_agreement::object::{CHECKED, COMPONENTS, PIXELS};
use cobra_infer::depth::{
    Cell, DepthCheck, DepthError, DepthReport, DepthSettings, DepthWords, Nearby, Observed,
    Surface, TemplateSurface,
};
use cobra_infer::nalgebra::Point3;
use cobra_infer::{Camera, Pose, Template};
use core::cell::{Cell as Slot, RefCell};
use core::fmt::Write;

/// The most pixels of the sensor's image.
const IMAGE: usize = 320 * 240;

/// What a check works in, and the image.
#[derive(Debug)]
pub struct CheckRoom {
    image: [u16; IMAGE],
    pixels: [cobra_infer::depth::DepthPixel; PIXELS],
    cells: [Cell; CHECKED.cells()],
}

impl CheckRoom {
    /// Empty.
    pub const EMPTY: Self = Self {
        image: [0; IMAGE],
        pixels: [NO_PIXEL; PIXELS],
        cells: [Cell::EMPTY; CHECKED.cells()],
    };
}

/// Compares all bits, and prints what the checks of each pose take.
///
/// # Errors
/// [`Failed`] when a file does not read, when a bit differs, or when `out` fails.
pub fn run(
    board: &mut impl Board,
    out: &mut impl Write,
    files: &mut Room,
    room: &mut CheckRoom,
) -> Result<(), Failed> {
    let (bytes, scene_bytes, rest) = files.read_two(c"object.cobra", c"object.scene", out)?;
    let words = read(c"object.image", rest, out)?.as_chunks().0;
    for (word, bytes) in room.image.iter_mut().zip(words) {
        *word = u16::from_le_bytes(*bytes);
    }
    let words = room.image.get(..words.len()).unwrap_or_default();
    let expected = read(c"object.checked", rest, out)?;
    let template = match Template::from_bytes(bytes) {
        Ok(template) => template,
        Err(error) => return failed(out, format_args!("object.cobra: {error}")),
    };
    let compared = depth::compare(
        expected,
        |each| {
            let memory = Memory {
                pixels: &mut room.pixels,
                cells: &mut room.cells,
            };
            depth::check::<COMPONENTS>(&template, scene_bytes, words, &[CHECKED], memory, each)
        },
        |_| {},
    );
    let mismatched = match compared {
        Ok(compared) => compared.mismatched_bits,
        Err(error) => return failed(out, format_args!("object.scene: {error:?}")),
    };
    let scene = Scene::read(scene_bytes);
    let read = scene.and_then(|scene| Some((scene, scene.image(words)?, scene.camera()?)));
    let Some((scene, image, camera)) = read else {
        return failed(out, format_args!("object.scene does not read"));
    };
    let pixels = scene.observed(&image, &mut room.pixels);
    for (index, pose) in scene.poses().enumerate() {
        let asked = Asked {
            template: &template,
            camera: &camera,
            pose: &pose,
            image: &image,
        };
        let mut deepest = 0;
        let depth = stack::depth_of(|| {
            let report = asked.checked(&CHECKED, Observed::Pixels(pixels), &mut room.cells);
            deepest = report.map_or(0, |report| report.pixels);
        });
        let taken = match asked.parts(pixels, &mut room.cells, board) {
            Ok(taken) => taken,
            Err(error) => return failed(out, format_args!("a check failed: {error}")),
        };
        writeln!(
            out,
            "check pose-{index} pixels={deepest} cells={} stack={depth} bytes={} total={} \
             visible={} reverse={} forward={} refinement={} displacement={} silhouette={} \
             points={} judged={} mismatched_bits={mismatched}",
            room.cells.len(),
            size_of_val(pixels) + size_of_val(&room.cells),
            taken.total,
            taken.visible,
            taken.reverse,
            taken.forward,
            taken.refinement,
            taken.displacement,
            taken.silhouette,
            taken.points,
            taken.judged,
        )?;
    }
    if mismatched == 0 { Ok(()) } else { Err(Failed) }
}

/// Instructions of a check, and of its parts.
struct Taken {
    total: u64,
    visible: u64,
    reverse: u64,
    forward: u64,
    refinement: u64,
    displacement: u64,
    /// In total where the silhouette takes the place of the pixels.
    silhouette: u64,
    /// Of the surface.
    points: u32,
    judged: u32,
}

struct Asked<'a> {
    template: &'a Template<'a>,
    camera: &'a Camera,
    pose: &'a Pose,
    image: &'a DepthWords<'a>,
}

impl Asked<'_> {
    #[inline(never)]
    fn checked(
        &self,
        settings: &DepthSettings,
        observed: Observed<'_>,
        cells: &mut [Cell],
    ) -> Result<DepthReport, DepthError> {
        let (camera, pose) = (self.camera, self.pose);
        cobra_infer::depth::check_depth::<COMPONENTS>(
            self.template,
            camera,
            pose,
            settings,
            observed,
            self.image,
            cells,
        )
    }

    /// Without pixels nothing is put back and no step is made; without steps, and with a step of all pixels,
    /// each is put back once.
    fn parts(
        &self,
        pixels: &[cobra_infer::depth::DepthPixel],
        cells: &mut [Cell],
        board: &mut impl Board,
    ) -> Result<Taken, DepthError> {
        let surface = Counted {
            surface: TemplateSurface::<COMPONENTS>::at_pose(self.template, &CHECKED, self.pose)?,
            board: RefCell::new(board),
            samples: Slot::new([0; 2]),
            points: Slot::new(0),
        };
        let once = DepthSettings {
            steps: 0,
            step_pixels: u16::MAX,
            ..CHECKED
        };
        let all = Observed::Pixels(pixels);
        let (nothing, _) = self.counted(&surface, &once, Observed::Pixels(&[]), cells)?;
        let ([visible, displacement], points) = (surface.samples.get(), surface.points.get());
        let (one, report) = self.counted(&surface, &once, all, cells)?;
        let (total, _) = self.counted(&surface, &CHECKED, all, cells)?;
        let (silhouette, _) = self.counted(&surface, &CHECKED, Observed::Silhouette, cells)?;
        let forward = one.wrapping_sub(nothing);
        Ok(Taken {
            total,
            visible,
            reverse: nothing.wrapping_sub(visible + displacement),
            forward,
            refinement: total.wrapping_sub(nothing).wrapping_sub(forward),
            displacement,
            silhouette,
            points,
            judged: report.judged,
        })
    }

    fn counted<B: Board>(
        &self,
        surface: &Counted<'_, B>,
        settings: &DepthSettings,
        observed: Observed<'_>,
        cells: &mut [Cell],
    ) -> Result<(u64, DepthReport), DepthError> {
        surface.samples.set([0; 2]);
        surface.points.set(0);
        let check = DepthCheck::new(surface, self.camera, settings)?;
        let start = surface.instructions();
        // The counter has to be read before it has wrapped around twice.
        let report = check.run(self.pose, observed, self.image, cells, &mut || {
            surface.instructions();
        })?;
        Ok((surface.instructions().wrapping_sub(start), report))
    }
}

/// A surface that counts the instructions of handing over its points, with what is done with them: first for
/// the depth buffer, and then for the displacement.
struct Counted<'a, B> {
    surface: TemplateSurface<'a, COMPONENTS>,
    board: RefCell<&'a mut B>,
    samples: Slot<[u64; 2]>,
    points: Slot<u32>,
}

impl<B: Board> Counted<'_, B> {
    fn instructions(&self) -> u64 {
        self.board
            .try_borrow_mut()
            .map_or(0, |mut board| board.instructions())
    }
}

impl<B: Board> Surface for Counted<'_, B> {
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
        let start = self.instructions();
        let mut count = 0;
        self.surface.sample(spacing, &mut |point| {
            count += u32::from(point.is_some());
            take(point);
        });
        let taken = self.instructions().wrapping_sub(start);
        match self.samples.get() {
            [0, _] => {
                self.samples.set([taken, 0]);
                self.points.set(count);
            }
            [first, _] => self.samples.set([first, taken]),
        }
    }
}
