//! Is chaos proved where it is, and not where it is not?

use std::ops::ControlFlow;
use std::path::Path;

use corner_impact::cam::Cam;
use corner_impact::corner::locate;
use corner_impact::covering::find::{ProofScope, find};
use corner_impact::covering::prove::{Relation, prove};
use corner_impact::covering::region::{OpenRegion, Region, parted, trap};
use corner_impact::covering::{HSet, Image, UnprovedFlight, entropy, known};
use corner_impact::interval::Interval;
use corner_impact::model::Model;
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, EventKind, Machine, angular_velocity};
use corner_impact::study::chaos::{Chaos, chaos, portrait};
use corner_impact::study::trapping::{Trapped, Trapping};

use crate::common;

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

/// The h-set that is kept for one speed of the paper's machine.
fn kept(rpm: f64) -> HSet {
    let at = |set: &HSet| set.rpm[0] <= rpm && rpm <= set.rpm[1] && set.rpm[1] - set.rpm[0] < 1e-3;
    known("osorio-2008").into_iter().find(at).unwrap()
}

/// The h-set at 670 rpm with one strip, changed, and without cones.
fn changed(impacts: u64, change: impl Fn(&mut HSet)) -> HSet {
    let mut set = HSet { cone_slope: None, ..kept(670.0) };
    set.strips.retain(|strip| strip.impacts == impacts);
    change(&mut set);
    set
}

#[test]
fn at_670_rpm_five_strips_cover_and_keep_cones() {
    let set = kept(670.0);
    let proved = prove(&machine(&common::osorio(), 670.0), &set).unwrap();
    let symbols: Vec<u64> = proved.iter().map(|strip| strip.impacts).collect();
    assert_eq!(symbols, [2, 3, 4, 5, 6]);
    assert!(
        proved.iter().all(|strip| strip.revolutions + 1 == strip.impacts && strip.growth.unwrap() > 2.0),
        "{proved:?}"
    );
    // The sum of lambda^-k, k = 1 to 5, is 1 at lambda = 1.965948.
    assert!((0.67597..0.67598).contains(&set.entropy()), "{}", set.entropy());
    for strip in &proved {
        let [low, high] = strip.image_y;
        assert!(set.y[0] < low && low < high && high < set.y[1], "{strip:?}");
    }
}

/// On both sides of the corner impact there is chaos, and at it: it is not what creates it.
#[test]
#[ignore = "slow"]
fn at_the_corner_impact_and_above_it_strips_cover_and_keep_cones() {
    for (rpm, symbols) in [(673.2344455, 2..=6), (680.0, 2..=7)] {
        let proved = prove(&machine(&common::osorio(), rpm), &kept(rpm)).unwrap();
        assert_eq!(proved.iter().map(|strip| strip.impacts).collect::<Vec<_>>(), symbols.collect::<Vec<_>>(), "{rpm}");
        assert!(proved.iter().all(|strip| strip.growth.unwrap() > 1.0), "{proved:?}");
    }
}

#[test]
#[ignore = "slow"]
fn an_h_set_that_is_off_is_refused() {
    let machine = machine(&common::osorio(), 670.0);
    let move_by = |impacts: u64, by: [f64; 2]| {
        changed(impacts, |set| set.strips[0].x = [set.strips[0].x[0] + by[0], set.strips[0].x[1] + by[1]])
    };
    assert!(prove(&machine, &changed(3, |_| {})).is_ok());
    let cases = [
        ("moved", move_by(3, [0.1, 0.1]), Relation::Edges),
        ("moved back", move_by(3, [-0.1, -0.1]), Relation::Edges),
        ("too narrow on the right", move_by(3, [0.0, -0.015]), Relation::Edges),
        ("too narrow on the left", move_by(3, [0.015, 0.0]), Relation::Edges),
        ("N too low", changed(6, |set| set.y[1] = 1.2), Relation::Height),
        ("N too high up", changed(2, |set| set.y[0] = 0.05), Relation::Height),
        ("another number of turns", changed(3, |set| set.strips[0].revolutions = 3), Relation::Edges),
        ("not in N", changed(3, |set| set.x = [-1.2, 0.2]), Relation::Apart),
        ("no parallelogram", changed(3, |set| set.stable = set.unstable), Relation::Apart),
        ("below the cam", changed(3, |set| set.centre[1] = 0.1), Relation::Apart),
        ("cones too flat", changed(3, |set| set.cone_slope = Some(0.01)), Relation::Cones),
        ("cones too steep", changed(3, |set| set.cone_slope = Some(1e3)), Relation::Cones),
    ];
    for (what, set, relation) in cases {
        let refused = prove(&machine, &set).expect_err(what);
        assert_eq!(refused.relation, relation, "{what}: {refused:?}");
    }
    let mut twice = kept(670.0);
    twice.strips[1] = twice.strips[0].clone();
    assert_eq!(prove(&machine, &twice).unwrap_err().relation, Relation::Apart);
}

