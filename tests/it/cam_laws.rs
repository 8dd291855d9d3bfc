//! Does every lift law give the lift, the derivatives, the rises and the ranges that its formula says?

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Arc, Cam, Harmonics, Law, Lift, OffsetArc, Polynomial, Sinusoid};
use corner_impact::model::{HarmonicProfile, Model, StandardMotion};

/// One model file for every law but `arcs`, which all others have.
fn law_files() -> Vec<PathBuf> {
    let folder = Path::new(common::ROOT).join("models/laws");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    let names: Vec<String> = files.iter().map(|file| common::stem(file)).collect();
    assert_eq!(
        names,
        ["contour", "harmonic", "polynomial", "program", "rectified-sine", "table-cubic", "table-quintic"]
    );
    files
}

/// A cam from the text of its table, or what is wrong with it.
fn read(table: &str) -> Result<Cam, String> {
    let follower =
        "[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 0\nrest_position = 0\nrestitution = 1\n";
    let model = Model::parse("test.toml", &format!("{follower}[cam]\n{table}")).map_err(|error| error.to_string())?;
    Cam::new(&model).map_err(|error| error.to_string())
}

fn cam_of(table: &str) -> Cam {
    read(table).unwrap()
}

/// One motion and what undoes it.
fn motion(name: &str, span_deg: f64, rise: f64) -> Cam {
    cam_of(&format!(
        "law = \"program\"\nbase = 0.05\n[[cam.segment]]\nmotion = \"{name}\"\nspan_deg = {span_deg}\nrise = {rise}\n\
         [[cam.segment]]\nmotion = \"{name}\"\nspan_deg = {}\nrise = {}\n",
        360.0 - span_deg,
        -rise
    ))
}

/// A law, an angle, derivatives 0 to 3 and 5 there, and rises from there by five turns; 60-digit arithmetic.
type Reference = (Law, f64, [f64; 5], [f64; 5]);

const TURNS: [f64; 5] = [1e-12, 1e-6, 1e-3, 0.1, -0.2];

fn references() -> Vec<Reference> {
    let sinusoid = Sinusoid { start: 0.3, value: 0.1, tilt: 0.02, sine: 0.03, cosine: 0.01, frequency: 3.5 };
    let profile =
        HarmonicProfile { offset: 0.1, amplitudes: vec![0.02, 0.001, 0.004], phases_deg: vec![30.0, -70.0, 10.0] };
    vec![
        (
            Law::Arc(Arc { distance: 0.45, direction: 4.7, radius: 0.85 }),
            1.9,
            [0.41252612393396042, 0.074338514572236035, 0.2292781246307123, 0.1015237415473857, -0.16158643138457721],
            [
                7.4338514572350672e-14,
                7.4338629211315267e-8,
                7.4453170566971969e-5,
                0.0085983275163966362,
                -0.010398277769553475,
            ],
        ),
        (
            Law::OffsetArc(OffsetArc { distance: 0.45, direction: 4.7, radius: 0.85, offset: 0.12 }),
            1.9,
            [0.42544374437850329, 0.13539846017647512, 0.2175391231402102, 0.079144355949524703, -0.37787995933449674],
            [
                1.353984601765839e-13,
                1.3539856894604989e-7,
                0.00013550724293722296,
                0.014641544954619643,
                -0.022819974040244959,
            ],
        ),
        (
            Law::Polynomial(Polynomial::new(0.3, &[0.2, -0.05, 0.3, 0.7, -0.4, 0.1])),
            0.9,
            [0.38513600000000002, 0.78519999999999998, 1.8239999999999998, 0.59999999999999945, 12.000000000000001],
            [
                7.8520000000091197e-13,
                7.8520091200009995e-7,
                0.0007861120999001,
                0.087731000000000002,
                -0.12155200000000001,
            ],
        ),
        (
            Law::Sinusoid(sinusoid),
            0.9,
            [0.16415218004653237, 0.20822116881569562, 0.25538579442997853, -1.0194593179922714, 12.488376645405324],
            [
                2.0822116881582331e-13,
                2.0822129650842291e-7,
                0.00020834869167277524,
                0.021917191429905601,
                -0.035415343375188579,
            ],
        ),
        (
            Law::Harmonics(Harmonics::new(&profile)),
            2.0,
            [
                0.086740842621848671,
                -0.010997525096599963,
                -0.015747979913013974,
                0.0027197015045243604,
                0.08244218250120237,
            ],
            [
                -1.0997525096607837e-14,
                -1.0997532970589466e-8,
                -1.100539862115416e-5,
                -0.0011768243828219031,
                0.0018998411563891294,
            ],
        ),
    ]
}

