//! Pages of `claims`: one for a terminal, and one under `docs/`.

use crate::explain::{ExplainError, Links};
use crate::pages::explain::behind;
use crate::show::block::{Block, Column, PageSection, Span, Table, TextMark, Words, words};
use crate::show::words::{self, mark, verdict_word};
use corner_impact::known::Evidence;
use corner_impact::paper::{Claims, Held};
use corner_impact::published::Verdict;

/// Page for a terminal.
pub(crate) fn terminal(found: &Claims) -> Vec<Block> {
    let title = format!("What the paper states, checked with {}", found.model);
    let about = format!("The statements are from {}.", found.source);
    let mut blocks =
        vec![Block::Paragraph(0, (TextMark::Heading, title.as_str()).into()), Block::Paragraph(0, about.into())];
    for (verdict, held) in found.groups().filter(|(_, held)| !held.is_empty()) {
        let name = verdict_word(verdict).to_uppercase();
        let count = format!(" ({})", count(found, verdict, held.len()));
        blocks.extend([Block::Gap, Block::Paragraph(0, words![(mark(verdict), name.as_str()), count])]);
        for claim in held {
            let otherwise = (TextMark::Bad, "THE CHECK CONTRADICTS THE LEDGER");
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
        (TextMark::Good, "Every check confirms the ledger's verdict.")
    } else {
        (TextMark::Bad, "A CHECK DISAGREES WITH THE LEDGER.")
    };
    blocks.extend([Block::Gap, Block::Paragraph(0, agreement.into())]);
    blocks
}

/// Number of statements with a verdict. For a wrong verdict, also the number of statements with an independent error.
fn count(found: &Claims, verdict: Verdict, all: usize) -> String {
    if !verdict.is_wrong() {
        return all.to_string();
    }
    format!("{all}: {}", words::slips(found.slips_and_consequences(verdict)))
}

/// Errors in other statements that make a statement wrong.
fn by_slip(claim: &Held) -> Option<String> {
    let others: Vec<&str> = claim.slips.iter().filter(|slip| **slip != claim.id).map(String::as_str).collect();
    (!others.is_empty()).then(|| format!("Wrong because of the error in: {}", others.join("; ")))
}

/// Page under `docs/`: its introduction and its sections.
pub fn document(found: &Claims) -> Result<(Vec<Block>, Vec<PageSection>), ExplainError> {
    let links = Links::read()?;
    let behind_claims = links.of_claims();
    let term = |name| (TextMark::Strong, name);
    let about = words![
        "Written by ",
        Span::Code("make claims".into()),
        format!(
            "; a test keeps it up to date. The statements are from {}; the printed article was not available. They are reworded here. ",
            found.source
        ),
        "The verdicts are these. ",
        term("Holds"),
        ": the statement is right. ",
        term("Misprint"),
        ": an error in print on which no result depends. ",
        term("Refuted"),
        ": the statement is wrong. ",
        term("In part"),
        ": the statement is right in part or roughly, and its row says what is wrong. ",
        term("Definition"),
        ": there is nothing to check. ",
        term("Open"),
        ": not decided here yet. The kinds of evidence are these: ",
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
        "There are {} statements: {}. The refuted ones are {}. The misprints are {}. A slip is an error that a statement makes itself; a \
         consequence is wrong only because of a slip in an earlier statement.",
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
        "`corner-impact claims --verdict refuted --known computed` lists the statements of one kind. `corner-impact explain` with an id \
         explains one.",
        [],
    );
    PageSection {
        id: "",
        title: "Evidence by verdict".into(),
        blocks: vec![Block::Table(table), Block::paragraph(filter)],
    }
}

/// Each error, with the statements that it makes wrong.
fn slips(found: &Claims) -> PageSection {
    let heads = ["made in", "verdict", "where", "right instead", "also wrong because of it"];
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
