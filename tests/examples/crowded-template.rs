//! Writes a template of so many components that a scorer may have no room for it.
//!
//! `cargo run -p cobra-tests --example crowded-template -- COMPONENTS FILE`.

use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{ComponentSource, TemplateSource, TermsSource, encode, encoded_len};
use cobra_infer::{Exponent, Kernel, Model, Unit};
use nalgebra::Vector3;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let components: usize = arguments.next().ok_or("how many components?")?.parse()?;
    let path = arguments.next().ok_or("which file?")?;
    let directions = [UnitDirection::new_unchecked(Vector3::z())];
    let component = ComponentSource {
        centre: [0.0; 3],
        sigma_hat: 0.125,
        precision: None,
        hyperparameters: Hyperparameters {
            length_scale: 0.5,
            parameter: 1.0,
            prior_mean: 10.0,
        },
        terms: TermsSource::Exact {
            directions: &directions,
            weights: &[0.25],
        },
        validity: None,
    };
    let source = TemplateSource {
        name: "crowd",
        unit: Unit::Millimetre,
        centre: [0.0; 3],
        radius: 12.0,
        diameter: 24.0,
        model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
        components: &vec![component; components],
        quality: None,
        depth: None,
    };
    let mut bytes = vec![0; encoded_len(&source)];
    let length = encode(&source, &mut bytes)?;
    bytes.truncate(length);
    std::fs::write(path, bytes)?;
    Ok(())
}
