//! Pages of `simulate` and `diagram`: the results of a run and of a sweep.

use crate::show::block::{Block, Span, Words, words as sentence};
use crate::show::digits::Digits;
use crate::show::{Paged, words};
use corner_impact::study::diagram::Swept;
use corner_impact::study::simulate::{Lyapunov, Run, RunEnd};

impl Paged for Run {
    fn blocks(&self) -> Vec<Block> {
        let Self { model, rpm, revolutions, impacts, sticks, releases, wall_s, .. } = self;
        let RunEnd { cam_angle_rad, position_m, velocity_m_s, contact } = self.end;
        let nine = |value| Digits::Fixed(9).text(value);
        let (degrees, q, v) = (cam_angle_rad.to_degrees(), nine(position_m), nine(velocity_m_s));
        let place = if contact { ", on the cam" } else { "" };
        let mut lines: Vec<Words> = vec![
            format!("{model} at {rpm} rpm, {revolutions} revolutions").into(),
            format!("  impacts {impacts}, sticks {sticks}, releases {releases}").into(),
            sentence![
                format!("  ends at {degrees:.4} deg with q = {q} "),
                Span::Unit("m"),
                format!(", v = {v} "),
                Span::Unit("m/s"),
                place
            ],
        ];
        if let Some(loads) = &self.loads {
            let turns = words::many(loads.loads_over_revolutions, "revolution");
            let part =
                if loads.loads_over_revolutions as f64 >= *revolutions { "the whole run of " } else { "the last " };
            lines.push(sentence![
                "  hardest impact ",
                (loads.hardest_impact_m_s, Digits::Significant(5)),
                " ",
                Span::Unit("m/s"),
                " relative to the cam, largest gap ",
                (loads.largest_gap_m, Digits::Significant(5)),
                " ",
                Span::Unit("m"),
                format!(", off the cam {:.1} % of the time, over {part}{turns}", 100.0 * loads.off_cam_share)
            ]);
        }
        if let Some(Lyapunov { lyapunov_per_revolution: exponent, lyapunov_standard_error, ending, followed, .. }) =
            &self.long_run
        {
            let rests = *exponent == f64::NEG_INFINITY;
            let why = if rests { ": it rests on the cam, where every deviation is lost" } else { "" };
            let error = lyapunov_standard_error.map_or(String::new(), |error| format!(" ± {error:.4}"));
            lines.push(format!("  in the long run {}", words::followed(ending, *followed, false)).into());
            lines.push(format!("  Lyapunov exponent {exponent:.4}{error} per revolution{why}").into());
        }
        lines.push(format!("  computed in {wall_s:.3} s{}", per_turn(*wall_s, *revolutions)).into());
        lines.into_iter().map(Block::Line).collect()
    }
}

impl Paged for Swept {
    fn blocks(&self) -> Vec<Block> {
        let Self { model, tally, wall_s, .. } = self;
        let (turns, threads) = (tally.revolutions, words::many(self.threads as u64, "thread"));
        let each = per_turn(*wall_s, turns as f64);
        vec![
            Block::Line(
                format!("{model}: {turns} revolutions, {} rows, {} impacts", tally.points, tally.impacts).into(),
            ),
            Block::Line(
                format!(
                    "  each run followed for {}{}",
                    words::many(self.followed, "revolution"),
                    if self.is_judged {
                        ", and longer for growth rates or attractors"
                    } else {
                        "; the motions are not classified"
                    }
                )
                .into(),
            ),
            Block::Line(format!("  {wall_s:.3} s on {threads}{each}").into()),
        ]
    }
}

/// Computing time for a revolution; empty if there were no revolutions.
fn per_turn(wall_s: f64, revolutions: f64) -> String {
    if revolutions > 0.0 { format!(", {:.0} ns a revolution", wall_s / revolutions * 1e9) } else { String::new() }
}
