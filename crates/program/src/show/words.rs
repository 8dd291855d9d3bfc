//! Words for enums: one name of each value on all pages.
//!
//! A value has the name of its serialization in JSON and in tables.

use std::borrow::Borrow;

use crate::show::block::{Span, TextMark, Words, words};
use crate::show::digits::Digits;
use corner_impact::agreement::Quantity;
use corner_impact::border_collision::conditions::Decides;
use corner_impact::border_collision::danger::{Danger, DangerKind, Divergence, LocalAttractor, Returns};
use corner_impact::border_collision::feigin::{Classification, Scenario, Speeds};
use corner_impact::border_collision::long_run::{LocalChaos, LocalLongRun};
use corner_impact::border_collision::validity::{ComparedMotion, Ends};
use corner_impact::cam::Side;
use corner_impact::corner::map::RouteName;
use corner_impact::covering::UnprovedFlight;
use corner_impact::covering::prove::Relation;
use corner_impact::known::Evidence;
use corner_impact::measured::Measured;
use corner_impact::model::{Holds, Reading, Separator, Units};
use corner_impact::orbit::Stability;
use corner_impact::orbit::branch::{self, Bifurcation, Doubt, FirstTouch, GrazeClass};
use corner_impact::orbit::long_run::{Kind, LongRun};
use corner_impact::published::Verdict;
use corner_impact::study::attractors::{Cause, Transition};
use corner_impact::study::speeds::AttractorRow;
use corner_impact::study::survey::Wandering;

/// Name of a route.
pub(crate) fn route(name: RouteName) -> String {
    spoken(&name.to_string())
}

/// A quantity by its name in documents, which a browser typesets as the paper writes it.
pub(crate) fn quantity(quantity: Quantity) -> Words {
    match quantity {
        Quantity::Speed | Quantity::Border => Span::Quoted(quantity.to_string()).into(),
        _ => Span::Formula(quantity.to_string()).into(),
    }
}

/// Plural of an event's name.
pub(crate) fn events(kind: branch::SpecialKind) -> &'static str {
    kind.bifurcation().map_or("points", |event| match event {
        Bifurcation::Corner => "corner impacts",
        Bifurcation::Fold => "folds",
        Bifurcation::Flip => "flips",
        Bifurcation::Graze => "grazes",
        Bifurcation::Detachment => "detachments",
        Bifurcation::Resting => "onsets of resting",
    })
}

/// Description of the motions beyond the graze of an orbit without impacts, to follow the name of the graze.
pub(crate) fn first_touch(touch: FirstTouch, units: &Units) -> String {
    let beyond = match (touch.class, touch.back, touch.doubt) {
        (GrazeClass::Jump, Some((passages, depth)), _) => {
            let (passages, depth) = (many(passages, "passage"), Digits::Significant(2).text(depth));
            let unit = units.spelled("m");
            format!(
                "no attractor is nearby: {passages} of the cam's top after an impact, a harder one follows, \
                 up to a depth of about {depth} {unit}"
            )
        }
        (GrazeClass::PeriodAdding, ..) => {
            "stable orbits of one impact, in more and more revolutions towards the graze, with ranges that overlap"
                .into()
        }
        (GrazeClass::PeriodAddingChaos, ..) => {
            "stable orbits of one impact, in more and more revolutions towards the graze, with chaos between them"
                .into()
        }
        (GrazeClass::Chaos, ..) => "chaos of impacts that shrink towards the graze".into(),
        (_, _, doubt) => doubt.map_or("", doubted).to_owned(),
    };
    format!(" {}; class {}: {beyond}", touch_side(touch.larger), touch.class)
}

/// Side of the parameter on which the cam reaches a follower at rest.
pub(crate) fn touch_side(larger: bool) -> &'static str {
    if larger { "at larger values" } else { "at smaller values" }
}

