//! Page of `chart`: the number of points of each kind.

use crate::show::Paged;
use crate::show::block::Block;
use crate::show::words;
use corner_impact::orbit::long_run::Kind;
use corner_impact::study::chart::{Blocks, Charted, Filled};

impl Paged for Charted {
    fn blocks(&self) -> Vec<Block> {
        let chart = &self.chart;
        let [x, y] = [&chart.x, &chart.y].map(|axis| axis.parameter.name());
        let at = chart.speed().map_or_else(String::new, |rpm| format!(" at {rpm} rpm"));
        let points = self.points.len();
        let mut lines = vec![format!("{}{at}, {y} over {x}, {points} points", chart.model.name)];
        lines.push("  share of the points, motion (number of points)".into());
        for (kind, number) in self.counts() {
            let share = number as f64 / points as f64;
            // For chaos, the number of revolutions for which it was followed is added.
            let chaotic = self.points.iter().flatten().filter(|_| kind == Some(Kind::Chaotic));
            let seen = words::followed_for(chaotic.filter(|it| it.kind == Kind::Chaotic).map(|it| it.followed));
            lines.push(format!("  {share:.4}  {} ({number}){seen}", kind.map_or("failed", words::kind)));
        }
        lines.extend(self.failure().map(|why| format!("  the first that failed: {why}")));
        let [cpu_s, wall_s] = self.times;
        lines.push(format!("  {wall_s:.3} s, {cpu_s:.3} s of processor time"));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}

impl Paged for Filled {
    fn blocks(&self) -> Vec<Block> {
        let [cpu_s, wall_s] = self.times;
        let words = format!("  {wall_s:.3} s, {cpu_s:.3} s of processor time for {} points", self.points);
        let mut blocks = self.blocks.blocks();
        blocks.push(Block::Line(words.into()));
        blocks
    }
}

impl Paged for Blocks {
    fn blocks(&self) -> Vec<Block> {
        let Self { computed, done, total } = self;
        let now = if *computed > 0 { format!(", {computed} of them now") } else { String::new() };
        vec![Block::Line(format!("{done} of {total} blocks are done{now}").into())]
    }
}
