//! The corner impacts of a range of speeds as a document: JSON, and a page of text.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::cam::Side;
use crate::corner::candidates::MOST_IMPACTS;
use crate::corner::locate::Rejected;
use crate::model::Model;
use crate::show::block::{Column, Mark, Table, Words};
use crate::show::digits::Digits;
use crate::show::page::{Page, WIDTH};
use crate::study::locate::{LocalMap, Located, Surveyed};
use crate::study::verify::border_collision::ClassificationEntry;
use crate::study::verify::document::{AgreementEntry, SideEntry, SkippedEntry};

/// What `locate` found; serializes to the document `corner-impact/locate/1`.
#[derive(Clone, Debug, Serialize)]
pub struct LocateDocument {
    /// `corner-impact/locate/1`.
    pub schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Where its numbers come from.
    pub source: String,
    /// The range of speeds, rpm.
    pub rpm: [f64; 2],
    /// Turns of the cam in one period of the orbits looked for.
    pub revolutions: u64,
    /// By rising speed.
    pub corner_impacts: Vec<CornerImpactEntry>,
    /// Speeds at which the equations hold and the cam has no such orbit.
    pub rejected: Vec<RejectedEntry>,
    /// What was looked at.
    pub searched: SearchedEntry,
    /// Whether the routes agree at every corner impact.
    pub agrees: bool,
}

/// A corner impact.
#[derive(Clone, Debug, Serialize)]
pub struct CornerImpactEntry {
    /// omega*.
    pub speed_rpm: f64,
    /// T*: one revolution of the cam.
    pub period_s: f64,
    /// Of the orbit.
    pub orbit_period_s: f64,
    /// Turns of the cam in the orbit's period.
    pub revolutions: u64,
    /// Impacts in the orbit's period.
    pub impacts: usize,
    /// Of the corner.
    pub cam_angle_rad: f64,
    /// The lowest derivative of the lift that jumps there.
    pub jump_order: usize,
    /// `minus` or `plus`: at a corner of velocity, the side whose orbit this is.
    pub side: Option<&'static str>,
    /// Position and velocity on the section, in the cam's coordinates.
    pub state: [f64; 2],
    /// The section.
    pub section_angle_rad: f64,
    /// v- at the corner.
    pub velocity_before_m_s: f64,
    /// v+ at the corner.
    pub velocity_after_m_s: f64,
    /// Cam angle of every impact, in order.
    pub impact_angles_rad: Vec<f64>,
    /// A and B of each side that there is, by the product of propagators and saltation matrices.
    pub map: MapSides,
    /// What happens there.
    pub classification: LocalMapEntry,
    /// Every comparison of two routes.
    pub agreement: Vec<AgreementEntry>,
    /// What did not run, and why.
    pub skipped: Vec<SkippedEntry>,
    /// Whether every comparison agrees and every route ran.
    pub agrees: bool,
}

/// The matrices of the sides that there are.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MapSides {
    /// Impacts before the corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minus: Option<SideEntry>,
    /// Impacts after the corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plus: Option<SideEntry>,
}

/// What happens at a corner impact.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum LocalMapEntry {
    /// Feigin's verdict, as in `verify`.
    BorderCollision(Box<ClassificationEntry>),
    /// None: `gap`, `smooth` or `degenerate`.
    Other {
        /// The name.
        scenario: &'static str,
        /// In words.
        meaning: String,
    },
}

impl LocalMapEntry {
    fn new(located: &Located) -> Self {
        match &located.local {
            LocalMap::BorderCollision(Ok(verdict)) => {
                Self::BorderCollision(Box::new(ClassificationEntry::new(verdict, located.border)))
            }
            LocalMap::BorderCollision(Err(degenerate)) => Self::Other {
                scenario: "degenerate",
                meaning: format!("Feigin's classification says nothing: {degenerate}"),
            },
            LocalMap::Gap => Self::Other {
                scenario: "gap",
                meaning:
                    "the cam's velocity jumps, and what an impact leaves the follower with jumps with it: this side's \
                          orbit ends here, and across the corner the map has a gap, not a second matrix"
                        .into(),
            },
            LocalMap::Smooth => Self::Other {
                scenario: "smooth",
                meaning:
                    "only a derivative above the acceleration jumps: both sides have the same matrices, the map's \
                          derivative is continuous, and there is no border collision to first order"
                        .into(),
            },
        }
    }

    fn scenario(&self) -> String {
        match self {
            Self::BorderCollision(entry) => entry.scenario.to_string(),
            Self::Other { scenario, .. } => (*scenario).into(),
        }
    }
}

/// A speed at which the equations hold and the cam has no such orbit.
#[derive(Clone, Debug, Serialize)]
pub struct RejectedEntry {
    /// The speed.
    pub speed_rpm: f64,
    /// Of the corner.
    pub cam_angle_rad: f64,
    /// What is wrong with it.
    pub why: String,
}

