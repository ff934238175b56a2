//! A template as a surface, as a robot has it.

use crate::train::LARGEST_TEMPLATE;
use cobra_infer::Template;
use cobra_infer::depth::{DepthError, DepthSettings, TemplateSurface};

/// A template with the σ_m that the settings make of its own diameter, whatever a mesh's may be. The depth,
/// which matters to a sensor's noise alone, is 0: what templates record is a share of the diameter.
///
/// # Errors
/// [`DepthError`]: no σ_m, or the template does not say where its surface is.
pub fn template_surface<'t>(
    template: &'t Template<'t>,
    settings: &DepthSettings,
) -> Result<TemplateSurface<'t, LARGEST_TEMPLATE>, DepthError> {
    let noise = settings.noise.at(template.diameter(), 0.0)?;
    TemplateSurface::new(template, noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo::mechanical_part;
    use crate::progress::Silent;
    use crate::train::{TrainOptions, train};
    use cobra_infer::depth::{Noise, Surface};

    #[test]
    fn sigma_m_is_a_share_of_the_templates_own_diameter() {
        let options = TrainOptions {
            points: 2000,
            test_points: 1500,
            ..TrainOptions::new("part")
        };
        let trained = train(&mechanical_part().into(), &options, &Silent).unwrap();
        let template = Template::from_bytes(&trained.bytes).unwrap();
        let settings = DepthSettings {
            noise: Noise::Share(0.05),
            ..DepthSettings::for_template(&template)
        };
        let surface = template_surface(&template, &settings).unwrap();
        assert_eq!(surface.noise(), 0.05 * template.diameter());
    }
}
