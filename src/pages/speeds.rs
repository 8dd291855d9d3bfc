//! What a machine does over a range of speeds, as a document: the short answer first.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::figures::run::Exponent;
use crate::show::block::{Column, Mark, Table, Words};
use crate::show::page::{Page, WIDTH};
use crate::show::words;
use crate::study::speeds::{Cause, Regime, Regimes, Settled, Walk};

/// The answer.
#[derive(Clone, Debug, Serialize)]
pub struct RegimesDocument {
    /// `corner-impact/speeds/1`.
    pub schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Lowest and highest speed that were looked at, rpm.
    pub rpm: [f64; 2],
    /// Where the follower first leaves the cam, rpm.
    pub detachment_rpm: Option<f64>,
    /// Speeds of every regime, rpm, rising or falling, overlaps joined.
    pub regimes: Vec<RegimeEntry>,
    /// Where what is seen depends on where the speed comes from.
    pub hysteresis: Vec<HysteresisEntry>,
    /// By rising speed.
    pub rising: Vec<StretchEntry>,
    /// By falling speed; listed by rising speed too.
    pub falling: Vec<StretchEntry>,
}

/// Where one regime is seen.
#[derive(Clone, Debug, Serialize)]
pub struct RegimeEntry {
    /// `on-cam`, `chattering`, `regular`, `chaotic`, `free` or `unsettled`.
    pub regime: Regime,
    /// Lowest and highest speed of each range, rpm.
    pub ranges: Vec<[f64; 2]>,
}

/// A range of speeds with one kind of motion.
#[derive(Clone, Debug, Serialize)]
pub struct StretchEntry {
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// What is seen.
    #[serde(flatten)]
    pub motion: MotionEntry,
    /// Why it begins at its lower end; nothing at the lowest speed.
    pub begins: Option<ChangeEntry>,
}

/// A change of the motion.
#[derive(Clone, Debug, Serialize)]
pub struct ChangeEntry {
    /// Where, rpm.
    pub rpm: f64,
    /// The speeds of the runs on either side.
    pub bracket_rpm: [f64; 2],
    /// Why, in words.
    pub cause: String,
    /// Whether that is a special point of a branch, located, and not a bracket of runs.
    pub located: bool,
}

/// A kind of motion.
#[derive(Clone, Debug, Serialize)]
pub struct MotionEntry {
    /// As in [`RegimeEntry`].
    pub regime: Regime,
    /// Turns of the cam in one period, if it repeats.
    pub revolutions: Option<u64>,
    /// Impacts in one period; of a chattering follower those that are flown one by one.
    pub impacts: Option<usize>,
    /// Growth of a small deviation per revolution, where it does not repeat.
    pub lyapunov_per_revolution: Option<Exponent>,
}

/// A range in which there are two answers.
#[derive(Clone, Debug, Serialize)]
pub struct HysteresisEntry {
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// What rising speed shows.
    pub rising: MotionEntry,
    /// What falling speed shows.
    pub falling: MotionEntry,
}

impl From<&Settled> for MotionEntry {
    fn from(settled: &Settled) -> Self {
        let period = settled.period();
        Self {
            regime: settled.regime,
            revolutions: period.map(|(revolutions, _)| revolutions),
            impacts: period.map(|(_, impacts)| impacts),
            lyapunov_per_revolution: settled.growth.map(Exponent),
        }
    }
}

impl RegimesDocument {
    /// What was found about a model.
    pub fn new(model: &str, found: &Regimes) -> Self {
        let order =
            [Regime::OnCam, Regime::Chattering, Regime::Regular, Regime::Chaotic, Regime::Free, Regime::Unsettled];
        let regimes = order.iter().filter_map(|regime| {
            let ranges = ranges(found, regime);
            (!ranges.is_empty()).then(|| RegimeEntry { regime: *regime, ranges })
        });
        let hysteresis = found.hysteresis.iter().map(|found| HysteresisEntry {
            rpm: found.rpm,
            rising: MotionEntry::from(&found.rising),
            falling: MotionEntry::from(&found.falling),
        });
        Self {
            schema: "corner-impact/speeds/1",
            model: model.into(),
            rpm: found.rpm,
            detachment_rpm: found.detachment,
            regimes: regimes.collect(),
            hysteresis: hysteresis.collect(),
            rising: stretches(&found.rising),
            falling: stretches(&found.falling),
        }
    }

    /// For people, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// Where rising and falling speed show something else, joined where they meet.
    pub fn hysteresis_ranges(&self) -> Vec<[f64; 2]> {
        joined(self.hysteresis.iter().map(|found| found.rpm).collect())
    }

