//! diffsol: the Tsitouras 4(5) method with root finding, its state set back to the root and bounced after every impact, as in
//! the book's bouncing ball. The same task and results as `problem.py`, and the same loop.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;
use std::time::{Duration, Instant};

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use serde::Deserialize;
use serde_json::{Value, json};

type Failure = Box<dyn std::error::Error>;

/// As in `problem.py`.
const THROUGH: f64 = 1e-9;
const STANDSTILL: u32 = 1000;
const KEPT: usize = 10_000;
const LOOKS: u32 = 100;

/// What the task says.
#[derive(Deserialize)]
struct Task {
    problem: Problem,
    /// `[cam angle, q, v]` of each run.
    starts: Vec<[f64; 3]>,
    turn: f64,
    tolerance: String,
    restart: bool,
    look: bool,
    repeats: u32,
    seconds: f64,
}

#[derive(Clone, Deserialize)]
struct Problem {
    omega0_squared: f64,
    equilibrium: f64,
    restitution: f64,
    omega: f64,
    /// `[start, distance, direction, radius]`.
    arcs: Vec<[f64; 4]>,
}

impl Problem {
    fn arc_at(&self, theta: f64) -> usize {
        let theta = theta.rem_euclid(TAU);
        self.arcs.iter().rposition(|arc| arc[0] <= theta).unwrap_or(0)
    }

    /// Lift and its slope on a circle.
    fn lift(&self, arc: usize, theta: f64) -> (f64, f64) {
        let [_, distance, direction, radius] = self.arcs[arc];
        let (sin, cos) = (theta - direction).sin_cos();
        let across = distance * sin;
        let root = ((radius - across) * (radius + across)).sqrt();
        (distance * cos + root, -across - across * distance * cos / root)
    }

    fn acceleration(&self, q: f64) -> f64 {
        -self.omega0_squared * (q - self.equilibrium)
    }

    /// The first look at which a flight of length `span`, in closed form, is below the cam: the time since its start.
    fn passed_through(&self, theta: f64, [q, v]: [f64; 2], span: f64) -> Option<f64> {
        let omega0 = self.omega0_squared.sqrt();
        (1..LOOKS).map(|k| span * f64::from(k) / f64::from(LOOKS)).find(|s| {
            let (sin, cos) = (omega0 * s).sin_cos();
            let position = self.equilibrium + (q - self.equilibrium) * cos + v / omega0 * sin;
            let theta = theta + self.omega * s;
            self.lift(self.arc_at(theta), theta).0 - position > THROUGH
        })
    }
}

