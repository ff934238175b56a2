//! What a template is called in source text.

use std::fmt;

/// The most characters in a name: what C compilers must tell apart.
pub const MOST_CHARACTERS: usize = 63;

/// Words that are names in neither C nor C++, also those of their standards to come. In capitals,
/// which Rust's constants are in, no word of Rust is reserved.
const RESERVED: &str = "\
    alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept auto bitand bitor \
    bool break case catch char char16_t char32_t char8_t class co_await co_return co_yield compl \
    concept const const_cast consteval constexpr constinit continue contract_assert decltype \
    default delete do double dynamic_cast else enum explicit export extern false far float for \
    friend goto huge if inline int interrupt long main mutable namespace near new noexcept not \
    not_eq nullptr operator or or_eq private protected public reflexpr register reinterpret_cast \
    requires restrict return short signed sizeof static static_assert static_cast struct switch \
    synchronized template this thread_local throw true try typedef typeid typename typeof \
    typeof_unqual uint8_t union unsigned using virtual void volatile wchar_t while xor xor_eq";

/// A name that Rust, C and C++ accept: letters, digits and underscores of ASCII, a letter first, no
/// word that one of them reserves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identifier(String);

/// Why a text is not a name in Rust, C and C++.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IdentifierError {
    /// It does not start with a letter, or is empty.
    #[error("expected a letter of A to Z first, found {}", first(found))]
    Start {
        /// The text.
        found: String,
    },
    /// It has a character that no name has.
    #[error("expected letters, digits and underscores of ASCII, found {found:?}")]
    Character {
        /// The first such character.
        found: char,
    },
    /// Two underscores follow each other, which C++ keeps to itself.
    #[error("expected no two underscores one behind the other, found {found:?}")]
    Underscores {
        /// The text.
        found: String,
    },
    /// It is too long.
    #[error("expected at most {MOST_CHARACTERS} characters, found {found}")]
    Length {
        /// How many there are.
        found: usize,
    },
    /// It means something else in C or C++.
    #[error("{found:?} is a word of C or C++")]
    Reserved {
        /// The word.
        found: String,
    },
}

fn first(text: &str) -> String {
    text.chars()
        .next()
        .map_or_else(|| "nothing".to_owned(), |c| format!("{c:?}"))
}

impl Identifier {
    /// The name that somebody chose.
    ///
    /// # Errors
    /// [`IdentifierError`] says what no name can have.
    pub fn new(text: &str) -> Result<Self, IdentifierError> {
        let found = || text.to_owned();
        if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return Err(IdentifierError::Start { found: found() });
        }
        if let Some(found) = text
            .chars()
            .find(|c| !(c.is_ascii_alphanumeric() || *c == '_'))
        {
            return Err(IdentifierError::Character { found });
        }
        if text.contains("__") {
            return Err(IdentifierError::Underscores { found: found() });
        }
        if text.len() > MOST_CHARACTERS {
            return Err(IdentifierError::Length { found: text.len() });
        }
        if RESERVED.split_whitespace().any(|word| word == text) {
            return Err(IdentifierError::Reserved { found: found() });
        }
        Ok(Self(text.to_owned()))
    }

    /// The name of an object's template: its letters and digits in lower case, whatever lies
    /// between them an underscore, and `_template` behind, which keeps it apart from the words and
    /// the functions of every language. `object` stands for a name without any, and before a digit.
    #[must_use]
    pub fn of_object(name: &str) -> Self {
        let words: Vec<String> = name
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter(|word| !word.is_empty())
            .map(str::to_ascii_lowercase)
            .collect();
        let object = (!words
            .first()
            .is_some_and(|word| word.starts_with(|c: char| c.is_ascii_alphabetic())))
        .then_some("object");
        let words: Vec<&str> = object
            .into_iter()
            .chain(words.iter().map(String::as_str))
            .chain(["template"])
            .collect();
        Self(words.join("_"))
    }

    /// The name as a constant or a macro has it.
    #[must_use]
    pub fn capitals(&self) -> String {
        self.0.to_ascii_uppercase()
    }
}

impl fmt::Display for Identifier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_objects_name_becomes_a_name_in_every_language() {
        for (object, expected) in [
            ("screwdriver", "screwdriver_template"),
            ("Drill Bit (3.5mm)", "drill_bit_3_5mm_template"),
            ("6d-pose", "object_6d_pose_template"),
            ("", "object_template"),
            ("---", "object_template"),
            ("ключ", "object_template"),
            ("Schlüssel", "schl_ssel_template"),
            ("__weak__", "weak_template"),
            ("int", "int_template"),
            ("template", "template_template"),
            ("*/ evil \n\\", "evil_template"),
        ] {
            let identifier = Identifier::of_object(object);
            assert_eq!(identifier.to_string(), expected, "{object:?}");
            assert_eq!(Identifier::new(expected), Ok(identifier));
        }
    }

    #[test]
    fn the_longest_object_name_makes_a_name_that_is_not_too_long() {
        let name = "6".repeat(cobra_infer::template::NAME_CAPACITY);
        let identifier = Identifier::of_object(&name).to_string();
        assert!(Identifier::new(&identifier).is_ok(), "{identifier}");
    }

    #[test]
    fn a_chosen_name_is_taken_as_it_is_or_refused_with_the_reason() {
        for good in ["a", "Part7", "partTemplate", "SELF", "MAIN", "x_"] {
            assert_eq!(Identifier::new(good).unwrap().to_string(), good);
        }
        let long = "x".repeat(MOST_CHARACTERS + 1);
        for (bad, said) in [
            ("", "found nothing"),
            ("7up", "'7'"),
            ("_x", "'_'"),
            ("ü", "'ü'"),
            ("a-b", "'-'"),
            ("a b", "' '"),
            ("a;", "';'"),
            ("schlüssel", "'ü'"),
            ("a__b", "a__b"),
            ("int", "word of C"),
            ("class", "word of C"),
            (&long, "64"),
        ] {
            let error = Identifier::new(bad).unwrap_err().to_string();
            assert!(error.contains(said), "{bad:?}: {error}");
        }
    }
}
