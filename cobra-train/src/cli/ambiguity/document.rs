//! What `cobra ambiguity` says: as JSON, and as a table with what follows from it.

use crate::cli::report::{plural, table};
use cobra_train::ambiguity::{
    Ambiguities, Ambiguity, AmbiguityDocument, AmbiguityEntry, Masks, MotionDocument, SCHEMA,
    SearchOptions, StatedSymmetries,
};
use cobra_train::bop::symmetry::Symmetries;

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

impl Found<'_> {
    pub(super) fn document(&self) -> AmbiguityDocument {
        let all = self.ambiguities;
        AmbiguityDocument {
            schema: SCHEMA,
            template: self.template.to_owned(),
            diameter_mm: all.diameter * self.millimetres,
            limit_mm: all.limit * self.millimetres,
            views: all.views,
            candidates: all.candidates,
            step_degrees: self.options.spacing().to_degrees(),
            masks: self.masks().to_owned(),
            depth_noise_mm: self.options.noise * self.millimetres,
            seed: self.options.seed,
            true_confidence: all.truth,
            accepted_from: all.least,
            calibrated: self.calibrated,
            ambiguities: all.found.iter().map(|found| self.entry(found)).collect(),
            stated: self.symmetries.map(|symmetries| StatedSymmetries {
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

    fn entry(&self, found: &Ambiguity) -> AmbiguityEntry {
        let mm = self.millimetres;
        AmbiguityEntry {
            what: MotionDocument::new(&found.what, mm),
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
                 with a confidence {}.",
                plural(all.candidates, "rotation"),
                plural(all.views, "view"),
                mm * all.limit,
                if self.calibrated {
                    "that the threshold accepts"
                } else {
                    "like the true pose's"
                }
            )),
            Some(worst) => sentences.push(format!(
                "{}: ADD up to {:.1} mm, confidences up to {:.2}.",
                if self.calibrated {
                    "The threshold accepts these too"
                } else {
                    "Shape cannot tell these apart"
                },
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
                     ADD, and are accepted as right ones are.",
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
