//! Page of `locate`: the corner impacts in a range of speeds, and the scenario at each.

use crate::show::Paged;
use crate::show::block::{Block, Column, Table, TextMark, Words, words};
use crate::show::digits::Digits;
use crate::show::sources::Sources;
use crate::show::words;
use corner_impact::border_collision::Classification;
use corner_impact::corner::Way;
use corner_impact::corner::candidates::{MOST_IMPACTS, NEAREST_OTHER};
use corner_impact::corner::range::{FoundCornerImpacts, Recaptured, UndecidedSpeeds};
use corner_impact::corner::shots::{SHOT_RATIO, VELOCITIES};
use corner_impact::orbit::branch::GRID_RATIO;
use corner_impact::study::locate::{Happens, Located, LocatedImpact};

impl Paged for Located {
    fn blocks(&self) -> Vec<Block> {
        let plural = if self.revolutions == 1 { "" } else { "s" };
        let (low, high) = (self.range.rpm_min, self.range.rpm_max);
        let mut page = vec![
            Block::Title(format!("Corner impacts of {}", self.model.name).into()),
            Block::paragraph(format!(
                "{low} to {high} rpm, orbits that repeat after {} revolution{plural}.",
                self.revolutions
            )),
            Block::Heading(format!("Found ({})", self.found.len()).into()),
            match self.found.is_empty() {
                true => Block::paragraph("No orbit of this kind was found with an impact on a corner in this range."),
                false => Block::Table(table(&self.found)),
            },
        ];
        for (index, impact) in self.found.iter().enumerate().filter(|(_, impact)| !impact.agrees) {
            let words = format!("{}: {}. {}", index + 1, verdict(impact), disagreement(impact));
            page.extend([Block::Gap, Block::paragraph(words)]);
        }
        if let Some(sources) = Sources::of(&self.measured, self.errors).if_any().filter(|_| !self.found.is_empty()) {
            for (index, impact) in self.found.iter().enumerate() {
                let speed = sources.speed(impact.at.speed_rpm(), Digits::Fixed(9), impact.speed_error);
                page.extend([Block::Gap, Block::paragraph(words![format!("{}: ", index + 1), speed])]);
            }
            page.extend([Block::Gap, Block::paragraph(sources.note())]);
        }
        page.push(Block::Heading("What happens there".into()));
        page.extend(meanings(&self.found));
        page.extend(rejected(self));
        page.extend([Block::Heading("What was searched".into()), Block::paragraph(searched(self))]);
        page.extend(words::hypotheses(&self.hypotheses).map(Block::paragraph));
        page
    }
}

fn table(found: &[LocatedImpact]) -> Table {
    let columns = [
        Column::right("", 4),
        Column::right("rpm", 15),
        Column::right("corner deg", 13),
        Column::right("order", 7),
        Column::right("impacts", 9),
        Column::right("v before", 12).missable(1),
        Column::right("v after", 12).missable(2),
        Column::left("what happens", 2, 16),
        Column::left("routes", 1, 0),
    ];
    let mut table = Table::new("Corner impacts", columns);
    for (index, impact) in found.iter().enumerate() {
        let at = &impact.at;
        let side = impact.side().map_or(String::new(), |side| format!(", {side}"));
        table.row([
            (index + 1).into(),
            (at.speed_rpm(), Digits::Fixed(9)).into(),
            (at.corner.angle.to_degrees(), Digits::Fixed(6)).into(),
            at.corner.jump_order.into(),
            at.cycle.impacts.len().into(),
            (at.velocity_before, Digits::Significant(8)).into(),
            (at.velocity_after, Digits::Significant(8)).into(),
            words::verdict_with(&format!("{}{side}", impact.local.scenario()), impact.danger.as_ref()).into(),
            Words::from((if impact.agrees { TextMark::Good } else { TextMark::Bad }, verdict(impact))),
        ]);
    }
    table
}

/// Sentence for each scenario of border collision, and for each other kind of event.
fn meanings(found: &[LocatedImpact]) -> Vec<Block> {
    let mut said: Vec<String> = Vec::new();
    let mut meanings = Vec::new();
    for (index, impact) in found.iter().enumerate() {
        let scenario = impact.local.scenario();
        match &impact.local {
            Happens::BorderCollision(Ok(kind @ Classification { minus, plus, .. })) => {
                let verdict = words::border_collision(kind, impact.danger.as_ref());
                meanings.push(Block::paragraph(format!(
                    "{}: {verdict}. The fixed point with its impact before the corner exists at {} speeds and is {}. The one with its impact \
                     after the corner exists at {} speeds and is {}.",
                    index + 1,
                    minus.exists_for,
                    words::stability(minus.stability),
                    plus.exists_for,
                    words::stability(plus.stability),
                )));
                let lines = impact.danger.iter().flat_map(|danger| {
                    std::iter::once(words::danger(danger)).chain(words::returns(danger)).map(|line| words![line, "."])
                });
                meanings.extend(lines.map(|line| Block::Paragraph(4, line)));
            }
            other if !said.contains(&scenario) => {
                meanings.push(Block::paragraph(format!("{scenario}: {}.", other.meaning())));
                said.push(scenario);
            }
            _ => {}
        }
    }
    if found.is_empty() { vec![Block::paragraph("Nothing.")] } else { meanings }
}