#[test]
fn derivatives_and_rises_against_sixty_digits() {
    for (law, angle, derivatives, rises) in references() {
        let (lift, jet) = (law.lift(angle), law.jet(angle));
        let found = [lift.value, lift.slope, lift.curvature, lift.third, jet.0[5]];
        for (found, expected) in found.into_iter().zip(derivatives) {
            assert_relative_eq!(found, expected, max_relative = 2e-14);
        }
        for (order, found) in found.into_iter().take(4).enumerate() {
            assert_relative_eq!(jet.0[order], found, max_relative = 2e-14);
        }
        // However short the turn.
        for (turn, expected) in TURNS.into_iter().zip(rises) {
            assert_relative_eq!(law.rise(angle, turn), expected, epsilon = 0.0, max_relative = 1e-14);
        }
    }
    // Off a dwell, where velocity and acceleration are 0: a third power of the turn.
    let cycloid =
        Law::Sinusoid(Sinusoid { start: 0.3, value: 0.1, tilt: 0.0, sine: 0.03, cosine: 0.0, frequency: 3.5 });
    for (turn, expected) in [
        (1e-9, 2.1437500000000003e-28),
        (1e-3, 2.143748686953508e-10),
        (0.28, 0.004485078885240887),
        (0.5, 0.022980421593781892),
    ] {
        assert_relative_eq!(cycloid.rise(0.3, turn), expected, epsilon = 0.0, max_relative = 2e-15);
    }
}

/// Each derivative is the rate of the one before: every law, every segment, ends included.
#[test]
fn every_derivative_is_the_rate_of_the_one_before() {
    for file in law_files() {
        let cam = common::cam(&common::read(&file));
        for segment in cam.segments() {
            let law = &segment.law;
            let span = segment.end - segment.start;
            for part in 0..=8 {
                let angle = segment.start + span * f64::from(part) / 8.0;
                let h = 1e-3 * span;
                let (behind, ahead) = (law.lift(angle - h), law.lift(angle + h));
                let lift = law.lift(angle);
                // Difference quotients are off by h^2/6 of the rate's second derivative, and by rounding over h.
                let ranges = &segment.bounds;
                let size = |range: [f64; 2]| range[1].abs().max(range[0].abs());
                let rounding = |value: f64, rate: f64| 4e-15 * value / h + 1e-9 * rate;
                let jets = [law.jet(angle - h), law.jet(angle), law.jet(angle + h)];
                let rate = |order: usize| jets.iter().fold(0.0_f64, |rate, jet| rate.max(jet.0[order].abs()));
                let quotient = |behind: f64, ahead: f64| (ahead - behind) / (2.0 * h);
                for (quotient, expected, order, value) in [
                    (quotient(behind.value, ahead.value), lift.slope, 3, size(ranges.lift)),
                    (quotient(behind.slope, ahead.slope), lift.curvature, 4, size(ranges.slope)),
                    (quotient(behind.curvature, ahead.curvature), lift.third, 5, size(ranges.curvature)),
                ] {
                    assert_abs_diff_eq!(
                        quotient,
                        expected,
                        epsilon = 0.2 * h * h * rate(order) + rounding(value, rate(order - 2))
                    );
                }
                let jet = law.jet(angle);
                for (order, value) in [lift.value, lift.slope, lift.curvature, lift.third].into_iter().enumerate() {
                    let scale = [size(ranges.lift), size(ranges.slope), size(ranges.curvature), ranges.third][order];
                    assert_abs_diff_eq!(jet.0[order], value, epsilon = 1e-12 * scale);
                }
            }
        }
    }
}

