//! Numbers as people read them: as many digits as mean something, whatever the unit.

/// A length with three digits.
#[must_use]
pub fn short(length: f64) -> String {
    if length == 0.0 {
        return "0".to_owned();
    }
    let magnitude = length.abs().log10().floor();
    let decimals = (2.0 - magnitude).clamp(0.0, 9.0) as usize;
    format!("{length:.decimals$}")
}

/// A count with a comma between thousands.
#[must_use]
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_three_digits_in_any_unit() {
        let found = [132.99, 1.3299, 0.001_329_9, -7.5, 0.0].map(short);
        assert_eq!(found, ["133", "1.33", "0.00133", "-7.50", "0"]);
    }

    #[test]
    fn thousands_are_told_apart() {
        let found = [0, 999, 1_000, 34_896, 1_234_567].map(grouped);
        assert_eq!(found, ["0", "999", "1,000", "34,896", "1,234,567"]);
    }
}
