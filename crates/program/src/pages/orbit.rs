//! Page of `orbit`: each periodic orbit, its multipliers, and its impacts on the cam.

use corner_impact::known::{Complete, Evidence};

use crate::pages::some_of;
use crate::show::block::{Block, Span, TextMark, Words, words};
use crate::show::digits::{Digits, with_error};
use crate::show::sources::Sources;
use crate::show::{Paged, words};
use corner_impact::orbit::{Course, Eigenvalue, PeriodicOrbit, Stability, Undecided};
use corner_impact::study::orbit::{OrbitErrors, OrbitUncertainty, Orbits};

impl Paged for Orbits {
    fn blocks(&self) -> Vec<Block> {
        let count = match self.orbits.len() {
            0 => "no periodic orbit".into(),
            1 => "1 periodic orbit".into(),
            count => format!("{count} periodic orbits"),
        };
        let title = format!("{} at {} rpm: {count} found", self.model, self.speed_rpm);
        let mut page = vec![Block::Line((TextMark::Heading, title.as_str()).into())];
        for (index, orbit) in self.orbits.iter().enumerate() {
            let error = self.errors.get(index).copied().flatten();
            page.extend(one(index + 1, orbit, error.as_ref().map(|error| &error.total)));
            page.extend(sources(self).map(|sources| left_open(sources, error.as_ref())));
        }
        if self.orbits.iter().any(|orbit| orbit.impacts().next().is_some()) {
            page.push(Block::paragraph(
                "q and v are the follower's position and velocity. At an impact, v is given before and after it, not relative to the cam.",
            ));
        }
        page.extend(self.complete.iter().map(complete));
        page.extend(some_of(&self.undecided, "place", undecided));
        page.extend(how_known(&self.orbits));
        page.extend(words::hypotheses(&self.hypotheses).map(Block::paragraph));
        page.extend(sources(self).map(|sources| Block::paragraph(sources.note())));
        if self.measured.is_some() && !self.complete.is_empty() {
            page.push(Block::paragraph("The proofs are for the cam as it is drawn through the rows."));
        }
        page
    }
}

/// States whether other orbits are possible.
fn complete(of: &Complete) -> Block {
    let (impacts, turns) = (words::many(of.impacts as u64, "impact"), words::many(of.revolutions, "revolution"));
    let others = match of.known {
        Evidence::Proved => "it is proved that there are no others",
        _ => "there may be others where the proof does not decide",
    };
    Block::paragraph(format!("Orbits of {impacts} in {turns}: {others}."))
}

fn undecided(at: &Undecided) -> Words {
    let angles = at.cam_angles.iter().map(|ends| words::range(ends.map(f64::to_degrees), Digits::Fixed(6)));
    format!("Not decided: impacts at {} deg.", angles.collect::<Vec<_>>().join(" and ")).into()
}

/// States which results about the orbits are proved, and which are only computed.
fn how_known(orbits: &[PeriodicOrbit]) -> Option<Block> {
    let proved = orbits.iter().filter(|orbit| orbit.known == Evidence::Proved).count();
    let judged = orbits.iter().filter(|orbit| orbit.judgement.known == Evidence::Proved).count();
    (proved > 0).then(|| {
        Block::paragraph(format!(
            "Proved: the existence of {proved} of these orbits, and the stability or instability of {judged}. The digits are computed."
        ))
    })
}

/// Sources of the uncertainty of the orbits.
fn sources(found: &Orbits) -> Option<Sources<'_>> {
    Sources::of(&found.measured, found.deviations).if_any().filter(|_| !found.errors.is_empty())
}

/// Uncertainty of an orbit's numbers, and its cause.
fn left_open(sources: Sources<'_>, error: Option<&OrbitUncertainty>) -> Block {
    let (why, machines) = (sources.why(), sources.machines());
    let Some(OrbitUncertainty { total: error, cam, numbers }) = error else {
        return Block::paragraph(format!(
            "The uncertainty is unknown: equally likely {machines} have no such orbit nearby ({why})."
        ));
    };
    let of = |error: f64| Digits::Aligned(2).text(error);
    let [position, velocity] = error.state.map(of);
    let mut text = words![
        format!("± {} in a multiplier, {position} ", of(error.multiplier)),
        Span::Unit("m"),
        format!(" and {velocity} "),
        Span::Unit("m/s"),
        " at cam angle 0"
    ];
    if error.velocity_m_s > 0.0 {
        let (angle, velocity) = (of(error.cam_angle_rad.to_degrees()), of(error.velocity_m_s));
        text.push(words![
            format!(", {angle} deg and {velocity} "),
            Span::Unit("m/s"),
            " where it meets or leaves the cam"
        ]);
    }
    text.push(format!(": {why}."));
    if sources.cam.is_some() && !sources.errors.are_none() {
        let [cam, numbers] = [cam, numbers].map(|part| of(part.multiplier));
        text.push(format!(" Of a multiplier's ±, {cam} is from the cam and {numbers} from the numbers."));
    }
    Block::paragraph(text)
}