/// Between x = -1.7 and -1.75 the third flight just touches the cam: on one side it is struck there, on the other half a turn later.
#[test]
#[ignore = "slow"]
fn a_strip_with_a_graze_in_it_is_refused() {
    let set = changed(3, |set| set.strips[0].x = [-1.8, -1.1365]);
    let refused = prove(&machine(&common::osorio(), 670.0), &set).unwrap_err();
    assert!(refused.relation == Relation::Flight && !refused.is_refuted, "{refused:?}");
    assert!((-1.8..-1.7).contains(&refused.at[0]), "{refused:?}");
}

/// Without losses the motions of one sequence need not be one.
#[test]
fn without_losses_cones_say_nothing() {
    let set = HSet { cone_slope: Some(8.0), ..changed(3, |_| {}) };
    let mut model = common::osorio();
    model.follower.restitution = 1.0;
    assert_eq!(prove(&machine(&model, 670.0), &set).unwrap_err().relation, Relation::Losses);
}

/// Both conditions, and a of one sign, each failing alone.
#[test]
fn cones_are_kept_and_stretched_where_their_conditions_hold() {
    let exactly = |by: [f64; 4]| {
        let [a, b, c, d] = by.map(Interval::from);
        let zero = Interval::from(0.0);
        Image { centre: [zero; 2], value: [zero; 2], by: [[a, b, zero], [c, d, zero]] }
    };
    for (by, is_kept) in [
        ([3.0, 0.25, 0.5, 0.5], true),
        ([-3.0, 0.25, 0.5, -0.5], true),
        // |a| - L |b| is 1/2, and the image is within the cone all the same.
        ([1.0, 0.25, 0.25, 0.125], false),
        // |c| + L |d| is 7, L (|a| - L |b|) is 5.
        ([3.0, 0.25, 6.0, 0.5], false),
    ] {
        let image = exactly(by);
        assert_eq!((image.stretched(2.0).is_some(), image.misses(2.0)), (is_kept, !is_kept), "{by:?}");
    }
    // Where b may be 0 nothing is missed.
    let mut unknown = exactly([1.5, 0.0, 0.0, 0.0]);
    unknown.by[0][1] = Interval::new(-1.0, 1.0);
    assert!(unknown.stretched(1.0).is_none() && !unknown.misses(1.0));
    let mut folded = exactly([3.0, 0.0, 0.0, 0.0]);
    folded.by[0][0] = Interval::new(-3.0, 3.0);
    assert!(folded.stretched(2.0).is_none() && !folded.misses(2.0));
}

#[test]
fn entropy_is_a_bound_from_below() {
    assert_eq!(entropy(&[1]), 0.0);
    let two = entropy(&[1, 1]);
    assert!(two <= std::f64::consts::LN_2 && two > std::f64::consts::LN_2 - 1e-12, "{two}");
    let golden = (0.5 + 1.25_f64.sqrt()).ln();
    let found = entropy(&[1, 2]);
    assert!(found <= golden && found > golden - 1e-12, "{found}");
}

