//! Is every jump of the lift's derivatives found, at its order, and can a law be continued past it anywhere?

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common::{self, corner_impact};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Cam, Corner, Law, Polynomial, Side};
use corner_impact::model::Model;
use serde_json::Value;

const FOLLOWER: &str =
    "[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 0\nrest_position = 0\nrestitution = 1\n";

fn cam_of(table: &str) -> Cam {
    Cam::new(&Model::parse("test.toml", &format!("{FOLLOWER}[cam]\n{table}")).unwrap()).unwrap()
}

fn law_file(name: &str) -> String {
    Path::new(common::ROOT).join("models/laws").join(name).to_string_lossy().into_owned()
}

fn law_cam(name: &str) -> Cam {
    common::cam(&common::read(Path::new(&law_file(name))))
}

/// Dwell, rise, dwell, return: the motion's own corners besides those at its ends.
fn between_dwells(motion: &str, rise: f64) -> Cam {
    let segment = |motion: &str, span: f64, rise: f64| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span}\nrise = {rise}\n")
    };
    let segments = [
        segment("dwell", 100.0, 0.0),
        segment(motion, 80.0, rise),
        segment("dwell", 100.0, 0.0),
        segment(motion, 80.0, -rise),
    ];
    cam_of(&format!("law = \"program\"\nbase = 0.03\n{}", segments.concat()))
}

#[test]
fn motions_between_dwells_jump_at_their_orders() {
    let expected: [(&str, &[usize], f64); 7] = [
        ("parabolic", &[2, 2, 2], 4.0),
        ("harmonic", &[2, 2], std::f64::consts::PI.powi(2) / 2.0),
        ("cycloidal", &[3, 3], TAU.powi(2)),
        ("modified-trapezoid", &[3, 4, 4, 4, 4, 3], 61.4),
        ("modified-sine", &[3, 4, 4, 3], 69.47),
        ("poly345", &[3, 3], 60.0),
        ("poly4567", &[4, 4], 840.0),
    ];
    // As large as a cam, as small as a scratch on it.
    for rise in [0.02, -1e-6] {
        for (motion, orders, first_jump) in expected {
            let mut corners = between_dwells(motion, rise).corners().to_vec();
            // At 0 the return ends.
            corners.rotate_left(1);
            let found: Vec<usize> = corners.iter().map(|corner| corner.jump_order).collect();
            assert_eq!(found, [orders, orders].concat(), "{motion} {rise}");
            assert_abs_diff_eq!(corners[0].angle, 100.0_f64.to_radians(), epsilon = 1e-15);
            let span = 80.0_f64.to_radians();
            let jump = corners[0].jump * span.powi(orders[0] as i32) / rise;
            assert_relative_eq!(jump, first_jump, max_relative = 1e-3);
        }
    }
}

/// A hump whose n-th derivative is the first to jump, at both its ends, however high n is.
#[test]
fn jumps_of_any_order_are_found() {
    for order in 2..=11_usize {
        // u^n (1 - u)^n over a radian: the n-th derivative jumps by n! at 0, by n! (-1)^(n+1) at 1.
        let mut coefficients = vec![0.0; 2 * order + 1];
        coefficients[0] = 0.1;
        let mut binomial = 1.0;
        for k in 0..=order {
            coefficients[order + k] = 1e-2 * binomial;
            binomial *= -((order - k) as f64) / (k as f64 + 1.0);
        }
        let corners = cam_of(&format!(
            "law = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0\ncoefficients = {coefficients:?}\n\
             [[cam.segment]]\nstart_deg = 57.29577951308232\ncoefficients = [0.1]\n"
        ))
        .corners()
        .to_vec();
        let orders: Vec<usize> = corners.iter().map(|corner| corner.jump_order).collect();
        assert_eq!(orders, [order, order], "{corners:?}");
        let jump = 1e-2 * (1..=order).map(|k| k as f64).product::<f64>();
        assert_relative_eq!(corners[0].jump, jump, max_relative = 1e-9);
        assert_relative_eq!(corners[1].jump, -jump * (-1.0_f64).powi(order as i32), max_relative = 1e-6);
    }
}

