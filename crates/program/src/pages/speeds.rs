//! Page of `speeds`: the short answer first, then every attractor with its beginning and end.

use crate::pages::design::decided_by_errors;
use crate::show::Paged;
use crate::show::block::{Block, Column, Table, TextMark, Words, words};
use crate::show::digits::{Digits, with_error};
use crate::show::sources::Sources;
use crate::show::words;
use corner_impact::elementary;
use corner_impact::orbit::long_run::{Budget, Kind};
use corner_impact::study::attractors::Transition;
use corner_impact::study::speeds::{AttractorRow, SpeedSurvey, kinds};
use corner_impact::study::survey::{Sample, Spacing};

impl Paged for SpeedSurvey {
    fn blocks(&self) -> Vec<Block> {
        let heading = |text: String| Block::Line((TextMark::Heading, text.as_str()).into());
        let mut page = vec![heading(format!("{}, {}", self.model, self.over.range(self.range))), Block::Gap];
        let leaves = if self.over.is_speed() { "  leaves the cam first at  " } else { "  leaves the cam at        " };
        page.push(Block::Line(words![leaves, detachment(self)]));
        let together = together(self);
        let together = if together.is_empty() {
            format!("at no {value}", value = self.over.value()).into()
        } else {
            words![Words::joined(together, ", "), unit(self)]
        };
        page.extend([
            Block::Line(words!["  several attractors        ", together]),
            Block::Gap,
            Block::Table(table(self)),
        ]);
        page.extend(self.separation.and_then(decided_by_errors).map(Block::paragraph));
        page.extend(remarks(self));
        page.extend(self.off_for_good().map(|off| Block::paragraph(off.words)));
        page.extend(dangers(self));
        page.push(Block::paragraph(how(self)));
        page.extend(uncertainty(self));
        page.extend(self.failed.iter().map(|failed| {
            let what = match failed.starts {
                Some(1) => "one start".to_owned(),
                Some(starts) => format!("{starts} starts"),
                None => "nothing".to_owned(),
            };
            let of_them = if failed.starts.is_some() { "could not be run" } else { "could be run" };
            let at = self.over.words(failed.at.across());
            Block::paragraph(format!("At {at} {what} {of_them}: {}.", failed.why))
        }));
        page
    }
}

/// Ranges with several attractors; adjacent ranges are joined.
pub(crate) fn together(found: &SpeedSurvey) -> Vec<Words> {
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for over in &found.coexistence {
        match joined.last_mut() {
            Some(last) if over.range()[0] <= last[1] => last[1] = over.range()[1],
            _ => joined.push(over.range()),
        }
    }
    joined.into_iter().map(|[from, to]| words![open_to(found, from), "–", open_to(found, to)]).collect()
}

/// Beginnings and ends of attractors.
fn ends(found: &SpeedSurvey) -> impl Iterator<Item = &Transition> {
    found.attractors.iter().flat_map(|attractor| attractor.birth.iter().chain(&attractor.death))
}

/// Value at which an attractor begins or ends, in the digits that its uncertainty leaves.
fn open_to(found: &SpeedSurvey, value: f64) -> Words {
    let usual = if found.over.is_speed() { Digits::Fixed(2) } else { Digits::Significant(5) };
    let end = ends(found).find(|end| end.value() == value);
    words![(value, end.and_then(|end| open(found, end)).map_or(usual, |error| with_error(error).0))]
}

/// Unit after a value, with a space.
fn unit(found: &SpeedSurvey) -> String {
    found.over.words("").trim_end().to_owned()
}

/// Uncertainty of an end, for the choice of digits. An end of unknown uncertainty gets the smallest known one. If none is known, a speed
/// gets no decimals, and another value three digits of the range.
fn open(found: &SpeedSurvey, end: &Transition) -> Option<f64> {
    const WHOLE: f64 = 10.0;
    let coarse = if found.over.is_speed() { WHOLE } else { 0.1 * (found.range[1] - found.range[0]) };
    let best = || ends(found).filter_map(|end| end.error).map(|error| error.total()).reduce(f64::min);
    let total = end.error.map(|error| error.total());
    total.or_else(|| sources(found).map(|_| best().unwrap_or(coarse)))
}

/// Speed at which the follower first leaves the cam.
pub(crate) fn detachment(found: &SpeedSurvey) -> Words {
    let Some(separation) = found.separation else {
        return match found.detachment() {
            Some([value, _]) => {
                let value = (value, Digits::Significant(9));
                Sources::of(&found.measured, found.errors).value(value, &unit(found), found.detachment_error())
            }
            None => "no value in the range was located".into(),
        };
    };
    match found.detachment() {
        Some([rpm, _]) => {
            Sources::of(&found.measured, found.errors).speed(rpm, Digits::Fixed(6), found.detachment_error())
        }
        None if separation.speed() > found.range[1] => "no speed in the range".into(),
        None => format!("{} rpm or below", found.range[0]).into(),
    }
}