/// Given number of places, or fewer if the uncertainty is larger.
fn known(places: usize, error: Option<f64>) -> Digits {
    match error.filter(|error| *error > 0.0).map(|error| with_error(error).0) {
        Some(Digits::Fixed(left)) => Digits::Fixed(left.min(places)),
        _ => Digits::Fixed(places),
    }
}

fn one(number: usize, orbit: &PeriodicOrbit, error: Option<&OrbitErrors>) -> Vec<Block> {
    /// Largest number of impacts shown for an orbit.
    const SHOWN: usize = 8;
    let impacts = orbit.impacts().count();
    let turns = words::many(orbit.revolutions, "revolution");
    let what = match orbit.course {
        Course::Sticking(_) => "sticks to the cam".to_owned(),
        Course::Free => "stays clear of the cam".to_owned(),
        Course::Impacts(_) => words::many(impacts as u64, "impact"),
    };
    let largest = orbit.multipliers().map(Eigenvalue::modulus).into_iter().fold(0.0, f64::max);
    let stability = orbit.judgement.stability;
    let stable = match stability {
        Stability::Neutral => (TextMark::Doubtful, words::stability(stability)),
        _ if error.is_some_and(|error| (largest - 1.0).abs() <= error.multiplier) => {
            (TextMark::Doubtful, "stable or unstable: its ± does not decide")
        }
        Stability::Stable => (TextMark::Good, words::stability(stability)),
        Stability::Unstable => (TextMark::Doubtful, words::stability(stability)),
    };
    let ten = known(10, Some(error.map_or(orbit.judgement.error, |error| error.multiplier)));
    let [one, two] = orbit.multipliers().map(|multiplier| Span::Complex([multiplier.re, multiplier.im], ten));
    let multipliers = match orbit.course {
        Course::Sticking(_) if orbit.judgement.error.is_nan() => {
            "     multipliers   none: with restitution 1 no bounce ends in a rest".into()
        }
        _ => words!["     multipliers   ", one, "   ", two],
    };
    let q = known(12, error.map(|error| error.state[0])).text(orbit.state.position);
    let v = known(9, error.map(|error| error.state[1])).text(orbit.state.velocity);
    let mut lines = vec![
        Block::Gap,
        Block::Line(words![format!("  {number}. {turns}, {what}, "), stable]),
        Block::Line(multipliers),
        Block::Line(words![
            format!("     at cam angle 0   q = {q} "),
            Span::Unit("m"),
            format!(", v = {v} "),
            Span::Unit("m/s")
        ]),
    ];
    let mut line = |text: Words| lines.push(Block::Line(text));
    let of_angle = known(6, error.map(|error| error.cam_angle_rad.to_degrees()));
    let of_velocity = known(6, error.map(|error| error.velocity_m_s));
    for impact in orbit.impacts().take(SHOWN) {
        let (angle, turn) = (of_angle.text(impact.cam_angle.to_degrees()), impact.revolution);
        let (before, after) = (of_velocity.text(impact.velocity_before), of_velocity.text(impact.velocity_after));
        let text = format!("     impact at {angle:>10} deg of revolution {turn}  v {before:>12} -> {after} ");
        line(words![text, Span::Unit("m/s")]);
    }
    if impacts > SHOWN {
        let speeds = orbit.impacts().map(|impact| ((impact.velocity_before - impact.cam_velocity).abs(), impact));
        let mut more = words![format!("     and {} more", impacts - SHOWN)];
        if let Some((speed, impact)) = speeds.max_by(|one, two| one.0.total_cmp(&two.0)) {
            let (angle, speed) = (of_angle.text(impact.cam_angle.to_degrees()), of_velocity.text(speed));
            let hardest = format!("; the hardest is at {angle} deg: {speed} ");
            more.push(words![hardest, Span::Unit("m/s"), " relative to the cam"]);
        }
        line(more);
    }
    for rest in orbit.rests() {
        let (angle, turn) = (of_angle.text(rest.cam_angle.to_degrees()), rest.revolution);
        line(format!("     {:<7} at {angle:>10} deg of revolution {turn}", rest.kind.name()).into());
    }
    lines
}
