//! What `cobra ambiguity` says: as JSON, and as a table with what follows from it.

use crate::cli::report::{plural, table};
use cobra_train::ambiguity::{Ambiguities, Ambiguity, Masks, Path, Range, SearchOptions, What};
use cobra_train::bop::symmetry::Symmetries;
use nalgebra::Vector3;
use serde::Serialize;

/// What was found; the ambiguities' lengths are in the template's unit.
pub(super) struct Found<'a> {
    pub(super) template: &'a str,
    /// Of the template's unit.
    pub(super) millimetres: f64,
    /// Whether the template's own threshold says what is accepted.
    pub(super) calibrated: bool,
    pub(super) options: &'a SearchOptions,
    pub(super) symmetries: Option<&'a Symmetries>,
    pub(super) ambiguities: &'a Ambiguities,
}

#[derive(Serialize)]
pub(super) struct Document<'a> {
    schema: u32,
    template: &'a str,
    diameter_mm: f64,
    /// Poses of at least this ADD are wrong.
    limit_mm: f64,
    views: usize,
    candidates: usize,
    step_degrees: f64,
    masks: &'static str,
    depth_noise_mm: f64,
    seed: u64,
    true_confidence: f64,
    /// The least confidence that was accepted in some view.
    accepted_from: f64,
    calibrated: bool,
    ambiguities: Vec<Entry>,
    /// `null` where nothing is known of what a data set states.
    stated: Option<StatedDocument>,
    conclusion: String,
}

#[derive(Serialize)]
struct Entry {
    #[serde(flatten)]
    what: WhatDocument,
    views: usize,
    confidence: f64,
    add_mm: f64,
    add_s_mm: f64,
    mssd_mm: f64,
    mssd_with_symmetries_mm: Option<f64>,
    stated: Option<bool>,
}

/// Motions of the object in its own frame: the pose that scores as well is the true one after them.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum WhatDocument {
    /// Turns about a line by any angle, or by those from low to high.
    Turns {
        axis: [f64; 3],
        offset_mm: [f64; 3],
        any: bool,
        low_degrees: Option<f64>,
        high_degrees: Option<f64>,
    },
    Slides {
        direction: [f64; 3],
        low_mm: Option<f64>,
        high_mm: Option<f64>,
    },
    /// One motion, as a turn about a line with a shift along it, and as R and t.
    Motion {
        axis: [f64; 3],
        offset_mm: [f64; 3],
        angle_degrees: f64,
        along_mm: f64,
        rotation: [f64; 9],
        translation_mm: [f64; 3],
    },
}

#[derive(Serialize)]
struct StatedDocument {
    discrete: usize,
    continuous: usize,
    /// Of the discrete ones and then the continuous ones: whether shape cannot tell them apart.
    found: Vec<bool>,
}

