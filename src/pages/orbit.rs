//! The page of `orbit`: each periodic orbit, its multipliers, and where it meets the cam.

use crate::known::{Complete, Known};
use crate::orbit::{Course, PeriodicOrbit, Undecided};
use crate::show::block::{Block, Mark, Span, Words, words};
use crate::show::digits::Digits;
use crate::show::{Paged, words};
use crate::study::orbit::Orbits;

impl Paged for Orbits {
    fn blocks(&self) -> Vec<Block> {
        let count = match self.orbits.len() {
            0 => "no periodic orbit".into(),
            1 => "1 periodic orbit".into(),
            count => format!("{count} periodic orbits"),
        };
        let title = format!("{} at {} rpm: {count} found", self.model, self.speed_rpm);
        let mut page = vec![Block::Line((Mark::Heading, title.as_str()).into())];
        self.orbits.iter().enumerate().for_each(|(index, orbit)| page.extend(one(index + 1, orbit)));
        page.extend(self.complete.iter().map(complete));
        page.extend(self.undecided.iter().map(undecided));
        page
    }
}

/// Whether there may be others.
fn complete(of: &Complete) -> Block {
    let (impacts, turns) = (words::many(of.impacts as u64, "impact"), words::many(of.revolutions, "revolution"));
    let others = match of.known {
        Known::Proved => "there are no others, which is proved",
        _ => "there may be others where it is not decided",
    };
    Block::paragraph(format!("Orbits of {impacts} in {turns}: {others}."))
}

fn undecided(at: &Undecided) -> Block {
    let angles = at.cam_angles.iter().map(|ends| words::range(ends.map(f64::to_degrees), Digits::Fixed(6)));
    Block::paragraph(format!("Not decided: impacts at {} deg.", angles.collect::<Vec<_>>().join(" and ")))
}

fn one(number: usize, orbit: &PeriodicOrbit) -> Vec<Block> {
    /// Impacts that are shown of an orbit.
    const SHOWN: usize = 8;
    let impacts = orbit.impacts().count();
    let turns = words::many(orbit.revolutions, "revolution");
    let what = match orbit.course {
        Course::Sticking(_) => "sticks to the cam".to_owned(),
        Course::Free => "stays clear of the cam".to_owned(),
        Course::Impacts(_) => words::many(impacts as u64, "impact"),
    };
    let mark = if orbit.is_stable() { Mark::Good } else { Mark::Doubtful };
    let stable = (mark, words::stability(orbit.is_stable()));
    let [one, two] = orbit.multipliers().map(|multiplier| Span::Complex([multiplier.re, multiplier.im], TEN));
    let (q, v) = (Digits::Fixed(12).text(orbit.state.position), Digits::Fixed(9).text(orbit.state.velocity));
    let mut lines = vec![
        Block::Gap,
        Block::Line(words![format!("  {number}. {turns}, {what}, "), stable]),
        Block::Line(words!["     multipliers   ", one, "   ", two]),
        Block::Line(words![
            format!("     at cam angle 0   q = {q} "),
            Span::Unit("m"),
            format!(", v = {v} "),
            Span::Unit("m/s")
        ]),
    ];
    let mut line = |text: Words| lines.push(Block::Line(text));
    let six = |value: f64| Digits::Fixed(6).text(value);
    for impact in orbit.impacts().take(SHOWN) {
        let (angle, turn) = (six(impact.cam_angle.to_degrees()), impact.revolution);
        let (before, after) = (six(impact.velocity_before), six(impact.velocity_after));
        let text = format!("     impact at {angle:>11} deg of revolution {turn}   v {before:>14} -> {after} ");
        line(words![text, Span::Unit("m/s")]);
    }
    if impacts > SHOWN {
        line(format!("     and {} more", impacts - SHOWN).into());
    }
    for rest in orbit.rests() {
        let (angle, turn) = (six(rest.cam_angle.to_degrees()), rest.revolution);
        line(format!("     {:<7} at {angle:>10} deg of revolution {turn}", rest.kind.name()).into());
    }
    lines
}

const TEN: Digits = Digits::Fixed(10);