    /// For people, in `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        let [low, high] = self.rpm;
        page.marked(Mark::Heading, &format!("{}, {low} to {high} rpm", self.model));
        writeln!(page, "\n")?;
        match self.detachment_rpm {
            Some(rpm) => writeln!(page, "  leaves the cam first at   {rpm:.6} rpm")?,
            None if self.rising.first().is_some_and(|stretch| stretch.motion.regime == Regime::OnCam) => {
                writeln!(page, "  leaves the cam first at   no speed in between")?;
            }
            None if self.rising.first().is_some_and(|stretch| stretch.motion.regime == Regime::Free) => {
                writeln!(page, "  leaves the cam first at   no speed: it is never on it")?;
            }
            None => writeln!(page, "  leaves the cam first at   {low} rpm already, or below")?,
        }
        for RegimeEntry { regime, ranges } in &self.regimes {
            let what = words::regime(*regime);
            writeln!(page, "  {what:<24}  {}", listed(ranges))?;
        }
        let hysteresis = self.hysteresis_ranges();
        if hysteresis.is_empty() {
            writeln!(page, "  hysteresis                none")?;
        } else {
            writeln!(page, "  hysteresis                {}", listed(&hysteresis))?;
        }
        for (title, entries) in [("rising speed", &self.rising), ("falling speed", &self.falling)] {
            writeln!(page)?;
            page.marked(Mark::Heading, title);
            writeln!(page)?;
            let columns = [
                Column { gap: 2, ..Column::right("from (rpm)", 10) },
                Column { gap: 1, ..Column::right("to (rpm)", 11) },
                Column::left("motion", 2, 36),
                Column::left("at the lower end", 1, 0),
            ];
            let mut table = Table::new(title, columns);
            for StretchEntry { rpm: [from, to], motion, begins } in entries {
                let why = begins.as_ref().map_or("", |change| change.cause.as_str());
                let row = [format!("{from:.4}"), format!("{to:.4}"), motion.words(), why.to_owned()];
                table.row(row.map(Words::from));
            }
            page.table(&table)?;
        }
        Ok(page)
    }
}

impl MotionEntry {
    /// In words.
    pub(crate) fn words(&self) -> String {
        let turns = |n: u64| if n == 1 { "a revolution".to_owned() } else { format!("{n} revolutions") };
        match (self.regime, self.revolutions, self.impacts) {
            (Regime::Regular, Some(n), Some(1)) => format!("1 impact in {}", turns(n)),
            (Regime::Regular, Some(n), Some(m)) => format!("{m} impacts in {}", turns(n)),
            (Regime::Chaotic, ..) => {
                let growth = self.lyapunov_per_revolution.map_or(f64::NAN, |Exponent(growth)| growth);
                format!("{}, growth {growth:.2}", words::regime(self.regime))
            }
            (Regime::Unsettled, ..) => format!("{}: no period found", words::regime(self.regime)),
            (regime, ..) => words::regime(regime).into(),
        }
    }
}

/// Ranges, the longest first where there are many.
fn listed(ranges: &[[f64; 2]]) -> String {
    /// Ranges that fit a line.
    const SHOWN: usize = 5;
    let mut longest: Vec<[f64; 2]> = ranges.to_vec();
    longest.sort_by(|one, two| (two[1] - two[0]).total_cmp(&(one[1] - one[0])));
    longest.truncate(SHOWN);
    longest.sort_by(|one, two| one[0].total_cmp(&two[0]));
    let words: Vec<String> = longest.iter().map(|[low, high]| format!("{low:.2}-{high:.2}")).collect();
    let more = ranges.len().saturating_sub(SHOWN);
    let rest = if more > 0 { format!(" rpm, and {more} shorter") } else { " rpm".into() };
    words.join(", ") + &rest
}

/// The ranges of one regime over both walks, joined where they overlap or meet.
fn ranges(found: &Regimes, regime: &Regime) -> Vec<[f64; 2]> {
    let walks = [&found.rising, &found.falling];
    let stretches = walks.into_iter().flat_map(|walk| &walk.stretches);
    joined(stretches.filter(|stretch| stretch.settled.regime == *regime).map(|stretch| stretch.rpm).collect())
}

/// Ranges, those that overlap or meet as one.
fn joined(mut all: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    all.sort_by(|one, two| one[0].total_cmp(&two[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [low, high] in all {
        match joined.last_mut() {
            Some(last) if low <= last[1] => last[1] = last[1].max(high),
            _ => joined.push([low, high]),
        }
    }
    joined
}

fn stretches(walk: &Walk) -> Vec<StretchEntry> {
    let changes = std::iter::once(None).chain(walk.changes.iter().map(Some));
    let entry =
        |(stretch, change): (&crate::study::speeds::Stretch, Option<&crate::study::speeds::Change>)| StretchEntry {
            rpm: stretch.rpm,
            motion: MotionEntry::from(&stretch.settled),
            begins: change.map(|change| ChangeEntry {
                rpm: change.rpm,
                bracket_rpm: change.bracket,
                cause: change.cause.words(),
                located: matches!(change.cause, Cause::Special(..)),
            }),
        };
    walk.stretches.iter().zip(changes).map(entry).collect()
}
