//! What was measured of a template when it was trained.
//!
//! Owns the section that scoring never reads: loading leaves it alone, and a controller that does not
//! ask for it links nothing of it.

use super::wire::QualitySection;

/// What was measured of a template on points that training did not see.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quality<'a> {
    /// The share of held-out surface points that some component speaks for and explains, 0 to 1.
    pub covered: f32,
    /// The largest deviation of the written mean from the one that was fitted, in units of σ̂.
    pub deviation_max: f32,
    /// The rms of it.
    pub deviation_rms: f32,
    unexplained: &'a [[u8; 2]],
}

impl<'a> Quality<'a> {
    /// `None` of a body that is none, or has not one share for each component.
    pub(super) fn read(body: &'a [u8], components: usize) -> Option<Self> {
        let (section, rest) = postcard::take_from_bytes::<QualitySection<&'a [u8]>>(body).ok()?;
        let (unexplained, odd) = section.unexplained.as_chunks();
        let deviates = |deviation: f32| deviation >= 0.0 && deviation.is_finite();
        let holds = (0.0..=1.0).contains(&section.covered)
            && deviates(section.deviation_max)
            && deviates(section.deviation_rms)
            && unexplained.len() == components
            && odd.is_empty()
            && rest.is_empty();
        holds.then_some(Self {
            covered: section.covered,
            deviation_max: section.deviation_max,
            deviation_rms: section.deviation_rms,
            unexplained,
        })
    }

    /// For each component, the share of the held-out points in its care that it does not explain.
    pub fn unexplained(&self) -> impl ExactSizeIterator<Item = f32> + use<'a> {
        let share = |steps: &[u8; 2]| f32::from(u16::from_le_bytes(*steps)) / f32::from(u16::MAX);
        self.unexplained.iter().map(share)
    }
}
