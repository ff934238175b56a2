//! How much memory handles need: exactly, as functions, and as constants of the header, which a
//! program in C sizes its static memory by. That they are enough is checked when this is compiled.

use crate::scorer::CobraScorer;
use crate::template::CobraTemplate;
use cobra_infer::template::NAME_CAPACITY;

/// Bytes that hold the name of any object and the zero behind it.
pub const COBRA_NAME_SIZE: usize = 33;

/// Bytes that hold a template's handle on every processor.
pub const COBRA_TEMPLATE_SIZE: usize = 192;

/// Alignment of a template's handle on every processor.
pub const COBRA_TEMPLATE_ALIGN: usize = 8;

/// Bytes that a scorer's handle takes on every processor, besides those for each component.
pub const COBRA_SCORER_BASE_SIZE: usize = 448;

/// Bytes that a scorer's handle takes for each component that it has room for.
pub const COBRA_SCORER_COMPONENT_SIZE: usize = 12;

/// Alignment of a scorer's handle on every processor.
pub const COBRA_SCORER_ALIGN: usize = 8;

/// The most components that a scorer has room for unless the build says otherwise.
const DEFAULT_MAX_COMPONENTS: usize = 32;

/// The most components that this build's scorer has room for.
pub(crate) const MAX_COMPONENTS: usize = match option_env!("COBRA_MAX_COMPONENTS") {
    Some(text) => parse(text),
    None => DEFAULT_MAX_COMPONENTS,
};

const fn parse(text: &str) -> usize {
    let mut digits = text.as_bytes();
    let mut number = 0;
    while let [digit, rest @ ..] = digits {
        assert!(
            digit.is_ascii_digit() && number < 6554,
            "COBRA_MAX_COMPONENTS must be a whole number from 1 to 65535"
        );
        number = number * 10 + (*digit - b'0') as usize;
        digits = rest;
    }
    assert!(
        number > 0 && number < 65536,
        "COBRA_MAX_COMPONENTS must be a whole number from 1 to 65535"
    );
    number
}

/// The header has it as an expression, which follows what the program in C says of the build.
pub(crate) const COBRA_SCORER_SIZE: usize =
    COBRA_SCORER_BASE_SIZE + COBRA_SCORER_COMPONENT_SIZE * MAX_COMPONENTS;

const _: () = {
    assert!(COBRA_NAME_SIZE > NAME_CAPACITY);
    assert!(size_of::<CobraTemplate>() <= COBRA_TEMPLATE_SIZE);
    assert!(align_of::<CobraTemplate>() <= COBRA_TEMPLATE_ALIGN);
    assert!(size_of::<CobraScorer>() <= COBRA_SCORER_SIZE);
    assert!(align_of::<CobraScorer>() <= COBRA_SCORER_ALIGN);
};
