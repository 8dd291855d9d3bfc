//! Everything that is found about one model in one value: what the HTML page is made of.

use serde::Serialize;

use crate::agreement::{
    Agreement, Pairs, Quantity as AgreementQuantity, by_quantity, fewest_shared_decimals, shared_decimals,
};
use crate::cam::{Cam, Jet};
use crate::corner::CornerMap;
use crate::figures::{Plate, Subject, corner_marks, plates, through_corner};
use crate::model::{Model, ModelError};
use crate::pages::report::quantities::{Quantity, quantities};
use crate::pages::report::through::ThroughEntry;
use crate::paper::{Claims, Context, LedgerError};
use crate::progress::Watch;
use crate::show::command::command;
use crate::show::words;
use crate::study::cam::CamSheet;
use crate::study::speeds::{Care, Regimes, regimes, usual_speeds};
use crate::study::verify::{External, Verification, verify_watched};

/// A report on one model; serializes to the document `corner-impact/report/1`.
#[derive(Clone, Debug, Serialize)]
pub struct Dossier {
    /// `corner-impact/report/1`.
    pub schema: &'static str,
    /// Of this program.
    pub version: &'static str,
    /// Whether nothing that was checked disagrees.
    pub agrees: bool,
    /// Whether follower and cam are the paper's.
    pub is_paper: bool,
    /// The findings in brief.
    pub headline: Headline,
    /// What the model is.
    pub model: ModelSheet,
    /// The corner impact and its map by every route.
    pub verification: Option<Verification>,
    /// Why there is none.
    pub nothing_to_verify: Option<String>,
    /// The angle of the corner that is hit.
    pub corner_deg: Option<f64>,
    /// The matrices by every route side by side.
    pub tables: Vec<MapTable>,
    /// The comparisons, one quantity each.
    pub quantities: Vec<QuantitySummary>,
    /// The motion at speeds on either side of the corner impact.
    pub through: Option<ThroughEntry>,
    /// Why there is none.
    pub no_through: Option<String>,
    /// The paper's statements, where the model is the paper's.
    pub claims: Option<Claims>,
    /// What the follower does at other speeds.
    pub speeds: Option<Regimes>,
    /// Why that is not known.
    pub no_speeds: Option<String>,
    /// The figures, in the paper's order.
    pub plates: Vec<Plate>,
    /// Commands that do all this again, each with what it does.
    pub commands: Vec<(String, &'static str)>,
}

/// The findings in brief.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Headline {
    /// Comparisons of two routes.
    pub comparisons: usize,
    /// Those that agree.
    pub agreeing: usize,
    /// Decimals that every entry of A and B shares between any two routes; none where they are the same in all digits.
    pub shared_decimals: Option<u32>,
    /// Routes that ran.
    pub routes: Vec<String>,
    /// What should have run and did not.
    pub failed: Vec<String>,
    /// The paper's printed numbers that were looked at.
    pub printed: usize,
    /// Those that hold.
    pub printed_right: usize,
    /// Those that are wrong as the ledger says.
    pub printed_wrong: usize,
    /// Those that came out otherwise than the ledger says.
    pub printed_otherwise: usize,
    /// Statements that came out otherwise than the ledger says.
    pub claims_otherwise: usize,
}

/// What the model is.
#[derive(Clone, Debug, Serialize)]
pub struct ModelSheet {
    /// Its name.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
    /// Its file, as given.
    pub file: String,
    /// Every number of it.
    pub quantities: Vec<Quantity>,
    /// Segments and corners.
    pub cam: CamSheet,
}

/// One side's matrices by every route.
#[derive(Clone, Debug, Serialize)]
pub struct MapTable {
    /// `minus` or `plus`.
    pub side: &'static str,
    /// In the order of the values.
    pub routes: Vec<String>,
    /// A by rows, then B.
    pub rows: Vec<MapRow>,
}

/// One entry of A or B.
#[derive(Clone, Debug, Serialize)]
pub struct MapRow {
    /// `A11` to `B2`.
    pub entry: &'static str,
    /// By each route.
    pub values: Vec<f64>,
    /// The largest less the smallest of them.
    pub spread: f64,
    /// As the paper prints it.
    pub printed: Option<String>,
}

