//! Have the answers of cams, comparisons, charts and sets of chaos moved? In snapshots; that they are right is for other files.

use crate::answers::are_as_they_were;

#[test]
fn what_cams_are_made_of() {
    are_as_they_were(
        "answers-cam",
        &[
            "cam --json",
            "cam models/laws/program.toml --json",
            "cam models/laws/polynomial.toml --json --order 2",
            "cam models/laws/rectified-sine.toml --json",
            "cam models/laws/harmonic.toml --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn what_moved_between_machines() {
    are_as_they_were(
        "answers-compare-more",
        &[
            "compare models/laws/polynomial.toml models/laws/harmonic.toml --json",
            "compare models/ballistic.toml models/sharp-nose.toml --json",
        ],
    );
}

#[test]
fn what_runs_of_two_numbers_come_to() {
    are_as_they_were(
        "answers-chart-more",
        &[
            "chart --x rpm=110:185:4 --y restitution=0:0.9:4 --out - --transient 50 --record 16",
            "chart models/ballistic.toml --x gravity=-1:9.81:3 --y restitution=0.2:0.4:2 --rpm 100 --out -",
            "chart models/laws/program.toml --x mass=0.5:0.6:2 --y damping=1:2:2 --rpm 900 --out -",
        ],
    );
}

#[test]
fn which_motions_a_smooth_cam_has() {
    are_as_they_were(
        "answers-speeds-smooth",
        &["speeds models/laws/harmonic.toml --rpm 500:510 --step 10 --starts 2 --json"],
    );
}

#[test]
fn where_chaos_is_proved() {
    are_as_they_were(
        "answers-chaos",
        &["chaos --rpm 670 --json", "chaos models/laws/polynomial.toml --rpm 700 --json"],
    );
}