#[test]
fn smooth_cams_and_velocity_jumps() {
    assert!(law_cam("harmonic.toml").corners().is_empty());
    // One parabola cut in two is one parabola.
    let cut = "law = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0\ncoefficients = [0.1, 0.0, 0.0]\n\
               [[cam.segment]]\nstart_deg = 180\ncoefficients = [0.1]\n";
    assert!(cam_of(cut).corners().is_empty());
    let sine = law_cam("rectified-sine.toml").corners().to_vec();
    assert_eq!(sine.iter().map(|corner| corner.jump_order).collect::<Vec<_>>(), [1, 1]);
    assert_eq!((sine[0].angle, sine[0].jump), (0.0, 2.0));
    assert_abs_diff_eq!(sine[1].angle, std::f64::consts::PI);
    // The polynomial that goes on through 360 degrees has no corner there.
    let angles: Vec<f64> =
        law_cam("polynomial.toml").corners().iter().map(|corner| corner.angle.to_degrees()).collect();
    assert_eq!(angles, [90.0, 270.0]);
}

#[test]
fn every_row_of_a_table_is_a_corner_of_its_splines_order() {
    for (file, order) in [("table-cubic.toml", 3), ("table-quintic.toml", 5)] {
        let corners = law_cam(file).corners().to_vec();
        assert_eq!(corners.len(), 360);
        assert!(corners.iter().all(|corner| corner.jump_order == order));
    }
    assert_eq!(common::cam(&common::osorio()).corners().iter().filter(|corner| corner.jump_order == 2).count(), 6);
}

/// The law of one side past the corner, the cam as it was before it.
fn is_continued(cam: &Cam, corner: &Corner, reach: f64) {
    let count = cam.segments().len();
    let before = &cam.segments()[(corner.segment + count - 1) % count].law;
    let after = &cam.segments()[corner.segment].law;
    let minus = cam.continued(corner, Side::Minus, reach).unwrap();
    let plus = cam.continued(corner, Side::Plus, reach).unwrap();
    for continued in [&minus, &plus] {
        let segments = continued.segments();
        assert_eq!((segments[0].start, segments[segments.len() - 1].end), (0.0, TAU));
        assert!(segments.windows(2).all(|pair| pair[0].end == pair[1].start));
    }
    for part in 0..10 {
        let offset = reach * (f64::from(part) + 0.5) / 10.0;
        let (ahead, behind) = (corner.angle + offset, corner.angle - offset);
        let wrapped = |angle: f64| if angle < 0.0 { angle + TAU } else { angle };
        // At 0 the segment before counts from 2 pi.
        let turn = if corner.angle == 0.0 { TAU } else { 0.0 };
        let expected = (before.lift(ahead + turn), after.lift(behind));
        let found = (minus.lift(ahead), plus.lift(wrapped(behind)));
        for (expected, found) in [(expected.0, found.0), (expected.1, found.1)] {
            assert_abs_diff_eq!(found.value, expected.value, epsilon = 1e-14);
            assert_abs_diff_eq!(found.slope, expected.slope, epsilon = 1e-14);
            assert_abs_diff_eq!(found.curvature, expected.curvature, epsilon = 1e-12);
        }
        assert_eq!(minus.lift(wrapped(behind)), cam.lift(wrapped(behind)));
        assert_eq!(plus.lift(ahead), cam.lift(ahead));
        // The ranges are those of the new segments.
        for continued in [&minus, &plus] {
            for angle in [ahead, wrapped(behind)] {
                let segment = &continued.segments()[continued.segment_at(angle)];
                let value = continued.lift(angle).value;
                assert!(segment.bounds.lift[0] <= value && value <= segment.bounds.lift[1]);
            }
        }
    }
    // Past the reach, the other law again.
    assert_eq!(minus.lift(corner.angle + 1.5 * reach), cam.lift(corner.angle + 1.5 * reach));
    let back = corner.angle - 1.5 * reach;
    let back = if back < 0.0 { back + TAU } else { back };
    assert_eq!(plus.lift(back), cam.lift(back));
    assert_eq!(cam.segments().len() + usize::from(corner.angle == 0.0), minus.segments().len());
}

