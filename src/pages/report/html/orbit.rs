//! Where the corner impact is.

use maud::html;

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::{number, unheaded};
use crate::show::block::{Block, Section, Words, words};
use crate::show::digits::Digits;
use crate::show::words::symbol;

pub(crate) fn section(dossier: &Dossier) -> Section {
    Section { id: "corner-impact", title: "Where the corner impact is".into(), blocks: blocks(dossier) }
}

fn blocks(dossier: &Dossier) -> Vec<Block> {
    let Some(found) = &dossier.verification else {
        return vec![Block::Markup(html! {
            p {
                "There is none to verify; " a href="#findings" { "the findings" }
                " say why. What follows is what cam and follower do without it."
            }
        })];
    };
    let at = &found.at;
    let (state, [before, after]) = (at.x_star(), at.cam_acceleration());
    let mut table = unheaded("The corner impact", 4);
    for (name, letter, value, unit) in [
        ("period", symbol("T*", "T", "", "∗"), number(at.period, 14), "s"),
        ("speed", symbol("omega*", "ω", "", "∗"), words![(at.speed_rpm(), Digits::Fixed(9))], "rpm"),
        (
            "cam angle of the corner",
            symbol("theta", "θ", "", ""),
            words![(at.corner.angle.to_degrees(), Digits::Fixed(6))],
            "deg",
        ),
        ("state half a revolution from it, position", symbol("x1*", "x", "1", "∗"), number(state[0], 13), "m"),
        ("and velocity", symbol("x2*", "x", "2", "∗"), number(state[1], 13), "m/s"),
        ("height of the cam there", symbol("c", "c", "", ""), number(at.corner.plus.value, 10), "m"),
        ("velocity of the follower before", symbol("v-", "v", "", "−"), number(at.velocity_before, 10), "m/s"),
        ("and after", symbol("v+", "v", "", "+"), number(at.velocity_after, 10), "m/s"),
        ("velocity of the cam", symbol("c'", "c′", "", ""), number(at.cam_velocity, 10), "m/s"),
        ("acceleration of the cam before the corner", symbol("c''-", "c″", "−", ""), number(before, 10), "m/s²"),
        ("and after", symbol("c''+", "c″", "+", ""), number(after, 10), "m/s²"),
    ] {
        table.row([name.into(), letter.into(), value, Words::from(unit)]);
    }
    let about = "The orbit with one impact a revolution whose impact is on a corner, solved for from the model's numbers alone.";
    let [low, high] = at.bracket;
    let close = Words::prose(
        "Position is measured from _q_ = {} m. _T^∗_ lies between {} and {} s; one simulated revolution ends within {} of \
         where it started, in parts of the orbit's size.",
        [number(at.origin, 9), number(low, 16), number(high, 16), words![(at.closure, Digits::Size)]],
    );
    let mut blocks = vec![Block::paragraph(about), Block::Table(table), Block::Note(close)];
    blocks.extend(found.others.iter().map(|other| {
        let speed = (other.speed_rpm(), Digits::Fixed(6));
        Block::Note(words!["There is another corner impact at ", speed, " rpm: narrow [study] to verify that one."])
    }));
    blocks
}
