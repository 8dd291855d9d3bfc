//! Shape of the cam, viewed along its axis at angle 0, with the follower straight above the axis.
//!
//! The outline is the contour that the follower touches; for the paper's follower, a point above the axis, it is the lift as a
//! radius. At cam angle `theta` the ray `(sin theta, cos theta)` is on top; the cam turns to the left.

use crate::figures::cam::{corner_marks, corners_in_words, lift_figure, of_circles};
use crate::figures::{Entry, drawn};
use corner_impact::cam::{Cam, Outline, OutlinePiece};
use corner_impact::elementary;
use corner_impact::model::{FollowerContact, Model};
use corner_impact_plot::{BREAK, Beside, Colour, Figure, FigureAxis, Label, Marker, Panel, Series, Stroke};

/// The report's figure of the cam's shape.
pub(crate) const CAM_SHAPE: Entry = Entry {
    id: "cam-shape",
    place: "Figures 3(a) and 9",
    takes_rpm: false,
    title: |subject| format!("{}: the cam, its segments and corners", subject.model.name),
    draw: |subject, title| {
        let outline = Outline::of(&subject.model, &subject.cam);
        let how = match subject.model.cam.contact() {
            Some(FollowerContact::Flat) => {
                "The flat face of the follower is perpendicular to the line straight above the axis O".to_owned()
            }
            Some(FollowerContact::Roller { .. }) => {
                "The thin line is the path of the roller's centre, seen from the cam; the axis is O".to_owned()
            }
            _ if outline.added == 0.0 => {
                "Its outline is the lift as a distance from the axis O: the follower stands on the point straight above O"
                    .to_owned()
            }
            _ => format!(
                "The model gives the lift alone; it is drawn around O with {:.4} {} added, so this is the path of the \
                 follower's foot seen from the cam and not the cut of the metal",
                outline.added,
                subject.model.units.length.name()
            ),
        };
        drawn(
            figure(title, &subject.cam, &outline),
            format!("The cam at angle 0. {how}. {}", corners_in_words(&subject.cam, "Dots on the outline")),
        )
    },
};

/// Circles and top of a cam of three circles, from angle 0 to half a turn, with their colour and stroke.
const CIRCLES: [(&str, Colour, Stroke); 4] = [
    ("base circle", Colour::Ink, Stroke::Solid),
    ("flank", Colour::Blue, Stroke::Dashed),
    ("nose", Colour::Vermilion, Stroke::Thick),
    ("top", Colour::Green, Stroke::Dotted),
];
/// Colours and strokes of other cams' segments, used in rotation.
const OTHERS: [(Colour, Stroke); 3] =
    [(Colour::Blue, Stroke::Solid), (Colour::Vermilion, Stroke::Dashed), (Colour::Green, Stroke::Thick)];
/// Distance below which corners share one label, relative to the largest radius.
const NEAR: f64 = 0.12;
/// Largest number of segments that are drawn separately; with more, the outline is one line.
const MOST: usize = 24;

/// Draws the shape of a model's cam, and the end of the follower on it.
pub fn shape_figure(model: &Model, cam: &Cam, title: &str) -> Figure {
    figure(title, cam, &Outline::of(model, cam))
}

/// Draws lift, velocity and acceleration of a model's cam and, if the lift follows from a contour, its shape below them.
pub fn cam_figure(model: &Model, cam: &Cam, title: &str) -> Figure {
    let figure = lift_figure(cam, title);
    match model.cam.contact() {
        Some(_) => {
            let (x, shape) = shape_panel(cam, &Outline::of(model, cam));
            Figure { panels: figure.panels.into_iter().chain([shape.across(x)]).collect(), ..figure }
        }
        None => figure,
    }
}

fn figure(title: &str, cam: &Cam, outline: &Outline) -> Figure {
    let (x, panel) = shape_panel(cam, outline);
    Figure::new(title, x, vec![panel])
}