/// A Taylor sum up to the third derivative is a cubic itself.
#[test]
fn a_little_further_on_the_lift_is_that_of_its_derivatives() {
    let lift = Lift { value: 1.0, slope: 2.0, curvature: 3.0, third: 6.0 };
    assert_eq!(lift.after(2.0), Lift { value: 19.0, slope: 20.0, curvature: 15.0, third: 6.0 });
}

/// High derivatives, each as the difference quotient of the one before.
#[test]
fn high_derivatives_follow_from_one_another() {
    for (law, angle, _, _) in references() {
        let h = 1e-5;
        let (behind, at, ahead) = (law.jet(angle - h), law.jet(angle), law.jet(angle + h));
        for order in 0..12 {
            let quotient = (ahead.0[order] - behind.0[order]) / (2.0 * h);
            let scale = at.0[order].abs() + at.0[order + 1].abs() + ahead.0[order + 1].abs();
            assert_abs_diff_eq!(quotient, at.0[order + 1], epsilon = 1e-7 * scale);
        }
    }
}

/// Ranges hold every sample, and are hardly wider than what samples fill.
#[test]
#[ignore = "slow"]
fn ranges_hold_the_lift_and_its_derivatives_closely() {
    for file in law_files().into_iter().chain(common::model_files()) {
        let cam = common::cam(&common::read(&file));
        let mut top = f64::NEG_INFINITY;
        for segment in cam.segments() {
            let samples = 2000;
            let mut filled = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
            for sample in 0..=samples {
                let part = f64::from(sample) / f64::from(samples);
                let lift = segment.law.lift(segment.start + (segment.end - segment.start) * part);
                for (filled, value) in filled.iter_mut().zip([lift.value, lift.slope, lift.curvature, lift.third]) {
                    *filled = [filled[0].min(value), filled[1].max(value)];
                }
            }
            let bounds = &segment.bounds;
            for ([low, high], [least, most]) in [bounds.lift, bounds.slope, bounds.curvature].into_iter().zip(filled) {
                assert!(low <= least && most <= high, "{file:?}: {low} {least} {most} {high}");
                let room = 1e-3 * (most - least) + 1e-12;
                assert!(least - low <= room && high - most <= room, "{file:?}: {low} {least} {most} {high}");
            }
            let third = filled[3][1].max(-filled[3][0]);
            assert!(third <= bounds.third && bounds.third <= 1.5 * third + 1e-9, "{file:?}: {third} {}", bounds.third);
            top = top.max(filled[0][1]);
        }
        assert!(top <= cam.top() && cam.top() <= top + 1e-3, "{file:?}");
    }
}

/// The bound on the third derivative holds on every stretch, long or short, and is close on short ones.
#[test]
fn bounds_on_the_third_derivative() {
    for (law, middle, _, _) in references() {
        for reach in [1e-9, 1e-4, 0.01, 0.1, 0.5] {
            let bound = law.third_bound(middle - reach, middle + reach);
            let at = |sample: i32| law.lift(middle + reach * f64::from(sample) / 500.0).third.abs();
            let largest = (-500..=500).map(at).fold(0.0, f64::max);
            assert!(largest <= bound, "{law:?} {reach}: {largest} {bound}");
            let slack = if reach < 0.05 { 1.2 } else { 12.0 };
            assert!(bound <= slack * largest + 0.1 * reach, "{law:?} {reach}: {largest} {bound}");
        }
    }
    // A circle that holds the axis is met all round.
    for (distance, radius) in [(0.02, 0.05), (-0.3, 0.4)] {
        let arc = Law::Arc(Arc { distance, direction: 0.3, radius });
        for (middle, reach) in [0.0, 0.9, 2.0, 4.5]
            .into_iter()
            .flat_map(|middle| [1.0, 1.7, 2.4, 3.0, PI, 6.0].map(|reach| (middle, reach)))
        {
            let at = |sample: i32| middle + reach * f64::from(sample) / 500.0;
            let largest = |of: &dyn Fn(f64) -> f64| (-500..=500).map(|sample| of(at(sample)).abs()).fold(0.0, f64::max);
            let (from, to) = (middle - reach, middle + reach);
            assert!(
                largest(&|angle| arc.lift(angle).third) <= arc.third_bound(from, to),
                "{distance} {middle} {reach}"
            );
            assert!(largest(&|angle| arc.jet(angle).0[4]) <= arc.fourth_bound(from, to), "{distance} {middle} {reach}");
        }
    }
    // A ray misses a circle that does not hold the axis.
    let arc = Law::Arc(Arc { distance: 0.5, direction: 0.0, radius: 0.1 });
    assert!(arc.third_bound(-0.1, 0.1).is_finite());
    assert_eq!(arc.third_bound(0.1, 0.21), f64::INFINITY);
    assert_eq!(arc.third_bound(-2.0, 2.0), f64::INFINITY);
}

