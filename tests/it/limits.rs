//! Limits of the numbers that a user asks with: one rule for the command line and Python.

use corner_impact::orbit::Search;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::limits::{range, spaced, speed, thread_count};
use corner_impact::study::survey::{Spacing, Values};

#[test]
fn a_cam_turns_at_a_finite_speed_above_0() {
    assert_eq!(speed(700.0), Ok(700.0));
    assert_eq!(speed(Values::FASTEST), Ok(Values::FASTEST));
    for rpm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(speed(rpm), Err("must be a finite number above 0".into()), "{rpm}");
    }
    assert_eq!(speed(2.0 * Values::FASTEST), Err("must be 1e9 or less".into()));
}

#[test]
fn a_range_goes_up_and_is_finite() {
    assert_eq!(range([1.0, 2.0]), Ok([1.0, 2.0]));
    for ends in [[2.0, 1.0], [1.0, 1.0], [f64::NAN, 1.0], [-f64::MAX, f64::MAX]] {
        assert!(range(ends).is_err(), "{ends:?}");
    }
}

#[test]
fn a_logarithmic_axis_begins_above_0() {
    assert_eq!(spaced(0.1, Spacing::Logarithmic), Ok(Spacing::Logarithmic));
    assert_eq!(spaced(0.0, Spacing::Linear), Ok(Spacing::Linear));
    assert_eq!(spaced(-1.0, Spacing::Linear), Ok(Spacing::Linear));
    for low in [0.0, -1.0] {
        assert!(spaced(low, Spacing::Logarithmic).unwrap_err().contains("begins above 0"), "{low}");
    }
}

#[test]
fn an_axis_has_a_value_or_more() {
    let checked = |low, high, count, spacing| Values { low, high, count, spacing }.checked("value");
    let linear = |low, high, count| checked(low, high, count, Spacing::Linear);
    assert_eq!(linear(1.0, 2.0, 2), Ok(Values::linear(1.0, 2.0, 2)));
    assert_eq!(linear(1.0, 1.0, 1), Ok(Values::linear(1.0, 1.0, 1)));
    assert_eq!(linear(1.0, 1.0, 3), Ok(Values::linear(1.0, 1.0, 3)));
    assert!(linear(1.0, 2.0, Values::MOST).is_ok());
    assert_eq!(linear(1.0, 2.0, Values::MOST + 1), Err("must be 10000000 values or fewer".into()));
    assert_eq!(linear(1.0, 2.0, 0), Err("must be 1 value or more".into()));
    assert_eq!(linear(1.0, 2.0, 1), Err("1 value needs the lowest and the highest to be the same".into()));
    assert_eq!(linear(2.0, 1.0, 2), Err("the highest value, 1, is below the lowest, 2".into()));
    assert!(linear(-f64::MAX, f64::MAX, 2).is_err() && linear(f64::NAN, 1.0, 2).is_err());
    assert!(checked(0.0, 1.0, 2, Spacing::Logarithmic).unwrap_err().contains("begins above 0"));
    assert!(checked(0.1, 1.0, 2, Spacing::Logarithmic).is_ok());
}

#[test]
fn a_machine_starts_as_many_threads_as_it_may_use() {
    assert_eq!(thread_count(1), Ok(1));
    assert_eq!(thread_count(256), Ok(256));
    for count in [0, 1_000_000, u64::MAX] {
        assert!(thread_count(count).unwrap_err().contains("a whole number of threads from 1 to "), "{count}");
    }
}

#[test]
fn a_budget_that_judges_records_something() {
    let budget = Budget { transient: 0, record: 0, longest: 1, patience: 0 };
    assert_eq!(budget.checked(), Ok(budget));
    assert_eq!(budget.judging(), Err("record 0: in no revolution nothing grows".into()));
    let budget = Budget { record: 1, longest: Search::MOST_REVOLUTIONS, patience: Budget::MOST, ..budget };
    assert_eq!(budget.judging(), Ok(budget));
    let longest = Budget { longest: Search::MOST_REVOLUTIONS + 1, ..budget };
    assert_eq!(longest.judging(), Err("longest 1001: must be from 1 to 1000".into()));
    assert_eq!(Budget { longest: 0, ..budget }.checked(), Err("longest 0: must be from 1 to 1000".into()));
    let patience = Budget { patience: Budget::MOST + 1, ..budget };
    assert_eq!(patience.checked(), Err("patience 1000000001: must be from 0 to 1000000000".into()));
}