/// Reason why the class of a graze is undecided.
fn doubted(doubt: Doubt) -> &'static str {
    match doubt {
        Doubt::Sharp => "the cam's velocity jumps at its top",
        Doubt::Flat => "the cam's top is not a parabola",
        Doubt::Places => "the cam is highest at several places that are not alike",
        Doubt::Unheld => "nothing returns the follower to its place",
        Doubt::Resonance => "the follower's oscillation is in resonance with the cam",
        Doubt::Boundary => "the eigenvalue is at the boundary of two classes",
    }
}

/// The names of several events, as alternatives.
pub(crate) fn any_of(events: &[Bifurcation]) -> String {
    let word = |event: &Bifurcation| match event {
        Bifurcation::Corner => "corner impact",
        Bifurcation::Fold => "fold",
        Bifurcation::Flip => "flip",
        Bifurcation::Graze => "graze",
        Bifurcation::Detachment => "detachment",
        Bifurcation::Resting => "onset of resting",
    };
    events.iter().map(word).collect::<Vec<_>>().join(" or ")
}

/// Number of decimals that two values share.
pub(crate) fn shared(decimals: Option<u32>) -> String {
    match decimals {
        Some(1) => "1 decimal".into(),
        Some(decimals) => format!("{decimals} decimals"),
        None => "all digits".into(),
    }
}

/// Returns a name with spaces for its hyphens and underscores. A formula, which already has spaces, is unchanged.
pub(crate) fn spoken(name: &str) -> String {
    if name.contains(' ') { name.to_owned() } else { name.replace(['_', '-'], " ") }
}

/// Name of a verdict in the ledger.
pub(crate) fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::Definition => "definition",
        Verdict::InPart => "in part",
        Verdict::Misprint => "misprint",
        Verdict::Refuted => "refuted",
        Verdict::Open => "open",
    }
}

/// Counts of the statements with an independent error, and of those that are wrong because of an earlier error.
pub(crate) fn slips((slips, consequences): (usize, usize)) -> String {
    let counted = |count: usize, word: &str| format!("{count} {word}{}", if count == 1 { "" } else { "s" });
    format!("{} and {}", counted(slips, "slip"), counted(consequences, "consequence"))
}

/// Verdict of the ledger, with its mark.
pub(crate) fn verdict(verdict: Verdict) -> Words {
    (mark(verdict), verdict_word(verdict)).into()
}

/// Mark of a verdict in the ledger.
pub(crate) fn mark(verdict: Verdict) -> TextMark {
    match verdict {
        Verdict::Holds | Verdict::Definition => TextMark::Good,
        Verdict::Misprint | Verdict::InPart => TextMark::Doubtful,
        Verdict::Refuted => TextMark::Bad,
        Verdict::Open => TextMark::Open,
    }
}

/// Effect of a border collision, depending on whether a fixed point of either side is stable and on the danger.
pub(crate) fn meaning(scenario: Scenario, has_stable: bool, danger: Option<&Danger>) -> &'static str {
    match scenario {
        Scenario::Persistence if danger.is_some_and(|danger| danger.kind == DangerKind::Dangerous) => {
            "the fixed point crosses from one side to the other, but its basin shrinks to nothing at omega*"
        }
        Scenario::Persistence if danger.is_some() => {
            "the fixed point crosses from one side to the other, and other attractors shrink to it at omega*"
        }
        Scenario::Persistence => "the fixed point crosses from one side to the other",
        Scenario::NonsmoothFold if has_stable => {
            "the two fixed points meet at omega* = 60/T* rpm and vanish: beyond it, a motion has no fixed point to follow"
        }
        Scenario::NonsmoothFold => {
            "the two fixed points meet at omega* = 60/T* rpm and vanish. Both are unstable. Any attractor that the local map \
             has beside them can be lost there"
        }
        Scenario::NonsmoothFlip => {
            "the fixed point crosses from one side to the other, and an orbit of period two is born"
        }
    }
}

/// Scenario with the kind of danger, if any.
pub(crate) fn verdict_with(scenario: &str, danger: Option<&Danger>) -> String {
    match danger.map(|danger| danger.kind) {
        Some(DangerKind::Dangerous) => format!("{scenario}, dangerous"),
        Some(DangerKind::MultipleAttractors) => format!("{scenario}, multiple attractors"),
        None => scenario.into(),
    }
}