/// What was looked at.
#[derive(Clone, Debug, Serialize)]
pub struct SearchedEntry {
    /// The cam's corners.
    pub corners_rad: Vec<f64>,
    /// Speeds at which orbits of several impacts were searched for.
    pub speeds_rpm: Vec<f64>,
    /// Branches of orbits found there and followed.
    pub branches: usize,
    /// Whether every corner impact of one-impact orbits is listed: they are the roots of one equation.
    pub one_impact_exhaustive: bool,
    /// Whether the same can be said of orbits with several impacts.
    pub several_impacts_exhaustive: bool,
    /// The first search that could not go on.
    pub failed: Option<String>,
}

impl CornerImpactEntry {
    fn new(located: &Located) -> Self {
        let Located { at, map, comparisons, skipped, agrees, .. } = located;
        let side = |side: Side, map| {
            let shown = at.corner.jump_order > 1 || at.side == side;
            shown.then(|| SideEntry::new(map))
        };
        let name = match at.side {
            Side::Minus => "minus",
            Side::Plus => "plus",
        };
        Self {
            speed_rpm: at.speed_rpm(),
            period_s: at.period,
            orbit_period_s: at.period * at.cycle.revolutions as f64,
            revolutions: at.cycle.revolutions,
            impacts: at.cycle.contacts.len(),
            cam_angle_rad: at.corner.angle,
            jump_order: at.corner.jump_order,
            side: (at.corner.jump_order == 1).then_some(name),
            state: [at.state.position, at.state.velocity],
            section_angle_rad: at.section_angle(),
            velocity_before_m_s: at.velocity_before,
            velocity_after_m_s: at.velocity_after,
            impact_angles_rad: at.cycle.contacts.iter().map(|contact| contact.cam_angle).collect(),
            map: MapSides { minus: side(Side::Minus, &map.minus), plus: side(Side::Plus, &map.plus) },
            classification: LocalMapEntry::new(located),
            agreement: comparisons.iter().map(AgreementEntry::new).collect(),
            skipped: skipped.iter().map(SkippedEntry::new).collect(),
            agrees: *agrees,
        }
    }
}

impl LocateDocument {
    /// Longest list of refusals that is printed line by line.
    const LONGEST: usize = 12;

    /// Lays out what was found about `model`.
    pub fn new(model: &Model, found: &Surveyed) -> Self {
        let looked_at = &found.looked_at;
        let rejected = |Rejected { cam_angle, speed_rpm, why }: &Rejected| RejectedEntry {
            speed_rpm: *speed_rpm,
            cam_angle_rad: *cam_angle,
            why: why.clone(),
        };
        Self {
            schema: "corner-impact/locate/1",
            model: model.name.clone(),
            source: model.source.clone(),
            rpm: [found.range.rpm_min, found.range.rpm_max],
            revolutions: found.revolutions,
            corner_impacts: found.found.iter().map(CornerImpactEntry::new).collect(),
            rejected: looked_at.rejected.iter().map(rejected).collect(),
            searched: SearchedEntry {
                corners_rad: looked_at.corners.iter().map(|corner| corner.angle).collect(),
                speeds_rpm: looked_at.searched.speeds.clone(),
                branches: looked_at.searched.branches,
                one_impact_exhaustive: true,
                several_impacts_exhaustive: false,
                failed: looked_at.searched.failed.clone(),
            },
            agrees: found.agrees,
        }
    }

