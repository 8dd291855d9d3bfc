//! Thinning of lines to no more points than print can show.

/// Largest distance of a thinned line from the omitted points, in units of the page: a thirtieth of a thin line.
const CLOSE: f64 = 0.03;
/// Width of a column, in units of the page. A line that is still too long keeps the first, lowest, highest and last point of each column.
const COLUMN: f64 = 0.5;

/// Splits a line into the runs between its breaks and thins them. Points are on the page; a NaN breaks the line.
///
/// If more than `most` points remain, each run is thinned by columns instead, and may still have more.
pub fn strokes(points: impl IntoIterator<Item = [f64; 2]>, most: usize) -> Vec<Vec<[f64; 2]>> {
    let mut strokes = vec![Vec::new()];
    for point in points {
        if point.iter().any(|part| part.is_nan()) {
            strokes.push(Vec::new());
        } else if let Some(stroke) = strokes.last_mut() {
            stroke.push(point);
        }
    }
    strokes.retain(|stroke| !stroke.is_empty());
    let close: Vec<_> = strokes.iter().map(|stroke| close(stroke)).collect();
    let long = close.iter().map(Vec::len).sum::<usize>() > most;
    if long { strokes.iter().map(|stroke| columns(stroke)).collect() } else { close }
}

/// Omits the points that the line passes anyway. After each kept point, the next is the farthest point visible through the gates, [`CLOSE`]
/// to either side, around all points between (Zhao and Saalfeld's sleeve).
fn close(stroke: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Some((first, rest)) = stroke.split_first() else { return Vec::new() };
    let mut kept = vec![*first];
    let mut anchor = *first;
    let mut last = *first;
    let mut sleeve: Option<Sleeve> = None;
    for point in rest {
        let fits = match &mut sleeve {
            None => true,
            Some(sleeve) => sleeve.admits(anchor, *point),
        };
        if !fits {
            kept.push(last);
            anchor = last;
            sleeve = None;
        }
        if sleeve.is_none() {
            sleeve = Sleeve::towards(anchor, *point);
        }
        last = *point;
    }
    if last != anchor {
        kept.push(last);
    }
    kept
}

/// Range of directions in which a straight line passes all points since the last kept one.
struct Sleeve {
    /// Direction towards the first of these points.
    along: [f64; 2],
    /// Lowest and highest angle from that direction.
    gate: [f64; 2],
    /// Distance of the farthest point.
    reach: f64,
}

impl Sleeve {
    fn towards(anchor: [f64; 2], point: [f64; 2]) -> Option<Self> {
        let along = [point[0] - anchor[0], point[1] - anchor[1]];
        let reach = libm::hypot(along[0], along[1]);
        let open = libm::asin((CLOSE / reach).min(1.0));
        (reach > CLOSE).then_some(Self { along, gate: [-open, open], reach })
    }

    fn admits(&mut self, anchor: [f64; 2], point: [f64; 2]) -> bool {
        let to = [point[0] - anchor[0], point[1] - anchor[1]];
        let distance = libm::hypot(to[0], to[1]);
        let cross = self.along[0] * to[1] - self.along[1] * to[0];
        let angle = libm::atan2(cross, self.along[0] * to[0] + self.along[1] * to[1]);
        let [low, high] = self.gate;
        // At a reversal of the line its farthest point is kept.
        if distance < self.reach || angle < low || angle > high {
            return false;
        }
        let open = libm::asin((CLOSE / distance).min(1.0));
        self.gate = [low.max(angle - open), high.min(angle + open)];
        self.reach = distance;
        true
    }
}

fn columns(stroke: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut thinned = Vec::new();
    for column in stroke.chunk_by(|one, other| (one[0] / COLUMN).floor() == (other[0] / COLUMN).floor()) {
        let extreme = |better: fn(f64, f64) -> bool| {
            (0..column.len()).fold(0, |best, at| if better(column[at][1], column[best][1]) { at } else { best })
        };
        let (lowest, highest) = (extreme(|one, other| one < other), extreme(|one, other| one > other));
        let mut kept = [0, lowest.min(highest), lowest.max(highest), column.len() - 1].map(|at| column[at]).to_vec();
        kept.dedup();
        thinned.append(&mut kept);
    }
    thinned
}
