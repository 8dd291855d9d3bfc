//! The pages of `claims`: one for a terminal, and one under `docs/`.

use crate::explain::{ExplainError, Links};
use crate::pages::explain::behind;
use crate::show::block::{Block, Column, PageSection, Span, Table, TextMark, Words, words};
use crate::show::words::{self, mark, verdict_word};
use corner_impact::known::Evidence;
use corner_impact::paper::{Claims, Held};
use corner_impact::published::Verdict;

/// The page for a terminal.
pub(crate) fn terminal(found: &Claims) -> Vec<Block> {
    let title = format!("What the paper states, held against {}", found.model);
    let about = format!("All of it is about {}.", found.source);
    let mut blocks =
        vec![Block::Paragraph(0, (TextMark::Heading, title.as_str()).into()), Block::Paragraph(0, about.into())];
    for (verdict, held) in found.groups().filter(|(_, held)| !held.is_empty()) {
        let name = verdict_word(verdict).to_uppercase();
        let count = format!(" ({})", count(found, verdict, held.len()));
        blocks.extend([Block::Gap, Block::Paragraph(0, words![(mark(verdict), name.as_str()), count])]);
        for claim in held {
            let otherwise = (TextMark::Bad, "OTHERWISE THAN THE LEDGER SAYS");
            let mut head = words![format!("{} [{}]", claim.id, claim.place)];
            if !claim.as_found {
                head.push(words![": ", otherwise]);
            }
            blocks.extend([Block::Gap, Block::Paragraph(2, head), Block::Paragraph(4, (&claim.statement).into())]);
            blocks.extend(claim.correct.iter().map(|correct| Block::Paragraph(4, words!["Right: ", correct])));
            blocks.extend(by_slip(claim).map(|slip| Block::Paragraph(4, slip.into())));
            blocks.push(Block::Paragraph(4, words![format!("Evidence, {}: ", claim.known), &claim.evidence]));
        }
    }
    let agreement = if found.agrees {
        (TextMark::Good, "Every check comes to the ledger's verdict.")
    } else {
        (TextMark::Bad, "A CHECK DISAGREES WITH THE LEDGER.")
    };
    blocks.extend([Block::Gap, Block::Paragraph(0, agreement.into())]);
    blocks
}

/// Number of statements with a verdict. For a wrong verdict, also the number with an error of their own.
fn count(found: &Claims, verdict: Verdict, all: usize) -> String {
    if !verdict.is_wrong() {
        return all.to_string();
    }
    format!("{all}: {}", words::slips(found.slips_and_consequences(verdict)))
}

/// Errors in other statements that make a statement wrong.
fn by_slip(claim: &Held) -> Option<String> {
    let others: Vec<&str> = claim.slips.iter().filter(|slip| **slip != claim.id).map(String::as_str).collect();
    (!others.is_empty()).then(|| format!("By the slip of: {}", others.join("; ")))
}

/// The page under `docs/`: its introduction and its sections.
pub fn document(found: &Claims) -> Result<(Vec<Block>, Vec<PageSection>), ExplainError> {
    let links = Links::read()?;
    let behind_claims = links.of_claims();
    let term = |name| (TextMark::Strong, name);
    let about = words![
        "Written by ",
        Span::Code("make claims".into()),
        format!("; a test keeps it fresh. All of it is about {}; the printed article was not at hand. ", found.source),
        "Statements are in words of this project. ",
        term("Misprint"),
        ": a slip in what is written, on which no result rests; ",
        term("refuted"),
        ": what is said is wrong; ",
        term("in part"),
        ": right in part or roughly, and the row says what is not; ",
        term("definition"),
        ": there is nothing to check; ",
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
    let counts: Vec<String> =
        found.groups().map(|(verdict, held)| format!("{} {}", held.len(), verdict_word(verdict))).collect();
    let of = |verdict| words::slips(found.slips_and_consequences(verdict));
    let counts = format!(
        "{} statements: {}. What is refuted is {}, what is misprinted {}: a consequence has the slip of a statement before it, and none of \
         its own.",
        found.claims.len(),
        counts.join(", "),
        of(Verdict::Refuted),
        of(Verdict::Misprint)
    );
    let title = Block::Title("What the paper states, and what was found".into());
    let sections = found.groups().map(|(verdict, held)| {
        let columns = ["id", "where", "statement", "right instead", "known", "evidence", "code", "proof", "test"]
            .map(|head| Column::left(head, 0, 0));
        let mut table = Table::new("", columns);
        for claim in held.iter() {
            let correct = claim.correct.as_deref().unwrap_or_default();
            let known = claim.known.to_string();
            let mut cells =
                [&claim.id, &claim.place, &claim.statement, correct, &known, &claim.evidence].map(Words::from).to_vec();
            cells.extend(behind_claims.get(claim.id.as_str()).map(behind).unwrap_or_default());
            table.row(cells);
        }
        let title = words![capitalized(verdict_word(verdict)), format!(" ({})", count(found, verdict, held.len()))];
        PageSection { id: "", title, blocks: vec![Block::Table(table)] }
    });
    let lead = vec![title, Block::paragraph(about), Block::paragraph(counts)];
    Ok((lead, [by_knowledge(found), slips(found)].into_iter().chain(sections).collect()))
}

/// Number of statements for each verdict and each kind of knowledge.
fn by_knowledge(found: &Claims) -> PageSection {
    let ways = [Evidence::Proved, Evidence::Computed, Evidence::Sampled, Evidence::Read];
    let heads = ["".to_owned()].into_iter().chain(ways.map(|known| known.to_string()));
    let mut table = Table::new("", heads.map(|head| Column::left(head, 0, 0)).collect::<Vec<_>>());
    for (verdict, held) in found.groups() {
        let count = |known| held.iter().filter(|claim| claim.known == known).count();
        table.row([vec![verdict_word(verdict).into()], ways.map(|known| count(known).into()).to_vec()].concat());
    }
    let filter = Words::prose(
        "`corner-impact claims --verdict refuted --known computed` lists those of a kind, and `corner-impact explain` with an id says \
         what is behind one.",
        [],
    );
    PageSection {
        id: "",
        title: "How each is known".into(),
        blocks: vec![Block::Table(table), Block::paragraph(filter)],
    }
}

/// Each error, with the statements that it makes wrong.
fn slips(found: &Claims) -> PageSection {
    let heads = ["made in", "verdict", "where", "right instead", "wrong by it as well"];
    let mut table = Table::new("", heads.map(|head| Column::left(head, 0, 0)));
    for (maker, others) in found.slips() {
        let correct = maker.correct.as_deref().unwrap_or_default();
        let others: Vec<String> =
            others.iter().map(|held| format!("{} ({})", held.id, verdict_word(held.verdict))).collect();
        let row = [&maker.id, verdict_word(maker.verdict), &maker.place, correct, &others.join("; ")];
        table.row(row.map(Words::from));
    }
    let title = format!("Slips ({})", found.slips().count());
    PageSection { id: "", title: title.into(), blocks: vec![Block::Table(table)] }
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