impl Found<'_> {
    pub(super) fn document(&self) -> Document<'_> {
        let all = self.ambiguities;
        Document {
            schema: 1,
            template: self.template,
            diameter_mm: all.diameter * self.millimetres,
            limit_mm: all.limit * self.millimetres,
            views: all.views,
            candidates: all.candidates,
            step_degrees: self.options.spacing().to_degrees(),
            masks: self.masks(),
            depth_noise_mm: self.options.noise * self.millimetres,
            seed: self.options.seed,
            true_confidence: all.truth,
            accepted_from: all.least,
            calibrated: self.calibrated,
            ambiguities: all.found.iter().map(|found| self.entry(found)).collect(),
            stated: self.symmetries.map(|symmetries| StatedDocument {
                discrete: symmetries.discrete.len(),
                continuous: symmetries.continuous.len(),
                found: all.stated_found.clone(),
            }),
            conclusion: self.conclusion(),
        }
    }

    fn masks(&self) -> &'static str {
        match self.options.masks {
            Masks::Visible => "simulated",
            Masks::Silhouette => "silhouette",
        }
    }

    fn entry(&self, found: &Ambiguity) -> Entry {
        let mm = self.millimetres;
        let lengths = |vector: Vector3<f64>| (mm * vector).into();
        Entry {
            what: match found.what {
                What::Path {
                    path: Path::Turn(axis),
                    range,
                } => WhatDocument::Turns {
                    axis: axis.direction.into_inner().into(),
                    offset_mm: lengths(axis.offset.coords),
                    any: range == Range::Any,
                    low_degrees: range.ends().map(|[low, _]| low.to_degrees()),
                    high_degrees: range.ends().map(|[_, high]| high.to_degrees()),
                },
                What::Path {
                    path: Path::Slide(direction),
                    range,
                } => WhatDocument::Slides {
                    direction: direction.into_inner().into(),
                    low_mm: range.ends().map(|[low, _]| mm * low),
                    high_mm: range.ends().map(|[_, high]| mm * high),
                },
                What::Motion { motion, screw } => {
                    let matrix = motion.rotation.to_rotation_matrix();
                    WhatDocument::Motion {
                        axis: screw.axis.direction.into_inner().into(),
                        offset_mm: lengths(screw.axis.offset.coords),
                        angle_degrees: screw.angle.to_degrees(),
                        along_mm: mm * screw.along,
                        rotation: std::array::from_fn(|i| matrix[(i / 3, i % 3)]),
                        translation_mm: lengths(motion.translation.vector),
                    }
                }
            },
            views: found.views,
            confidence: found.confidence,
            add_mm: mm * found.add,
            add_s_mm: mm * found.add_s,
            mssd_mm: mm * found.mssd,
            mssd_with_symmetries_mm: found.mssd_stated.map(|mssd| mm * mssd),
            stated: found.stated,
        }
    }

    pub(super) fn text(&self) -> String {
        let all = self.ambiguities;
        let mm = self.millimetres;
        let mut text = format!(
            "object      {}, diameter {:.1} mm; wrong from an ADD of {:.1} mm on\n\
             true pose   mean confidence {:.3} in {}; accepted is {}\n\
             tried       {} in each, {:.0} degrees apart, with masks {}\n",
            self.template,
            mm * all.diameter,
            mm * all.limit,
            all.truth,
            plural(all.views, "view"),
            if self.calibrated {
                format!("{:.3} or more, the template's threshold", all.least)
            } else {
                format!("{} of it or more", self.options.share)
            },
            plural(all.candidates, "rotation"),
            self.options.spacing().to_degrees(),
            self.masks()
        );
        if !all.found.is_empty() {
            let shown = all.found.iter().take(SHOWN);
            let rows: Vec<Vec<String>> = shown.map(|found| self.row(found)).collect();
            let mut header = vec![
                "motion",
                "views",
                "confidence",
                "ADD mm",
                "ADD-S mm",
                "MSSD mm",
            ];
            if self.symmetries.is_some() {
                header.extend(["MSSD, symmetries", "stated"]);
            }
            text += &format!("\n{}\n", table(&header, &["motion", "stated"], &rows));
            let more = all.found.len().saturating_sub(SHOWN);
            if more > 0 {
                text +=
                    &format!("and {more} more, in as many views or fewer: --json has them all\n");
            }
        }
        format!("{text}\n{}", self.conclusion())
    }

    fn row(&self, found: &Ambiguity) -> Vec<String> {
        let mm = self.millimetres;
        let mut row = vec![
            found.what.words(mm),
            format!("{} of {}", found.views, self.ambiguities.views),
            format!("{:.3}", found.confidence),
            format!("{:.1}", mm * found.add),
            format!("{:.1}", mm * found.add_s),
            format!("{:.1}", mm * found.mssd),
        ];
        row.extend(found.mssd_stated.map(|mssd| format!("{:.1}", mm * mssd)));
        row.extend(
            found
                .stated
                .map(|stated| if stated { "yes" } else { "no" }.to_owned()),
        );
        row
    }

    /// What follows for whoever trusts the score.
    fn conclusion(&self) -> String {
        let all = self.ambiguities;
        let mm = self.millimetres;
        let mut sentences = Vec::new();
        match worst(all.found.iter()) {
            None => sentences.push(format!(
                "Nothing found: of {} tried in each of {} none came to rest {:.1} mm or more from the truth \
                 with a confidence like the true pose's.",
                plural(all.candidates, "rotation"),
                plural(all.views, "view"),
                mm * all.limit
            )),
            Some(worst) => sentences.push(format!(
                "Shape cannot tell these apart: ADD up to {:.1} mm, confidences up to {:.2}.",
                mm * worst.add,
                all.found
                    .iter()
                    .map(|found| found.confidence)
                    .fold(0.0, f64::max)
            )),
        }
        let unstated = || all.found.iter().filter(|found| found.stated != Some(true));
        if self.symmetries.is_some() && !all.found.is_empty() {
            sentences.push(match worst(unstated()) {
                None => "All are stated in models_info: ADD-S, and MSSD and MSPD with its symmetries, excuse \
                         them; ADD does not."
                    .to_owned(),
                Some(worst) => format!(
                    "{} of {} not stated in models_info: such poses count as wrong, by up to {:.1} mm of \
                     ADD, and score as right ones do.",
                    unstated().count(),
                    all.found.len(),
                    mm * worst.add
                ),
            });
        }
        let some = all.found.iter().filter(|found| found.views < all.views);
        let some = some.count();
        if some > 0 {
            sentences.push(format!(
                "{some} of {} only in some views: in the others shape decides.",
                all.found.len()
            ));
        }
        let stated = all.stated_found.len();
        let told_apart = all.stated_found.iter().filter(|found| !**found).count();
        if told_apart > 0 {
            sentences.push(format!(
                "{told_apart} of {stated} that models_info states not found: the check tells it apart."
            ));
        }
        sentences.join("\n")
    }
}

/// So many are printed.
const SHOWN: usize = 12;

/// That of the largest ADD.
fn worst<'a>(found: impl Iterator<Item = &'a Ambiguity>) -> Option<&'a Ambiguity> {
    found.max_by(|a, b| a.add.total_cmp(&b.add))
}
