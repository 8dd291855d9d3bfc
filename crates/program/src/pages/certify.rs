//! Page of `certify`: the proofs about each corner impact, with the proved digits, and what is not proved.

use crate::pages::some_of;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, words};
use crate::show::digits::Digits;
use crate::show::{Paged, words};
use corner_impact::ball::Ball;
use corner_impact::orbit::Stability;
use corner_impact::study::certify::{
    Certificate, Certified, OrbitKind, ProvedCounts, ProvedEigenvalue, ProvedOrbits, ProvedRelease, ProvedResting,
    ProvedSide, ProvedStart, Round, Unproved,
};

impl Paged for Certified {
    fn blocks(&self) -> Vec<Block> {
        let (low, high) = (self.range.rpm_min, self.range.rpm_max);
        let count = match self.corner_impacts.len() {
            0 => "no corner impact is proved".into(),
            1 => "1 corner impact is proved".to_owned(),
            count => format!("{count} corner impacts are proved"),
        };
        let mut page = vec![
            Block::Title(format!("Certificates of corner impacts of {}", self.model.name).into()),
            Block::paragraph(words![
                format!(
                    "{low} to {high} rpm: {count}, with {} bits. Every digit below is proved, up to one unit of the last. \
                     Positions are in ",
                    self.bits
                ),
                Span::Unit("m"),
                ", velocities in ",
                Span::Unit("m/s"),
                ", times in s."
            ]),
        ];
        self.corner_impacts.iter().for_each(|one| page.extend(certificate(one)));
        page.extend(words::hypotheses(&self.hypotheses()).map(Block::paragraph));
        page.extend(refused(&self.refused));
        page
    }
}

impl Paged for ProvedOrbits {
    fn blocks(&self) -> Vec<Block> {
        let mut page = vec![Block::Title(format!("Periodic orbits at {} rpm, proved", self.speed_rpm).into())];
        for orbit in &self.orbits {
            let start = |start: &ProvedStart| {
                let words = words![
                    &start.cam_angle_rad.mid,
                    " rad, leaves the cam at ",
                    &start.relative_velocity_m_s.mid,
                    " ",
                    Span::Unit("m/s"),
                    " relative to it"
                ];
                ("impact".into(), words)
            };
            let (impacts, kind) = (words::many(orbit.impacts.len() as u64, "impact"), orbit.kind.to_string());
            page.push(Block::paragraph(words![format!("{impacts}, "), (TextMark::Strong, kind.as_str())]));
            page.push(Block::Entries(9, orbit.impacts.iter().map(start).collect()));
        }
        for count in [1, 2] {
            let impacts = words::many(count as u64, "impact");
            page.push(Block::paragraph(match self.complete.contains(&count) {
                true => format!("Orbits of {impacts} in 1 revolution: it is proved that there are no others."),
                false => format!("Orbits of {impacts} in 1 revolution: it is not decided whether there are others."),
            }));
            let places: Vec<_> = self.undecided.iter().filter(|one| one.impacts == count).collect();
            page.extend(some_of(&places, "place", |one| {
                let angles = one.cam_angles_rad.iter().map(|ends| {
                    let [low, high] = ends.map(|end| (end.to_degrees(), Digits::Fixed(6)));
                    words![low, " to ", high, " deg"]
                });
                words!["not decided about impacts at ", Words::joined(angles, " and ")]
            }));
        }
        page.extend(words::hypotheses(&self.hypotheses()).map(Block::paragraph));
        page
    }
}

impl Paged for ProvedCounts {
    fn blocks(&self) -> Vec<Block> {
        let [low, high] = self.range_rpm;
        let mut counts = Table::new(
            "At every speed between",
            [Column::right("from (rpm)", 14), Column::right("to (rpm)", 14), Column::left("orbits", 2, 0)],
        );
        for count in &self.counts {
            let speed = |rpm: f64| words![(rpm, Digits::Significant(9))];
            counts.row([speed(count.from_rpm), speed(count.to_rpm), kinds(&count.kinds)]);
        }
        let mut page = vec![
            Block::Title(format!("Orbits of 1 impact in 1 revolution, {low} to {high} rpm, proved").into()),
            Block::Table(counts),
        ];
        for event in &self.events {
            let changes = |kinds_there: &Option<Vec<_>>| match kinds_there {
                Some(all) => kinds(all),
                None => "not decided".into(),
            };
            page.push(Block::paragraph(words![(TextMark::Strong, words::spoken(&event.kind.to_string()).as_str())]));
            page.push(Block::Entries(
                9,
                vec![
                    ("rpm".into(), words![&event.speed_rpm.mid]),
                    ("impact".into(), words![&event.cam_angle_rad.mid, " rad"]),
                    ("below".into(), changes(&event.before)),
                    ("above".into(), changes(&event.after)),
                ],
            ));
        }
        let undecided = self.undecided.iter().map(|[low, high]| format!("{low} to {high} rpm").as_str().into());
        page.push(Block::paragraph(match self.undecided[..] {
            [] => "It is proved that there are no others at any speed of the range. The digits of each event are proved, up to one unit of the last.".into(),
            _ => words!["The number is not decided from ", Words::joined(undecided, ", from "), "."],
        }));
        page.extend(words::hypotheses(&self.hypotheses()).map(Block::paragraph));
        page
    }
}