fn rejected(found: &Located) -> Vec<Block> {
    /// Largest number of rejected speeds that are printed line by line.
    const LONGEST: usize = 12;
    let all = &found.looked_at.rejected;
    if all.is_empty() {
        return Vec::new();
    }
    let title = format!("Not corner impacts, though the equations hold at these speeds ({})", all.len());
    let line = |words: Words| Block::Paragraph(4, words);
    let mut lines = vec![Block::Heading(title.into())];
    lines.extend(all.iter().take(LONGEST).map(|rejected| {
        let (speed, angle) = (rejected.speed_rpm, rejected.cam_angle.to_degrees());
        line(words![(speed, Digits::Fixed(6)), " rpm at ", (angle, Digits::Fixed(4)), " deg: ", &rejected.why])
    }));
    if all.len() > LONGEST {
        lines.push(line(format!("and {} more; --json lists them", all.len() - LONGEST).into()));
    }
    lines
}

fn searched(found: &Located) -> String {
    let FoundCornerImpacts { corners, left_out, searched, undecided, .. } = &found.looked_at;
    let corners = corners.len();
    let knots = match left_out {
        0 => String::new(),
        _ => format!(", {left_out} knots of its spline left out"),
    };
    let mut words = if corners == 0 && *left_out == 0 {
        "The cam has no corner: no jump of a derivative of its lift was found.".to_owned()
    } else if corners == 0 {
        format!(
            "No corner was searched: {left_out} knots of the cam's spline, or ends of dwells that its rows show, are not part of the measurement."
        )
    } else {
        format!(
            "{} of the cam{knots}. Orbits of one impact: {}. Orbits of several impacts were searched for in two independent ways. The first \
             follows branches of orbits, and the branches of twice the period that begin on them ({2} stretches of branches). They start from \
             the orbits that a search finds at {3} speeds, each {4:.0} % above the one before. The second fires {VELOCITIES} shots from each \
             corner, at speeds {5:.1} % apart. {6} Both look for orbits of up to {MOST_IMPACTS} impacts a revolution, with no other impact \
             within {7:.2} deg of the corner. A search of a part of the range finds the same there. Orbits on which the follower sticks are \
             left out: their motion does not depend on earlier impacts.",
            words::many(corners as u64, "corner"),
            if undecided.is_empty() {
                "the list is proved to be complete"
            } else {
                "the list is complete, except where it is not decided"
            },
            searched.branches,
            searched.speeds.len(),
            100.0 * (GRID_RATIO - 1.0),
            100.0 * (SHOT_RATIO - 1.0),
            found_by(found),
            NEAREST_OTHER.to_degrees(),
        )
    };
    for UndecidedSpeeds { cam_angle, speeds_rpm } in undecided {
        let (angle, speeds) =
            (Digits::Fixed(4).text(cam_angle.to_degrees()), words::range(*speeds_rpm, Digits::Fixed(6)));
        words += &format!(" Not decided at {angle} deg: {speeds} rpm.");
    }
    if let Some(error) = &searched.failed {
        words += &format!(" A search stopped: {error}.");
    }
    words
}

/// Numbers of corner impacts found by each search, by only one search, and estimated as missing.
fn found_by(found: &Located) -> String {
    let recaptured = found.looked_at.recaptured();
    let sum = |count: fn(&Recaptured) -> usize| recaptured.values().map(count).sum::<usize>();
    let (branches, shots, both) = (sum(|it| it.branches), sum(|it| it.shots), sum(|it| it.both));
    /// Smallest number of corner impacts found by both searches for an estimate of the missing ones.
    const TELLING: usize = 10;
    let missing = match recaptured.values().map(Recaptured::missing).sum::<f64>() {
        _ if both < TELLING => "too few for an estimate of how many both missed".to_owned(),
        some if some >= 0.1 => {
            format!("by the overlap, both missed an estimated {some:.1}, or more if some are hard to find")
        }
        _ => "by the overlap, both missed an estimated 0, except those that are hard to find in both ways".to_owned(),
    };
    let alone = |way: Way| {
        let numbers =
            (1..).zip(&found.found).filter(|(_, it)| it.at.ways == [way]).map(|(number, _)| number.to_string());
        Some(numbers.collect::<Vec<_>>().join(", ")).filter(|numbers| !numbers.is_empty())
    };
    let on_branches = alone(Way::Branch).map_or_else(String::new, |numbers| format!(" On branches alone: {numbers}."));
    let by_shots = alone(Way::Shot).map_or_else(String::new, |numbers| format!(" By shots alone: {numbers}."));
    if branches + shots == 0 {
        return "Neither found any.".into();
    }
    format!("The first found {branches}, the second {shots}, and both found {both}: {missing}.{on_branches}{by_shots}")
}

/// Agreement of the routes, in a word or two.
fn verdict(impact: &LocatedImpact) -> &'static str {
    match (impact.agrees, impact.comparisons.iter().all(|entry| entry.agrees)) {
        (true, _) => "agree",
        (false, true) => "not all ran",
        (false, false) => "DISAGREE",
    }
}

/// Disagreements at a corner impact, and routes that failed.
fn disagreement(impact: &LocatedImpact) -> String {
    let missing = impact.skipped.iter().filter(|skipped| skipped.failed);
    let missing = missing.map(|skipped| format!("{}: {}", skipped.route, skipped.why));
    let differing = impact.comparisons.iter().filter(|entry| !entry.agrees);
    let differing = differing.map(|entry| {
        let [one, other] = &entry.routes;
        let (off, allowed) = (entry.max_abs_diff, entry.bound.value);
        format!("{}: {one} and {other} differ by {off:.1e}, allowed {allowed:.1e}", entry.quantity)
    });
    missing.chain(differing).collect::<Vec<_>>().join("; ")
}
