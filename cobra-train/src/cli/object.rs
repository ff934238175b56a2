//! The object that `train` and `eval` are given: its surface, its unit, and the move into the unit
//! sphere where that was asked for.
//!
//! Owns what the user is told about the unit. Reading is `surface::read`'s work.

use super::choices::UnitArgument;
use super::failure::Failure;
use super::terminal::Terminal;
use cobra_infer::{Template, Unit};
use cobra_train::progress::Progress;
use cobra_train::surface::{BoundingSphere, Geometry, ReadGeometry, read_geometry};
use std::path::Path;

/// What a file holds, ready for use.
pub(super) struct Object {
    pub(super) geometry: Geometry,
    /// The unit that the format prescribes, if any.
    pub(super) prescribed: Option<Unit>,
    /// Where the object was before it was moved into the unit sphere.
    pub(super) moved_from: Option<BoundingSphere>,
}

/// Reads the object and moves it if asked to; says so in a line.
pub(super) fn read(path: &Path, unit_sphere: bool, terminal: &Terminal) -> Result<Object, Failure> {
    let ReadGeometry { geometry, unit } = read_geometry(path)?;
    let (geometry, moved_from) = if unit_sphere {
        let (geometry, sphere) = geometry.into_unit_sphere();
        let BoundingSphere { centre, radius } = sphere;
        terminal.say(&format!(
            "unit sphere: centre ({}, {}, {}), scale {}: a point P is now at scale * (P - centre)",
            centre.x,
            centre.y,
            centre.z,
            1.0 / radius
        ));
        (geometry, Some(sphere))
    } else {
        (geometry, None)
    };
    Ok(Object {
        geometry,
        prescribed: unit,
        moved_from,
    })
}

impl Object {
    /// The unit that was asked for, else the format's, else millimetres. After the move into the
    /// unit sphere it labels the scaled numbers, and nothing is doubted.
    pub(super) fn unit(&self, wanted: Option<UnitArgument>, terminal: &Terminal) -> Unit {
        let wanted = wanted.map(Unit::from);
        match (wanted, self.prescribed) {
            (None, Some(Unit::Metre)) if self.moved_from.is_none() => {
                terminal.say("note: glTF lengths are metres");
            }
            (Some(wanted), Some(prescribed))
                if wanted != prescribed && self.moved_from.is_none() =>
            {
                terminal.warn(&format!(
                    "glTF lengths are metres, but --unit {0} is followed: the numbers are taken \
                     for {0}",
                    wanted.symbol()
                ));
            }
            _ => {}
        }
        wanted.or(self.prescribed).unwrap_or(Unit::Millimetre)
    }
}

/// A mesh whose diameter differs from the template's by more than this share is of another object.
const DIAMETER: f64 = 0.05;

/// Refuses a mesh of another diameter than the template's.
pub(super) fn check_diameter(
    template: &Template<'_>,
    found: f64,
    path: &Path,
) -> Result<(), Failure> {
    let expected = f64::from(template.diameter());
    if (found / expected - 1.0).abs() <= DIAMETER {
        return Ok(());
    }
    Err(Failure::BadInput(format!(
        "{}: expected the template's object, with a diameter of {expected:.1} {unit}, found one of {found:.1}",
        path.display(),
        unit = template.unit().symbol()
    )))
}