impl Paged for ProvedResting {
    fn blocks(&self) -> Vec<Block> {
        let degrees = |rad: f64| words![(rad.to_degrees(), Digits::Fixed(4))];
        let mut page =
            vec![Block::Title(format!("Motions that rest on the cam at {} rpm, proved", self.speed_rpm).into())];
        if self.releases.is_empty() {
            page.push(Block::paragraph(match self.pressed_rad.is_empty() {
                true => "The cam nowhere presses against the follower: no motion rests on it.",
                false => "The cam presses against the follower everywhere: a follower at rest on it stays on it.",
            }));
            page.extend(words::hypotheses(&self.hypotheses()).map(Block::paragraph));
            return page;
        }
        let pressed = self.pressed_rad.iter().map(|[low, high]| words![degrees(*low), " to ", degrees(*high)]);
        page.push(Block::paragraph(words![
            "The cam presses against a follower that rests on it from ",
            Words::joined(pressed, " deg, from "),
            " deg. Where the cam releases it, exactly one motion follows, whatever came before:"
        ]));
        let mut table = Table::new(
            "From one release to the next",
            [
                ("released (deg)", 14),
                ("impacts", 8),
                ("rests by (deg)", 14),
                ("released (deg)", 14),
                ("revolutions", 11),
            ]
            .map(|(head, least)| Column { gap: 2, ..Column::right(head, least) }),
        );
        let angle = |release: &ProvedRelease| degrees(release.cam_angle_rad.value());
        for release in &self.releases {
            let dash = || Words::from("–");
            let next = release.next.as_ref();
            table.row([
                angle(release),
                next.map_or_else(dash, |next| next.impacts.to_string().into()),
                next.map_or_else(dash, |next| degrees(next.rests_by_rad)),
                next.and_then(|next| self.releases.get(next.release)).map_or_else(dash, angle),
                next.map_or_else(dash, |next| next.revolutions.to_string().into()),
            ]);
        }
        page.push(Block::Table(table));
        let all = match self.all_repeat() {
            true => "So every motion that rests once becomes periodic".to_owned(),
            false => {
                format!("Motions that do not rest again within {} impacts were not followed further", self.looked_at)
            }
        };
        let round = |round: &Round| {
            let (impacts, turns) = (words::many(round.impacts, "impact"), words::many(round.revolutions, "revolution"));
            format!("{turns}, with {impacts} and the infinite sequence of impacts before its rest").as_str().into()
        };
        page.push(Block::paragraph(match self.periodic[..] {
            [] => words![all, "."],
            _ => words![
                all,
                ". A motion that is released at the same place again repeats after ",
                Words::joined(self.periodic.iter().map(round), ", or after "),
                "."
            ],
        }));
        page.extend(words::hypotheses(&self.hypotheses()).map(Block::paragraph));
        page
    }
}

/// Number of orbits of each kind.
fn kinds(all: &[Option<OrbitKind>]) -> Words {
    if all.is_empty() {
        return "none".into();
    }
    let parts = all.chunk_by(|one, other| one == other).map(|same| {
        let kind = same[0].map_or("of undecided kind".into(), |kind| kind.to_string());
        format!("{} {kind}", same.len()).as_str().into()
    });
    Words::joined(parts, ", ")
}