/// By the high derivatives that tell corners apart, which are found another way. Somewhere each bound is nearly met: one
/// smaller by a fifth would not be one.
#[test]
fn bounds_on_the_fourth_derivative() {
    let arc = |distance: f64, radius: f64| Law::Arc(Arc { distance, direction: 0.0, radius });
    let arcs = [arc(0.45, 0.85), arc(-0.45, 0.85), arc(0.404, 0.15), arc(0.1, 0.4)];
    let mut laws: Vec<(Law, f64)> = references().into_iter().map(|(law, middle, _, _)| (law, middle)).collect();
    for arc in arcs {
        laws.extend((0..=20).map(|sample| (arc.clone(), 0.015 * f64::from(sample))));
    }
    let mut nearest = std::collections::BTreeMap::new();
    for (law, middle) in laws {
        for reach in [1e-9, 1e-4, 0.01, 0.1, 0.5] {
            let bound = law.fourth_bound(middle - reach, middle + reach);
            let at = |sample: i32| law.jet(middle + reach * f64::from(sample) / 500.0).0[4].abs();
            let largest = if bound.is_finite() { (-500..=500).map(at).fold(0.0, f64::max) } else { 0.0 };
            assert!(largest <= bound * (1.0 + 1e-12), "{law:?} {middle} {reach}: {largest} {bound}");
            let nearest: &mut f64 = nearest.entry(law.name()).or_insert(0.0);
            *nearest = nearest.max(largest / bound.max(f64::MIN_POSITIVE));
        }
    }
    let loose = |(name, nearest): &(&&str, &f64)| **name != "dwell" && **nearest < 0.8;
    assert_eq!(nearest.iter().find(loose), None, "{nearest:?}");
    assert_eq!(arc(0.5, 0.1).fourth_bound(0.1, 0.21), f64::INFINITY);
}

/// An arc or a sinusoid that is a million times as large has bounds that are, to the last bit where that is a power of two.
#[test]
fn bounds_of_a_law_are_as_large_as_it_is() {
    let arc = |distance: f64, radius: f64, size: f64| {
        Law::Arc(Arc { distance: distance * size, direction: 0.3, radius: radius * size })
    };
    let sinusoid = |frequency: f64, size: f64| {
        let (value, tilt, sine, cosine) = (0.1 * size, 0.02 * size, 0.3 * size, -0.2 * size);
        Law::Sinusoid(Sinusoid { start: 0.3, value, tilt, sine, cosine, frequency })
    };
    let laws: [&dyn Fn(f64) -> Law; 6] = [
        &|size| arc(0.45, 0.85, size),
        &|size| arc(-0.45, 0.85, size),
        &|size| arc(0.404, 0.15, size),
        &|size| arc(0.1, 0.4, size),
        &|size| sinusoid(1.0, size),
        &|size| sinusoid(7.3, size),
    ];
    for law in laws {
        let (one, size) = (law(1.0), 2.0_f64.powi(20));
        for sample in 0..60 {
            let middle = 0.1 * f64::from(sample);
            for reach in [1e-9, 1e-4, 0.01, 0.1, 0.5, 2.0] {
                let bounds = |law: &Law| {
                    let (from, to) = (middle - reach, middle + reach);
                    [law.third_bound(from, to), law.fourth_bound(from, to)]
                };
                for larger in [size, 1.0 / size] {
                    assert_eq!(bounds(&law(larger)), bounds(&one).map(|bound| bound * larger), "{middle} {reach}");
                }
            }
            // What is farther from a middle is bounded by no less.
            let fourth = |part: i32| one.fourth_bound(middle - 0.02 * f64::from(part), middle + 0.02 * f64::from(part));
            for part in 1..80 {
                assert!(fourth(part + 1) >= fourth(part) * (1.0 - 1e-12), "{middle} {part}");
            }
        }
    }
}

