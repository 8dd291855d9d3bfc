//! Do the paper's printed numbers come out as found: the right ones right, the wrong ones wrong?

use crate::common;
use corner_impact::published::{PublishedError, Verdict, compare_published};
use corner_impact::study::verify::{External, verify};

#[test]
fn every_printed_number_is_as_found() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    assert_eq!(found.published.len(), 20);
    for number in &found.published {
        assert!(number.as_found, "{number:?}");
        let is_estimate = number.agreement.quantity.to_string().starts_with("B_hat");
        assert_eq!(number.note.is_empty(), number.verdict == Verdict::Holds && !is_estimate, "{number:?}");
        assert_eq!(number.printed.len(), number.computed.len());
    }
    let wrong: Vec<_> = found.published.iter().filter(|number| number.verdict != Verdict::Holds).collect();
    let names: Vec<_> = wrong.iter().map(|number| number.agreement.quantity.to_string()).collect();
    let expected = ["B_tilde", "B_bar", "eigenvalues_minus", "eigenvalues_plus"];
    assert_eq!(names, expected);
    // A misprint that agreed would be a silent change.
    assert!(wrong.iter().all(|number| !number.agreement.agrees));
}

/// The note on the estimates of B says how good they are: the worst entry of the four.
#[test]
fn estimates_are_as_good_as_is_said() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    let estimates = found.published.iter().filter(|number| number.agreement.quantity.to_string().starts_with("B_hat"));
    let off = estimates.flat_map(|number| {
        assert!(number.note.contains("to 4.3e-7 of each entry"), "{number:?}");
        let entries = number.printed.iter().zip(&number.computed);
        entries.map(|(printed, computed)| (printed.parse::<f64>().unwrap() / computed - 1.0).abs())
    });
    let worst = off.fold(0.0_f64, f64::max);
    assert!((4.25e-7..4.3e-7).contains(&worst), "{worst:e}");
}

/// The analytic matrices are printed with 14 digits, and are held to them.
#[test]
fn fourteen_digits_are_held_to_fourteen_digits() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    for quantity in
        ["A_minus", "A_plus", "B_minus", "B_plus", "C", "D", "x_star", "T_star", "A_bar_minus", "A_bar_plus"]
    {
        let number = found.published.iter().find(|number| number.agreement.quantity.to_string() == quantity).unwrap();
        let largest = number.computed.iter().fold(1.0_f64, |largest, entry| largest.max(entry.abs()));
        assert!(number.agreement.bound.value <= 2.1e-13 * largest, "{number:?}");
    }
}

/// What is wrong with a printed number, computed: each error alone, as the note says.
#[test]
fn the_errors_are_those_that_the_notes_name() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    let map = &found.map;
    let printed = |quantity: &str| -> Vec<f64> {
        let number = found.published.iter().find(|number| number.agreement.quantity.to_string() == quantity).unwrap();
        number.printed.iter().map(|digits| digits.replace(',', ".").parse().unwrap()).collect()
    };
    // B~ as printed is B - A e1 D/c1.
    let (c1, d) = (map.c()[0], map.d());
    let without_identity = map.minus.b - map.minus.a.column(0) * (d / c1);
    let b_tilde = printed("B_tilde");
    assert!((without_identity[0] - b_tilde[0]).abs() < 1e-8 && (without_identity[1] - b_tilde[1]).abs() < 1e-8);
    // B bar as printed is -W times that.
    let form = found.normal_form.unwrap();
    let b_bar = -(form.w * without_identity);
    let as_printed = printed("B_bar");
    assert!(
        (b_bar[0] - as_printed[0]).abs() < 5e-6 && (b_bar[1] - as_printed[1]).abs() < 1e-5,
        "{b_bar} {as_printed:?}"
    );
}

#[test]
fn another_model_is_not_held_against_the_paper() {
    let model = common::osorio_with(&[("restitution", "0.75")]);
    let found = verify(&model, External::LeftOut).unwrap();
    assert!(found.published.is_empty());
    assert!(found.skipped.iter().any(|skipped| skipped.route == "published"));
    let result = compare_published(&model, &found.at, &found.routes[0], None);
    assert_eq!(result.unwrap_err(), PublishedError::OtherModel);
}

/// A model that is the paper's in all but its name is the paper's.
#[test]
fn names_decide_nothing() {
    let model = common::osorio_with(&[("name", "\"mine\"")]);
    assert_eq!(verify(&model, External::LeftOut).unwrap().published.len(), 20);
}
