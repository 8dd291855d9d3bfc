//! Topological entropy of a full shift on strips of different lengths, per revolution.

use crate::interval::Interval;

/// Lower bound on the topological entropy of a full shift, per revolution, in which each symbol takes this number of revolutions.
///
/// The entropy is the logarithm of the lambda at which the sum of `lambda^-k` over the symbols is 1. For less than two symbols it is 0.
pub fn entropy(revolutions: &[u64]) -> f64 {
    /// Number of halvings, after which a bracket of two close doubles cannot be halved again.
    const HALVINGS: usize = 60;
    if revolutions.len() < 2 || revolutions.contains(&0) {
        return 0.0;
    }
    let sum = |lambda: f64| {
        let part = Interval::from(1.0) / Interval::from(lambda);
        let term = |count: &u64| (0..*count).fold(Interval::from(1.0), |power, _| power * part);
        revolutions.iter().map(term).fold(Interval::from(0.0), |sum, term| sum + term)
    };
    // At lambda = 1 the sum is the number of symbols n, and at lambda = n it is at most 1; the lower end is certain.
    let (mut low, mut high) = (1.0, revolutions.len() as f64);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if sum(middle).low() >= 1.0 { low = middle } else { high = middle }
    }
    logarithm(low.into()).low().max(0.0)
}

/// Lower bound on the logarithm: `ln x = 2 (z + z^3/3 + z^5/5 + ...)` with `z = (x - 1)/(x + 1)`, with positive terms for x above 1.
fn logarithm(number: Interval) -> Interval {
    /// Number of terms of the series. For up to 40 symbols the omitted terms are less than a tenth.
    const TERMS: u32 = 60;
    let z = (number - 1.0) / (number + 1.0);
    let square = z.squared();
    let inner = (0..TERMS)
        .rev()
        .fold(Interval::from(0.0), |sum, term| sum * square + Interval::from(1.0) / f64::from(2 * term + 1));
    z * inner * 2.0
}
