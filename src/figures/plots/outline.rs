//! The cam as a shape, its segments and corners, the axis and the follower's direction.

use crate::cam::Cam;
use crate::draw::{Axis, Beside, Colour, Data, Figure, Marker, Series, Stroke, Word};
use crate::figures::Outline;
use crate::figures::outline::Piece;
use crate::figures::plots::cam::{corner_marks, of_circles};
use crate::figures::plots::panel;

/// The circles of a cam of three circles and its top, in order from angle 0 to half a turn, and how they are drawn.
const CIRCLES: [(&str, Colour, Stroke); 4] = [
    ("base circle", Colour::Ink, Stroke::Solid),
    ("flank", Colour::Blue, Stroke::Dashed),
    ("nose", Colour::Vermilion, Stroke::Thick),
    ("top", Colour::Green, Stroke::Dotted),
];
/// Other cams: one way after another.
const OTHERS: [(Colour, Stroke); 3] =
    [(Colour::Blue, Stroke::Solid), (Colour::Vermilion, Stroke::Dashed), (Colour::Green, Stroke::Thick)];
/// Corners nearer to one another than this share of the farthest point get one label.
const NEAR: f64 = 0.12;
/// More segments than this are one line.
const MOST: usize = 24;

/// The outline of `cam`, with its corners.
pub fn outline_figure(title: &str, cam: &Cam, outline: &Outline) -> Figure {
    let (marks, of_circles) = (corner_marks(cam), of_circles(cam, &cam.corners()));
    let mut series: Vec<Series> = Vec::new();
    let named = |label: &str, colour, data| Series { label: label.into(), colour, data };
    let unnamed = |colour, data| named("", colour, data);
    let farthest =
        outline.pieces.iter().flat_map(|piece| &piece.points).fold(0.0_f64, |far, [x, y]| far.max(x.hypot(*y)));
    if of_circles {
        series.extend(construction(&outline.pieces));
        for (index, (label, colour, stroke)) in CIRCLES.into_iter().enumerate() {
            // Base circle, flank, nose, top, nose, flank, base circle.
            let here = outline.pieces.iter().enumerate().filter(|(at, _)| *at == index || at + index == 6);
            let points = here.flat_map(|(_, piece)| piece.points.iter().copied().chain([[f64::NAN; 2]])).collect();
            series.push(named(label, colour, Data::Line { points, stroke }));
        }
    } else if outline.pieces.len() <= MOST {
        for (index, piece) in outline.pieces.iter().enumerate() {
            let (colour, stroke) = OTHERS[index % OTHERS.len()];
            series.push(unnamed(colour, Data::Line { points: piece.points.clone(), stroke }));
        }
    } else {
        let points = outline.pieces.iter().flat_map(|piece| piece.points.iter().copied()).collect();
        series.push(unnamed(Colour::Blue, Data::Line { points, stroke: Stroke::Solid }));
    }
    // Towards where the outline goes on outside of it.
    let letters = marks.iter().filter_map(|mark| {
        let (_, at) = outline.corners.iter().find(|(angle, _)| *angle == mark.angle_rad)?;
        let steep = at[1].abs() > 2.0 * at[0].abs();
        // A little up where it is beside the axis: the line of centres may run there.
        let low = at[1] < -0.1 * farthest;
        let beside = match (steep, at[0] > 0.0, low) {
            // Beside the follower's own line.
            (true, _, false) if at[0].abs() < NEAR * farthest => Beside::AboveLeft,
            (true, _, false) => Beside::Above,
            (true, _, true) => Beside::Below,
            (false, true, false) => Beside::AboveRight,
            (false, true, true) => Beside::BelowRight,
            (false, false, false) => Beside::AboveLeft,
            (false, false, true) => Beside::BelowLeft,
        };
        Some(Word { at: *at, text: mark.label(), beside })
    });
    let letters: Vec<Word> = letters.collect();
    let corners = letters.iter().map(|word| word.at).collect();
    // Of labels that would cover one another the first stays.
    let mut apart: Vec<Word> = Vec::new();
    for word in letters {
        let near = |other: &Word| (other.at[0] - word.at[0]).hypot(other.at[1] - word.at[1]) < NEAR * farthest;
        if !apart.iter().any(near) {
            apart.push(word);
        }
    }
    let letters = apart;
    series.push(unnamed(Colour::Ink, Data::Points { points: corners, marker: Marker::Dot }));
    series.push(unnamed(Colour::Ink, Data::Words(letters)));
    // The axis, the follower above it, and a stretch of a circle for the way that the cam turns.
    let first = outline.pieces.first().and_then(|piece| piece.points.first()).map_or(0.0, |[_, y]| *y);
    let follower = vec![[0.0, first], [0.0, first + 0.45 * farthest]];
    let turn = (0..=24).map(|step| {
        let angle = -0.5 + f64::from(step) / 24.0;
        [-0.25 * farthest * angle.sin(), 0.25 * farthest * angle.cos()]
    });
    series.push(unnamed(Colour::Ink, Data::Points { points: vec![[0.0, 0.0]], marker: Marker::Disc }));
    series.push(named(
        "follower, and the way the cam turns",
        Colour::Purple,
        Data::Arrow { points: follower, stroke: Stroke::Thin },
    ));
    series.push(unnamed(Colour::Purple, Data::Arrow { points: turn.collect(), stroke: Stroke::Thin }));
    let words = vec![
        Word { at: [0.0, 0.0], text: "O".into(), beside: Beside::BelowRight },
        Word { at: [0.0, first + 0.45 * farthest], text: "q".into(), beside: Beside::Right },
        Word { at: [0.0, 0.25 * farthest], text: "ω".into(), beside: Beside::Above },
    ];
    series.push(unnamed(Colour::Ink, Data::Words(words)));
    let reach = 1.7 * farthest;
    Figure {
        title: title.into(),
        x: Axis::new("from the axis, across", "m").over([-reach, reach]),
        marks: Vec::new(),
        panels: vec![panel(
            Axis::new("from the axis, along the follower", "m").over([-1.12 * farthest, 1.3 * farthest]).to_scale(),
            0.6,
            series,
            Vec::new(),
        )],
        note: String::new(),
    }
}

/// Centres and radii of flank and nose on the way up, as the paper constructs them.
fn construction(pieces: &[Piece]) -> Vec<Series> {
    let (mut lines, mut centres, mut words) = (Vec::new(), Vec::new(), Vec::new());
    for (piece, (text, beside)) in pieces.iter().skip(1).zip([("O_1", Beside::BelowLeft), ("O_2", Beside::Left)]) {
        let (Some(centre), Some(first), Some(last)) = (piece.centre, piece.points.first(), piece.points.last()) else {
            continue;
        };
        lines.extend([*first, centre, *last, [f64::NAN; 2]]);
        centres.push(centre);
        words.push(Word { at: centre, text: text.into(), beside });
    }
    let series = |data| Series { label: String::new(), colour: Colour::Grey, data };
    vec![
        series(Data::Line { points: lines, stroke: Stroke::Thin }),
        series(Data::Points { points: centres, marker: Marker::Dot }),
        Series { colour: Colour::Ink, ..series(Data::Words(words)) },
    ]
}
