//! The template: a file that stays where it is and is read in place.
//!
//! Owns the wire format (its document is `docs/FORMAT.md`): the header, the sections, the records,
//! everything that is checked before anything is used, and the encoder that the trainer calls.
//! A [`Template`] borrows the bytes, at any alignment; its components are read by offset when they
//! are needed, so that nothing of a template in flash is copied to RAM.

mod cost;
mod decoded;
mod depth;
mod encode;
mod encode_depth;
mod encode_error;
mod encode_validity;
mod error;
mod error_text;
mod near;
mod number;
mod precision;
mod quality;
mod source;
mod stored;
mod validate;
mod validate_components;
mod validate_validity;
mod validity;
mod wire;

pub use cost::Cost;
pub use decoded::DecodedTerm;
pub use depth::{
    CALIBRATION_LENGTH, Calibration, CalibrationSource, DepthRecord, DepthSource, MeasuredShare,
    PROVENANCE_CAPACITY,
};
pub use encode::{encode, encoded_len};
pub use encode_depth::{DEPTH_CAPACITY, with_depth};
pub use encode_error::EncodeError;
pub use error::{Section, TemplateError};
pub use number::{Number, Range};
pub use precision::Precision;
pub use quality::Quality;
pub use source::{ComponentSource, QualitySource, TemplateSource, TermsSource, ValiditySource};
pub use validity::Validity;
pub use wire::{
    HEADER_LENGTH, MAGIC, NAME_CAPACITY, PRECISION_LENGTH, RECORD_LENGTH, VALIDITY_LENGTH, VERSION,
    peek_len,
};

use crate::gp::{self, Hyperparameters, Terms, UnitDirection};
use crate::kernel::{Kernel, Metric, Model};
use crate::trace;
use crate::unit::Unit;
pub(crate) use stored::Stored;
pub(crate) use validity::{Validities, Window};
use wire::{PrecisionRecord, Record, TermValues};

/// A validated template over borrowed bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Template<'a> {
    name: &'a [u8],
    unit: Unit,
    centre: [f32; 3],
    radius: f32,
    diameter: f32,
    model: Model,
    records: &'a [Record],
    precisions: Option<&'a [PrecisionRecord]>,
    values: TermValues<'a>,
    validities: Option<Validities<'a>>,
    quality: Option<&'a [u8]>,
    /// Checked when it was loaded.
    depth: Option<&'a [u8]>,
}

/// One component of a template: a reference point and the Gaussian process around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component<'a> {
    /// C_k, in the object's frame and the template's unit.
    pub centre: [f32; 3],
    /// σ̂_k > 0 (Eq. 9): the rms residual on held-out points, in the template's unit.
    pub sigma_hat: f32,
    /// Q_k (Eq. 8), in 1/unit²; `None` for the identity in the unit sphere.
    pub precision: Option<Precision>,
    /// The hyperparameters that its mean needs.
    pub hyperparameters: Hyperparameters,
    /// Its directions and weights.
    pub terms: Terms<'a>,
    /// Where it may speak; `None` for everywhere.
    pub validity: Option<Validity<'a>>,
}

