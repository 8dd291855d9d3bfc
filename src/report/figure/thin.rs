//! Lines with no more points than print can show.

/// Half a unit of the page: points in one such column are shown by the first, lowest, highest and last of them.
const COLUMN: f64 = 0.5;

/// The runs of a line between its breaks, thinned; points are on the page, and what is not a number breaks the line.
pub fn strokes(points: impl IntoIterator<Item = [f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut strokes = Vec::new();
    let mut stroke = Vec::new();
    let mut column: Vec<[f64; 2]> = Vec::new();
    for point in points {
        let broken = point.iter().any(|part| part.is_nan());
        let same = column.first().is_some_and(|first| (first[0] / COLUMN).floor() == (point[0] / COLUMN).floor());
        if broken || !same {
            stroke.append(&mut column);
        }
        if broken {
            finish(&mut strokes, &mut stroke);
        } else if column.len() < 4 {
            column.push(point);
        } else {
            merge(&mut column, point);
        }
    }
    stroke.append(&mut column);
    finish(&mut strokes, &mut stroke);
    strokes
}

fn finish(strokes: &mut Vec<Vec<[f64; 2]>>, stroke: &mut Vec<[f64; 2]>) {
    // Points in one place are one point.
    stroke.dedup();
    if !stroke.is_empty() {
        strokes.push(std::mem::take(stroke));
    }
}

/// Adds a point to a full column: the first and the last stay, of those between only the extremes, in their order.
fn merge(column: &mut Vec<[f64; 2]>, point: [f64; 2]) {
    let between = [column[1], column[2], column[3]];
    let lowest = (0..3).fold(0, |best, at| if between[at][1] < between[best][1] { at } else { best });
    let highest = (0..3).fold(0, |best, at| if between[at][1] > between[best][1] { at } else { best });
    let (one, other) = (lowest.min(highest), lowest.max(highest));
    *column = vec![column[0], between[one], between[other], point];
}
