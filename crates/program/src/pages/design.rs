//! Page of `design`: the answer in sentences first, then speeds, limits and required changes.

use crate::pages::cam::follower;
use crate::pages::source;
use crate::show::Paged;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, words};
use crate::show::digits::{Digits, at_most, with_error};
use crate::show::page::text;
use crate::show::sources::Sources;
use crate::show::words::{noise_unknown, spoken};
use corner_impact::known::Evidence;
use corner_impact::study::design::contact::Separation;
use corner_impact::study::design::needs::Answer;
use corner_impact::study::design::{Design, RequiredPair, SeparationPlace, Trade};
use corner_impact::uncertainty::SourcedUncertainty;

/// Column of numbers with a gap before it.
fn number(head: impl Into<Words>) -> Column {
    Column { gap: 2, ..Column::number(head) }
}

const SIX: Digits = Digits::Significant(6);

impl Paged for Design {
    fn blocks(&self) -> Vec<Block> {
        let title = Block::Title(words!["Design of ", &self.model.name]);
        let mut page = vec![title];
        page.extend(source(&self.model.source));
        page.extend([Block::Gap, Block::paragraph(separation(self))]);
        if !self.over.is_speed() {
            let name = self.over.own_name();
            page.push(Block::paragraph(format!(
                "The separation speed and those of rounded corners are for the model's own {name}."
            )));
        }
        let unknown = self.measured.as_ref().and_then(|measured| measured.noise_unknown.as_deref());
        page.extend(unknown.map(|why| Block::paragraph(noise_unknown(why))));
        if let Some(words) = margin(self) {
            page.push(Block::paragraph(words));
        }
        if self.geometry.is_some() || self.lever_ratio != 1.0 {
            page.push(follower(self.geometry.as_ref(), self.lever_ratio));
        }
        page.extend(speeds(self));
        page.extend(limits(self));
        page.extend(needs(self));
        page.extend(rounded(self));
        page.extend(self.trades.iter().flat_map(trade));
        page.extend(sources(self).map(|sources| Block::Note(format!("{}{}", sources.note(), exact(self)).into())));
        page
    }
}

/// Uncertain numbers that are exact in a part of the page.
fn exact(found: &Design) -> String {
    let is_uncertain = |name: &str| found.errors.uncertain().any(|(uncertain, _)| uncertain == name);
    let varied = [Some(found.over.own_name()), found.trades.first().map(|trade| trade.against.as_str())];
    let mut varied: Vec<&str> = varied.into_iter().flatten().filter(|name| is_uncertain(name)).collect();
    varied.dedup();
    let varied = varied.into_iter().map(|name| format!(" Where {0} varies, {0} is exact.", spoken(name)));
    let is_sought = found.needs.iter().any(|answer| is_uncertain(&answer.lever.to_string()));
    let sought = is_sought.then(|| " A number that is solved for has no error of its own.".to_owned());
    varied.chain(sought).collect()
}

/// Sources of the uncertainty of the machine.
fn sources(found: &Design) -> Option<Sources<'_>> {
    Sources::of(&found.measured, found.errors).if_any()
}

/// Sources of the uncertainty in the table, in which the varied number is exact.
fn table_sources(found: &Design) -> Option<Sources<'_>> {
    Sources::of(&found.measured, found.table_errors()).if_any()
}

/// States in a sentence where the follower leaves the cam.
pub(crate) fn separation(found: &Design) -> Words {
    let error = found.separation_errors.map(|[error, _]| error);
    leaves(found.separation, &found.places, sources(found), error)
}

/// Sentence about a separation, with its angle or the competing places. Another sentence follows if errors of the rows may decide it.
pub(crate) fn leaves(
    separation: Separation,
    places: &[SeparationPlace],
    sources: Option<Sources<'_>>,
    error: Option<SourcedUncertainty>,
) -> Words {
    let first = leaves_first(separation, places, sources, error);
    match decided_by_errors(separation) {
        Some(sentence) => words![first, " ", sentence],
        None => first,
    }
}

