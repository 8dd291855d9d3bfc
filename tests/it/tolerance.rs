//! Is the table of tolerances what it says: a reason for each row, and bounds that are neither empty nor out of reach?

use corner_impact::agreement::{Quantity, compare, shared_decimals};
use corner_impact::corner::map::RouteName;
use corner_impact::tolerance::{Comparison, TABLE, agreement_bound};

const ROUTES: [RouteName; 2] = [RouteName::ClosedForm, RouteName::Variational];

#[test]
fn every_row_has_its_reason() {
    assert!(TABLE.len() >= 15);
    for row in TABLE {
        assert!(row.value > 0.0 && row.value <= 1.0, "{row:?}");
        assert!(row.reason.split_whitespace().count() >= 6, "{row:?}");
        assert_eq!(TABLE.iter().filter(|other| other.name == row.name).count(), 1, "{row:?}");
    }
}

/// Five decimals where entries are large enough for five decimals to mean something; never less than eight digits of a
/// small matrix, never more digits of a huge one than an estimate in doubles has.
#[test]
fn routes_are_bound_by_five_decimals_between_two_relative_bounds() {
    for (scale, expected) in [(1e-6, 1e-14), (1.0, 1e-8), (100.0, 1e-6), (5455.8, 5e-6), (1e4, 5e-6), (1e7, 5e-3)] {
        let bound = agreement_bound(Comparison::Routes, scale).value;
        assert!((bound - expected).abs() <= 1e-9 * expected, "{scale}: {bound}");
    }
    assert_eq!(agreement_bound(Comparison::Printed { decimals: 4 }, 1.0).value, 0.5e-4);
    assert_eq!(agreement_bound(Comparison::Printed { decimals: 14 }, 10.0).value, 2e-12);
    assert_eq!(agreement_bound(Comparison::PrintedEstimate, 5000.0).value, 5e-3);
    for comparison in [Comparison::Routes, Comparison::Eigenvalues, Comparison::Integrated, Comparison::Orbit] {
        assert!(!agreement_bound(comparison, 1.0).reason.is_empty());
    }
}

#[test]
fn what_is_not_a_number_disagrees() {
    let agrees = |left: &[f64], right: &[f64]| compare(ROUTES, Quantity::C, [left, right], Comparison::Routes).agrees;
    assert!(agrees(&[1.0, 2.0], &[1.0, 2.0 + 1e-9]));
    assert!(!agrees(&[1.0, 2.0], &[1.0, 2.0 + 1e-7]));
    assert!(!agrees(&[f64::NAN, 2.0], &[1.0, 2.0]));
    assert!(!agrees(&[1.0, f64::NAN], &[1.0, f64::NAN]));
    assert!(!agrees(&[f64::INFINITY], &[1.0]));
    assert!(!agrees(&[1.0], &[1.0, 2.0]));
    let relative = compare(ROUTES, Quantity::C, [&[1e-3, 5.0], &[1.1e-3, 5.0]], Comparison::Routes);
    assert!((relative.max_rel_diff - 1.0 / 11.0).abs() < 1e-12, "{relative:?}");
    assert!((relative.max_abs_diff - 1e-4).abs() < 1e-15, "{relative:?}");
}

#[test]
fn shared_decimals_are_counted_by_half_units() {
    assert_eq!(shared_decimals(0.0), None);
    for (diff, decimals) in [(4.9e-6, 5), (5.1e-6, 4), (0.49, 0), (3.0, 0), (f64::NAN, 0), (1e-12, 11)] {
        assert_eq!(shared_decimals(diff), Some(decimals), "{diff}");
    }
}