/// Every comparison in one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct QuantitySummary {
    /// Which.
    pub quantity: AgreementQuantity,
    /// Pairs of routes.
    pub pairs: usize,
    /// Pairs that agree.
    pub agreeing: usize,
    /// The pair that is nearest to its bound, or beyond.
    pub closest: Agreement,
    /// Decimals that it shares; none for all digits.
    pub shared_decimals: Option<u32>,
}

/// Why there is no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DossierError {
    /// The model is impossible.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The ledger cannot be held against it.
    #[error(transparent)]
    Ledger(#[from] LedgerError),
}

/// Speeds that are run for the section on other speeds.
const SPEEDS: usize = 100;
/// Parts of the work that are done when each stage is, of one.
const VERIFIED: f64 = 0.1;
const HELD: f64 = 0.25;
const SURVEYED: f64 = 0.55;
const THROUGH: f64 = 0.6;

impl Dossier {
    /// Everything about a model.
    ///
    /// A model without a corner impact to verify has a report that says so.
    pub fn of(model: &Model, external: External, watch: &dyn Watch) -> Result<Self, DossierError> {
        let part = |from, to| Part { watch, from, to };
        let cam = Cam::new(model)?;
        let is_paper = model.is_the_papers()?;
        let findings = verify_watched(model, external, &part(0.0, VERIFIED));
        let claims = match &findings {
            Ok(found) if is_paper => Some(Claims::hold(&Context::new(model, &cam, found)?, &part(VERIFIED, HELD))?),
            _ => None,
        };
        let speeds = speeds(model, &part(HELD, SURVEYED));
        part(SURVEYED, THROUGH).at("the orbits on both sides of the corner impact", 0, 1);
        let marks = corner_marks(&cam);
        let through = match &findings {
            Ok(found) => match through_corner(model, &cam, &found.at) {
                Ok(Some(through)) => {
                    ThroughEntry::new(&through, found.at.corner.angle, &marks).map_err(|error| error.to_string())
                }
                Ok(None) => Err("the corner impact is not one of an orbit with one impact a revolution".to_owned()),
                Err(error) => Err(format!("a run cannot go on: {error}")),
            },
            Err(error) => Err(error.to_string()),
        };
        let verification = findings.as_ref().ok().cloned();
        let corner_deg = findings.as_ref().ok().map(|found| found.at.corner.angle.to_degrees());
        let (findings, nothing_to_verify) = match findings {
            Ok(found) => (Ok(found), None),
            Err(error) => (Err(error.to_string()), Some(error.to_string())),
        };
        let subject = Subject::with(model, findings)?;
        let drawing = part(THROUGH, 1.0);
        let plates = plates(&subject, &mut |done, total| drawing.at("the figures", done as u64, total as u64));
        let agrees = verification.as_ref().is_none_or(|found| found.agrees) && claims.as_ref().is_none_or(|c| c.agrees);
        Ok(Self {
            schema: "corner-impact/report/1",
            version: env!("CARGO_PKG_VERSION"),
            agrees,
            is_paper,
            headline: Headline::new(verification.as_ref(), claims.as_ref()),
            model: ModelSheet {
                name: model.name.clone(),
                source: model.source.clone(),
                file: model.file().to_owned(),
                quantities: quantities(model),
                cam: CamSheet::new(model, &cam, Jet::HIGHEST_JUMP),
            },
            corner_deg,
            tables: verification
                .iter()
                .flat_map(|found| ["minus", "plus"].map(|side| MapTable::new(found, side)))
                .collect(),
            quantities: verification.as_ref().map(QuantitySummary::all).unwrap_or_default(),
            nothing_to_verify,
            no_through: through.as_ref().err().cloned(),
            through: through.ok(),
            claims,
            no_speeds: speeds.as_ref().err().cloned(),
            speeds: speeds.ok(),
            plates,
            commands: commands(model, verification.is_some()),
            verification,
        })
    }
}

