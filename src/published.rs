//! Numbers that the paper prints, each with the finding about it.
//!
//! The digits are in `golden/published`, as printed; the findings are here. A printed number that was found wrong must stay wrong: if a
//! computed number ever agrees with it, the verification fails. The verification also fails if a correct number disagrees.

use serde::{Deserialize, Serialize};

use crate::agreement::{Agreement, Quantity, compare, quantities};
use crate::border_collision::NormalForm;
use crate::cam::Side::{Minus, Plus};
use crate::corner::map::RouteName;
use crate::corner::{CornerImpact, Route};
use crate::model::{Model, ModelError};
use crate::tolerance::Comparison;

/// Printed digits.
const PRINTED: &str = include_str!("../golden/published/osorio-2008.json");

/// Finding about a printed number or a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Correct.
    Holds,
    /// Definition, which needs no check.
    Definition,
    /// Partly or roughly correct; the note names the part that is not.
    InPart,
    /// Misprint in digits, a sign or brackets; results that use the correct form are unaffected.
    Misprint,
    /// Wrong statement.
    Refuted,
    /// Statement that this program does not decide.
    Open,
}

named!(Verdict);

impl Verdict {
    /// All verdicts, the most serious first.
    pub(crate) const WORST_FIRST: [Self; 6] =
        [Self::Refuted, Self::Misprint, Self::InPart, Self::Open, Self::Definition, Self::Holds];

    /// Whether there is a correction.
    pub(crate) fn has_correction(self) -> bool {
        matches!(self, Self::Refuted | Self::Misprint | Self::InPart)
    }

    /// Whether the statement is wrong, by its own error or by an earlier one.
    pub fn is_wrong(self) -> bool {
        matches!(self, Self::Refuted | Self::Misprint)
    }
}

/// Printed number with the computed one.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedNumber {
    /// Place in the paper.
    pub place: String,
    /// Digits as printed.
    pub printed: Vec<String>,
    /// Entries as computed.
    pub computed: Vec<f64>,
    /// Comparison.
    pub agreement: Agreement,
    /// Earlier finding.
    pub verdict: Verdict,
    /// Description of the error; empty if there is none.
    pub note: &'static str,
    /// Whether the comparison agrees with the finding.
    pub as_found: bool,
}

document!(PrintedNumber as number {
    quantity: number.agreement.quantity,
    where: number.place,
    printed: number.printed,
    computed: number.computed,
    max_abs_diff: number.agreement.max_abs_diff,
    tolerance: number.agreement.bound.value,
    reason: number.agreement.bound.reason,
    agrees: number.agreement.agrees,
    verdict: number.verdict,
    note: number.note,
    as_found: number.as_found,
});

/// The paper states that its estimates share five decimals with the matrices.
const ESTIMATE: &str = "it holds as an estimate, to 4.3e-7 of each entry or better. The paper also says that it shares five decimals; \
                        this is a separate statement, and is refuted";

/// Printed numbers with a remark: the quantity, the finding, and the error, or the sense in which it is correct if that is not obvious. All
/// other numbers are correct.
static REMARKS: [(Quantity, Verdict, &str); 6] = [
    (Quantity::BHat(Minus), Verdict::Holds, ESTIMATE),
    (Quantity::BHat(Plus), Verdict::Holds, ESTIMATE),
    (
        Quantity::BTilde,
        Verdict::Refuted,
        "the shift of coordinates was applied to the point but not to its image. B - A e1 D/c1 is printed, and B - (A - I) e1 D/c1 is correct",
    ),
    (
        Quantity::BBar,
        Verdict::Refuted,
        "it is the wrong B tilde, transformed by the W built on -C, so its sign is wrong too. The correct second entry is 0 because the paper's follower is undamped",
    ),
    (Quantity::Eigenvalues(Minus), Verdict::Misprint, "1.005147 rounds to 1.0051, printed 1.0052"),
    (Quantity::Eigenvalues(Plus), Verdict::Misprint, "0.41207 rounds to 0.4121, printed 0.4120"),
];

#[derive(Deserialize)]
struct Paper {
    numbers: Vec<Number>,
}

#[derive(Deserialize)]
struct Number {
    quantity: String,
    #[serde(rename = "where")]
    place: String,
    printed: Vec<String>,
}

/// Reason why the printed numbers were not compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PublishedError {
    /// Model that is not the paper's.
    #[error("the paper prints numbers for another follower or cam")]
    OtherModel,
    /// Built-in model that cannot be read.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// Built-in digits that cannot be read.
    #[error("golden/published: {0}")]
    Digits(String),
    /// Printed quantity that is not computed, or quantity with a remark that is not printed.
    #[error("golden/published: not printed, or not computed: {0}")]
    Unmatched(String),
}