fn certificate(of: &Certificate) -> Vec<Block> {
    let (impacts, turns) = (words::many(of.impacts.len() as u64, "impact"), words::many(of.revolutions, "revolution"));
    let degrees = Digits::Fixed(4).text(of.cam_angle_rad.value().to_degrees());
    let mut entries: Vec<(Words, Words)> = vec![
        ("omega*, rpm".into(), words![&of.speed_rpm.mid]),
        ("T*, s".into(), words![&of.period_s.mid]),
        ("x*".into(), pair(&of.state)),
    ];
    for (index, impact) in of.impacts.iter().enumerate().skip(1) {
        entries.push((format!("impact {}, rad", index + 1).into(), words![&impact.cam_angle_rad.mid]));
    }
    for (mark, side) in [("-", &of.sides.minus), ("+", &of.sides.plus)] {
        entries.extend(side_entries(mark, side));
    }
    entries.extend([("C".into(), pair(&of.c)), ("D".into(), words![&of.d.mid])]);
    let mut conditions = Table::new(
        "Conditions",
        [Column::left("condition", 2, 34), Column::left("value", 2, 38), Column::left("sign", 2, 0).missable(1)],
    );
    for condition in &of.conditions {
        let sign = if condition.sign > 0 { "above 0" } else { "below 0" };
        conditions.row([condition.name.as_str().into(), words![&condition.value.mid], (TextMark::Good, sign).into()]);
    }
    let near = |side: &ProvedSide| {
        // Proofs exclude eigenvalues on the unit circle.
        let stability = if side.stable { Stability::Stable } else { Stability::Unstable };
        format!("{} and is {}", words::speeds(Some(side.fixed_point_exists_for)), words::stability(stability))
    };
    let within = |side: &ProvedSide| side.followed.as_ref().map(|followed| Digits::Size.text(followed.period_within_s));
    let how_far = match (within(&of.sides.minus), within(&of.sides.plus)) {
        (Some(minus), Some(plus)) => format!(
            "This is proved for all periods within {minus} s of T* for the first, and within {plus} s for the second. There each side's \
             law, continued past the corner, has one fixed point near x*. At the speeds named, its flights are clear of the cam. \
             At other speeds its impact is beyond the corner, where that law does not hold."
        ),
        _ => "This holds for all speeds near enough to omega*; how near is not proved. It follows from the implicit function theorem for \
              the map of each side, with the cam's law continued past the corner."
            .into(),
    };
    let others = match (of.impacts.len(), of.revolutions) {
        (1, 1) => {
            " `certify --orbits --rpm LO:HI` proves the number of orbits of one impact in one revolution at every speed of a range."
        }
        _ => "",
    };
    vec![
        Block::Heading(
            format!("{} rpm, on the corner at {degrees} deg", Digits::Fixed(6).text(of.speed_rpm.value())).into(),
        ),
        Block::paragraph(format!(
            "Theorem. There is a periodic orbit of {impacts} in {turns} with an impact on this corner. There is no other orbit whose period \
             and impacts differ from its own by up to {} of their size. Each impact is on its piece of the cam. Each flight leaves the \
             cam, is clear of it, and ends in an impact at a speed above 0. Its map is given below; two routes agree in every entry.",
            of.alone_within
        )),
        Block::Entries(20, entries),
        Block::Table(conditions),
        Block::Paragraph(
            2,
            words![
                (
                    TextMark::Strong,
                    format!("{}{}", of.verdict, words::beside(of.verdict, of.period_two_orbit)).as_str()
                ),
                format!(
                    ": {}. Next to omega*, the machine's fixed point with its impact before the corner exists {}. The one with its impact \
                     after the corner exists {}. {how_far}{others}",
                    words::meaning(of.verdict, of.sides.minus.stable || of.sides.plus.stable, None),
                    near(&of.sides.minus),
                    near(&of.sides.plus),
                ),
            ],
        ),
    ]
}

fn side_entries(mark: &str, side: &ProvedSide) -> Vec<(Words, Words)> {
    let eigenvalue = |ProvedEigenvalue { re, im }: &ProvedEigenvalue| match im.mid.as_str() {
        "0" => re.mid.clone(),
        im if im.starts_with('-') => format!("{} - {}i", re.mid, im.trim_start_matches('-')),
        im => format!("{} + {im}i", re.mid),
    };
    let [one, other] = &side.eigenvalues;
    vec![
        (format!("A{mark}").into(), pair(&side.a[0])),
        ("".into(), pair(&side.a[1])),
        (format!("B{mark}").into(), pair(&side.b)),
        (format!("eigenvalues of A{mark}").into(), words![eigenvalue(one), ",  ", eigenvalue(other)]),
    ]
}

fn pair([one, other]: &[Ball; 2]) -> Words {
    words![&one.mid, ",  ", &other.mid]
}

fn refused(all: &[Unproved]) -> Vec<Block> {
    if all.is_empty() {
        return Vec::new();
    }
    let mut page = vec![Block::Heading(format!("Not proved ({})", all.len()).into())];
    page.extend(some_of(all, "place", |one| {
        let (speed, angle) = (one.speed_rpm, one.cam_angle.to_degrees());
        words![(speed, Digits::Fixed(6)), " rpm at ", (angle, Digits::Fixed(4)), " deg: ", &one.why]
    }));
    page
}
