//! Follower position once a revolution against speed, with branches of orbits over the attractors of runs; and the states of one long run
//! at the section.

use crate::figures::trace::TRANSIENT;
use crate::figures::{Entry, Fast, FigureContext, SPEED, by_stability, drawn, position};
use crate::show::words;
use corner_impact::flight::State;
use corner_impact::orbit::branch::Branch;
use corner_impact::simulate::SimulateError;
use corner_impact::study::local::Crossings;
use corner_impact_plot::layout::widened;
use corner_impact_plot::{BREAK, Cloud, Colour, Data, Density, Figure, FigureAxis, Marker, Panel, Series, extent};

/// The stroboscopic diagram around the corner impact.
pub(crate) const FAST_SECTION: Entry = Entry {
    id: "fast-section",
    place: "Figure 5(d)",
    takes_rpm: false,
    title: |subject| {
        subject.fast_title("once a revolution around the corner impact", |Fast { range: [low, high], .. }| {
            format!("once a revolution, {low} to {high} rpm")
        })
    },
    draw: |subject, title| {
        let range = subject.shown.fast.clone()?.range;
        let mut runs = Cloud::new(range);
        subject.fast_runs(range, true)?.iter().for_each(|[rpm, position]| runs.push(*rpm, *position));
        let crossings = subject.crossings(subject.branches()?)?;
        let at = &subject.found()?.at;
        let caption = format!(
            "The same runs and orbits, once a revolution: the position of the follower when the cam is at {:.2}°, \
             half a turn from the corner.",
            at.section_angle().to_degrees()
        );
        drawn(section_diagram(title, runs.finish(), &crossings, [at.speed_rpm(), at.state.position]), caption)
    },
};

/// The attractor beyond the corner impact at a fold, where the orbits of the corner impact no longer exist.
pub(crate) const BEYOND_ATTRACTOR: Entry = Entry {
    id: "beyond-attractor",
    place: "",
    takes_rpm: false,
    title: |subject| {
        subject.fast_title("the attractor beyond the corner impact", |fast| {
            format!("the attractor at {} rpm", fast.beyond)
        })
    },
    draw: |subject, title| {
        let rpm = subject.shown.fast.clone()?.beyond;
        let states = subject.section_states(rpm, STATES)?;
        let star = subject.found()?.at.state;
        let caption = format!(
            "States at the section of the map, half a turn from the corner, in {STATES} revolutions of the motion at {rpm} \
             rpm; a periodic motion has only a few points. The orbit of the corner impact has q = {:.4} m, q' = {:.4} m/s there.",
            star.position, star.velocity
        );
        drawn(attractor(title, &states, star), caption)
    },
};

/// Number of states of the attractor.
const STATES: usize = 20_000;

/// Draws positions at the section against speed, with the corner impact at its speed, rpm, and position, m.
fn section_diagram(title: &str, runs: Density, branches: &[Crossings], corner: [f64; 2]) -> Figure {
    let [rpm, all] = runs.ranges();
    let shown = |[speed, _]: &&[f64; 2]| (rpm[0]..=rpm[1]).contains(speed);
    let heights = branches.iter().flat_map(|line| &line.points).chain([&corner]).filter(shown).map(|[_, q]| *q);
    let all = widened(extent(heights.chain(all)), 0.03);
    let mut series = vec![Series::new("runs", Colour::Grey, Data::Density(runs))];
    series.extend(by_stability(words::stability, |stability| {
        let lines = branches.iter().filter(|line| line.stability == stability);
        lines.flat_map(|line| line.points.iter().copied().chain([BREAK])).collect()
    }));
    series.push(Series::points("corner impact", Colour::Ink, Marker::Ring, [corner]));
    let panel = Panel::new(position().over(all), 0.52, series);
    Figure::new(title, FigureAxis::new(SPEED[0], SPEED[1]).over(rpm), vec![panel])
}

/// Draws states of a long run at the section, with the former position of an orbit that no longer exists if it lies among them.
fn attractor(title: &str, states: &[State], gone: State) -> Figure {
    let ends = |value: fn(&State) -> f64| widened(extent(states.iter().map(value)), 0.03);
    let (x, y) = (ends(|state| state.position), ends(|state| state.velocity));
    let mut cloud = Density::new(x, y);
    states.iter().for_each(|state| cloud.push(state.position, state.velocity));
    let at = [gone.position, gone.velocity];
    let inside = (x[0]..=x[1]).contains(&at[0]) && (y[0]..=y[1]).contains(&at[1]);
    let mut series = vec![Series::new("states, once a revolution", Colour::Blue, Data::Density(cloud))];
    if inside {
        series.push(Series::points("x* of the corner impact", Colour::Vermilion, Marker::Disc, [at]));
    }
    Figure::new(title, position().over(x), vec![Panel::new(FigureAxis::new("velocity q'", "m/s").over(y), 0.6, series)])
}

impl FigureContext {
    /// States, once a revolution at the section of the corner impact's map, on which a start at rest on the cam settles.
    pub fn section_states(&self, rpm: f64, revolutions: usize) -> Result<Vec<State>, String> {
        let machine = self.machine(rpm);
        let cam_angle = self.found()?.at.section_angle();
        let run = || {
            let mut motion = machine.start_on_cam(0.0, 0.0)?;
            machine.revolve(&mut motion, TRANSIENT)?;
            let mut states = Vec::with_capacity(revolutions);
            for _ in 0..revolutions {
                machine.turn_to(&mut motion, cam_angle)?;
                states.push(motion.state);
            }
            Ok::<_, SimulateError>(states)
        };
        run().map_err(|error| format!("at {rpm} rpm: {error}"))
    }

    /// Crossings of the orbits of branches with the section of the corner impact's map.
    pub(crate) fn crossings(&self, branches: &[Branch]) -> Result<Vec<Crossings>, String> {
        Ok(Crossings::of(branches, &self.model, &self.cam, &self.found()?.at))
    }
}
