//! The page of `chart`: how many points there are of each kind.

use crate::show::Paged;
use crate::show::block::Block;
use crate::show::words;
use crate::study::chart::Charted;

impl Paged for Charted {
    fn blocks(&self) -> Vec<Block> {
        let chart = &self.chart;
        let [x, y] = [&chart.x, &chart.y].map(|axis| axis.parameter.name());
        let at = chart.speed().map_or_else(String::new, |rpm| format!(" at {rpm} rpm"));
        let points = self.points.len();
        let mut lines = vec![format!("{}{at}, {y} over {x}, {points} points", chart.model.name)];
        for (kind, number) in self.counts() {
            let share = number as f64 / points as f64;
            lines.push(format!("  {share:.4}  {} ({number})", kind.map_or("failed", words::kind)));
        }
        lines.extend(self.failure().map(|why| format!("  the first that failed: {why}")));
        let [cpu_s, wall_s] = self.times;
        lines.push(format!("  {wall_s:.3} s, {cpu_s:.3} s of processor time"));
        lines.into_iter().map(|line| Block::Line(line.into())).collect()
    }
}