/// Verdict on a border collision in words: the scenario, its danger, and the orbit of period two that a fold may have beside it.
pub(crate) fn border_collision(kind: &Classification, danger: Option<&Danger>) -> String {
    format!("{}{}", verdict_with(&kind.scenario.to_string(), danger), beside(kind.scenario, kind.period_two_orbit))
}

/// Orbit of period two beside the fixed points, as the end of a verdict. A nonsmooth flip has one by definition.
pub(crate) fn beside(scenario: Scenario, period_two_orbit: bool) -> &'static str {
    if period_two_orbit && scenario != Scenario::NonsmoothFlip { ", with an orbit of period two" } else { "" }
}

/// Describes a danger in a sentence.
pub(crate) fn danger(danger: &Danger) -> Words {
    match &danger.divergence {
        Some(Divergence { share, known, follows }) => {
            let which = if *share == 1.0 && *known != Evidence::Sampled {
                "every motion of the local map diverges there".into()
            } else {
                let least = if *known == Evidence::Sampled { "" } else { "at least " };
                let percent = (1000.0 * share).floor() / 10.0;
                format!("motions of the local map diverge there, from {least}{percent} % of the directions")
            };
            let follows = follows.as_ref().map_or_else(String::new, |(word, multiplier)| {
                format!(", along the sequence {word} by a factor of {multiplier:.6} per period")
            });
            format!("dangerous: the basin shrinks to nothing at omega*, since {which} ({known}){follows}").into()
        }
        None => {
            let at = |speeds| {
                let names: Vec<String> = danger.at(speeds).map(local_attractor).collect();
                (names.len() > 1).then(|| format!("{}: {}", self::speeds(Some(speeds)), names.join(", ")))
            };
            let sides: Vec<String> = [Speeds::Faster, Speeds::Slower].into_iter().filter_map(at).collect();
            let known = danger.known;
            format!(
                "several attractors meet at omega* ({known}), {}; near omega* the smallest disturbance selects one of them",
                sides.join("; ")
            )
            .into()
        }
    }
}

/// An attractor of the local map.
fn local_attractor(attractor: &LocalAttractor) -> String {
    attractor.word().map_or_else(|| attractor.end.name().into(), ToString::to_string)
}

/// Disturbances of the attractors of a local map that return, one line for each attractor.
pub(crate) fn returns(danger: &Danger) -> Vec<Words> {
    let line = |attractor: &LocalAttractor| {
        let Returns { position, velocity, any } = attractor.returns?;
        let size = |size: Option<f64>, unit: &'static str| match size {
            Some(size) => words![(size, Digits::Power(3)), " ", Span::Unit(unit)],
            None => "any size".into(),
        };
        let name = format!("{}, {}", speeds(Some(attractor.speeds)), local_attractor(attractor));
        Some(Words::prose(
            "{} recovers from a disturbance of {} in position, {} in velocity, or {} in both, for each rpm from omega* (sampled)",
            [name.into(), size(position, "m"), size(velocity, "m/s"), size(any, "m")],
        ))
    };
    danger.attractors.iter().filter_map(line).collect()
}

/// Condition on a strip.
pub(crate) fn relation(relation: Relation) -> &'static str {
    match relation {
        Relation::Apart => "the condition that N is a parallelogram above the cam, with its strips inside and apart,",
        Relation::Flight => "the condition that each flight ends with the first impact",
        Relation::Edges => "the condition that the images of its edges lie beyond N",
        Relation::Height => "the condition that no part of its image lies above or below N",
        Relation::Cones => "the condition that cones are mapped into cones",
        Relation::Losses => "the condition that impacts or flights have losses",
    }
}

/// Reason why nothing is proved about a flight.
pub(crate) fn unproved(why: UnprovedFlight) -> &'static str {
    match why {
        UnprovedFlight::NoImpact => "the follower may stay on the cam, or not return to it for long",
        UnprovedFlight::NotTransversal => "the next impact may be a graze",
        UnprovedFlight::NotFirst => "the follower may meet the cam earlier",
    }
}