#[test]
fn laws_are_continued_past_any_corner() {
    for name in ["rectified-sine.toml", "polynomial.toml"] {
        let cam = law_cam(name);
        for corner in cam.corners() {
            is_continued(&cam, corner, 0.1);
        }
    }
    let cam = law_cam("program.toml");
    for corner in cam.corners().iter().filter(|corner| [0.0, 200.0, 260.0].contains(&corner.angle.to_degrees().round()))
    {
        is_continued(&cam, corner, 0.04);
    }
    // Two halves of cosines that meet at 0.
    let halves = cam_of(
        "law = \"program\"\nbase = 0.1\n[[cam.segment]]\nmotion = \"harmonic\"\nspan_deg = 100\nrise = 0.1\n\
         [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 40\n\
         [[cam.segment]]\nmotion = \"harmonic\"\nspan_deg = 220\nrise = -0.1\n",
    );
    assert_eq!((halves.corners()[0].angle, halves.corners()[0].jump_order), (0.0, 2));
    is_continued(&halves, &halves.corners()[0], 0.1);
    // One segment that meets itself at 0.
    let wrapped = cam_of(
        "law = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0\ncoefficients = [0.1, 0.06283185307179587, -0.01]\n",
    );
    let corners = wrapped.corners();
    assert_eq!((corners.len(), corners[0].jump_order), (1, 1));
    is_continued(&wrapped, &corners[0], 0.1);
    // The corner itself has one lift from both sides, to the last bit: nothing for a follower to fall from.
    let continued = wrapped.continued(&corners[0], Side::Minus, 0.1).unwrap();
    let (first, last) = (&continued.segments()[0], &continued.segments()[continued.segments().len() - 1]);
    assert_eq!(first.law.lift(0.0), last.law.lift(TAU));
    assert!(wrapped.continued(&corners[0], Side::Minus, 4.0).is_none());
    assert!(wrapped.continued(&corners[0], Side::Plus, f64::NAN).is_none());
}

#[test]
fn the_cam_document_lists_segments_and_corners() {
    let output = corner_impact(["cam", "--json", &law_file("program.toml")]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["schema"], "corner-impact/cam/1");
    assert_eq!((&document["law"], &document["model"]), (&"program".into(), &"program".into()));
    let cam = law_cam("program.toml");
    let (segments, corners) = (document["segments"].as_array().unwrap(), document["corners"].as_array().unwrap());
    assert_eq!((segments.len(), corners.len()), (18, 16));
    for (entry, segment) in segments.iter().zip(cam.segments()) {
        assert_eq!(entry["start_deg"], segment.start.to_degrees());
        assert_eq!(entry["end_deg"], segment.end.to_degrees());
        assert_eq!(entry["law"], segment.law.name());
        let highest = entry["lift_m"][1].as_f64().unwrap();
        assert!(highest <= segment.bounds.lift[1] && segment.bounds.lift[1] - highest < 1e-9, "{highest}");
    }
    for (entry, corner) in corners.iter().zip(cam.corners()) {
        assert_eq!(entry["cam_angle_rad"], corner.angle);
        assert_eq!(entry["angle_deg"], corner.angle.to_degrees());
        assert_eq!(entry["jump_order"], corner.jump_order);
        assert_eq!(entry["jump"], corner.jump);
        assert_eq!(entry["lift_m"], corner.plus.value);
        assert_eq!([&entry["slope_before"], &entry["slope_after"]], [corner.minus.slope, corner.plus.slope]);
        assert_eq!(
            [&entry["curvature_before"], &entry["curvature_after"]],
            [corner.minus.curvature, corner.plus.curvature]
        );
    }
    assert_eq!(document["lift_m"][1], 0.064);
    let few = corner_impact(["cam", "--json", "--order", "2", &law_file("program.toml")]);
    let few: Value = serde_json::from_slice(&few.stdout).unwrap();
    assert_eq!((few["corners"].as_array().unwrap().len(), &few["highest_order"]), (4, &2.into()));
}

#[test]
#[ignore = "slow"]
fn the_page_fits_and_counts_what_it_does_not_list() {
    let page = |name: &str| {
        let output = corner_impact(["cam", &law_file(name)]);
        assert!(output.status.code() == Some(0) && output.stderr.is_empty());
        String::from_utf8(output.stdout).unwrap()
    };
    for name in ["contour", "harmonic", "polynomial", "program", "rectified-sine", "table-cubic", "table-quintic"] {
        let page = page(&format!("{name}.toml"));
        assert!(page.lines().all(|line| line.chars().count() <= 100 && !line.ends_with(' ')), "{page}");
        assert!(page.lines().count() < 60, "{page}");
    }
    assert!(page("table-quintic.toml").contains("360 of order 5, with the largest jump"));
    assert!(page("harmonic.toml").contains("No jump was found in the derivatives of the lift up to order 11"));
    assert!(
        page("program.toml")
            .contains("  245.000000      2     0.116722004           0.058    -0.015278875    -0.015278875\n")
    );
}

