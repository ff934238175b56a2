//! What the 3-D view is drawn from: places, what the template says of each, and how they are joined.
//!
//! Owns which places are shown and how their numbers become bytes. `assets/viewer/viewer.js` reads them, by
//! the names in [`View`].

mod densify;
mod merge;
mod own;

use super::colours;
use super::content::Content;
use crate::digits::{grouped, short};
use crate::evaluate::{TAU, residuals};
use crate::surface::{Geometry, Mesh};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use cobra_infer::{Assignment, ScoreError, Template};
use nalgebra::Point3;
use serde::Serialize;

/// Most triangles on a page: some 2 MB of it.
const MOST_TRIANGLES: usize = 130_000;

/// Most places where there are no triangles.
const MOST_POINTS: usize = 60_000;

/// Edges longer than this share of the diameter are halved, for between two places nothing is asked.
const LONGEST_EDGE: f64 = 0.02;

/// Residuals beyond this many τ are said to be at least that.
const LARGEST_RESIDUAL: f64 = 8.0;

/// For a residual: no component speaks.
const SILENT_RESIDUAL: i16 = i16::MIN;

/// For a component: none speaks.
const SILENT_COMPONENT: u16 = u16::MAX;

/// The picture's data. Names are those that the viewer reads; the numbers of places go onto the page apart, as bytes.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct View {
    /// Whether places are joined by triangles.
    pub surface: bool,
    /// Whether residuals are known: of an object.
    pub measured: bool,
    /// How many places.
    pub places: usize,
    /// How many triangles.
    pub triangles: usize,
    /// A coordinate is `low` and so many times `step`.
    low: [f64; 3],
    step: f64,
    /// Millimetres in a step of a residual.
    residual_step: f64,
    /// τ in millimetres.
    tau: f64,
    /// Digits behind the point, of places and of residuals.
    digits: usize,
    residual_digits: usize,
    unit: &'static str,
    /// Whether indices have four bytes each, not two.
    wide: bool,
    colours: Colours,
    components: Vec<ViewComponent>,
    /// What was done to the object's faces, in a sentence.
    #[serde(skip)]
    pub remark: String,
    #[serde(skip)]
    pub(super) buffers: Buffers,
}

#[derive(Clone, Debug, Serialize)]
struct Colours {
    ramp: Vec<String>,
    covered: String,
    uncovered: String,
    silent: String,
}

#[derive(Clone, Debug, Serialize)]
struct ViewComponent {
    centre: [f64; 3],
    colour: String,
    /// What is said of it when it is pointed at.
    said: String,
}

/// Base64 of little-endian numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffers {
    /// `u16`, three a place.
    pub(super) positions: String,
    /// `i16`, one a place.
    pub(super) residuals: String,
    /// `u16`, one a place.
    pub(super) components: String,
    /// `u16` or `u32`, three a triangle.
    pub(super) indices: String,
}

/// Places, and what is known of each.
struct Places {
    positions: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    components: Vec<Option<usize>>,
    /// In the template's unit.
    residuals: Option<Vec<Option<f64>>>,
    remark: String,
}

impl View {
    pub(super) fn new(
        template: &Template<'_>,
        assignment: Assignment,
        object: Option<&Geometry>,
        content: &Content,
    ) -> Result<Self, ScoreError> {
        let mm = content.millimetres;
        let places = match object {
            Some(object) => of_object(template, assignment, object)?,
            None => of_template(template, content),
        };
        let tau = TAU * content.radius * mm;
        let residual_step = LARGEST_RESIDUAL * tau / f64::from(i16::MAX);
        let low = places
            .positions
            .iter()
            .fold([f64::INFINITY; 3], |low, point| {
                std::array::from_fn(|axis| low[axis].min(point[axis]))
            });
        let extent = places.positions.iter().fold(0.0_f64, |most, point| {
            (0..3).fold(most, |most, axis| most.max(point[axis] - low[axis]))
        });
        let step = extent / f64::from(u16::MAX);
        let wide = places.positions.len() > usize::from(u16::MAX);
        let decimals = |smallest: f64| (-smallest.log10()).ceil().clamp(0.0, 6.0) as usize;
        Ok(Self {
            surface: !places.triangles.is_empty(),
            measured: places.residuals.is_some(),
            places: places.positions.len(),
            triangles: places.triangles.len(),
            low,
            step,
            residual_step,
            tau,
            digits: decimals(content.diameter / 1000.0),
            residual_digits: decimals(tau / 50.0),
            unit: content.unit,
            wide,
            colours: Colours {
                ramp: colours::ramp().into_iter().map(colours::hex).collect(),
                covered: colours::hex(colours::COVERED),
                uncovered: colours::hex(colours::uncovered()),
                silent: colours::hex(colours::SILENT),
            },
            components: components(content),
            buffers: Buffers {
                positions: base64(
                    places
                        .positions
                        .iter()
                        .flat_map(|point| {
                            (0..3).map(move |axis| {
                                let steps = (point[axis] - low[axis]) / step.max(f64::MIN_POSITIVE);
                                steps.round().clamp(0.0, f64::from(u16::MAX)) as u16
                            })
                        })
                        .map(u16::to_le_bytes),
                ),
                residuals: base64(
                    places
                        .residuals
                        .iter()
                        .flatten()
                        .map(|residual| {
                            residual.map_or(SILENT_RESIDUAL, |residual| {
                                let most = f64::from(i16::MAX);
                                (residual * mm / residual_step).round().clamp(-most, most) as i16
                            })
                        })
                        .map(i16::to_le_bytes),
                ),
                components: base64(places.components.iter().map(|component| {
                    component
                        .and_then(|index| u16::try_from(index).ok())
                        .unwrap_or(SILENT_COMPONENT)
                        .to_le_bytes()
                })),
                indices: {
                    let all = places.triangles.iter().flatten().copied();
                    if wide {
                        base64(all.map(u32::to_le_bytes))
                    } else {
                        base64(all.map(|index| (index as u16).to_le_bytes()))
                    }
                },
            },
            remark: places.remark,
        })
    }