/// The least of what lift and derivatives make with any weights is that of a fine scan, of a cam of six hundred cosines and of a small one too, and is where it says.
#[test]
#[ignore = "slow"]
fn the_least_is_that_of_a_scan() {
    let amplitudes: Vec<f64> = (1..=600).map(|k| 0.1 * f64::from(k * k % 7 - 3) / f64::from(k * k)).collect();
    let phases: Vec<f64> = (1..=600).map(|k| f64::from(k * 47 % 360)).collect();
    let waves =
        cam_of(&format!("law = \"harmonic\"\noffset = 0.5\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}\n"));
    let cams = law_files().into_iter().chain(common::model_files()).map(|file| common::cam(&common::read(&file)));
    let small = cam_of("law = \"harmonic\"\noffset = 1e-6\namplitudes = [1e-6, 3e-7]\nphases_deg = [10.0, 50.0]\n");
    for cam in cams.chain([waves, small]) {
        let lifts: Vec<Vec<Lift>> = cam
            .segments()
            .iter()
            .map(|segment| {
                let count = 50 + (4000.0 * (segment.end - segment.start)) as u32;
                let part = |index: u32| (segment.end - segment.start) * f64::from(index) / f64::from(count);
                (0..=count).map(|index| segment.law.lift(segment.start + part(index))).collect()
            })
            .collect();
        for weights in [
            [1.0, 0.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.3, -0.1, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.2, 0.1, 0.4, -0.1],
        ] {
            let [a0, a1, a2, a3] = weights;
            let value = |lift: &Lift| a0 * lift.value + a1 * lift.slope + a2 * lift.curvature + a3 * lift.third;
            let values = lifts.iter().map(|segment| segment.iter().map(value).collect::<Vec<_>>());
            let (mut least, mut step, mut size) = (f64::INFINITY, 0.0_f64, 0.0_f64);
            for segment in values {
                step = segment.windows(2).fold(step, |step, pair| step.max((pair[1] - pair[0]).abs()));
                (least, size) = segment
                    .iter()
                    .fold((least, size), |(least, size), value| (least.min(*value), size.max(value.abs())));
            }
            let found = cam.least(weights);
            assert!(found.value <= least + 1e-13 * size, "{weights:?}: {found:?}, and {least}");
            assert!(found.value >= least - step, "{weights:?}: {found:?}, and {least}");
            let lift = cam.segments()[found.segment].law.lift(found.angle);
            assert_eq!((value(&lift), lift), (found.value, found.lift));
        }
    }
}