/// Where no h-set is kept for a speed, those next to each other are for ranges: there is chaos on all of one.
#[test]
#[ignore = "slow"]
fn at_every_speed_of_a_range_three_strips_cover() {
    let is_range = |set: &HSet| set.rpm[1] - set.rpm[0] > 0.1;
    let tiles: Vec<HSet> = known("osorio-2008").into_iter().filter(is_range).collect();
    assert!(tiles.windows(2).all(|two| two[0].rpm[1] == two[1].rpm[0] && two[0].strips.len() == 3), "a gap");
    let [first, last] = [tiles.first(), tiles.last()].map(|tile| tile.unwrap().rpm);
    assert!(first[0] == 640.0 && last[1] == 700.0, "{first:?} {last:?}");
    // Each takes a second or two; those around the corner impact stand for the others.
    let tile = tiles.iter().find(|tile| tile.rpm[0] < 673.234445 && 673.234446 < tile.rpm[1]).unwrap();
    let proved = prove(&machine(&common::osorio(), 670.0), tile).unwrap();
    assert_eq!(proved.iter().map(|strip| strip.impacts).collect::<Vec<_>>(), [2, 3, 4]);
    let wider = HSet { rpm: [tile.rpm[0] - 8.0, tile.rpm[1]], ..tile.clone() };
    assert!(prove(&machine(&common::osorio(), 670.0), &wider).is_err(), "not for any range");
}

/// Over a range one h-set follows another without a gap: those that are kept from where they begin to where they end, and where none
/// is kept, below 640 rpm, one that is found. Where nothing is proved the range is halved down to 0.03 rpm, and over as little one h-set is
/// looked for as it is at a speed, with cones.
#[test]
#[ignore = "slow"]
fn a_range_is_covered_by_h_sets_from_end_to_end() {
    let paper = common::osorio();
    let found = chaos(&paper, [639.98, 640.52], false, &Unwatched).unwrap();
    let ranges: Vec<[f64; 2]> = found.theorems.iter().map(|theorem| theorem.set.rpm).collect();
    assert_eq!((ranges, found.open.len()), (vec![[639.98, 640.0], [640.0, 640.5], [640.5, 640.52]], 0));
    let tiles = known("osorio-2008");
    let own: Vec<bool> = found
        .theorems
        .iter()
        .map(|theorem| tiles.iter().any(|tile| HSet { rpm: tile.rpm, ..theorem.set.clone() } == *tile))
        .collect();
    assert_eq!(own, [false, true, true]);
    let narrow = chaos(&paper, [640.49, 640.51], false, &Unwatched).unwrap();
    let kinds: Vec<_> =
        narrow.theorems.iter().map(|theorem| (theorem.set.rpm, theorem.set.cone_slope.is_some())).collect();
    assert_eq!(kinds[0], ([640.49, 640.51], true));
    let none = chaos(&paper, [160.0, 160.05], false, &Unwatched).unwrap();
    let open: Vec<[f64; 2]> = none.open.iter().map(|open| open.rpm).collect();
    assert!(none.theorems.is_empty() && open.len() == 2, "{open:?}");
    assert_eq!((open[0][0], open[0][1], open[1][1]), (160.0, open[1][0], 160.05));
    assert!(open.iter().all(|[low, high]| high - low < 0.03 && high - low > 0.02), "{open:?}");
}

/// The outline of a strip's image, along the one side of the strip and back along the other, is where runs from its points arrive.
#[test]
fn images_in_a_picture_are_where_runs_arrive() {
    let (paper, set) = (common::osorio(), kept(670.0));
    let machine = machine(&paper, 670.0);
    let found = portrait(&paper, &set).unwrap();
    // The first 500 are left out.
    assert_eq!((found.impacts.len(), found.images.len()), (399_500, set.strips.len()));
    for (strip, image) in set.strips.iter().zip(&found.images) {
        assert_eq!(image.len(), 2 * 401);
        for (place, part, y) in
            [(0, 0, set.y[0]), (150, 150, set.y[0]), (400, 400, set.y[0]), (401, 400, set.y[1]), (801, 0, set.y[1])]
        {
            let x = strip.x[0] + (strip.x[1] - strip.x[0]) * f64::from(part) / 400.0;
            let start = [0, 1].map(|side| set.centre[side] + x * set.unstable[side] + y * set.stable[side]);
            let arrived = impacts(&machine, start, strip.impacts as usize);
            let [angle, velocity] = arrived[strip.impacts as usize - 1];
            let turned = (image[place][0] - angle) / 360.0;
            assert!(
                (turned - turned.round()).abs() < 1e-9 && (image[place][1] - velocity).abs() < 1e-6,
                "{place} {strip:?}"
            );
        }
    }
}

