//! Ids of images: the same image, by whatever number of leading zeros.
//!
//! Owns nothing else. BOP's files say `61` in JSON and `000061` in file names.

/// The same id, or the same number: `000061` and `61`.
#[must_use]
pub fn same_image(a: &str, b: &str) -> bool {
    let number = |text: &str| text.parse::<u64>().ok();
    a == b || (number(a).is_some() && number(a) == number(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_before_a_number_do_not_count_and_words_must_agree() {
        assert!(same_image("000061", "61"));
        assert!(same_image("left", "left"));
        for (a, b) in [("61", "62"), ("left", "right"), ("", "0"), ("6.1", "06.1")] {
            assert!(!same_image(a, b), "{a} {b}");
        }
    }
}