    /// Residuals from 0 to τ, as a style sheet writes colours.
    pub(super) fn ramp(&self) -> &[String] {
        &self.colours.ramp
    }

    pub(super) fn covered(&self) -> &str {
        &self.colours.covered
    }

    pub(super) fn uncovered(&self) -> &str {
        &self.colours.uncovered
    }
}

fn base64<const BYTES: usize>(words: impl Iterator<Item = [u8; BYTES]>) -> String {
    STANDARD.encode(words.flatten().collect::<Vec<u8>>())
}

fn components(content: &Content) -> Vec<ViewComponent> {
    let of = |(index, component): (usize, &super::ComponentData)| ViewComponent {
        centre: component.centre,
        colour: component.colour.clone(),
        said: format!(
            "component {index}: σ̂ {} mm, {} {}, {} bytes",
            short(component.sigma_hat_mm),
            component.terms,
            content.elements,
            component.bytes
        ),
    };
    content.components.iter().enumerate().map(of).collect()
}

/// The object's surface, and what the template says of it.
fn of_object(
    template: &Template<'_>,
    assignment: Assignment,
    object: &Geometry,
) -> Result<Places, ScoreError> {
    let (positions, triangles, remark) = match object {
        Geometry::Mesh(mesh) => of_mesh(
            mesh,
            f64::from(template.diameter()),
            template.unit().symbol(),
        ),
        Geometry::Cloud(cloud) => {
            let positions = thinned(cloud.points().to_vec());
            let remark = format!(
                "{} of the cloud's {} points.",
                grouped(positions.len() as u64),
                grouped(cloud.points().len() as u64)
            );
            (positions, Vec::new(), remark)
        }
    };
    let matches = residuals(template, assignment, &positions)?;
    Ok(Places {
        components: matches
            .iter()
            .map(|found| found.map(|found| found.component))
            .collect(),
        residuals: Some(
            matches
                .iter()
                .map(|found| found.map(|found| f64::from(found.residual())))
                .collect(),
        ),
        positions,
        triangles,
        remark,
    })
}

type Surface = (Vec<Point3<f64>>, Vec<[u32; 3]>, String);

fn of_mesh(mesh: &Mesh, diameter: f64, unit: &str) -> Surface {
    let given = mesh.triangles().len();
    if given > MOST_TRIANGLES {
        let merged = merge::merged(mesh, diameter, MOST_TRIANGLES);
        let remark = format!(
            "{} triangles in the place of the mesh's {}: vertices in the same cell of a grid of {} {unit} \
             are one of them.",
            grouped(merged.triangles.len() as u64),
            grouped(given as u64),
            short(merged.cell)
        );
        return (merged.vertices, merged.triangles, remark);
    }
    let (vertices, triangles) = densify::densified(mesh, LONGEST_EDGE * diameter, MOST_TRIANGLES);
    let remark = if triangles.len() > given {
        format!(
            "The mesh's {} triangles, long edges halved: {} places.",
            grouped(given as u64),
            grouped(vertices.len() as u64)
        )
    } else {
        format!("The mesh's {} triangles.", grouped(given as u64))
    };
    (vertices, triangles, remark)
}

/// The surface that the template itself describes.
fn of_template(template: &Template<'_>, content: &Content) -> Places {
    let all = thinned(own::surface(template));
    let (components, positions) = all
        .into_iter()
        .unzip::<usize, Point3<f64>, Vec<_>, Vec<_>>();
    Places {
        remark: format!(
            "{} points that the template's {} components predict{}.",
            grouped(positions.len() as u64),
            content.components.len(),
            if content.validity {
                " where they may speak"
            } else {
                ""
            }
        ),
        components: components.into_iter().map(Some).collect(),
        positions,
        triangles: Vec::new(),
        residuals: None,
    }
}

/// At most [`MOST_POINTS`], evenly.
fn thinned<T>(all: Vec<T>) -> Vec<T> {
    let every = all.len().div_ceil(MOST_POINTS).max(1);
    all.into_iter().step_by(every).collect()
}