/// Sentence about a separation where hardly any force presses the follower on a measured cam.
pub(crate) fn decided_by_errors(separation: Separation) -> Option<&'static str> {
    matches!(separation, Separation::At { within_errors: true, .. }).then_some(
        "On this or another likely cam, it leaves where spring and weight press with less force than an error of one row changes. There \
         errors of the rows may decide the speed: is the preload right?",
    )
}

fn leaves_first(
    separation: Separation,
    places: &[SeparationPlace],
    sources: Option<Sources<'_>>,
    error: Option<SourcedUncertainty>,
) -> Words {
    let degrees = |angle: f64| (angle.to_degrees(), Digits::Fixed(3));
    match separation {
        Separation::At { rpm, cam_angle, angle_error, .. } => match sources {
            None => words![
                "The follower leaves the cam first at ",
                (rpm, Digits::Fixed(6)),
                " rpm, at ",
                degrees(cam_angle),
                " deg (computed from the contact force)."
            ],
            Some(sources) if !places.is_empty() => words![
                "The follower leaves the cam first at ",
                sources.speed(rpm, Digits::Fixed(6), error),
                ". ",
                match places {
                    [one] => words![
                        format!("On each of {} equally likely {}, it leaves at ", one.cams, sources.machines()),
                        angles(one)
                    ],
                    _ => words![
                        "The angle is uncertain: ",
                        Words::joined(places.iter().map(|it| place(it, sources.machines())).collect::<Vec<_>>(), ", ")
                    ],
                },
                " (computed from the contact force)."
            ],
            Some(sources) => words![
                "The follower leaves the cam at ",
                with_open(
                    cam_angle.to_degrees(),
                    angle_error.map(f64::to_degrees).filter(|error| error.is_finite()),
                    Digits::Fixed(3)
                ),
                " deg first (computed from the contact force), at ",
                sources.speed(rpm, Digits::Fixed(6), error),
                "."
            ],
        },
        Separation::NotPressed { cam_angle } => {
            words![
                "The follower leaves the cam at every speed, however low: nothing presses it onto the cam at ",
                degrees(cam_angle),
                " deg."
            ]
        }
        Separation::Kink { cam_angle } => words![
            "The follower leaves the cam at every speed: the cam's velocity jumps at ",
            degrees(cam_angle),
            " deg."
        ],
        Separation::Never => {
            "The follower stays on the cam at every speed: the cam nowhere accelerates away from it.".into()
        }
    }
}

/// One of the places at which the follower may first leave the cam.
fn place(place: &SeparationPlace, machines: &str) -> Words {
    let share = (100.0 * place.share, Digits::Fixed(0));
    words![angles(place), " for ", share, format!(" % of {} equally likely {machines}", place.cams)]
}

/// Angles of a place.
fn angles(place: &SeparationPlace) -> Words {
    let ([from, to], width) = place.within_a_turn();
    let ([from, to], width) = ([from, to].map(f64::to_degrees), width.to_degrees());
    match width {
        width if width < 1.0 => words!["about ", (from, Digits::Fixed(0)), " deg"],
        _ => words![(from, Digits::Fixed(0)), " to ", (to, Digits::Fixed(0)), " deg"],
    }
}

/// Least force at the highest tabulated speed below separation.
pub(crate) fn margin(found: &Design) -> Option<Words> {
    /// Share of the separation speed above which rounding dominates the force.
    const BELOW: f64 = 0.999;
    // For a survey over another number, each value has its own separation speed.
    if !found.over.is_speed() {
        return None;
    }
    let below = BELOW * found.separation.speed();
    let last = found.forces.iter().rfind(|at| at.place.rpm < below)?;
    let force = with_open(found.force(last.least.value), last.error.map(|error| found.force(error.total())), SIX);
    let (rpm, angle) = ((last.place.rpm, SIX), (last.least.angle.to_degrees(), Digits::Fixed(3)));
    let unit = found.units.force.name();
    Some(words!["At ", rpm, " rpm the least contact force is ", force, format!(" {unit}, at "), angle, " deg."])
}