/// Draws the outline, the corners, the axis and the follower's direction; with the horizontal axis.
fn shape_panel(cam: &Cam, outline: &Outline) -> (FigureAxis, Panel) {
    let farthest = outline.farthest();
    let mut series = if of_circles(cam) { circles(&outline.pieces) } else { segments(&outline.pieces) };
    let letters = letters(cam, outline, farthest);
    series.push(Series::points("", Colour::Ink, Marker::Dot, letters.iter().map(|word| word.at)));
    // If labels would overlap, the first is kept.
    let mut apart: Vec<Label> = Vec::new();
    for word in letters {
        let near =
            |other: &Label| elementary::hypot(other.at[0] - word.at[0], other.at[1] - word.at[1]) < NEAR * farthest;
        if !apart.iter().any(near) {
            apart.push(word);
        }
    }
    series.push(Series::words(apart));
    // The axis, the follower above it, and an arc for the direction of rotation.
    let first = outline.pieces.first().and_then(|piece| piece.points.first()).map_or(0.0, |[_, y]| *y);
    // The line of a roller starts at its centre.
    let from = outline.pitch.first().copied().unwrap_or([0.0, first]);
    let follower = [from, [from[0], from[1] + 0.45 * farthest]];
    let pitch = if outline.pitch.is_empty() { "" } else { "path of the roller's centre" };
    series.extend([
        Series::line(pitch, Colour::Grey, Stroke::Thin, outline.pitch.iter().copied()),
        Series::line("", Colour::Purple, Stroke::Solid, outline.follower.iter().copied()),
    ]);
    let turn = (0..=24).map(|step| {
        let angle = -0.5 + f64::from(step) / 24.0;
        [-0.25 * farthest * elementary::sin(angle), 0.25 * farthest * elementary::cos(angle)]
    });
    series.extend([
        Series::points("", Colour::Ink, Marker::Disc, [[0.0, 0.0]]),
        Series::arrow("follower, and the way the cam turns", Colour::Purple, Stroke::Thin, follower),
        Series::arrow("", Colour::Purple, Stroke::Thin, turn),
        Series::words([
            Label::new([0.0, 0.0], "O", Beside::BelowRight),
            Label::new(follower[1], "q", Beside::Right),
            Label::new([0.0, 0.25 * farthest], "ω", Beside::Above),
        ]),
    ]);
    let reach = 1.7 * farthest;
    let x = FigureAxis::new("from the axis, across", "m").over([-reach, reach]);
    let y = FigureAxis::new("from the axis, along the follower", "m").over([-1.3 * farthest, 1.3 * farthest]).scaled();
    (x, Panel::new(y, 0.6, series))
}

/// Draws a cam of three circles as the paper does.
fn circles(pieces: &[OutlinePiece]) -> Vec<Series> {
    let mut series = construction(pieces);
    for (index, (label, colour, stroke)) in CIRCLES.into_iter().enumerate() {
        // Base circle, flank, nose, top, nose, flank, base circle.
        let here = pieces.iter().enumerate().filter(|(at, _)| *at == index || at + index == 6);
        let points = here.flat_map(|(_, piece)| piece.points.iter().copied().chain([BREAK]));
        series.push(Series::line(label, colour, stroke, points));
    }
    series
}

fn segments(pieces: &[OutlinePiece]) -> Vec<Series> {
    if pieces.len() > MOST {
        let points = pieces.iter().flat_map(|piece| piece.points.iter().copied());
        return vec![Series::line("", Colour::Blue, Stroke::Solid, points)];
    }
    let ways = OTHERS.into_iter().cycle();
    let line =
        |(piece, (colour, stroke)): (&OutlinePiece, _)| Series::line("", colour, stroke, piece.points.iter().copied());
    pieces.iter().zip(ways).map(line).collect()
}

/// Names of the corners, placed on the outer side of the outline.
fn letters(cam: &Cam, outline: &Outline, farthest: f64) -> Vec<Label> {
    let letter = |mark: &super::CornerMark| {
        let (_, at) = outline.corners.iter().find(|(angle, _)| *angle == mark.angle_rad)?;
        let steep = at[1].abs() > 2.0 * at[0].abs();
        // Moved up if the corner is beside the axis, because the line of centres may be there.
        let low = at[1] < -0.1 * farthest;
        let beside = match (steep, at[0] > 0.0, low) {
            // Beside the follower's line.
            (true, _, false) if at[0].abs() < NEAR * farthest => Beside::AboveLeft,
            (true, _, false) => Beside::Above,
            (true, _, true) => Beside::Below,
            (false, true, false) => Beside::AboveRight,
            (false, true, true) => Beside::BelowRight,
            (false, false, false) => Beside::AboveLeft,
            (false, false, true) => Beside::BelowLeft,
        };
        Some(Label::new(*at, &mark.label(), beside))
    };
    corner_marks(cam).iter().filter_map(letter).collect()
}

/// Centres and radii of flank and nose on the rising side, as the paper constructs them.
fn construction(pieces: &[OutlinePiece]) -> Vec<Series> {
    let (mut lines, mut centres, mut words) = (Vec::new(), Vec::new(), Vec::new());
    for (piece, (text, beside)) in pieces.iter().skip(1).zip([("O_1", Beside::BelowLeft), ("O_2", Beside::Left)]) {
        let (Some(centre), Some(first), Some(last)) = (piece.centre, piece.points.first(), piece.points.last()) else {
            continue;
        };
        lines.extend([*first, centre, *last, BREAK]);
        centres.push(centre);
        words.push(Label::new(centre, text, beside));
    }
    vec![
        Series::line("", Colour::Grey, Stroke::Thin, lines),
        Series::points("", Colour::Grey, Marker::Dot, centres),
        Series::words(words),
    ]
}