/// A part of the work, told as its share of the whole.
struct Part<'a> {
    watch: &'a dyn Watch,
    from: f64,
    to: f64,
}

impl Watch for Part<'_> {
    fn at(&self, what: &str, done: u64, total: u64) {
        const STEPS: f64 = 1000.0;
        let share = if total > 0 { done as f64 / total as f64 } else { 0.0 };
        self.watch.at(what, (STEPS * (self.from + (self.to - self.from) * share)) as u64, STEPS as u64);
    }
}

/// What the follower does at its usual speeds, or why that is not known.
fn speeds(model: &Model, watch: &dyn Watch) -> Result<Regimes, String> {
    let care = Care { speeds: SPEEDS, ..Care::default() };
    regimes(model, usual_speeds(model), care, watch).map_err(|error| error.to_string())
}

fn commands(model: &Model, verified: bool) -> Vec<(String, &'static str)> {
    let again = |name: &str, what| (command(name, model, ""), what);
    let mut commands = vec![again("report", "writes this page")];
    if verified {
        commands.push(again("verify", "finds the corner impact, its map by every route, and compares"));
        commands.push(again("claims", "holds the statements of the paper that this program checks against it"));
    }
    commands.push(again("cam", "lists segments and corners of the cam"));
    commands.push(again("speeds", "what the follower does at each speed, with more speeds than here"));
    commands
}

impl Headline {
    fn new(verification: Option<&Verification>, claims: Option<&Claims>) -> Self {
        let Some(found) = verification else { return Self::default() };
        let right = found.published.iter().filter(|number| number.as_found && number.agreement.agrees).count();
        let otherwise = found.published.iter().filter(|number| !number.as_found).count();
        Self {
            comparisons: found.comparisons.len(),
            agreeing: found.comparisons.iter().filter(|entry| entry.agrees).count(),
            shared_decimals: fewest_shared_decimals(&found.comparisons),
            routes: found.routes_by_name().map(|route| words::route(route.name)).collect(),
            failed: found
                .skipped
                .iter()
                .filter(|skipped| skipped.failed)
                .map(|skipped| words::spoken(&skipped.route))
                .collect(),
            printed: found.published.len(),
            printed_right: right,
            printed_wrong: found.published.len() - right - otherwise,
            printed_otherwise: otherwise,
            claims_otherwise: claims.map_or(0, |ledger| ledger.claims.iter().filter(|claim| !claim.as_found).count()),
        }
    }
}

impl MapTable {
    fn new(found: &Verification, side: &'static str) -> Self {
        let of = |map: &CornerMap| if side == "minus" { map.minus } else { map.plus };
        let sides: Vec<[f64; 6]> = found.routes_by_name().map(|route| of(&route.map).entries()).collect();
        let printed = |quantity: &str, index: usize| {
            let number = found
                .published
                .iter()
                .find(|number| number.agreement.quantity.to_string() == format!("{quantity}_{side}"))?;
            number.printed.get(index).cloned()
        };
        let row = |(index, entry): (usize, &'static str)| {
            let values: Vec<f64> = sides.iter().map(|side| side[index]).collect();
            let (least, most) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(*value), most.max(*value)));
            let printed = if index < 4 { printed("A", index) } else { printed("B", index - 4) };
            MapRow { entry, values, spread: most - least, printed }
        };
        let rows = ["A11", "A12", "A21", "A22", "B1", "B2"].into_iter().enumerate().map(row).collect();
        Self { side, routes: found.routes_by_name().map(|route| words::route(route.name)).collect(), rows }
    }
}

impl QuantitySummary {
    fn all(found: &Verification) -> Vec<Self> {
        let of = |pairs: Pairs<'_>| Self {
            quantity: pairs.quantity,
            pairs: pairs.all.len(),
            agreeing: pairs.all.iter().filter(|entry| entry.agrees).count(),
            shared_decimals: shared_decimals(pairs.closest.max_abs_diff),
            closest: pairs.closest.clone(),
        };
        by_quantity(&found.comparisons).into_iter().map(of).collect()
    }
}