pub(crate) fn speeds(found: &Design) -> Vec<Block> {
    let is_open = table_sources(found).is_some();
    let force = found.units.force.name();
    let mut columns =
        vec![number(found.over.head()), number(format!("least force {force}")), number("at deg").missable(2)];
    let head = |name: &str, unit: &'static str| number(words![name, Span::Unit(unit)]);
    if !found.loads.is_empty() {
        columns.extend([
            head("impact ", "m/s"),
            head("gap ", "m"),
            number("off cam %"),
            number("lost J/rev").missable(3),
            number(format!("most force {force}")).missable(1),
        ]);
    }
    let by = found.over.at_speed("speed");
    let mut table = Table::new(&format!("Contact force and loads by {by}"), columns);
    let mut values: Vec<f64> = found.forces.iter().map(|at| at.place.across()).collect();
    values.extend(found.loads.iter().map(|loads| loads.place.across()));
    values.sort_by(f64::total_cmp);
    values.dedup();
    for value in values {
        let mut cells = vec![words![(value, SIX)]];
        match found.forces.iter().find(|at| at.place.across() == value) {
            Some(at) => cells.extend([
                with_open(found.force(at.least.value), at.error.map(|error| found.force(error.total())), SIX),
                words![(at.least.angle.to_degrees(), Digits::Fixed(2))],
            ]),
            None => cells.extend([Words::default(), Words::default()]),
        }
        if !found.loads.is_empty() {
            let three = |value: f64| words![(value, Digits::Aligned(3))];
            match found.loads.iter().find(|loads| loads.place.across() == value) {
                Some(loads) => {
                    let error = |index: usize| loads.errors.map(|errors| errors[index].total());
                    // In per cent, which no document field has.
                    let off_cam = error(2).map(|error| 100.0 * error);
                    let force = error(4).map(|error| found.force(error));
                    let unknown = if is_open && loads.errors.is_none() { " ± ?" } else { "" };
                    cells.extend([
                        words![load(loads.impact_speed, error(0), Digits::Aligned(3), true), unknown],
                        load(loads.gap, error(1), Digits::Aligned(3), true),
                        text(&load(100.0 * loads.off_cam, off_cam, Digits::Fixed(1), false)).into(),
                        load(loads.energy, error(3), Digits::Aligned(3), false),
                        load(found.force(loads.force), force, Digits::Aligned(3), false),
                    ]);
                }
                None => {
                    cells.extend((0..4).map(|_| "".into()));
                    let on_cam = found.forces.iter().find(|at| at.place.across() == value);
                    cells.push(on_cam.map_or("".into(), |at| three(found.force(at.largest))));
                }
            }
        }
        table.row(cells);
    }
    let heading = if found.over.is_speed() { "Speeds".into() } else { format!("Over {}", found.over.at_speed("")) };
    let mut blocks = vec![Block::Heading(heading.as_str().into()), Block::Table(table)];
    blocks.push(Block::Note(
        "least force: least force of the cam on the follower in contact, computed. Where it is below 0, they separate."
            .into(),
    ));
    if !found.loads.is_empty() {
        let transient = found.budget.transient;
        let words = format!(
            "The other columns are the largest values over 8 revolutions, after at most {transient} revolutions to settle. They are sampled \
             by runs from four starts, unless others are given: another motion may reach more. impact: speed of the follower relative to \
             the cam. lost: energy lost in impacts. most force: largest force of the cam on the follower between impacts."
        );
        blocks.push(Block::Note(words.as_str().into()));
        if found.loads.iter().any(|loads| loads.errors.is_some()) {
            let words = match table_sources(found) {
                Some(Sources { cam: Some(_), errors }) if errors.are_none() => {
                    "from runs with cams that fit the rows".to_owned()
                }
                Some(sources) => {
                    format!("the uncertainty from {}, found by runs with equally likely machines", sources.name())
                }
                None => String::new(),
            };
            let words = format!(
                "± is {words}. A load that may be 0 shows its upper bound. The last three columns are rounded to their ±; --json has the ±."
            );
            blocks.push(Block::Note(words.as_str().into()));
            blocks.extend(hardest(found).map(Block::Note));
        }
    }
    blocks
}

