//! The baseline as a program, for the comparison with other integrators: one JSON document in, one out.
//!
//! In: `model` (a file), `rpm`, `starts` as rows of `[cam angle, q, v]`, `turn` (rad), `repeats`. Out, for each start: `wall_s`
//! of each repeat, `impacts` as rows of `[turned, cam angle, v-, v+]`, `sticks`, `releases`, and where the follower ends.

#[path = "mod.rs"]
mod baseline;

use std::path::Path;
use std::time::Instant;

use baseline::{Baseline, Kind, Place};
use corner_impact::flight::State;
use corner_impact::model::Model;
use serde_json::{Value, json};

fn number(task: &Value, pointer: &str) -> Result<f64, String> {
    task.pointer(pointer).and_then(Value::as_f64).ok_or_else(|| format!("the task has no number {pointer}"))
}

fn run(machine: &Baseline, start: Place, turn: f64, repeats: u64) -> Value {
    let (mut wall_s, mut end) = (Vec::new(), start);
    let (mut impacts, mut sticks, mut releases) = (Vec::new(), 0, 0);
    for _ in 0..repeats {
        (impacts, sticks, releases) = (Vec::new(), 0, 0);
        let began = Instant::now();
        end = machine.run(start, turn, |event| {
            match event.kind {
                Kind::Release => releases += 1,
                Kind::Stick => sticks += 1,
                Kind::Impact => {}
            }
            if event.kind != Kind::Release {
                impacts.push([event.turned, event.cam_angle, event.velocity_before, event.velocity_after]);
            }
        });
        wall_s.push(began.elapsed().as_secs_f64());
    }
    let state = [end.state.position, end.state.velocity];
    json!({
        "wall_s": wall_s, "setup_s": 0.0, "impacts": impacts, "sticks": sticks, "releases": releases,
        "state": state, "turned": turn, "ended": "done",
    })
}

fn answer(task: &Value) -> Result<Vec<Value>, String> {
    let file = task.get("model").and_then(Value::as_str).ok_or("the task names no model")?;
    let model = Model::read(Path::new(file)).map_err(|error| error.to_string())?;
    let machine = Baseline::new(&model, number(task, "/rpm")?)?;
    let turn = number(task, "/turn")?;
    let repeats = task.get("repeats").and_then(Value::as_u64).unwrap_or(1);
    let starts = task.get("starts").and_then(Value::as_array).ok_or("the task has no starts")?;
    let place = |start: &Value| -> Result<Place, String> {
        let state = State { position: number(start, "/1")?, velocity: number(start, "/2")? };
        Ok(Place { cam_angle: number(start, "/0")?, state })
    };
    starts.iter().map(|start| Ok(run(&machine, place(start)?, turn, repeats))).collect()
}

fn main() -> Result<(), String> {
    let task = serde_json::from_reader(std::io::stdin()).map_err(|error| error.to_string())?;
    println!("{}", json!(answer(&task)?));
    Ok(())
}
