//! Page of `basins`: the share of the starts that end on each motion.

use crate::show::Paged;
use crate::show::block::Block;
use crate::show::digits::Digits;
use crate::show::words;
use corner_impact::study::basins::{Basin, Basins, BasinsOver, Summary};

/// Head of the lines below it.
const HEAD: &str = "  share of the starts, motion that they settle on (number of starts)";

impl Paged for Summary {
    fn blocks(&self) -> Vec<Block> {
        let Self { model, rpm, basins, wall_s, .. } = self;
        let angle = basins.begun.cam_angle().to_degrees();
        let mut lines =
            vec![format!("{model} at {rpm} rpm, {} at {angle:.4} deg", words::many(basins.starts as u64, "start"))];
        lines.push(HEAD.into());
        lines.extend(basins.parts.iter().map(|part| format!("  {}", ending(basins, part))));
        lines.extend(words::transient_chaos(&basins.wandering).map(|words| format!("  {words}")));
        lines.extend(below_cam(basins).map(|words| format!("  {words}")));
        lines.extend(basins.failure.iter().map(|why| format!("  failed ({}): {why}", basins.failed)));
        lines.push(format!("  {wall_s:.3} s"));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}

impl Paged for BasinsOver {
    fn blocks(&self) -> Vec<Block> {
        let angle = self.cam_angle.to_degrees();
        let mut lines = vec![format!("{}, {}, starts at {angle:.4} deg", self.model, self.over.range(self.range))];
        lines.push(HEAD.into());
        for at in &self.at {
            lines.push(format!("  {}", self.over.words(Digits::Significant(6).text(at.place.across()))));
            let parts = at.found.iter().flat_map(|found| found.parts.iter().map(move |part| ending(found, part)));
            lines.extend(parts.map(|line| format!("    {line}")));
            lines.extend(at.found.iter().filter_map(below_cam).map(|words| format!("    {words}")));
            lines.extend(at.failure().map(|why| format!("    failed: {why}")));
        }
        lines.push(format!("  {:.3} s", self.wall_s));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}

/// Line of a motion: the share of the starts that end on it, and their number.
fn ending(of: &Basins, part: &Basin) -> String {
    // Given starts are counted.
    let error = if part.share.error > 0.0 { format!(" ± {:.4}", part.share.error) } else { String::new() };
    let ending = words::followed(&part.ending, part.followed, of.wandering.rested > 0);
    format!("{:.4}{error}  {ending} ({})", part.share.value, part.starts)
}

/// Number of the starts below the cam.
fn below_cam(found: &Basins) -> Option<String> {
    let all = if found.below_cam == found.begun.count() { ": none could be run" } else { "" };
    (found.below_cam > 0).then(|| format!("below the cam: {}{all}", words::many(found.below_cam as u64, "start")))
}