/// Sources of the uncertainty of the impact speed, at the last value with loads.
fn hardest(found: &Design) -> Option<Words> {
    let sources = table_sources(found).filter(|sources| !sources.errors.are_none())?;
    let loads = found.loads.iter().rfind(|loads| loads.impact_speed > 0.0 && loads.errors.is_some())?;
    let error = loads.errors.map(|errors| errors[0])?;
    let at = if found.over.is_speed() { " rpm" } else { "" };
    let (digits, total) = with_error(error.total());
    Some(words![
        "± of the impact at ",
        (loads.place.across(), SIX),
        format!("{at}: "),
        (total, digits),
        format!(", {}.", sources.parts(&error))
    ])
}

fn limits(found: &Design) -> Vec<Block> {
    let open = match table_sources(found) {
        Some(Sources { cam: Some(_), errors }) if errors.are_none() => "; for the fitted cam, without a ±",
        Some(_) => "; for the machine as given, without a ±",
        None => "",
    };
    let sentence = |passed: &corner_impact::study::design::Passed| {
        let name = passed.limit.to_string().replace('-', " ");
        let limit = words![format!("{name} of "), (passed.value, SIX), format!(" {}: ", passed.unit)];
        let values = if found.over.is_speed() { "speeds" } else { "values" };
        let lowest = found.loads.first().map(|loads| loads.place.across());
        match passed.at {
            Some(at) => {
                words![
                    limit,
                    Span::Marked(TextMark::Bad, "passed".into()),
                    " at ",
                    (at.across(), Digits::Significant(4)),
                    if found.over.is_speed() { " rpm" } else { "" },
                    if lowest == Some(at.across()) {
                        format!(" already, the lowest of the {values} with loads")
                    } else {
                        format!(", between two of the {values} above")
                    },
                    open
                ]
            }
            None => {
                words![
                    limit,
                    Span::Marked(TextMark::Good, "kept".into()),
                    format!(" at each of the {values} above"),
                    open
                ]
            }
        }
    };
    if found.limits.is_empty() {
        return Vec::new();
    }
    vec![Block::Heading("Limits".into()), Block::List(found.limits.iter().map(sentence).collect())]
}

fn needs(found: &Design) -> Vec<Block> {
    let sources = sources(found);
    let total = |error: Option<SourcedUncertainty>| error.map(|error| error.total());
    let mut blocks = Vec::new();
    for of_need in found.needs.chunk_by(|one, two| one.need == two.need) {
        let columns = [
            Column::words("change"),
            number("now"),
            Column::words(""),
            number("to"),
            Column::words("unit"),
            Column::words("known"),
            Column::words(""),
        ];
        let mut table = Table::new(&of_need[0].need, columns);
        for answer in of_need {
            let Answer { lever, now, unit, note, known, .. } = answer;
            let digits = |value: f64| Digits::of(value, if *known == Evidence::Computed { 9 } else { 3 });
            let bound = if answer.is_upper_bound { "at most" } else { "at least" };
            // If any value will do, there is no uncertainty, and the note states this.
            let unknown = if sources.is_some() && answer.error.is_none() && note.is_empty() { " ± ?" } else { "" };
            let value = answer.value.map(|value| words![positive(value, total(answer.error), digits(value)), unknown]);
            let other = answer.other.map(|other| positive(other, total(answer.other_error), digits(other)));
            let (bound, to) = match (value, other) {
                (None, _) => ("", "none".into()),
                (Some(value), None) => (bound, value),
                (Some(value), Some(other)) if answer.is_upper_bound => ("between", words![other, " and ", value]),
                (Some(value), Some(other)) => ("between", words![value, " and ", other]),
            };
            table.row([
                lever.to_string().into(),
                words![(*now, Digits::Short)],
                bound.into(),
                to,
                unit.into(),
                known.to_string().into(),
                note.into(),
            ]);
        }
        blocks.push(Block::Heading(of_need[0].need.as_str().into()));
        blocks.push(Block::Table(table));
        blocks.push(Block::Note("Each change alone suffices, with the other numbers unchanged.".into()));
        if let Some(sources) = sources.filter(|sources| !sources.errors.are_none()) {
            let part = |answer: &Answer| {
                let error = answer.error.filter(|error| error.total() > 0.0)?;
                let (digits, total) = with_error(error.total());
                Some(words![format!("{} ± ", answer.lever), (total, digits), format!(": {}", sources.parts(&error))])
            };
            blocks.push(Block::List(of_need.iter().filter_map(part).collect()));
        }
    }
    blocks
}

