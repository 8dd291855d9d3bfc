//! The page of `basins`: the share of the starts that end on each motion.

use crate::show::Paged;
use crate::show::block::Block;
use crate::show::digits::Digits;
use crate::show::words;
use crate::study::basins::{BasinsOver, Summary};

impl Paged for Summary {
    fn blocks(&self) -> Vec<Block> {
        let Self { model, rpm, basins, wall_s, .. } = self;
        let angle = basins.begun.cam_angle().to_degrees();
        let mut lines = vec![format!("{model} at {rpm} rpm, {} starts at {angle:.4} deg", basins.starts)];
        for part in &basins.parts {
            let (share, error, ending) =
                (part.share.value, part.share.error, words::followed(&part.ending, part.followed));
            lines.push(format!("  {share:.4} ± {error:.4}  {ending} ({})", part.starts));
        }
        lines.extend(words::transient_chaos(&basins.wandering).map(|words| format!("  {words}")));
        lines.extend(basins.failure.iter().map(|why| format!("  failed ({}): {why}", basins.failed)));
        lines.push(format!("  {wall_s:.3} s"));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}

impl Paged for BasinsOver {
    fn blocks(&self) -> Vec<Block> {
        let angle = self.cam_angle.to_degrees();
        let mut lines = vec![format!("{}, {}, starts at {angle:.4} deg", self.model, self.over.range(self.range))];
        for at in &self.at {
            lines.push(format!("  {}", self.over.words(Digits::Significant(6).text(at.place.across()))));
            for part in at.found.iter().flat_map(|found| &found.parts) {
                let (share, error, ending) =
                    (part.share.value, part.share.error, words::followed(&part.ending, part.followed));
                lines.push(format!("    {share:.4} ± {error:.4}  {ending} ({})", part.starts));
            }
            lines.extend(at.failure().map(|why| format!("    failed: {why}")));
        }
        lines.push(format!("  {:.3} s", self.wall_s));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}
