//! Does the closed form give the numbers that an independent computation with 40 digits gives for the paper's model?
//!
//! The digits below come from mpmath, from the same constants as `models/osorio-2008.toml`: T* by root finding on the
//! repaired eq:fixedp, the matrices by the repaired eq:Px and eq:PT, cam derivatives by numerical differentiation at 40
//! digits. Each is met to 1e-12 of its quantity's largest entry, T* to 1e-14.

use crate::common;
use approx::assert_relative_eq;
use corner_impact::border_collision::feigin::{Scenario, Speeds};
use corner_impact::corner::closed_form;
use corner_impact::study::verify::{External, Verification, verify};

fn findings() -> Verification {
    verify(&common::osorio(), External::LeftOut).unwrap()
}

#[track_caller]
fn meets(computed: &[f64], target: &[f64]) {
    let scale = target.iter().fold(0.0_f64, |scale, entry| scale.max(entry.abs()));
    assert_eq!(computed.len(), target.len());
    for (a, b) in computed.iter().zip(target) {
        assert!((a - b).abs() <= 1e-12 * scale, "{a:?} against {b:?}");
    }
}

#[test]
fn the_orbit() {
    let at = findings().at;
    assert_relative_eq!(at.period, 0.089121999691593716257, max_relative = 1e-14, epsilon = 0.0);
    assert!(at.bracket[0] <= at.period && at.period <= at.bracket[1]);
    assert_relative_eq!(at.speed_rpm(), 673.23444500381200233, max_relative = 1e-13);
    meets(at.x_star().as_slice(), &[5.0970078818426217442, 0.0]);
    meets(&[at.corner.angle], &[2.6211245011662323486]);
    meets(&[at.corner.minus.value, at.corner.plus.value], &[0.531255562019001421, 0.531255562019001421]);
    meets(&[at.corner.minus.slope, at.corner.plus.slope], &[0.274702127132675765, 0.274702127132675765]);
    meets(&[at.corner.minus.curvature, at.corner.plus.curvature], &[0.341597100028544513, -1.86921258277444897]);
    meets(&[at.velocity_before, at.velocity_after], &[-174.30083902083143058, 174.30083902083143058]);
    meets(&[at.cam_velocity], &[19.366759891203492287]);
}

/// However wide the range, the orbit in it is found.
#[test]
#[ignore = "slow"]
fn the_orbit_in_a_wide_range() {
    let model = common::osorio_with(&[("rpm_min", "1.0"), ("rpm_max", "100000.0")]);
    let (first, others) = corner_impact::corner::locate(&model, &common::cam(&model)).unwrap();
    let speeds: Vec<f64> = others.iter().chain([&first]).map(|at| at.speed_rpm()).collect();
    assert!(speeds.iter().any(|speed| (speed - 673.234445).abs() < 1e-6), "{speeds:?}");
}

#[test]
fn the_orbit_by_the_papers_own_equation() {
    let model = common::osorio();
    let (x, period) = closed_form::orbit(&model, &findings().at).unwrap();
    assert_relative_eq!(period, 0.089121999691593716257, max_relative = 1e-14, epsilon = 0.0);
    meets(x.as_slice(), &[5.0970078818426217442, 0.0]);
}

#[test]
fn the_map() {
    let found = findings();
    let map = &found.map;
    let rows = |a: nalgebra::Matrix2<f64>| a.transpose().as_slice().to_vec();
    let a_minus = [0.8209349682147776064, 0.013465309156545112368, 2.520122014525261542, 0.8209349682147776064];
    let a_plus = [0.68571072072040589424, -0.073510523779642068408, 2.309884337079447908, 0.68571072072040589424];
    meets(&rows(map.minus.a), &a_minus);
    meets(&rows(map.plus.a), &a_plus);
    meets(map.minus.b.as_slice(), &[-51.627579902968250901, -5455.7945597763157455]);
    meets(map.plus.b.as_slice(), &[208.11740649865913455, -5051.9603090325984826]);
    meets(map.c().as_slice(), &[-0.13522424749437171215, -0.086975832936187180776]);
    meets(&[map.d()], &[259.74498640162738545]);
}

#[test]
fn eigenvalues_and_normal_form() {
    let found = findings();
    let map = &found.map;
    let [first, second] = map.minus.eigenvalues();
    meets(&[first.re, first.im, second.re, second.im], &[1.0051474054653550141, 0.0, 0.63672253096420019872, 0.0]);
    let [first, second] = map.plus.eigenvalues();
    let (re, im) = (0.68571072072040589424, 0.41206893536045823921);
    meets(&[first.re, first.im, second.re, second.im], &[re, im, re, -im]);
    let form = found.normal_form.unwrap();
    meets(form.b_tilde.as_slice(), &[-395.58397165878446836, -615.02768162784536141]);
    let w = [-0.13522424749437171215, -0.086975832936187180776, -0.10817939799549736972, 0.069580666348949744621];
    meets(form.w.transpose().as_slice(), &w);
    meets(form.a_bar_minus.transpose().as_slice(), &[1.6418699364295552128, 1.0, -0.64, 0.0]);
    meets(form.a_bar_plus.transpose().as_slice(), &[1.3714214414408117885, 1.0, -0.64, 0.0]);
    meets(form.b_bar.as_slice(), &[106.98508977678799208, 0.0]);
    meets(form.c_bar.as_slice(), &[1.0, 0.0]);
}

#[test]
fn the_classification() {
    let verdict = findings().classification.unwrap();
    assert_eq!(verdict.scenario, Scenario::NonsmoothFold);
    assert_eq!((verdict.minus.above_one, verdict.plus.above_one), (1, 0));
    assert_eq!((verdict.minus.below_minus_one, verdict.plus.below_minus_one), (0, 0));
    assert_eq!((verdict.minus.exists_for, verdict.plus.exists_for), (Speeds::Faster, Speeds::Faster));
    assert_eq!((verdict.minus.stable, verdict.plus.stable), (false, true));
    meets(&[verdict.minus.determinant], &[-0.00186993642955521279]);
    meets(&[verdict.plus.determinant], &[0.268578558559188212]);
    // (I - A)^{-1} divides by that determinant, 1/500: three digits fewer.
    assert_relative_eq!(verdict.minus.fixed_point[0], 44230.730719534362287, max_relative = 1e-10);
    assert_relative_eq!(verdict.minus.fixed_point[1], 592025.38088070029516, max_relative = 1e-10);
    meets(verdict.plus.fixed_point.as_slice(), &[1626.2702446096216953, -4121.8846093633891942]);
}