/// Sources of the uncertainty of the machine.
fn sources(found: &SpeedSurvey) -> Option<Sources<'_>> {
    Sources::of(&found.measured, found.errors).if_any()
}

/// Method of the search, and what it can miss.
pub(crate) fn how(found: &SpeedSurvey) -> String {
    const LOCATED: &str = " A speed with six decimals was located by its equations. Other speeds come from runs alone, to the digits shown.";
    const VALUE_LOCATED: &str = " A value with nine digits was located by its equations. Other values come from runs alone, to the \
                                 digits shown.";
    let located = match (sources(found), found.over.is_speed()) {
        (Some(_), _) => "",
        (None, true) => LOCATED,
        (None, false) => VALUE_LOCATED,
    };
    let value = found.over.value();
    let Budget { transient, patience, .. } = found.budget;
    let followed = format!(
        " Runs that do not settle within {transient} revolutions are followed for {patience} more, shared by all runs of a {value}. \
         Only then is the motion called chaotic; rarer rests are not seen."
    );
    let unit = if found.over.spacing == Spacing::Logarithmic { " decades".into() } else { unit(found) };
    let step = format!("at {value}s {}{unit} apart", found.step);
    if let Sample::Given(starts) = &found.sample {
        let starts = words::many(starts.len() as u64, "start");
        return format!("Sampled: {step}, runs begin from the given {starts}.{followed}{located}");
    }
    let listed =
        if found.two_impacts { ", and on those of two in one revolution that a search by intervals finds" } else { "" };
    format!(
        "Sampled: {step}, runs begin from {} starts on the cam (any angle, up to the velocity that impacts sustain). Runs also begin from \
         rest wherever the cam releases a follower, and on the stable orbits of one impact in up to three revolutions{listed}. An attractor \
         with a basin of less than {:.1} % of the starts may be missed at a {value}. So may one that exists only between two {value}s.{followed}{located}",
        found.sample.count(),
        100.0 * found.missed(),
    )
}

/// Meaning of the errors, and the sources of the error of each event.
pub(crate) fn uncertainty(found: &SpeedSurvey) -> Vec<Block> {
    let unknown = found.measured.as_ref().and_then(|measured| measured.noise_unknown.as_deref());
    let mut blocks: Vec<Block> = unknown.map(|why| Block::paragraph(words::noise_unknown(why))).into_iter().collect();
    let Some(sources) = sources(found) else { return blocks };
    let (name, machines) = (sources.name(), sources.machines());
    blocks.push(Block::paragraph(format!(
        "± is the uncertainty from {name}, {}: how far the event moves among equally likely {machines}. ? means that it is unknown: the \
         event is missing on some of those {machines}, or runs could not decide.",
        sources.why()
    )));
    if !sources.errors.are_none() {
        let of_one = |attractor| parts(sources, attractor, &unit(found));
        blocks.push(Block::List(found.attractors.iter().flat_map(of_one).collect()));
    }
    blocks.push(Block::paragraph(sources.note()));
    blocks
}

/// Parts of the uncertainty of an attractor's ends.
fn parts(sources: Sources<'_>, attractor: &AttractorRow, unit: &str) -> Vec<Words> {
    let of_end = |(what, end): (&'static str, &Option<Transition>)| {
        let (end, error) = end.as_ref().and_then(|end| Some((end, end.error?)))?;
        let (digits, total) = with_error(error.total());
        let [id, from] = [format!("{} {what} ", attractor.id), format!("{unit}: {}", sources.parts(&error))];
        Some(words![id, (end.value(), digits), " ± ", (total, digits), from])
    };
    [("from", &attractor.birth), ("to", &attractor.death)].into_iter().filter_map(of_end).collect()
}

/// Frequency of rests of a motion that bounces chaotically in between; or, if runs were too short, the time for which chaos was followed.
fn rests(attractor: &AttractorRow) -> Option<String> {
    let id = &attractor.id;
    let Some(rests) = attractor.rests() else {
        let chaotic = attractor.at.iter().filter(|at| at.ending.kind() == Kind::Chaotic);
        let seen = words::followed_for(chaotic.map(|at| at.followed));
        return (!seen.is_empty()).then(|| format!("{id} is chaotic{seen}."));
    };
    Some(match rests.rate_error {
        Some(error) => format!(
            "Where {id} is chaotic between rests, it rests on the cam once in {:.0} ± {:.0} revolutions ({} in {} revolutions). \
             The apparent chaos ends with a rest, and the motion repeats from then on.",
            1.0 / rests.rate,
            error / rests.rate.powi(2),
            words::many(rests.rests, "rest"),
            rests.revolutions
        ),
        None => format!(
            "Where {id} is chaotic, no rest was seen in {} revolutions: with 95 % confidence rests are rarer than one in {:.0} revolutions.",
            rests.revolutions,
            1.0 / rests.rate
        ),
    })
}