/// List of numbers.
pub(crate) fn listed(items: &[impl ToString]) -> String {
    let numbers: Vec<String> = items.iter().map(ToString::to_string).collect();
    match numbers.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => numbers.concat(),
    }
}

pub(crate) fn stability(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Unstable => "unstable",
        Stability::Neutral => "neutral",
    }
}

/// Speeds below or above the corner-impact speed, or that speed itself.
pub(crate) fn speeds(speeds: Option<Speeds>) -> &'static str {
    match speeds {
        Some(Speeds::Faster) => "above omega*",
        Some(Speeds::Slower) => "below omega*",
        None => "at omega*",
    }
}

/// Position of the impact on a side of the corner.
pub(crate) fn side(side: Side) -> &'static str {
    match side {
        Side::Minus => "impact before the corner",
        Side::Plus => "impact after the corner",
    }
}

/// Statement that depends on a condition.
pub(crate) fn decides(decides: Decides) -> &'static str {
    match decides {
        Decides::Classification => "classification",
        Decides::Stability => "stability",
        Decides::NormalForm => "normal form",
        Decides::RobustChaos => "theorem of robust chaos",
    }
}

/// Quantity that a prediction of the local map is about.
pub(crate) fn compared(compared: ComparedMotion) -> &'static str {
    match compared {
        ComparedMotion::OneRevolution => "a turn from x*",
        ComparedMotion::FixedPointMinus => "fixed point minus",
        ComparedMotion::FixedPointPlus => "fixed point plus",
    }
}

/// Reason for the end of a prediction's range, to follow the position of the end.
pub(crate) fn ends(ends: Ends) -> &'static str {
    match ends {
        Ends::Differs => "",
        Ends::OtherMotion => ", where the real motion ends",
        Ends::Nothing => ", the furthest that was tried",
    }
}

/// Ending of the motions of the local map.
pub(crate) fn end(end: &LocalLongRun) -> Words {
    let growth = |what: &str, value, error| {
        let four = Digits::Fixed(4);
        words![what, ", Lyapunov exponent ", (value, four), " +- ", (error, four), " per turn"]
    };
    match end {
        LocalLongRun::Periodic(orbit) if end.fixed_on().is_some() => {
            format!("on the fixed point {}", orbit.word).into()
        }
        LocalLongRun::Periodic(orbit) => format!("on the orbit {}", orbit.word).into(),
        LocalLongRun::Chaotic(LocalChaos { exponent, .. }) => growth("chaotic", exponent.value, exponent.error),
        LocalLongRun::Undecided(exponent) => growth("bounded so far, undecided", exponent.value, exponent.error),
        LocalLongRun::Corner => "to the corner impact".into(),
        LocalLongRun::Escapes(_) => format!("without bound ({})", end.basis()).into(),
    }
}

/// Long-term motion of the follower.
pub(crate) fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Stays => "stays on the cam",
        Kind::Periodic => "periodic",
        Kind::Resting => "rests in each period",
        Kind::Chaotic => "chaotic",
        Kind::Undecided => "undecided",
    }
}

/// Kind of motion as a predicate: `is chaotic`, `rests in each period`.
pub(crate) fn is_of(kind: Kind) -> String {
    let is = if matches!(kind, Kind::Stays | Kind::Resting) { "" } else { "is " };
    format!("{is}{}", self::kind(kind))
}