/// Each place that is as high as the highest is a top, once: every wave of a cosine, both ends of a dwell, one of two lobes that is higher than
/// the other by more than rounding; in whatever unit, and below 0 as well.
#[test]
fn tops_are_the_highest_places_each_once() {
    // Also of a cam that has no lift at all.
    let flat = cam_of("law = \"harmonic\"\noffset = 0.0\namplitudes = [0.0]\nphases_deg = [0.0]\n");
    assert!(!flat.tops().is_empty());
    let angles = |cam: &Cam| cam.tops().iter().map(|top| top.angle.to_degrees()).collect::<Vec<f64>>();
    for power in [0, -40, 20] {
        let unit = 2.0_f64.powi(power);
        let waves = |offset: f64, amplitudes: &[f64], phases: &[f64]| {
            let amplitudes: Vec<f64> = amplitudes.iter().map(|amplitude| unit * amplitude).collect();
            let offset = unit * offset;
            cam_of(&format!(
                "law = \"harmonic\"\noffset = {offset:?}\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}\n"
            ))
        };
        let two_lobes = |drop: f64| {
            let dwell = "[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 30.0\nrise = 0.0\n";
            let moves = |rise: f64| {
                let rise = unit * rise;
                format!("[[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 60.0\nrise = {rise:?}\n")
            };
            let lobe = |rise: f64, fall: f64| [&moves(rise), dwell, &moves(-fall), dwell].map(str::to_owned).concat();
            let base = 0.5 * unit;
            cam_of(&format!(
                "law = \"program\"\nbase = {base:?}\n{}{}",
                lobe(0.25, 0.25),
                lobe(0.25 - drop, 0.25 - drop)
            ))
        };
        for (cam, tops, highest) in [
            (waves(-2.0, &[1.0], &[-90.0]), vec![90.0], -1.0),
            (waves(1.0, &[0.0, 0.0, 0.25], &[0.0, 0.0, -90.0]), vec![30.0, 150.0, 270.0], 1.25),
            // Tops and ends of lift 0, of which only rounding is left.
            (waves(-1.0, &[0.0, 0.0, 1.0], &[0.0, 0.0, 0.0]), vec![0.0, 120.0, 240.0], 0.0),
            (two_lobes(0.0), vec![60.0, 90.0, 240.0, 270.0], 0.75),
            (two_lobes(1e-6), vec![60.0, 90.0], 0.75),
        ] {
            let found = angles(&cam);
            assert_eq!(found.len(), tops.len(), "2^{power}: {found:?}, and {tops:?}");
            for (one, other) in found.iter().zip(&tops) {
                assert_abs_diff_eq!(one, other, epsilon = 1e-5);
            }
            for top in cam.tops().into_iter().chain([cam.highest()]) {
                assert_abs_diff_eq!(top.value, unit * highest, epsilon = 1e-14 * unit);
            }
        }
    }
}

/// A cosine of so high an order that 1440 angles of a turn meet each wave at two places, and none of them near its lowest, is as low and as high as any.
#[test]
fn the_least_of_a_fast_cosine_is_found() {
    let (mut amplitudes, mut phases) = (vec![0.0; 720], vec![0.0; 720]);
    (amplitudes[719], phases[719]) = (0.01, 60.0);
    let cam =
        cam_of(&format!("law = \"harmonic\"\noffset = 0.1\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}\n"));
    assert_relative_eq!(cam.lowest().value, 0.09, max_relative = 1e-12);
    assert_relative_eq!(cam.highest().value, 0.11, max_relative = 1e-12);
}

/// Peak velocity (in rise/span) and acceleration (in rise/span^2) as the handbooks give them, to four digits.
#[test]
fn motions_have_the_peaks_of_the_handbooks() {
    let peaks = [
        ("parabolic", 2.0, 4.0),
        ("harmonic", PI / 2.0, PI * PI / 2.0),
        ("cycloidal", 2.0, TAU),
        ("modified-trapezoid", 2.0, 4.888),
        ("modified-sine", 1.760, 5.528),
        ("poly345", 1.875, 5.7735),
        ("poly4567", 2.1875, 7.5132),
    ];
    assert_eq!(peaks.len() + 1, StandardMotion::NAMES.len());
    for (name, velocity, acceleration) in peaks {
        for (span_deg, rise) in [(110.0, 0.02), (230.0, -0.01)] {
            let cam = motion(name, span_deg, rise);
            let span = f64::to_radians(span_deg);
            let samples = (0..=4000).map(|sample| cam.lift(span * f64::from(sample) / 4001.0));
            let (fastest, hardest) = samples.fold((0.0_f64, 0.0_f64), |(fastest, hardest), lift| {
                (fastest.max(lift.slope.abs()), hardest.max(lift.curvature.abs()))
            });
            assert_relative_eq!(fastest * span / rise.abs(), velocity, max_relative = 3e-4);
            assert_relative_eq!(hardest * span * span / rise.abs(), acceleration, max_relative = 3e-4);
            // From rest to rest, by the rise, half of it half way.
            let (start, middle, after) = (cam.lift(0.0), cam.lift(0.5 * span), cam.lift(span));
            assert_abs_diff_eq!(start.value, 0.05, epsilon = 1e-17);
            assert_abs_diff_eq!(middle.value, 0.05 + 0.5 * rise, epsilon = 1e-16);
            assert_abs_diff_eq!(after.value, 0.05 + rise, epsilon = 1e-16);
            assert_abs_diff_eq!(start.slope, 0.0, epsilon = 1e-16);
            assert_abs_diff_eq!(after.slope, 0.0, epsilon = 1e-16);
        }
    }
    assert_eq!(motion("dwell", 90.0, 0.0).lift(1.0).value, 0.05);
}