/// Compares every printed number with the computed one; only for a model with the paper's follower and cam.
pub fn compare_published(
    model: &Model,
    at: &CornerImpact,
    route: &Route,
    normal_form: Option<&NormalForm>,
) -> Result<Vec<PrintedNumber>, PublishedError> {
    if !model.is_the_papers()? {
        return Err(PublishedError::OtherModel);
    }
    let numbers: Paper = serde_json::from_str(PRINTED).map_err(|error| PublishedError::Digits(error.to_string()))?;
    let is_printed = |quantity: &Quantity| numbers.numbers.iter().any(|number| number.quantity == quantity.to_string());
    if let Some((quantity, ..)) = REMARKS.iter().find(|(quantity, ..)| !is_printed(quantity)) {
        return Err(PublishedError::Unmatched(quantity.to_string()));
    }
    let computed = computed(at, route, normal_form);
    numbers.numbers.into_iter().map(|number| hold_against(number, &computed)).collect()
}

fn hold_against(number: Number, computed: &[(Quantity, Vec<f64>)]) -> Result<PrintedNumber, PublishedError> {
    let Number { quantity, place, printed } = number;
    let unmatched = || PublishedError::Unmatched(quantity.clone());
    let (quantity, value) = computed.iter().find(|(name, _)| name.to_string() == quantity).ok_or_else(unmatched)?;
    let found = REMARKS.iter().find(|(of, ..)| of == quantity);
    let (verdict, note) = found.map_or((Verdict::Holds, ""), |(_, verdict, note)| (*verdict, *note));
    let digits = printed.iter().map(|text| read_digits(text)).collect::<Result<Vec<_>, _>>()?;
    let comparison = match quantity {
        Quantity::AHat(_) | Quantity::BHat(_) => Comparison::PrintedEstimate,
        _ => {
            // Entries without a decimal point stand beside entries with one, or are meant as exact.
            let decimals = digits.iter().map(|(_, decimals)| *decimals).max().filter(|most| *most > 0);
            Comparison::Printed { decimals: decimals.unwrap_or(u32::MAX) }
        }
    };
    let entries: Vec<f64> = digits.iter().map(|(entry, _)| *entry).collect();
    let agreement = compare([RouteName::ClosedForm, RouteName::Published], *quantity, [value, &entries], comparison);
    Ok(PrintedNumber {
        as_found: agreement.agrees == (verdict == Verdict::Holds),
        place,
        printed,
        computed: value.clone(),
        agreement,
        verdict,
        note,
    })
}

/// Reads a printed number and its number of decimals; one entry is printed with a decimal comma.
fn read_digits(text: &str) -> Result<(f64, u32), PublishedError> {
    let text = text.replace(',', ".");
    let value = text.parse().map_err(|_| PublishedError::Digits(format!("not a number: {text}")))?;
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len() as u32);
    Ok((value, decimals))
}

/// All quantities that the paper prints, as computed here.
fn computed(at: &CornerImpact, route: &Route, normal_form: Option<&NormalForm>) -> Vec<(Quantity, Vec<f64>)> {
    let mut all: Vec<_> = quantities(route).into_iter().map(|found| (found.quantity, found.entries)).collect();
    // An estimate is printed for a quantity of the map, under a hat.
    let estimates = all.clone().into_iter().filter_map(|(name, entries)| match name {
        Quantity::A(side) => Some((Quantity::AHat(side), entries)),
        Quantity::B(side) => Some((Quantity::BHat(side), entries)),
        _ => None,
    });
    all.extend(estimates);
    for (name, entries) in &mut all {
        match *name {
            // The paper prints the real pair, and one of the complex pair as real and imaginary part.
            Quantity::Eigenvalues(Minus) => *entries = vec![entries[0], entries[2]],
            Quantity::Eigenvalues(Plus) => *entries = vec![entries[0], entries[1]],
            _ => {}
        }
    }
    all.push((Quantity::Period, vec![at.period]));
    all.push((Quantity::Speed, vec![at.speed_rpm()]));
    all.push((Quantity::State, at.x_star().as_slice().to_vec()));
    if let Some(form) = normal_form {
        all.push((Quantity::BTilde, form.b_tilde.as_slice().to_vec()));
        all.push((Quantity::ABar(Minus), form.a_bar_minus.transpose().as_slice().to_vec()));
        all.push((Quantity::ABar(Plus), form.a_bar_plus.transpose().as_slice().to_vec()));
        all.push((Quantity::BBar, form.b_bar.as_slice().to_vec()));
        all.push((Quantity::CBar, form.c_bar.as_slice().to_vec()));
    }
    all
}
