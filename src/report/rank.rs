//! Whether two numbers of the same things rise together.

/// Fewest things whose rank correlation says something: three are in perfect order, one way or the other, by chance in one
/// case of three, five in one of sixty.
const FEWEST: usize = 5;

/// [`spearman`] where it says something; `None` for fewer than five things.
#[must_use]
pub fn rank_correlation(xs: &[f64], ys: &[f64]) -> Option<f64> {
    (xs.len() >= FEWEST).then(|| spearman(xs, ys)).flatten()
}

/// Spearman's rank correlation of two numbers a thing: 1 where one rises with the other, -1 where it falls; ties share the
/// mean of their ranks.
///
/// `None` for fewer than three things, for slices of different lengths, for NaN, and where one number is the same for all.
///
/// Source: C. Spearman, The proof and measurement of association between two things, 1904.
#[must_use]
pub fn spearman(xs: &[f64], ys: &[f64]) -> Option<f64> {
    let is_known = xs.len() == ys.len() && xs.len() >= 3 && !xs.iter().chain(ys).any(|value| value.is_nan());
    is_known.then(|| pearson(&ranks(xs), &ranks(ys))).flatten()
}

/// Rank of each number, from 1; equal numbers share the mean of their ranks.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    // 0 and -0 are equal, and sorting must agree with that.
    order.sort_by(|&a, &b| (values[a] + 0.0).total_cmp(&(values[b] + 0.0)));
    let mut ranks = vec![0.0; values.len()];
    let mut before = 0;
    for tied in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let mean = before as f64 + 0.5 * (tied.len() + 1) as f64;
        tied.iter().for_each(|&i| ranks[i] = mean);
        before += tied.len();
    }
    ranks
}

/// Correlation of two rows of ranks, which have the same mean; `None` where one has no spread.
fn pearson(xs: &[f64], ys: &[f64]) -> Option<f64> {
    let mean = 0.5 * (xs.len() + 1) as f64;
    let moment = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    let spread = (moment(xs, xs) * moment(ys, ys)).sqrt();
    (spread > 0.0).then(|| moment(xs, ys) / spread)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Ranks are small numbers: only the last rounding shows.
    const TOLERANCE: f64 = 1e-15;

    #[test]
    fn what_rises_together_has_1_and_what_falls_has_minus_1() {
        let xs = [0.1, 5.0, 7.0, 1e9];
        assert_eq!(spearman(&xs, &[1.0, 2.0, 3.0, 4.0]), Some(1.0));
        assert_eq!(spearman(&xs, &[4.0, 0.0, -1.0, f64::NEG_INFINITY]), Some(-1.0));
    }

    /// Without ties it is 1 - 6 Σd² / (n (n² - 1)): differences of ranks 1, 1, 1, 1, 0 give 1 - 24 / 120.
    #[test]
    fn without_ties_the_sum_of_squared_rank_differences_gives_it() {
        let correlation = spearman(&[1.0, 2.0, 3.0, 4.0, 5.0], &[20.0, 10.0, 40.0, 30.0, 50.0]).unwrap();
        assert!((correlation - 0.8).abs() < TOLERANCE);
    }

    /// Ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4: covariance 4.5, variances 4.5 and 5.
    #[test]
    fn ties_share_the_mean_of_their_ranks() {
        assert_eq!(ranks(&[3.0, -0.0, 0.0, 9.0, 3.0, 3.0]), [4.0, 1.5, 1.5, 6.0, 4.0, 4.0]);
        let correlation = spearman(&[1.0, 2.0, 2.0, 3.0], &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!((correlation - 4.5 / 22.5_f64.sqrt()).abs() < TOLERANCE);
    }

    /// Zhang & Turk, table 2: the less visible, the more is gained, but for the Buddha and the dragon, which change places.
    #[test]
    fn table_2_of_zhang_and_turk_is_almost_in_order() {
        use crate::report::paper::MODELS;
        let rows: Vec<_> = MODELS.iter().filter_map(|m| m.table2).collect();
        let visibility: Vec<f64> = rows.iter().map(|row| row.visibility).collect();
        let less_error: Vec<f64> = rows.iter().map(|row| row.less_error).collect();
        // Two neighbours of six exchanged: -(1 - 6 · 2 / 210).
        assert!((spearman(&visibility, &less_error).unwrap() + 33.0 / 35.0).abs() < TOLERANCE);
    }

    #[test]
    fn the_order_of_fewer_than_five_says_nothing() {
        let xs = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(rank_correlation(&xs[..4], &xs[..4]), None);
        assert_eq!(rank_correlation(&xs, &xs), Some(1.0));
    }

    #[test]
    fn too_little_to_rank_has_no_correlation() {
        assert_eq!(spearman(&[1.0, 2.0], &[1.0, 2.0]), None);
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[7.0; 3]), None);
        assert_eq!(spearman(&[0.0, -0.0, 0.0], &[1.0, 2.0, 3.0]), None);
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[1.0, 2.0]), None);
        assert_eq!(spearman(&[1.0, f64::NAN, 3.0], &[1.0, 2.0, 3.0]), None);
    }
}