/// 0.1 + 0.2 - 0.3 is not 0 in doubles; the cam ends on its base all the same.
#[test]
fn the_last_return_ends_on_the_base_to_the_last_bit() {
    let segments = [("poly345", 0.1), ("cycloidal", 0.2), ("poly4567", -0.3), ("dwell", 0.0)];
    let segment =
        |(motion, rise): (&str, f64)| format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = 90\nrise = {rise}\n");
    let segments: Vec<String> = segments.into_iter().map(segment).collect();
    let cam = cam_of(&format!("law = \"program\"\nbase = 0.01\n{}", segments.concat()));
    assert_eq!(cam.lift(6.0).value, 0.01);
    let last = &cam.segments()[cam.segments().len() - 2];
    let end = last.law.lift(last.end);
    assert_eq!((end.value, end.slope, end.curvature), (0.01, 0.0, 0.0));
}

/// Spans, rises and lifts that were typed to ten digits close the cam, in any unit; to nine they do not.
#[test]
fn what_typing_leaves_open_is_closed() {
    let program = |spans: [f64; 2], rises: [f64; 2]| {
        let segment = |(span, rise): (f64, f64)| {
            format!("[[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
        };
        let segments: String = spans.into_iter().zip(rises).map(segment).collect();
        format!("law = \"program\"\nbase = 0.0\n{segments}")
    };
    let polynomial = |size: f64, open: f64| {
        format!(
            "law = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0.0\ncoefficients = [{:?}]\n\
             [[cam.segment]]\nstart_deg = 180.0\ncoefficients = [{:?}]\n",
            size,
            size * (1.0 + open)
        )
    };
    for size in [1e-6, 1.0, 1e6] {
        // A part in 1e9 of 360 degrees, of 2 rises, and of the largest lift.
        for open in [0.9e-9, -0.9e-9, 1.1e-9, -1.1e-9] {
            let spans = program([120.0, 240.0 + 360.0 * open], [size, -size]);
            let rises = program([120.0, 240.0], [size, -size * (1.0 + 2.0 * open)]);
            for table in [spans, rises, polynomial(size, open)] {
                let cam = read(&table);
                assert_eq!(cam.is_ok(), open.abs() < 1e-9, "{table} {cam:?}");
            }
        }
    }
}

/// A jump of the lift is told with the piece that begins there, whether the first one starts at angle 0 or past it.
#[test]
fn a_jump_is_told_with_its_piece() {
    for (start, lifts, field) in
        [(0.0, [0.1, 0.1, 0.2], 0), (0.0, [0.1, 0.2, 0.1], 1), (30.0, [0.1, 0.1, 0.2], 0), (30.0, [0.1, 0.2, 0.1], 1)]
    {
        let piece = |(index, lift): (usize, &f64)| {
            let start = start + 100.0 * index as f64;
            format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = [{lift:?}]\n")
        };
        let pieces: String = lifts.iter().enumerate().map(piece).collect();
        let told = read(&format!("law = \"polynomial\"\n{pieces}")).unwrap_err();
        assert!(told.contains(&format!("cam.segment[{field}].coefficients[0]")), "{start} {lifts:?}: {told}");
    }
}

/// The largest nose circle that touches the flank's is as large as is told where it is larger, whether the nose lies before a right angle from where
/// the flank starts or past it.
#[test]
fn a_nose_may_be_as_large_as_is_told() {
    for (start, end, largest) in [(80.0, 150.0, 0.5), (50.0, 170.0, 1.5 - 120.0_f64.to_radians().sin())] {
        let cam = |nose: f64| {
            read(&format!(
                "law = \"arcs\"\nbase_radius = 0.5\nflank_radius = 1.5\nnose_radius = {nose:?}\n\
                 flank_start_deg = {start:?}\nnose_end_deg = {end:?}\n"
            ))
        };
        cam(largest * (1.0 - 1e-9)).unwrap();
        let none = read(&format!(
            "law = \"arcs\"\nbase_radius = 0.5\nflank_radius = 1.5\nnose_radius = 0.1\n\
             flank_start_deg = {start:?}\nnose_end_deg = {start:?}\n"
        ));
        assert!(none.unwrap_err().contains("cam.nose_end_deg"));
        let told = cam(largest * (1.0 + 1e-9)).unwrap_err();
        let limit = told.split("must be below ").nth(1).unwrap().split(' ').next().unwrap();
        assert!(told.contains("cam.nose_radius"), "{told}");
        assert_relative_eq!(limit.parse::<f64>().unwrap(), largest, max_relative = 1e-12);
    }
}

/// Within a motion nothing jumps below the acceleration's own derivatives, and the lift nowhere.
#[test]
fn pieces_of_a_motion_meet() {
    for (name, _) in StandardMotion::NAMES.into_iter().filter(|(name, _)| *name != "dwell") {
        let cam = motion(name, 123.0, 0.02);
        for pair in cam.segments().windows(2) {
            let (minus, plus) = (pair[0].law.lift(pair[0].end), pair[1].law.lift(pair[1].start));
            assert_abs_diff_eq!(minus.value, plus.value, epsilon = 1e-16);
            assert_abs_diff_eq!(minus.slope, plus.slope, epsilon = 1e-16);
        }
    }
}

#[test]
fn formulas_of_the_other_laws() {
    let cam = cam_of("law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02, -0.003]\nphases_deg = [30.0, 90.0]\n");
    let sine = cam_of("law = \"rectified-sine\"\noffset = 0.3\namplitude = -0.1\n");
    let segments = "[[cam.segment]]\nstart_deg = 90.0\ncoefficients = [0.1, 0.0, 0.01, -0.002]\n\
                    [[cam.segment]]\nstart_deg = 200.0\ncoefficients = [C0, C1]\n";
    // The second one is the chord back to the first one's start, a revolution on.
    let (u, rest) = (f64::to_radians(110.0), f64::to_radians(250.0));
    let end = 0.1 + 0.01 * u * u - 0.002 * u * u * u;
    let slope = (0.1 - end) / rest;
    let segments = segments.replace("C0", &format!("{end:?}")).replace("C1", &format!("{slope:?}"));
    let chords = cam_of(&format!("law = \"polynomial\"\n{segments}"));
    for k in 0..360 {
        let theta = f64::from(k).to_radians();
        let harmonic = 0.1 + 0.02 * (theta + PI / 6.0).cos() - 0.003 * (2.0 * theta + PI / 2.0).cos();
        assert_abs_diff_eq!(cam.lift(theta).value, harmonic, epsilon = 1e-15);
        assert_abs_diff_eq!(sine.lift(theta).value, 0.3 - 0.1 * theta.sin().abs(), epsilon = 1e-15);
        let from_first = theta - PI / 2.0;
        let chord = if (90..200).contains(&k) {
            0.1 + 0.01 * from_first.powi(2) - 0.002 * from_first.powi(3)
        } else {
            end + slope * (f64::from(if k < 90 { k + 160 } else { k - 200 })).to_radians()
        };
        assert_abs_diff_eq!(chords.lift(theta).value, chord, epsilon = 1e-15);
    }
}