    /// The page, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// The page for a terminal of `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        let out = &mut page;
        out.title(&format!("Corner impacts of {}", self.model))?;
        let [low, high] = self.rpm;
        let plural = if self.revolutions == 1 { "" } else { "s" };
        out.paragraph_at(
            2,
            &format!("{low} to {high} rpm, orbits that repeat after {} revolution{plural}.", self.revolutions),
        )?;
        self.write_table(out)?;
        for (index, impact) in self.corner_impacts.iter().enumerate().filter(|(_, impact)| !impact.agrees) {
            writeln!(out)?;
            out.paragraph_at(2, &format!("{}: {}. {}", index + 1, impact.verdict(), disagreement(impact)))?;
        }
        self.write_meanings(out)?;
        self.write_rejected(out)?;
        self.write_searched(out)?;
        Ok(page)
    }

    fn write_table(&self, out: &mut Page) -> fmt::Result {
        out.heading(&format!("Found ({})", self.corner_impacts.len()))?;
        if self.corner_impacts.is_empty() {
            return writeln!(out, "  No orbit of this kind was found with an impact on a corner in this range.");
        }
        let columns = [
            Column::right("", 4),
            Column::right("rpm", 15),
            Column::right("corner deg", 13),
            Column::right("order", 7),
            Column::right("impacts", 9),
            Column::right("v before", 12),
            Column::right("v after", 12),
            Column::left("what happens", 2, 17),
            Column::left("routes", 0, 0),
        ];
        let mut table = Table::new("Corner impacts", columns);
        for (index, impact) in self.corner_impacts.iter().enumerate() {
            let CornerImpactEntry { speed_rpm, jump_order, impacts, classification, .. } = impact;
            let [before, after] = [impact.velocity_before_m_s, impact.velocity_after_m_s]
                .map(|velocity| Digits::Significant(8).text(velocity));
            let side = impact.side.map_or(String::new(), |side| format!(", {side}"));
            let scenario = format!("{}{side}", classification.scenario());
            let routes = Words::from((if impact.agrees { Mark::Good } else { Mark::Bad }, impact.verdict()));
            let [speed, angle] =
                [format!("{speed_rpm:.9}"), format!("{:.6}", impact.cam_angle_rad.to_degrees())].map(Words::from);
            let [before, after, scenario] = [before, after, scenario].map(Words::from);
            let [index, order, impacts] = [index + 1, *jump_order, *impacts].map(Words::from);
            table.row([index, speed, angle, order, impacts, before, after, scenario, routes]);
        }
        out.table(&table)
    }

    fn write_meanings(&self, out: &mut Page) -> fmt::Result {
        out.heading("What happens there")?;
        let mut said: Vec<&str> = Vec::new();
        for (index, impact) in self.corner_impacts.iter().enumerate() {
            match &impact.classification {
                LocalMapEntry::BorderCollision(entry) => {
                    let words = format!(
                        "{}: {}. Fixed points: impacts before the corner at speeds {}, {}; after it {}, {}.",
                        index + 1,
                        entry.scenario,
                        entry.fixed_points_exist_for.minus,
                        if entry.stable.minus { "stable" } else { "unstable" },
                        entry.fixed_points_exist_for.plus,
                        if entry.stable.plus { "stable" } else { "unstable" },
                    );
                    out.paragraph_at(2, &words)?;
                }
                LocalMapEntry::Other { scenario, meaning } if !said.contains(scenario) => {
                    said.push(scenario);
                    out.paragraph_at(2, &format!("{scenario}: {meaning}."))?;
                }
                LocalMapEntry::Other { .. } => {}
            }
        }
        if self.corner_impacts.is_empty() { writeln!(out, "  Nothing.") } else { Ok(()) }
    }

    fn write_rejected(&self, out: &mut Page) -> fmt::Result {
        if self.rejected.is_empty() {
            return Ok(());
        }
        out.heading(&format!("Speeds that solve the equations and are none ({})", self.rejected.len()))?;
        for RejectedEntry { speed_rpm, cam_angle_rad, why } in self.rejected.iter().take(Self::LONGEST) {
            let words = format!("{speed_rpm:.6} rpm at {:.4} deg: {why}", cam_angle_rad.to_degrees());
            out.paragraph_at(4, &words)?;
        }
        if self.rejected.len() > Self::LONGEST {
            writeln!(out, "    and {} more; --json lists them", self.rejected.len() - Self::LONGEST)?;
        }
        Ok(())
    }

    fn write_searched(&self, out: &mut Page) -> fmt::Result {
        out.heading("What was looked at")?;
        let SearchedEntry { corners_rad, speeds_rpm, branches, failed, .. } = &self.searched;
        let mut words = if corners_rad.is_empty() {
            "The cam has no corner: no derivative of its lift jumps as far as can be told.".to_owned()
        } else {
            format!(
                "{} corner(s) of the cam. Orbits of one impact: all, as the roots of one equation. Orbits of several impacts: \
                 those on branches that a search finds at {} speeds ({branches} of them), of up to {MOST_IMPACTS} impacts a \
                 revolution; there may be others. Orbits on which the follower sticks forget where they hit: they are left out.",
                corners_rad.len(),
                speeds_rpm.len()
            )
        };
        if let Some(error) = failed {
            write!(words, " A search could not go on: {error}.")?;
        }
        out.paragraph_at(2, &words)
    }
}

impl CornerImpactEntry {
    /// What the routes say, in a word or two.
    fn verdict(&self) -> &'static str {
        match (self.agrees, self.agreement.iter().all(|entry| entry.agrees)) {
            (true, _) => "agree",
            (false, true) => "not all ran",
            (false, false) => "DISAGREE",
        }
    }
}

/// What does not agree at a corner impact.
fn disagreement(impact: &CornerImpactEntry) -> String {
    let missing = impact.skipped.iter().filter(|skipped| skipped.failed);
    let missing = missing.map(|skipped| format!("{}: {}", skipped.route, skipped.why));
    let differing = impact.agreement.iter().filter(|entry| !entry.agrees);
    let differing = differing.map(|entry| {
        let [one, other] = &entry.routes;
        format!(
            "{}: {one} and {other} differ by {:.1e}, allowed {:.1e}",
            entry.quantity, entry.max_abs_diff, entry.tolerance
        )
    });
    missing.chain(differing).collect::<Vec<_>>().join("; ")
}
