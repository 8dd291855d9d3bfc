//! The pages of `claims`: for a terminal, and the one under `docs/`.

use crate::paper::Claims;
use crate::show::block::{Block, Column, Mark, Section, Span, Table, Words, words};
use crate::show::words::mark;

/// The page for a terminal.
pub(crate) fn terminal(found: &Claims) -> Vec<Block> {
    let title = format!("What the paper states, held against {}", found.model);
    let mut blocks = vec![Block::Paragraph(0, (Mark::Heading, title.as_str()).into())];
    for (verdict, held) in found.groups() {
        let name = verdict.to_string().to_uppercase();
        blocks.extend([
            Block::Gap,
            Block::Paragraph(0, words![(mark(verdict), name.as_str()), format!(" ({})", held.len())]),
        ]);
        for claim in held {
            let otherwise = (Mark::Bad, "OTHERWISE THAN THE LEDGER SAYS");
            let mut head = words![format!("{} [{}]", claim.id, claim.place)];
            if !claim.as_found {
                head.push(words![": ", otherwise]);
            }
            blocks.extend([Block::Gap, Block::Paragraph(2, head), Block::Paragraph(4, (&claim.statement).into())]);
            blocks.extend(claim.correct.iter().map(|correct| Block::Paragraph(4, words!["Right: ", correct])));
            blocks.push(Block::Paragraph(4, words![format!("Evidence, {}: ", claim.known), &claim.evidence]));
        }
    }
    let agreement = if found.agrees {
        (Mark::Good, "Every check comes to the ledger's verdict.")
    } else {
        (Mark::Bad, "A CHECK DISAGREES WITH THE LEDGER.")
    };
    blocks.extend([Block::Gap, Block::Paragraph(0, agreement.into())]);
    blocks
}

/// The page under `docs/`: what stands before its sections, and these.
pub fn document(found: &Claims) -> (Vec<Block>, Vec<Section>) {
    let term = |name| (Mark::Strong, name);
    let about = words![
        "Written by ",
        Span::Code("make claims".into()),
        "; a test keeps it fresh. Statements are in words of this project. ",
        term("Misprint"),
        ": a slip that nothing was built on; ",
        term("refuted"),
        ": what is said is wrong; ",
        term("open"),
        ": not decided here yet. How a verdict is known: ",
        term("proved"),
        " by computer algebra, ",
        term("computed"),
        " in rounded numbers, ",
        term("sampled"),
        " at some cases out of many, or only ",
        term("read"),
        "."
    ];
    let counts: Vec<String> = found.groups().map(|(verdict, held)| format!("{} {verdict}", held.len())).collect();
    let counts = format!("{} statements: {}.", found.claims.len(), counts.join(", "));
    let title = Block::Title("What the paper states, and what was found".into());
    let sections = found.groups().map(|(verdict, held)| {
        let columns =
            ["id", "where", "statement", "right instead", "known", "evidence"].map(|head| Column::left(head, 0, 0));
        let mut table = Table::new("", columns);
        for claim in held.iter() {
            let correct = claim.correct.as_deref().unwrap_or_default();
            let known = claim.known.to_string();
            table.row([&claim.id, &claim.place, &claim.statement, correct, &known, &claim.evidence].map(Words::from));
        }
        let title = words![capitalized(&verdict.to_string()), format!(" ({})", held.len())];
        Section { id: "", title, blocks: vec![Block::Table(table)] }
    });
    (vec![title, Block::paragraph(about), Block::paragraph(counts)], sections.collect())
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