/// One run; what `problem.py` returns of it, with the seconds that it took.
fn run(task: &Task, start: [f64; 3]) -> Result<(Value, f64, f64), Failure> {
    let problem = task.problem.clone();
    let [start_angle, q0, v0] = start;
    let end = task.turn / problem.omega;
    let angle = |t: f64| start_angle + problem.omega * t;
    let built = Instant::now();

    // The circle that the gap is measured from: the one before the next corner, or whichever the angle says.
    let arc = Rc::new(Cell::new(task.restart.then(|| problem.arc_at(start_angle))));
    let (motion, gap, in_gap) = (problem.clone(), problem.clone(), Rc::clone(&arc));
    let mut builder = OdeBuilder::<NalgebraMat<f64>>::new()
        .rhs(move |y: &[f64], _: &[f64], _: f64, dy: &mut [f64]| {
            dy[0] = y[1];
            dy[1] = motion.acceleration(y[0]);
        })
        .init(
            move |_: &[f64], _: f64, y: &mut [f64]| {
                y[0] = q0;
                y[1] = v0;
            },
            2,
        )
        .root(
            move |y: &[f64], _: &[f64], t: f64, out: &mut [f64]| {
                let theta = start_angle + gap.omega * t;
                let arc = in_gap.get().unwrap_or_else(|| gap.arc_at(theta));
                out[0] = y[0] - gap.lift(arc, theta).0;
            },
            1,
        );
    // The documentation's defaults are 1e-6 and 1e-6; tightest is where it still steps.
    if task.tolerance == "tightest" {
        builder = builder.rtol(1e-14).atol([1e-15]);
    }
    let ode = builder.build()?;
    let mut solver = ode.tsit45()?;
    let setup_s = built.elapsed().as_secs_f64();

    let began = Instant::now();
    let mut looked = Duration::ZERO;
    let (mut impacts, mut count, mut standing) = (Vec::new(), 0, 0);
    let mut took_off = (0.0, [q0, v0]);
    let mut turns = 0.0;
    let corner = |arc: usize, turns: f64| {
        let ends = problem.arcs.get(arc + 1).map_or(TAU, |next| next[0]) + TAU * turns;
        (ends - start_angle) / problem.omega
    };
    let mut ends = arc.get().map_or(end, |arc| corner(arc, turns));
    solver.set_stop_time(ends.min(end))?;
    let mut last = (0.0, [q0, v0]);
    let ended = loop {
        if (began.elapsed() - looked).as_secs_f64() > task.seconds {
            break "time limit".to_string();
        }
        let stopped = match solver.step() {
            Ok(stopped) => stopped,
            Err(error) => break format!("error: {error}"),
        };
        let (t, hit) = match stopped {
            OdeSolverStopReason::InternalTimestep => continue,
            OdeSolverStopReason::RootFound(t, _) => (t, true),
            OdeSolverStopReason::TstopReached => (solver.state().t, false),
        };
        let y = solver.interpolate(t)?;
        let state = [y[0], y[1]];
        if !(t.is_finite() && state[0].is_finite()) {
            break "error: not a number".to_string();
        }
        let over = t >= end;
        if task.look && (hit || over) {
            let look = Instant::now();
            let through = problem.passed_through(angle(took_off.0), took_off.1, t - took_off.0);
            looked += look.elapsed();
            if let Some(after) = through {
                last = (took_off.0 + after, state);
                break "through the cam".to_string();
            }
        }
        if hit {
            let theta = angle(t);
            let (lift, slope) = problem.lift(arc.get().unwrap_or_else(|| problem.arc_at(theta)), theta);
            let cam_velocity = problem.omega * slope;
            let after = cam_velocity + problem.restitution * (cam_velocity - state[1]);
            count += 1;
            if count <= KEPT {
                impacts.push([problem.omega * t, theta.rem_euclid(TAU), state[1], after]);
            }
            // A little above the cam, as the book does: a root that starts at 0 would not be found again.
            let bounced = [lift + f64::EPSILON, after];
            let inner = solver.state_mut();
            inner.y[0] = bounced[0];
            inner.y[1] = bounced[1];
            inner.dy[0] = bounced[1];
            inner.dy[1] = problem.acceleration(bounced[0]);
            *inner.t = t;
            standing = if t == last.0 { standing + 1 } else { 0 };
            (last, took_off) = ((t, bounced), (t, bounced));
            if standing > STANDSTILL {
                break "stands still".to_string();
            }
            // The stop time was for the step that was undone, if it had reached it.
            if t < ends.min(end) {
                solver.set_stop_time(ends.min(end))?;
            }
        } else {
            last = (t, state);
            if over {
                break "done".to_string();
            }
            let next = arc.get().map_or(0, |arc| arc + 1) % problem.arcs.len();
            turns += if next == 0 { 1.0 } else { 0.0 };
            arc.set(Some(next));
            ends = corner(next, turns);
            solver.set_stop_time(ends.min(end))?;
        }
    };
    let wall_s = (began.elapsed() - looked).as_secs_f64();
    let result = json!({
        "impacts": impacts, "count": count, "turned": problem.omega * last.0, "ended": ended,
    });
    Ok((result, wall_s, setup_s))
}

fn main() -> Result<(), Failure> {
    let task: Task = serde_json::from_reader(std::io::stdin())?;
    let mut results = Vec::new();
    for start in &task.starts {
        let (mut walls, mut last, mut setup_s) = (Vec::new(), json!({}), 0.0);
        for _ in 0..task.repeats {
            let (result, wall_s, setup) = match run(&task, *start) {
                Ok(run) => run,
                Err(error) => {
                    let nothing = json!({"impacts": [], "count": 0, "turned": 0.0, "ended": format!("error: {error}")});
                    (nothing, 0.0, 0.0)
                }
            };
            walls.push(wall_s);
            (last, setup_s) = (result, setup);
        }
        last["wall_s"] = json!(walls);
        last["setup_s"] = json!(setup_s);
        results.push(last);
    }
    println!("{}", serde_json::to_string(&results)?);
    Ok(())
}