/// Numbers typed to ten digits leave steps of the tenth where polynomials meet: in the lift and, but where the velocity jumps, in the slope.
/// They are taken out, and the cam is nowhere further from what is typed than all of them together.
#[test]
fn polynomials_that_were_typed_meet_to_the_last_digit() {
    // Two parabolas that meet with one slope at 90 and 270 degrees; and three, of which two meet with one.
    let smooth: [(f64, Vec<f64>); 2] =
        [(90.0, vec![0.1, 0.0628318531, -0.02]), (270.0, vec![0.1, -0.0628318531, 0.02])];
    // The slopes gain something on the way round, which all of it has to take.
    let bent: [(f64, Vec<f64>); 2] =
        [(90.0, vec![0.1, 0.0628318531, -0.019999999995]), (270.0, vec![0.1, -0.0628318531, 0.02])];
    let sharp: [(f64, Vec<f64>); 3] = [
        (0.0, vec![0.1, 0.05, -0.0159154943]),
        (180.0, vec![0.1, 0.02, -0.005]),
        (300.0, vec![0.1199554478, -0.000943951, -0.0172957795]),
    ];
    for (segments, orders) in [(&smooth[..], vec![2, 2]), (&bent[..], vec![2, 2]), (&sharp[..], vec![1, 1, 2])] {
        let written = segments.iter().map(|(start, coefficients)| {
            format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {coefficients:?}\n")
        });
        let cam = cam_of(&format!("law = \"polynomial\"\n{}", written.collect::<String>()));
        let corners: Vec<usize> = cam.corners().iter().map(|corner| corner.jump_order).collect();
        assert_eq!(corners, orders, "{:?}", cam.corners());
        let is_sharp = |angle: f64| cam.corners().iter().any(|corner| corner.angle == angle && corner.jump_order == 1);
        let mut steps: f64 = 0.0;
        for (index, (start, coefficients)) in segments.iter().enumerate() {
            let typed = |u: f64| coefficients.iter().rev().fold(0.0, |sum, a| sum * u + a);
            let (next, turn) = segments.get(index + 1).map_or((&segments[0], 360.0), |next| (next, 0.0));
            let span = (next.0 + turn - start).to_radians();
            steps += (next.1[0] - typed(span)).abs();
            let slope = coefficients[1] + 2.0 * coefficients[2] * span;
            if !is_sharp(next.0.to_radians()) {
                steps += (next.1[1] - slope).abs() * TAU;
            }
        }
        assert!((1e-12..1e-8).contains(&steps), "nothing is typed off: {steps:e}");
        for segment in cam.segments() {
            for part in [0.0, 0.3, 0.7, 1.0] {
                let angle = segment.start + part * (segment.end - segment.start);
                let degrees = angle.to_degrees();
                let (start, coefficients) = segments
                    .iter()
                    .rev()
                    .find(|(start, _)| *start <= segment.start.to_degrees() + 1e-9)
                    .unwrap_or(&segments[segments.len() - 1]);
                let u = (degrees - start).rem_euclid(360.0).to_radians();
                let u = if part == 1.0 && u < 1e-9 { TAU } else { u };
                let typed = coefficients.iter().rev().fold(0.0, |sum, a| sum * u + a);
                assert_abs_diff_eq!(segment.law.lift(angle).value, typed, epsilon = steps);
            }
        }
        for after in 0..cam.segments().len() {
            let (before, next) = (&cam.segments()[cam.before(after)], &cam.segments()[after]);
            let (minus, plus) = (before.law.lift(before.end), next.law.lift(next.start));
            assert_abs_diff_eq!(minus.value, plus.value, epsilon = 1e-16);
            if !is_sharp(next.start) {
                assert_abs_diff_eq!(minus.slope, plus.slope, epsilon = 1e-16);
            }
        }
    }
}