/// Found from nothing but the model: at a speed of a machine that no h-set is kept for.
#[test]
#[ignore = "slow"]
fn chaos_of_other_machines_is_found_and_proved() {
    let model = common::read(std::path::Path::new(&format!("{}/models/damped-light.toml", common::ROOT)));
    let machine = machine(&model, 675.0);
    let found = find(&machine, [675.0; 2], ProofScope { strips: 2, cones: true }, &Unwatched).unwrap();
    let found = found.unwrap_or_else(|short| panic!("{short:?}"));
    assert!(prove(&machine, &found.set).is_ok());
}

/// Some of its strips keep cones, and more cover: both are told.
#[test]
#[ignore = "slow"]
fn a_theorem_with_cones_comes_before_one_of_more_strips_without() {
    let output = common::corner_impact(["chaos", "models/damped-light.toml", "--rpm", "670", "--json"]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let theorems = document["theorems"].as_array().unwrap();
    let kinds: Vec<_> =
        theorems.iter().map(|one| (one["cones"] == true, one["symbols"].as_array().unwrap().len())).collect();
    assert!(matches!(kinds[..], [(true, 2..)] | [(true, 2..), (false, 3..)]), "{kinds:?}");
    assert!(kinds.windows(2).all(|two| two[0].1 < two[1].1), "{kinds:?}");
}

/// Where a motion settles from everywhere no h-set is found.
#[test]
fn where_there_is_no_saddle_no_chaos_is_found() {
    let wanted = ProofScope { strips: 8, cones: true };
    let found = find(&machine(&common::osorio(), 160.0), [160.0; 2], wanted, &Unwatched).unwrap();
    assert!(found.is_err(), "{found:?}");
}

#[test]
fn the_command_keeps_its_fields() {
    let output = common::corner_impact(["chaos", "models/osorio-2008.toml", "--rpm", "673.2:673.4", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", common::text(output.stderr));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["schema"], "corner-impact/chaos/1");
    let theorem = &document["theorems"][0];
    assert_eq!(theorem["rpm"], serde_json::json!([673.2, 673.4]));
    assert_eq!(theorem["symbols"], serde_json::json!([2, 3, 4]));
    assert!(theorem["proved"] == true && theorem["cones"] == false, "{theorem}");
    assert_eq!(theorem["hypotheses"].as_array().unwrap().len(), 2);
    // The sum of lambda^-k, k = 1 to 3, is 1 at the tribonacci number.
    let entropy = theorem["entropy_per_revolution"].as_f64().unwrap();
    assert!((0.609377..0.609378).contains(&entropy), "{entropy}");
    assert_eq!(document["open"], serde_json::json!([]));
}

fn heavy() -> Model {
    common::read(&Path::new(common::ROOT).join("models/damped-heavy.toml"))
}

/// The region that the impacts of a run begin, in so many squares of a degree.
fn region(model: &Model, rpm: f64, start: [f64; 2], squares: u32, most: usize) -> Result<Region, OpenRegion> {
    let machine = machine(model, rpm);
    let run = impacts(&machine, start, 2500);
    let run: Vec<[Interval; 2]> = run
        .iter()
        .skip(500.min(run.len() / 2))
        .map(|[angle, velocity]| [angle.to_radians().into(), (*velocity).into()])
        .collect();
    trap(&machine, rpm, &run, squares, most, &Unwatched)
}

/// Impacts after one: the cam's angle, degrees, and the velocity relative to the cam, m/s.
fn impacts(machine: &Machine, [degrees, velocity]: [f64; 2], count: usize) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let mut motion = machine.start_on_cam(f64::to_radians(degrees), velocity).unwrap();
    let goal = motion.after(count as u64);
    let mut see = |event: &Event| {
        if event.kind == EventKind::Impact {
            found.push([event.cam_angle.to_degrees(), event.velocity_after - event.cam_velocity]);
        }
        if event.kind == EventKind::Stick || found.len() == count {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let _ = machine.advance(&mut motion, goal, &mut see).unwrap();
    found
}

/// By the simulator, from anywhere in it: near grazes are among them.
#[test]
#[ignore = "slow"]
fn runs_do_not_leave_a_region_that_traps() {
    let model = heavy();
    let region = region(&model, 706.6, [151.0, 2.0], 1, 20_000).unwrap();
    let machine = machine(&model, 706.6);
    let mut lowest = f64::INFINITY;
    for place in region.places.iter().step_by(20) {
        // Off the middle: low enough, where a cell begins at 0.
        let start = place.map(|[low, high]| low + 0.4 * (high - low));
        let run = impacts(&machine, start, 200);
        assert_eq!(run.len(), 200, "from {start:?} it rests");
        for impact in run {
            assert!(region.holds(impact), "{impact:?}, from {start:?}");
            lowest = lowest.min(impact[1]);
        }
    }
    // They graze, or this would tell nothing of grazes.
    assert!(lowest < region.square_m_s, "{lowest}");
}

#[test]
#[ignore = "slow"]
fn a_region_is_not_closed_where_motions_rest_or_cells_run_out() {
    let rests = region(&common::osorio(), 183.0, [200.0, 0.1], 1, 20_000).unwrap_err();
    assert_eq!(rests.flight, Some(UnprovedFlight::NoImpact), "{rests:?}");
    let none = trap(&machine(&heavy(), 706.6), 706.6, &[], 1, 1000, &Unwatched).unwrap_err();
    assert_eq!((none.cells, none.flight), (0, None), "of no impacts nothing is proved");
    let many = region(&heavy(), 706.6, [151.0, 2.0], 1, 1000).unwrap_err();
    assert_eq!(many.flight, None, "{many:?}");
    assert!(many.cells > 1000, "{many:?}");
}

/// Behind the corner impact of this machine a run stays next to it, without chaos that is proved in it: its region is one, and that of all
/// motions, which holds the strips, another.
#[test]
#[ignore = "slow"]
fn regions_are_next_to_the_corner_impact_and_of_all_motions() {
    let model = common::read(&Path::new(common::ROOT).join("models/nonsmooth-flip.toml"));
    let rpm = 880.0;
    let found = chaos(&model, [rpm; 2], true, &Unwatched).unwrap();
    let trapping = found.trapping.unwrap();
    let told: Vec<_> = trapping.regions.iter().map(|it| (it.region.squares_per_degree, it.holds_chaos)).collect();
    // 32 squares across what the run takes up, or up to twice as many.
    assert_eq!((told, trapping.escapes.len()), (vec![(8, false), (1, true)], 0));
    let [beside, all] = [0, 1].map(|index| &trapping.regions[index].region);
    let (at, _) = locate(&model, &Cam::new(&model).unwrap()).unwrap();
    let corner = at.corner.angle.to_degrees();
    assert!(beside.angles_deg[0] < corner && corner < beside.angles_deg[1] && beside.angles_deg[0] > corner - 6.0);
    assert!(all.angles_deg[0] < beside.angles_deg[0] && beside.angles_deg[1] < all.angles_deg[1]);
    let machine = machine(&model, rpm);
    let start = [corner, at.velocity_after - at.cam_velocity];
    assert!(impacts(&machine, start, 2000).iter().skip(500).all(|impact| beside.holds(*impact) && all.holds(*impact)));
    // The set of chaotic motions has impacts in its strips.
    let set = &found.theorems[0].set;
    for strip in &set.strips {
        let x = 0.5 * (strip.x[0] + strip.x[1]);
        assert!(all.holds([0, 1].map(|side| set.centre[side] + x * set.unstable[side])));
    }
}

/// Next to its corner impact there is a region in which no periodic orbit is stable.
#[test]
#[ignore = "slow"]
fn motions_that_stay_beside_a_corner_impact_are_chaotic() {
    let beside = region(&heavy(), 706.6, [150.18, 21.52], 1024, 20_000).unwrap();
    // The slope of the map at its saddle before the corner is 1.0275 at 706.5 rpm, and 1.0263 at the corner impact: no bound may be above it.
    let growth = parted(&machine(&heavy(), 706.6), 706.6, &beside).unwrap();
    assert!((1.02..1.0275).contains(&growth), "{growth}");
    let [low, high] = beside.angles_deg;
    assert!(low < 150.1794 && 150.1794 < high && high - low < 0.1, "{low} {high}");
    // By the simulator: a run stays, and one that begins beside it has parted from it by what the bound says at least.
    const OFF: f64 = 1e-9;
    let machine = machine(&heavy(), 706.6);
    let [one, two] = [0.0, OFF].map(|off| impacts(&machine, [150.18 + off, 21.52], 20));
    assert!(one.len() == 20 && one.iter().all(|impact| beside.holds(*impact)), "{one:?}");
    let [end, other] = [one, two].map(|run| run.last().unwrap()[0]);
    assert!((end - other).abs() > OFF * growth.powi(20), "{end} {other}");
}

/// A stable orbit draws its neighbours in, so nothing parts there.
#[test]
fn motions_do_not_part_about_a_stable_orbit() {
    let region = region(&common::osorio(), 700.0, [155.3, 72.0], 1, 20_000).unwrap();
    assert_eq!(parted(&machine(&common::osorio(), 700.0), 700.0, &region), None);
}

/// About a stable orbit a few cells are enough, and the saddle beside it is not among them.
#[test]
fn a_region_about_a_stable_orbit_is_small() {
    let region = region(&common::osorio(), 700.0, [155.3, 72.0], 1, 20_000).unwrap();
    assert!(region.cells < 100 && region.velocities_m_s[1] < 80.0, "{region:?}");
    assert!(region.places.iter().all(|[[low, high], _]| 154.0 < *low && *high < 157.0), "{:?}", region.places);
}

/// Of a follower that is pressed on the cam for good the h-sets that are kept for the paper's do not hold, though it goes by the same
/// name: where they begin is looked at like any other speed, and what is left open is the range, in pieces.
#[test]
fn h_sets_of_another_machine_of_the_name_are_passed_over() {
    let model = common::osorio().with_number("follower.rest_position", -50.0).unwrap();
    let [low, high] = [640.5, 640.535];
    let found = common::ends(move || chaos(&model, [low, high], false, &Unwatched).unwrap()).unwrap();
    assert!(found.theorems.is_empty(), "{:?}", found.theorems);
    let ends: Vec<f64> = found.open.iter().flat_map(|open| open.rpm).collect();
    assert_eq!((ends[0], ends[ends.len() - 1]), (low, high));
    assert!(ends.chunks(2).all(|piece| piece[0] < piece[1]), "{ends:?}");
    assert!(ends[1..ends.len() - 1].chunks(2).all(|pair| pair[0] == pair[1]), "{ends:?}");
}

/// At 1200 rpm a follower that loses most at each impact comes from its corner impact to impacts far from it: a region is looked for about
/// these alone, and told once.
#[test]
fn a_run_that_leaves_the_corner_impact_has_no_region_beside_it() {
    let model =
        Model::parse("soft.toml", &common::osorio_text(&[("restitution", "0.2"), ("rpm_max", "850.0")])).unwrap();
    assert!(locate(&model, &common::cam(&model)).is_ok());
    let found = chaos(&model, [1200.0; 2], true, &Unwatched).unwrap().trapping.unwrap();
    assert_eq!((found.regions.len(), found.escapes.len()), (1, 0), "{found:?}");
}

/// Something is proved where there is a region that traps, be there no chaos; of nothing that was found nothing is.
#[test]
fn a_region_that_traps_is_something_that_is_proved() {
    let region = region(&common::osorio(), 700.0, [155.3, 72.0], 1, 20_000).unwrap();
    let trapped =
        Trapping { regions: vec![Trapped { region, holds_chaos: false, parted: None }], ..Trapping::default() };
    for (trapping, known) in [(None, "sampled"), (Some(Trapping::default()), "sampled"), (Some(trapped), "proved")] {
        let (model, rpm) = ("osorio-2008".to_owned(), [700.0; 2]);
        let found = Chaos { model, rpm, hypotheses: Vec::new(), theorems: Vec::new(), open: Vec::new(), trapping };
        assert_eq!(found.proves_something(), known == "proved");
        assert_eq!(serde_json::to_value(&found).unwrap()["known"], known);
    }
}
