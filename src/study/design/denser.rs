//! Values between the values of a table, so that a curve through them looks smooth.

use crate::study::survey::Spacing;
use crate::uncertainty::SourcedUncertainty;

/// Number of values from which a curve is drawn: three to a millimetre of a column's width.
pub const DRAWN: usize = 241;

/// Returns values between the neighbouring values of a table, so that there are at least `count` in all, the table's own included.
pub(super) fn between(values: &[f64], spacing: Spacing, count: usize) -> Vec<f64> {
    let pieces = values.len().saturating_sub(1);
    let parts = count.saturating_sub(1).div_ceil(pieces.max(1)).max(1);
    let of_pair = |pair: &[f64]| {
        let [from, to] = [pair[0], pair[1]].map(|value| spacing.place(value));
        let value = move |part: usize| spacing.value(from + (to - from) * part as f64 / parts as f64);
        (1..parts).map(value).collect::<Vec<_>>()
    };
    values.windows(2).flat_map(of_pair).collect()
}

/// Uncertainties at `value`, linear between the neighbouring values of a table; none if a neighbour has no uncertainties.
pub(super) fn errors<const N: usize>(
    known: &[(f64, Option<[SourcedUncertainty; N]>)],
    value: f64,
) -> Option<[SourcedUncertainty; N]> {
    let after = known.partition_point(|(at, _)| *at < value);
    if let Some((_, errors)) = known.get(after).filter(|(at, _)| *at == value) {
        return *errors;
    }
    let ((low, one), (high, other)) = (known.get(after.checked_sub(1)?)?, known.get(after)?);
    let ((one, other), part) = ((one.as_ref()?, other.as_ref()?), (value - low) / (high - low));
    Some(std::array::from_fn(|index| one[index].towards(&other[index], part)))
}