/// The terms of a 3-4-5 motion cancel where it ends, from 6 to 0 in its acceleration: what ten digits leave there is no corner.
#[test]
fn a_motion_that_was_typed_has_the_corners_of_the_motion() {
    let (rise, span) = (0.01, 0.5 * PI);
    let typed = |sign: f64| {
        let coefficient = |a: f64, power: i32| format!("{:.9e}", sign * a * rise / span.powi(power));
        [(10.0, 3), (-15.0, 4), (6.0, 5)].map(|(a, power)| coefficient(a, power)).join(", ")
    };
    let (up, down) = (typed(1.0), typed(-1.0));
    let segments = [
        (0, "0.1".to_owned()),
        (90, format!("0.1, 0, 0, {up}")),
        (180, "0.11".into()),
        (270, format!("0.11, 0, 0, {down}")),
    ];
    let segments = segments.map(|(start, coefficients)| {
        format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = [{coefficients}]\n")
    });
    let polynomial = cam_of(&format!("law = \"polynomial\"\n{}", segments.concat()));
    let motions = [("dwell", 0.0), ("poly345", 0.01), ("dwell", 0.0), ("poly345", -0.01)];
    let motions = motions
        .map(|(motion, rise)| format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = 90.0\nrise = {rise:?}\n"));
    let program = cam_of(&format!("law = \"program\"\nbase = 0.1\n{}", motions.concat()));
    let [found, expected] = [&polynomial, &program].map(|cam| {
        let corners = cam.corners().iter();
        corners.map(|corner| (corner.angle.to_degrees().round(), corner.jump_order)).collect::<Vec<_>>()
    });
    assert_eq!(found, expected);
    for part in 0..720 {
        let angle = f64::from(part).to_radians() / 2.0;
        let [one, other] = [&polynomial, &program].map(|cam| cam.lift(angle));
        // Ten digits of the lift.
        assert_abs_diff_eq!(one.value, other.value, epsilon = 1e-10);
        assert_abs_diff_eq!(one.curvature, other.curvature, epsilon = 1e-9);
    }
}

/// A hump and a hollow, each a parabola over half a turn, with these slopes where they begin.
fn halves(slopes: [f64; 2]) -> (Vec<Law>, Cam) {
    let halves = [0.0, 180.0].into_iter().zip(slopes).map(|(start_deg, slope)| (start_deg, [0.1, slope, -slope / PI]));
    let written = |(start_deg, coefficients): (f64, [f64; 3])| {
        format!("[[cam.segment]]\nstart_deg = {start_deg:?}\ncoefficients = {coefficients:?}\n")
    };
    let law = |(start_deg, coefficients): (f64, [f64; 3])| {
        Law::Polynomial(Polynomial::new(start_deg.to_radians(), &coefficients))
    };
    let text = halves.clone().map(written).collect::<String>();
    (halves.map(law).collect(), cam_of(&format!("law = \"polynomial\"\n{text}")))
}

/// What is typed to all digits of a double stays as it is, to the last bit.
#[test]
fn polynomials_that_meet_are_left_as_they_are() {
    for slope in [0.06, 0.0123, 0.001] {
        let (typed, cam) = halves([slope, -slope]);
        let laws: Vec<Law> = cam.segments().iter().map(|segment| segment.law.clone()).collect();
        assert_eq!(laws, typed);
    }
    // The terms of a 3-4-5 motion leave rounding where they cancel, of which a dwell would get a slope.
    let span = 0.5 * PI;
    let powers = [(10.0, 3), (-15.0, 4), (6.0, 5)].map(|(a, power): (f64, i32)| 0.01 * a / span.powi(power));
    let [up, down] = [1.0, -1.0].map(|sign| powers.map(|a| sign * a));
    let rise = |from: f64, [a3, a4, a5]: [f64; 3]| vec![from, 0.0, 0.0, a3, a4, a5];
    let segments = [(0.0_f64, vec![0.1]), (90.0, rise(0.1, up)), (180.0, vec![0.11]), (270.0, rise(0.11, down))];
    let written = segments.iter().map(|(start, coefficients)| {
        format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {coefficients:?}\n")
    });
    let cam = cam_of(&format!("law = \"polynomial\"\n{}", written.collect::<String>()));
    for (segment, (start, coefficients)) in cam.segments().iter().zip(&segments) {
        assert_eq!(segment.law, Law::Polynomial(Polynomial::new(start.to_radians(), coefficients)));
    }
}

/// Slopes that part by five parts in 1e9, which is more than ten digits leave of three times a slope.
#[test]
fn slopes_that_were_meant_to_part_make_a_corner() {
    for (parts_by, order) in [(5e-9, 1), (2e-9, 2)] {
        let (_, cam) = halves([0.06, -0.06 * (1.0 + parts_by)]);
        let orders: Vec<usize> = cam.corners().iter().map(|corner| corner.jump_order).collect();
        assert_eq!(orders, [order; 2], "{parts_by:e}: {:?}", cam.corners());
    }
}