impl<'a> Template<'a> {
    /// Checks `bytes`, which must be exactly one template, and borrows them.
    ///
    /// Everything that scoring relies on is checked here: magic, version, length, checksum,
    /// sections, counts, finite numbers, positive σ̂ and length scales, unit directions, no
    /// trailing bytes. To load from flash that is padded behind the template, cut it with
    /// [`peek_len`] first:
    /// ```
    /// # use cobra_infer::{Template, template::peek_len, TemplateError};
    /// # fn load(flash: &[u8]) -> Result<(), TemplateError> {
    /// let length = peek_len(flash)?;
    /// let template = Template::from_bytes(flash.get(..length).unwrap_or(flash))?;
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    /// [`TemplateError`] says what is wrong and where.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, TemplateError> {
        let result = validate::template(bytes);
        match &result {
            Ok(template) => trace::template_loaded(template),
            Err(error) => trace::template_refused(error),
        }
        result
    }

    /// The object's name; of one that is no UTF-8, what there is of it before the first byte that is
    /// none. Loading does not look at it: a controller that shows no name links no check.
    #[must_use]
    pub fn name(&self) -> &'a str {
        text(self.name)
    }

    /// The unit of every length in the template.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.unit
    }

    /// The centre of the object's bounding sphere, in its frame.
    #[must_use]
    pub fn centre(&self) -> [f32; 3] {
        self.centre
    }

    /// The radius of the object's bounding sphere: 1 in the paper's unit sphere.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The largest distance between two points of the object.
    #[must_use]
    pub fn diameter(&self) -> f32 {
        self.diameter
    }

    /// In which coordinates directions are compared.
    #[must_use]
    pub fn metric(&self) -> Metric {
        self.model.metric
    }

    /// The covariance function.
    #[must_use]
    pub fn kernel(&self) -> Kernel {
        self.model.kernel
    }

    /// Metric and kernel, which a component's posterior mean needs.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }

    /// Whether the components carry precisions Q_k of their own.
    #[must_use]
    pub fn has_precisions(&self) -> bool {
        self.precisions.is_some()
    }

    /// Whether the components speak only where they are valid.
    #[must_use]
    pub fn has_validity(&self) -> bool {
        self.validities.is_some()
    }

    /// Where the components may speak; `None` for everywhere.
    #[inline]
    pub(crate) fn validities(&self) -> Option<&Validities<'a>> {
        self.validities.as_ref()
    }

    /// Whether the terms are compact ([`crate::gp::compact`]).
    #[must_use]
    pub fn has_compact_terms(&self) -> bool {
        matches!(
            self.values,
            TermValues::Compact(_) | TermValues::Decoded(..)
        )
    }

    /// Whether the components have maps in the place of terms ([`crate::gp::map`]).
    #[must_use]
    pub fn has_maps(&self) -> bool {
        matches!(self.values, TermValues::Map(_))
    }

    /// What was measured of the template, where it says so and what it says decodes.
    #[must_use]
    pub fn quality(&self) -> Option<Quality<'a>> {
        Quality::read(self.quality?, self.component_count())
    }

    /// What the template knows for depth mode, where it says so; a few words, read anew at each call.
    #[must_use]
    pub fn depth(&self) -> Option<DepthRecord<'a>> {
        DepthRecord::read(self.depth?).ok()
    }

    /// How many components there are; at least one.
    #[must_use]
    pub fn component_count(&self) -> usize {
        self.records.len()
    }

    /// How many terms all components have together; of maps, nodes.
    #[must_use]
    pub fn term_count(&self) -> usize {
        match self.values {
            TermValues::Exact(quads) => quads.len(),
            TermValues::Compact(_) | TermValues::Decoded(..) | TermValues::Map(_) => {
                self.stored().map(|stored| stored.terms().len()).sum()
            }
        }
    }

    /// How many bytes all terms take: directions, weights and, of compact ones, a scale a
    /// component; of maps, what is said of each and its nodes.
    #[must_use]
    pub fn terms_len(&self) -> usize {
        match self.values {
            TermValues::Exact(quads) => quads.as_flattened().as_flattened().len(),
            TermValues::Compact(bytes) | TermValues::Decoded(bytes, _) | TermValues::Map(bytes) => {
                bytes.len()
            }
        }
    }

    /// How many bytes it takes to say where the components may speak; 0 for everywhere.
    #[must_use]
    pub fn validity_len(&self) -> usize {
        self.validities.map_or(0, |validities| {
            let records = validities.records.as_flattened().as_flattened();
            records.len() + validities.cells.len()
        })
    }

    /// The components, each read from its record as it is asked for.
    pub fn components(&self) -> impl ExactSizeIterator<Item = Component<'a>> + use<'a> {
        let values = self.values;
        let mut precisions = self.precisions.map(<[PrecisionRecord]>::iter);
        let validities = self.validities;
        self.records.iter().enumerate().map(move |(index, record)| {
            let precision = precisions.as_mut().and_then(Iterator::next);
            let validity = validities.and_then(|all| all.get(index));
            Stored::new(record, values).component(precision.map(Precision::from_record), validity)
        })
    }

    /// Component `index`, read from its record.
    #[must_use]
    pub fn component(&self, index: usize) -> Option<Component<'a>> {
        let precision = self.precisions.and_then(|factors| factors.get(index));
        let validity = self.validities.and_then(|all| all.get(index));
        let stored = self.stored_at(index)?;
        Some(stored.component(precision.map(Precision::from_record), validity))
    }
}

impl Component<'_> {
    /// The posterior mean of the distance in direction `u`, in the template's unit (Eq. 5). Not
    /// finite where a term or the sum overflows; scoring then takes the component for silent.
    #[must_use]
    pub fn posterior_mean(&self, model: Model, u: &UnitDirection) -> f32 {
        gp::posterior_mean(model, &self.hyperparameters, &self.terms, u)
    }
}

/// Bytes that ought to be UTF-8; of those that are none, what there is before the first such byte.
fn text(bytes: &[u8]) -> &str {
    bytes.utf8_chunks().next().map_or("", |chunk| chunk.valid())
}
