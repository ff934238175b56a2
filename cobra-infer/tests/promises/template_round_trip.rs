//! A template that was written is read back bit by bit, from anywhere in memory, and a byte more,
//! less or different is refused.

use crate::content::{Content, content};
use cobra_infer::template::{HEADER_LENGTH, Number, peek_len};
use cobra_infer::{EncodeError, Template, TemplateError};
use proptest::prelude::*;

fn bits<const N: usize>(numbers: [f32; N]) -> [u32; N] {
    numbers.map(f32::to_bits)
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn what_is_encoded_is_decoded_bit_by_bit(content in content()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        prop_assert_eq!(template.name(), &content.name);
        prop_assert_eq!(template.unit(), content.unit);
        prop_assert_eq!(bits(template.centre()), bits(content.centre));
        prop_assert_eq!(template.radius().to_bits(), content.radius.to_bits());
        prop_assert_eq!(template.diameter().to_bits(), content.diameter.to_bits());
        prop_assert_eq!(template.model(), content.model);
        prop_assert_eq!(template.component_count(), content.parts.len());
        let sizes = content.parts.iter().map(|part| part.weights.len());
        prop_assert_eq!(template.term_count(), sizes.clone().sum::<usize>());
        prop_assert_eq!(template.terms_len(), 16 * template.term_count());
        prop_assert_eq!(template.validity_len(), 0);
        prop_assert_eq!(template.cost().maximum, template.term_count());
        prop_assert_eq!(Some(template.cost().nearest), sizes.max());
        for (component, part) in template.components().zip(&content.parts) {
            prop_assert_eq!(bits(component.centre), bits(part.centre));
            prop_assert_eq!(component.sigma_hat.to_bits(), part.sigma_hat.to_bits());
            prop_assert_eq!(component.precision, part.precision);
            let (read, written) = (component.hyperparameters, part.hyperparameters);
            prop_assert_eq!(read.length_scale.to_bits(), written.length_scale.to_bits());
            prop_assert_eq!(read.parameter.to_bits(), written.parameter.to_bits());
            prop_assert_eq!(read.prior_mean.to_bits(), written.prior_mean.to_bits());
            prop_assert_eq!(component.terms.len(), part.weights.len());
            let written = part.directions.iter().zip(&part.weights);
            for ((direction, weight), (u, w)) in component.terms.iter().zip(written) {
                let expected = content.model.metric.coordinates([u.x, u.y, u.z]).unwrap();
                prop_assert_eq!(bits(direction), bits(expected));
                prop_assert_eq!(weight.to_bits(), w.to_bits());
            }
        }
    }

    #[test]
    fn encoding_is_the_same_every_time(content in content()) {
        prop_assert_eq!(content.encode(), content.encode());
    }
}

#[test]
fn every_truncation_is_refused() {
    let bytes = Content::small().encode();
    for length in 0..bytes.len() {
        let expected = if length < HEADER_LENGTH {
            TemplateError::HeaderTruncated {
                expected: HEADER_LENGTH,
                found: length,
            }
        } else {
            TemplateError::Length {
                expected: bytes.len(),
                found: length,
            }
        };
        assert_eq!(Template::from_bytes(&bytes[..length]), Err(expected));
    }
}

#[test]
fn every_flipped_bit_is_refused() {
    let mut bytes = Content::small().encode();
    for bit in 0..8 * bytes.len() {
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(Template::from_bytes(&bytes).is_err(), "bit {bit}");
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
    assert!(Template::from_bytes(&bytes).is_ok());
}

#[test]
fn appended_bytes_are_refused() {
    let mut bytes = Content::small().encode();
    let expected = bytes.len();
    for found in expected + 1..expected + 40 {
        bytes.push(0);
        assert_eq!(
            Template::from_bytes(&bytes),
            Err(TemplateError::Length { expected, found })
        );
    }
}

#[test]
fn a_template_is_cut_out_of_padded_flash_by_its_header() {
    let bytes = Content::small().encode();
    let mut flash = bytes.clone();
    flash.resize(4096, 0xff);
    let length = peek_len(&flash).unwrap();
    assert_eq!(length, bytes.len());
    assert_eq!(
        Template::from_bytes(&flash[..length]),
        Template::from_bytes(&bytes)
    );
    assert_eq!(peek_len(&bytes[..HEADER_LENGTH]), Ok(bytes.len()));
}

#[test]
fn blank_flash_is_called_blank() {
    let error = peek_len(&[0xff; 64]).unwrap_err();
    assert_eq!(error, TemplateError::Magic { found: [0xff; 4] });
    assert!(error.to_string().contains("blank flash"));
    assert!(peek_len(&[0; 64]).is_err());
    assert!(peek_len(&[]).is_err());
}

#[test]
fn every_alignment_reads_the_same() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mut padded = vec![0; bytes.len() + 8];
    for offset in 0..8 {
        let place = &mut padded[offset..offset + bytes.len()];
        place.copy_from_slice(&bytes);
        let moved = Template::from_bytes(place).unwrap();
        assert_eq!(moved, template);
        assert!(moved.components().eq(template.components()));
    }
}

#[test]
fn what_a_controller_would_refuse_is_not_written() {
    let mut content = Content::small();
    content.parts[1].sigma_hat = f32::NAN;
    assert!(matches!(
        content.try_encode(),
        Err(EncodeError::Invalid(TemplateError::ComponentNumber {
            component: 1,
            number: Number::SigmaHat,
            ..
        }))
    ));
}

#[test]
fn a_name_too_long_or_terms_that_do_not_pair_are_not_written() {
    let mut content = Content::small();
    content.name = "x".repeat(33);
    let error = content.try_encode().unwrap_err();
    assert_eq!(
        error,
        EncodeError::Name {
            capacity: 32,
            found: 33
        }
    );
    content.name.pop();
    assert!(content.try_encode().is_ok());
    content.parts[0].weights.pop();
    assert_eq!(
        content.try_encode(),
        Err(EncodeError::TermCount {
            component: 0,
            directions: 3,
            weights: 2
        })
    );
}

#[test]
fn a_buffer_a_byte_too_small_is_refused_at_any_size() {
    use cobra_infer::Unit;
    use cobra_infer::template::{ComponentSource, TemplateSource, TermsSource, encode};
    let content = Content::small();
    let needed = content.encode().len();
    let part = &content.parts[0];
    let one = [ComponentSource {
        centre: part.centre,
        sigma_hat: part.sigma_hat,
        precision: None,
        hyperparameters: part.hyperparameters,
        terms: TermsSource::Exact {
            directions: &part.directions,
            weights: &part.weights,
        },
        validity: None,
    }];
    let source = TemplateSource {
        name: "nut",
        unit: Unit::Metre,
        centre: [0.0; 3],
        radius: 1.0,
        diameter: 2.0,
        model: content.model,
        components: &one,
        quality: None,
        depth: None,
    };
    let mut buffer = vec![0xa5; needed];
    let length = encode(&source, &mut buffer).unwrap();
    for found in 0..length {
        assert_eq!(
            encode(&source, &mut buffer[..found]),
            Err(EncodeError::Buffer { found })
        );
    }
    assert_eq!(encode(&source, &mut buffer[..length]), Ok(length));
}