pub(crate) fn many(count: u64, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A motion with its period in revolutions of the cam and in impacts.
pub(crate) fn motion(kind: Kind, revolutions: Option<u64>, impacts: Option<u64>) -> String {
    let turns = |n: u64| if n == 1 { "a revolution".to_owned() } else { many(n, "revolution") };
    match (kind, revolutions, impacts) {
        (Kind::Periodic, Some(_), Some(0)) => "never meets the cam".into(),
        (Kind::Periodic, Some(n), Some(impacts)) => format!("{} in {}", many(impacts, "impact"), turns(n)),
        (Kind::Resting, Some(1), _) => "rests in each revolution".into(),
        (Kind::Resting, Some(n), _) => format!("rests, period {}", many(n, "revolution")),
        (Kind::Resting, None, _) => "rests now and then".into(),
        _ => self::kind(kind).into(),
    }
}

/// Ending of starts, for a legend.
pub(crate) fn ending(ending: &LongRun) -> String {
    let period = ending.period();
    motion(ending.kind(), period.map(|(revolutions, _)| revolutions), period.map(|(_, impacts)| impacts))
}

/// Name of a long-run motion with its evidence: the number of revolutions for which chaotic or undecided runs were followed, and whether any
/// of them rested on the cam.
pub(crate) fn followed(ending: &LongRun, revolutions: u64, rested: bool) -> String {
    let words = self::ending(ending);
    match ending {
        // A chaotic run may rest in between, even at its start.
        LongRun::Chaotic(recorded) if recorded.rested || rested => {
            format!("{words} (rests occurred, but nothing repeated in {revolutions} revolutions)")
        }
        LongRun::Chaotic(_) => format!("{words} (no rest in {revolutions} revolutions)"),
        LongRun::Undecided(_) => format!("{words} after {revolutions} revolutions"),
        LongRun::Sticking(orbit) if orbit.is_long() => {
            format!("{words} (transient chaos: once in {:.0} revolutions)", orbit.between_rests())
        }
        _ => words,
    }
}

/// Number of revolutions for which runs were followed, for the title of a figure.
pub(crate) fn followed_for(each: impl Iterator<Item = u64>) -> String {
    let range = each.fold(None, |range: Option<[u64; 2]>, one| {
        Some(range.map_or([one; 2], |[low, high]| [low.min(one), high.max(one)]))
    });
    match range {
        Some([one, other]) if one == other => format!(", seen for {}", many(one, "revolution")),
        Some([low, high]) => format!(", seen for {low} to {high} revolutions"),
        None => String::new(),
    }
}

/// Sentence on transient chaos, if some of the wandering runs left it.
pub(crate) fn transient_chaos(wandering: &Wandering) -> Option<String> {
    let Wandering { revolutions, left, .. } = *wandering;
    (left > 0).then(|| {
        format!(
            "transient chaos: {left} of the runs that did not settle left the chaos for good in {revolutions} revolutions, so all of them do sooner or later"
        )
    })
}

/// Description of an attractor over a range.
pub(crate) fn attractor(row: &AttractorRow) -> String {
    motion(row.kind, row.revolutions, row.impacts)
}

/// Event that begins or ends an attractor.
pub(crate) fn transition(transition: &Transition) -> String {
    match transition.cause {
        Cause::Fold => "fold".into(),
        Cause::SymmetryBreaking => "symmetry breaking".into(),
        Cause::Flip => "flip".into(),
        Cause::Graze { impacts: [before, after] } => format!("graze, {before} and {after} impacts"),
        Cause::CornerImpact { cam_angle, .. } => format!("corner impact at {:.2} deg", cam_angle.to_degrees()),
        Cause::Detachment => "detachment".into(),
        Cause::Runs => "by runs".into(),
    }
}

/// Text of a range, or of one number if both ends look alike.
pub(crate) fn range(ends: [f64; 2], digits: Digits) -> String {
    match ends.map(|end| digits.text(end)) {
        [from, to] if from == to => from,
        [from, to] => format!("{from} to {to}"),
    }
}

/// States that the noise of the rows of a table is unknown, and why.
pub(crate) fn noise_unknown(why: &str) -> String {
    format!(
        "The noise of the rows is unknown: no smooth motion could be fitted to them (it {why}). The cam is the spline through \
         the rows, and its results have no ± from the table."
    )
}

/// Accuracy of a table of lifts: its rounding, or the spread of its lifts.
pub(crate) fn accuracy(measured: &Measured) -> String {
    let reading = &measured.reading;
    match reading.step.filter(|_| measured.is_rounded()) {
        Some(step) => format!("{} rounded to {step} {}", reading.holds.value(), reading.unit),
        None => known_to(reading, measured.noise_m),
    }
}

/// Accuracy of a table that is not rounded, from the spread of its lifts, m. The cause is measurement, or rows too far apart for the cam's
/// motion.
pub(crate) fn known_to(reading: &Reading, noise: f64) -> String {
    format!(
        "{} known to {} {}",
        reading.holds.value(),
        Digits::Aligned(2).text(reading.in_model.told(noise)),
        reading.unit
    )
}

/// Interpretation of the rows of a table, in three lines for checking: its text, its angles and its lifts.
pub(crate) fn reading(reading: &Reading) -> [String; 3] {
    let layout = reading.layout.as_ref();
    let column = |index: usize| layout.map_or_else(String::new, |layout| format!("column {}, ", layout.columns[index]));
    let mut table = vec![format!("{} rows", reading.rows)];
    if let Some(layout) = layout {
        let parted = match layout.separator {
            Separator::Comma => "commas",
            Separator::Semicolon => "semicolons",
            Separator::Tab => "tabs",
            Separator::Bar => "bars",
            Separator::Blanks => "blanks",
        };
        let decimals = if layout.decimal_comma { ", with decimal commas" } else { "" };
        table.push(format!("columns separated by {parted}{decimals}"));
        table.push(match &layout.header {
            Some(header) => format!("the header is \"{header}\""),
            None => "there is no header".into(),
        });
        table.extend(layout.units.as_ref().map(|units| format!("the units are \"{units}\"")));
        for (count, what) in [(layout.comments, "comment"), (layout.titles, "title")] {
            match count {
                0 => {}
                1 => table.push(format!("1 {what} is left out")),
                count => table.push(format!("{count} {what}s are left out")),
            }
        }
    }
    let are_points = reading.holds == Holds::Points;
    let unit = reading.part.as_ref().unwrap_or(&reading.unit);
    let mut angles = vec![format!("{}in {}", column(0), if are_points { unit } else { reading.angle_unit })];
    if let Some(turn) = reading.turn_deg {
        angles.push(format!("{turn} deg are one turn of the cam"));
    }
    if reading.falls {
        angles.push("they fall, and are read backwards".into());
    }
    if reading.first_deg != 0.0 {
        angles.push(format!("they begin at {} deg, apart from whole turns", Digits::UpTo(6).text(reading.first_deg)));
    }
    if reading.merged > 0 {
        angles.push(format!("{} of them repeat the row before", reading.merged));
    }
    if reading.repeats_first {
        angles.push("the last row repeats the first".into());
    }
    if reading.is_mirrored {
        let nose = reading.nose_deg.map(|nose| format!(" about {} deg", Digits::UpTo(6).text(nose)));
        angles.push(format!("half a lobe, and its mirror image{}", nose.unwrap_or_default()));
    }
    if reading.filled > 0 {
        angles.push(format!("{} rows are added on the base circle", reading.filled));
    }
    let mut lifts = vec![format!("{}in {unit}", column(1))];
    if let Some(layout) = layout.filter(|layout| !layout.left_out.is_empty()) {
        lifts.push(format!("columns left out: {}", layout.left_out.join(", ")));
    }
    if let Some(number) = layout.and_then(|layout| layout.thousands.as_ref()) {
        let [decimal, whole] = [".", ""].map(|sign| number.replace([',', '.'], sign));
        let signs = if number.contains(',') { "commas" } else { "points" };
        lifts.push(match layout.is_some_and(|layout| layout.has_parted) {
            true => format!(
                "{number} is read as {whole}, as the whole numbers beside it show; if it is {decimal}, write them with decimals, too"
            ),
            false => format!("{number} is read as {decimal}; if {signs} separate thousands, it is {whole}: remove them"),
        });
    }
    let [first, second] = if are_points { ["x", "y"] } else { ["angles", reading.holds.values()] };
    [("table", table), (first, angles), (second, lifts)].map(|(name, parts)| format!("{name}: {}", parts.join("; ")))
}

/// Hypotheses of the proofs on a page, in one sentence; `None` if there are none.
pub fn hypotheses(all: &[impl Borrow<str>]) -> Option<String> {
    (!all.is_empty()).then(|| format!("Hypotheses: {}.", all.join("; ")))
}