/// Corner impacts with a danger.
pub(crate) fn dangers(found: &SpeedSurvey) -> impl Iterator<Item = Block> {
    found.dangers.iter().map(|it| {
        let (value, angle) = ((it.at.across(), digits(found)), (it.cam_angle.to_degrees(), Digits::Fixed(2)));
        let attractors = it.attractors.join(", ");
        let mut words = words!["At ", value, unit(found), " ", attractors, " has a corner impact at ", angle, " deg: "];
        let lines = std::iter::once(words::danger(&it.danger)).chain(words::returns(&it.danger));
        words.push(words![Words::joined(lines, "; "), "."]);
        Block::paragraph(words)
    })
}

/// Table of the attractors, with the beginning and end of each.
pub(crate) fn table(found: &SpeedSurvey) -> Table {
    let ends = if found.over.is_speed() { ["from (rpm)", "to (rpm)"] } else { ["from", "to"] };
    let columns = [
        Column::left("", 2, 3),
        Column { gap: 1, ..Column::right(ends[0], 10) },
        Column { gap: 1, ..Column::right(ends[1], 10) },
        Column::left("motion", 2, 20),
        Column { gap: 1, ..Column::right("starts (%)", 8) },
        Column::left("begins with – ends with", 2, 0).missable(1),
    ];
    let mut table = Table::new(&format!("Attractors by rising {}", found.over.value()), columns);
    for attractor in &found.attractors {
        let shares = || attractor.at.iter().map(|at| 100.0 * at.share.value);
        let [least, most] = [shares().fold(f64::INFINITY, f64::min), shares().fold(0.0, f64::max)];
        let share = match (least, most) {
            (least, most) if least.round() == most.round() => format!("{most:.0}"),
            (least, most) if least.is_finite() => format!("{least:.0}–{most:.0}"),
            _ => String::new(),
        };
        let ends = [&attractor.birth, &attractor.death];
        let [from, to] = [0, 1].map(|side| end(found, attractor.range()[side], ends[side].as_ref()));
        let ends = ends.map(|end| end.as_ref().map_or(String::new(), words::transition)).join(" – ");
        table.row([
            attractor.id.as_str().into(),
            from,
            to,
            words::attractor(attractor).into(),
            share.into(),
            ends.into(),
        ]);
    }
    table
}

/// Remarks on each attractor, below the table.
pub(crate) fn remarks(found: &SpeedSurvey) -> impl Iterator<Item = Block> {
    let of_one = |attractor| other_kinds(found, attractor).into_iter().chain(rests(attractor));
    found.attractors.iter().flat_map(of_one).map(Block::paragraph)
}

/// Kinds of an attractor at some values that differ from its most frequent kind.
fn other_kinds(found: &SpeedSurvey, attractor: &AttractorRow) -> Option<String> {
    let all = words::many(attractor.at.len() as u64, found.over.value());
    let others = kinds(&attractor.at).into_iter().filter(|(kind, _)| *kind != attractor.kind);
    let others: Vec<String> = others.map(|(kind, count)| format!("{} at {count}", words::is_of(kind))).collect();
    (!others.is_empty())
        .then(|| format!("{} was seen at {all}: it {} of them.", attractor.id, others.join(" of them and ")))
}

/// Digits of a located value: six decimals for a speed.
fn digits(found: &SpeedSurvey) -> Digits {
    if found.over.is_speed() { Digits::Fixed(6) } else { Digits::Significant(9) }
}

/// Value in the known digits.
fn end(found: &SpeedSurvey, value: f64, change: Option<&Transition>) -> Words {
    /// Largest number of decimals: of a speed, the same as of a located speed; and of another number.
    const MOST: [f64; 2] = [6.0, 12.0];
    let most = MOST[usize::from(!found.over.is_speed())];
    let Some(change) = change else { return words![(value, Digits::UpTo(most as usize))] };
    let places = match open(found, change).map(with_error) {
        Some((digits, error)) if change.error.is_some() => return words![(value, digits), " ± ", (error, digits)],
        Some((digits, _)) => return words![(value, digits), " ± ?"],
        None if change.is_located() => return words![(value, digits(found))],
        None => (-elementary::log10(change.bracket[1] - change.bracket[0])).ceil().clamp(0.0, most),
    };
    words![(value, Digits::Fixed(places as usize))]
}