fn rounded(found: &Design) -> Vec<Block> {
    if found.rounded.is_empty() {
        return Vec::new();
    }
    let columns = [
        number("rounded over deg"),
        number("leaves the cam at rpm"),
        number("change %").missable(1),
        number(words!["largest jerk ", Span::Unit("m/rad^3")]),
    ];
    let mut table = Table::new("The cam with its corners rounded", columns);
    let speed = |rpm: f64| words![(rpm, Digits::Significant(7))];
    let own = found.separation.at_speed().map_or("".into(), speed);
    table.row(["none".into(), own, "".into(), "infinite".into()]);
    for at in &found.rounded {
        let change = at.separation_change.map_or("".into(), |part| words![(100.0 * part, Digits::Fixed(2))]);
        let speed = at.separation_rpm.map_or("".into(), speed);
        table.row([words![(at.corner_rounding_deg, SIX)], speed, change, words![(at.jerk, SIX)]]);
    }
    let words = "The acceleration of the cam jumps, so its jerk is infinite. Rounding the corners (corner_rounding_deg) makes the jerk finite. \
                 A wider rounding gives a smaller jerk. The separation speed falls or rises: the rounded acceleration overshoots both \
                 sides of the jump by a twelfth of it, but over a short angle.";
    vec![Block::Heading("Jumps of the acceleration".into()), Block::paragraph(words), Block::Table(table)]
}

/// Load with its uncertainty, or in the digits that the uncertainty leaves. A load that may be zero is shown as an upper bound.
fn load(value: f64, error: Option<f64>, digits: Digits, is_told: bool) -> Words {
    /// Relative uncertainty that leaves a value three digits.
    const KNOWN: f64 = 0.005;
    let Some(error) = error.filter(|error| *error > 0.0) else { return words![(value, digits)] };
    let (open, rounded) = with_error(error);
    match error < value {
        // Three digits are enough here.
        true if !is_told && error < KNOWN * value => words![(value, digits)],
        true if is_told => words![(value, open), " ± ", (rounded, open)],
        true => words![(value, open)],
        false => at_most(value + error).into(),
    }
}

/// Value with its uncertainty.
fn with_open(value: f64, error: Option<f64>, digits: Digits) -> Words {
    match error.filter(|error| *error > 0.0).map(with_error) {
        Some((digits, error)) => words![(value, digits), " ± ", (error, digits)],
        None => words![(value, digits)],
    }
}

/// Value of a quantity that is not negative, with its uncertainty.
fn positive(value: f64, error: Option<f64>, digits: Digits) -> Words {
    match error.filter(|error| *error >= value.abs()) {
        Some(error) => words![(value, digits), ", ", at_most(value + error)],
        None => with_open(value, error, digits),
    }
}

fn trade(trade: &Trade) -> [Block; 2] {
    let Trade { need, parameter, unit, against, against_unit, pairs, known } = trade;
    let digits = |value: f64| Digits::of(value, if *known == Evidence::Computed { 6 } else { 3 });
    let columns = [number(format!("{} {against_unit}", spoken(against))), number(format!("{parameter} {unit}"))];
    let mut table = Table::new(need, columns);
    for RequiredPair { given, found, error, other, other_error, again } in pairs {
        let with_error = |value: f64, error: &Option<SourcedUncertainty>| {
            with_open(value, error.map(|it| it.total()), digits(value))
        };
        let found = found.map(|value| with_error(value, error));
        let mut cell = match (found, other.map(|value| with_error(value, other_error))) {
            (None, _) => "none".into(),
            (Some(found), None) => found,
            (Some(found), Some(other)) if parameter.is_upper_bound() => words![other, " to ", found],
            (Some(found), Some(other)) => words![found, " to ", other],
        };
        if let Some(again) = again {
            cell = words![cell, ", and ", (*again, digits(*again))];
        }
        table.row([words![(*given, SIX)], cell]);
    }
    let bound = match parameter.is_upper_bound() {
        _ if pairs.iter().any(|pair| pair.other.is_some()) => "",
        true => "most ",
        false => "least ",
    };
    [Block::Heading(format!("{need}: the {bound}{parameter} for each {}", spoken(against)).into()), Block::Table(table)]
}
