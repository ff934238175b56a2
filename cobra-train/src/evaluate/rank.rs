//! Spearman's rank correlation.

/// The correlation of the ranks of `a` and `b`, from −1 to 1; equal numbers share the average of their
/// ranks. `None` where one of the two has the same rank throughout, of fewer than two pairs, of lists
/// that differ in length, and of what is no number.
///
/// Reference: C. Spearman, The proof and measurement of association between two things, Am. J. Psychol. 15
/// (1904); with ties it is Pearson's correlation of the ranks.
#[must_use]
pub fn rank_correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let ordered = |list: &[f64]| list.iter().all(|number| !number.is_nan());
    if a.len() != b.len() || a.len() < 2 || !ordered(a) || !ordered(b) {
        return None;
    }
    // The mean of all ranks, whatever is tied.
    let mean = (a.len() + 1) as f64 / 2.0;
    let (a, b) = (ranks(a), ranks(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(&b) {
        let (a, b) = (a - mean, b - mean);
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    (aa > 0.0 && bb > 0.0).then(|| (ab / (aa * bb).sqrt()).clamp(-1.0, 1.0))
}

/// The rank of each number, from 1, averaged over equal ones.
fn ranks(numbers: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]));
    let mut ranks = vec![0.0; numbers.len()];
    let mut before = 0;
    for tied in order.chunk_by(|&a, &b| numbers[a] == numbers[b]) {
        let rank = before as f64 + (tied.len() + 1) as f64 / 2.0;
        for &index in tied {
            ranks[index] = rank;
        }
        before += tied.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_numbers_share_the_average_of_their_ranks() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0, 3.0]), [4.0, 1.0, 4.0, 2.0, 4.0]);
        assert_eq!(ranks(&[0.0, -0.0]), [1.5, 1.5]);
    }

    #[test]
    fn any_rising_function_is_1_and_any_falling_one_minus_1() {
        let a: Vec<f64> = (1..40).map(f64::from).collect();
        let rising: Vec<f64> = a.iter().map(|x| x * x * x).collect();
        let falling: Vec<f64> = a.iter().map(|x| 1.0 / x).collect();
        assert_eq!(rank_correlation(&a, &rising), Some(1.0));
        assert_eq!(rank_correlation(&a, &falling), Some(-1.0));
    }

    #[test]
    fn with_ties_it_is_the_correlation_of_the_averaged_ranks() {
        // Ranks 1, 2.5, 2.5, 4, 5 and 2, 1, 3.5, 3.5, 5.
        let found = rank_correlation(&[1.0, 2.0, 2.0, 4.0, 5.0], &[3.0, 1.0, 4.0, 4.0, 5.0]);
        assert_eq!(found, Some(7.25 / 9.5));
    }

    #[test]
    fn what_has_no_order_has_no_correlation() {
        assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), None);
        assert_eq!(rank_correlation(&[1.0], &[1.0]), None);
        assert_eq!(rank_correlation(&[1.0, 2.0], &[1.0]), None);
        assert_eq!(rank_correlation(&[1.0, f64::NAN], &[1.0, 2.0]), None);
    }
}
