//! Blocks on a terminal: wrapped text, and marks on important words.
//!
//! Only `Page::coloured` shows marks; `Page::plain` omits them, and a mark only repeats what the words say. The crate textwrap breaks the
//! lines. Tables are laid out here, not by comfy-table: it wraps cells that are too wide, but breaks numbers too, and cannot write a table
//! row by row.

use std::fmt::{self, Write};

use textwrap::core::display_width;
use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

use crate::show::block::{Block, Column, Span, Table, TextMark, Words};
use corner_impact::untrusted;
use corner_impact_plot::formula;

/// Default width of a page, in columns.
pub(crate) const WIDTH: usize = 100;

/// Escape code that ends a mark.
const RESET: &str = "\x1b[0m";

impl TextMark {
    const ALL: [Self; 6] = [Self::Heading, Self::Strong, Self::Good, Self::Bad, Self::Doubtful, Self::Open];

    /// Escape codes that begin the mark: bold, and the terminal's sixteen colours, which suit any background.
    fn codes(self) -> &'static str {
        match self {
            Self::Heading => "\x1b[1m",
            Self::Strong => "",
            Self::Good => "\x1b[32m",
            Self::Bad => "\x1b[1;31m",
            Self::Doubtful => "\x1b[33m",
            Self::Open => "\x1b[36m",
        }
    }

    fn around(self, text: &str) -> String {
        let codes = self.codes();
        if codes.is_empty() || text.is_empty() { text.into() } else { format!("{codes}{text}{RESET}") }
    }
}

/// Text with marks, in lines of limited width.
#[derive(Clone, Debug)]
pub struct Page {
    width: usize,
    /// Whether tables have all their columns, however narrow the page is.
    has_all: bool,
    text: String,
    /// Start of the current line in the text.
    line: usize,
}

impl Write for Page {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for piece in text.split_inclusive('\n') {
            self.text.push_str(piece.trim_end_matches('\n'));
            if piece.ends_with('\n') {
                let line = self.text.split_off(self.line);
                self.text.push_str(&folded(&line, self.width));
                self.text.push('\n');
                self.line = self.text.len();
            }
        }
        Ok(())
    }
}

/// Type with a page: laid out once as blocks, shown on any medium.
pub trait Paged {
    /// Contents of the page.
    fn blocks(&self) -> Vec<Block>;

    /// Page for a terminal of `width` columns.
    fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        Page::of(width, false, &self.blocks())
    }

    /// Text of the page at the default width, without marks.
    fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain())
    }
}

impl Page {
    /// Lays out `blocks` as a page. If it is too narrow for a table, dispensable columns are omitted, unless it `has_all`.
    pub(crate) fn of(width: usize, has_all: bool, blocks: &[Block]) -> Result<Self, fmt::Error> {
        let mut page = Self { width, has_all, text: String::new(), line: 0 };
        page.blocks(blocks)?;
        Ok(page)
    }

    /// Writes emphasized words with a line under them.
    fn underlined(&mut self, text: &str, rule: char) -> fmt::Result {
        self.text.push_str(&TextMark::Heading.around(text));
        let length = display_width(text).min(self.width);
        writeln!(self, "\n{}", String::from(rule).repeat(length))
    }

    /// Writes an indented paragraph, wrapped.
    fn paragraph(&mut self, indent: usize, text: &str) -> fmt::Result {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        lines(&text, self.width.min(WIDEST_TEXT).saturating_sub(indent))
            .iter()
            .try_for_each(|line| writeln!(self, "{:indent$}{line}", ""))
    }

    /// Writes blocks in order.
    fn blocks(&mut self, blocks: &[Block]) -> fmt::Result {
        blocks.iter().try_for_each(|block| match block {
            Block::Title(words) => self.underlined(&text(words), '='),
            Block::Heading(words) => {
                writeln!(self)?;
                self.underlined(&text(words), '-')
            }
            Block::Line(words) => writeln!(self, "{}", text(words)),
            Block::Command(line) => {
                let options = options(self.width - 2).initial_indent("  ").subsequent_indent("      ");
                writeln!(self, "{}", textwrap::wrap(&untrusted::visible(line), options).join(" \\\n"))
            }
            Block::Paragraph(indent, words) => self.paragraph(*indent, &text(words)),
            Block::Note(words) => self.paragraph(2, &text(words)),
            Block::Entries(width, entries) => {
                entries.iter().try_for_each(|(name, words)| self.entry(*width, &text(name), &text(words)))
            }
            Block::Table(table) => self.table(table),
            Block::List(items) => items.iter().try_for_each(|words| self.paragraph(2, &text(words))),
            Block::Brief(blocks) | Block::About(_, blocks) => self.blocks(blocks),
            Block::Gap => writeln!(self),
            Block::Full(_) | Block::Details(..) | Block::Markup(_) => Ok(()),
        })
    }

    /// Writes a name, and its description wrapped in a column that begins `width` columns further.
    fn entry(&mut self, width: usize, name: &str, words: &str) -> fmt::Result {
        let column = 2 + width;
        let hang = if column <= self.width * 2 / 5 { column } else { 4 };
        let pad = " ".repeat(width.saturating_sub(display_width(name)));
        for (index, line) in words.split('\n').enumerate() {
            let first = if index == 0 { format!("  {name}{pad}") } else { " ".repeat(column) };
            let options = options(self.width).initial_indent(&first);
            let hang = " ".repeat(hang);
            let lines = textwrap::wrap(line, options.subsequent_indent(&hang));
            lines.iter().try_for_each(|line| writeln!(self, "{line}"))?;
        }
        Ok(())
    }

    pub(crate) fn plain(&self) -> String {
        let codes = TextMark::ALL.map(TextMark::codes).into_iter().filter(|codes| !codes.is_empty());
        codes.chain([RESET]).fold(self.text.clone(), |text, code| text.replace(code, ""))
    }

    /// The text with escape codes around marked words.
    pub(crate) fn coloured(&self) -> &str {
        &self.text
    }
}

/// Words as text for a terminal.
pub(crate) fn text(words: &Words) -> String {
    let of = |span: &Span| match span {
        Span::Text(text) => untrusted::visible(&formula::typed(text)).into_owned(),
        Span::Quoted(text) | Span::Code(text) | Span::Formula(text) => untrusted::visible(text).into_owned(),
        Span::Unit(unit) => (*unit).to_owned(),
        Span::Number(value, digits) | Span::Against(value, _, digits) => digits.text(*value),
        Span::Complex([re, im], digits) if *im == 0.0 => digits.text(*re),
        Span::Complex([re, im], digits) => {
            format!("{} {} {}i", digits.text(*re), if *im < 0.0 { '-' } else { '+' }, digits.text(im.abs()))
        }
        Span::Matrix(rows, digits) => {
            let row = |row: &Vec<f64>| match row.as_slice() {
                [entry] => digits.text(*entry),
                row => format!("[{}]", row.iter().map(|entry| digits.text(*entry)).collect::<Vec<_>>().join(", ")),
            };
            let entries = rows.iter().map(row).collect::<Vec<_>>().join(", ");
            if rows.iter().all(|row| row.len() == 1) { format!("({entries})") } else { format!("[{entries}]") }
        }
        Span::Marked(mark, text) => mark.around(&untrusted::visible(text)),
        Span::About(_, words) => self::text(words),
        Span::Break => "\n".into(),
    };
    words.0.iter().map(of).collect()
}

/// Widest line of text: longer ones are hard to read. Tables may be wider.
const WIDEST_TEXT: usize = 80;

/// Options for wrapping: lines break only at spaces, as late as possible; a word that is too long is not broken.
pub(crate) fn options<'a>(width: usize) -> Options<'a> {
    Options::new(width.min(WIDEST_TEXT))
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .wrap_algorithm(WrapAlgorithm::FirstFit)
        .word_splitter(WordSplitter::NoHyphenation)
}

fn lines(text: &str, width: usize) -> Vec<String> {
    textwrap::wrap(text, options(width)).into_iter().map(Into::into).collect()
}

/// Wraps a line; the continuation begins under the line's second column, if it has one.
fn folded(line: &str, width: usize) -> String {
    if display_width(line) <= width {
        return line.into();
    }
    let words = line.trim_start();
    let indent = line.len() - words.len();
    let second = words.find("  ").map(|gap| {
        let space = words[gap..].len() - words[gap..].trim_start().len();
        indent + display_width(&words[..gap]) + space
    });
    let hang = second.filter(|column| *column <= width * 2 / 5).unwrap_or(indent + 2).min(width / 2);
    let (first, hang) = (" ".repeat(indent), " ".repeat(hang));
    textwrap::wrap(words, options(width).initial_indent(&first).subsequent_indent(&hang)).join("\n")
}

/// Spaces before each column's cells, and the width of the cells.
type Layout = Vec<(usize, usize)>;

/// Least width in which the last column's words are wrapped.
const NARROWEST: usize = 18;

/// Table, or some of its columns, as text.
#[derive(Clone)]
struct Cells<'a> {
    columns: Vec<&'a Column>,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl<'a> Cells<'a> {
    fn of(table: &'a Table) -> Self {
        Self {
            columns: table.columns.iter().collect(),
            heads: table.columns.iter().map(|column| text(&column.head)).collect(),
            rows: table.rows.iter().map(|row| row.cells.iter().map(text).collect()).collect(),
        }
    }

    /// Selects some of the columns.
    fn only(&self, is_kept: impl Fn(usize) -> bool) -> Self {
        fn some<T: Clone>(all: &[T], is_kept: impl Fn(usize) -> bool) -> Vec<T> {
            all.iter().enumerate().filter(|(column, _)| is_kept(*column)).map(|(_, it)| it.clone()).collect()
        }
        Self {
            columns: some(&self.columns, &is_kept),
            heads: some(&self.heads, &is_kept),
            rows: self.rows.iter().map(|row| some(row, &is_kept)).collect(),
        }
    }

    /// Width of the widest cell of each column, with these heads.
    fn natural(&self, heads: &[String]) -> Vec<usize> {
        let widest = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column)).chain([&heads[column]]);
            cells.flat_map(|cell| cell.split('\n')).map(display_width).max().unwrap_or(0)
        };
        (0..self.columns.len()).map(widest).collect()
    }

    /// Layout with the gaps and widths that the columns request.
    fn wide(&self) -> Layout {
        let columns = self.columns.iter().zip(self.natural(&self.heads));
        columns.map(|(column, widest)| (column.gap, widest.max(column.least))).collect()
    }

    /// Layout with the smallest gaps, with these heads.
    fn close(&self, heads: &[String]) -> Layout {
        self.natural(heads).into_iter().map(|widest| (2, widest)).collect()
    }

    /// Heads and layout for a page of `width` columns; `None` if it is too narrow.
    fn layout(&self, width: usize) -> Option<(Vec<String>, Layout)> {
        let last = self.columns.len() - 1;
        // Heads are broken into lines as narrow as their cells.
        let longest = |head: &str| head.split_whitespace().map(display_width).max().unwrap_or(0);
        let of_cells = self.natural(&vec![String::new(); last + 1]);
        let heads = self.heads.iter().zip(of_cells);
        let broken: Vec<String> = heads.map(|(head, cells)| lines(head, cells.max(longest(head))).join("\n")).collect();
        let choices =
            [(&self.heads, self.wide()), (&self.heads, self.close(&self.heads)), (&broken, self.close(&broken))];
        let fits = |(_, layout): &&(&Vec<String>, Layout), folded: bool| {
            // Words may be wrapped, numbers may not.
            let (gap, widest) = layout[last];
            let room = if folded && self.columns[last].left { widest.min(NARROWEST) } else { widest };
            layout[..last].iter().map(|(gap, width)| gap + width).sum::<usize>() + gap + room <= width
        };
        let whole = choices.iter().find(|choice| fits(choice, false));
        let found = whole.or_else(|| choices.iter().find(|choice| fits(choice, true)));
        found.map(|(heads, layout)| ((*heads).clone(), layout.clone()))
    }

    /// Most dispensable column, if any.
    fn least_needed(&self) -> Option<usize> {
        let ranked = self.columns.iter().enumerate().filter(|(_, column)| column.missable > 0);
        ranked.max_by_key(|(_, column)| column.missable).map(|(index, _)| index)
    }
}

impl Page {
    /// Writes a table with its gaps, or without them, or with heads of several lines. If it is still too wide, dispensable columns are
    /// omitted and named below; without any, it is split into several tables or written row by row.
    fn table(&mut self, table: &Table) -> fmt::Result {
        if table.columns.is_empty() {
            return Ok(());
        }
        let cells = Cells::of(table);
        if let Some(kept) = table.repeated {
            return self.tables(&cells, kept);
        }
        let mut part = cells.clone();
        let mut left_out = Vec::new();
        loop {
            if let Some((heads, layout)) = part.layout(self.width) {
                self.side_by_side(&part, &heads, &layout)?;
                break;
            }
            let Some(least) = part.least_needed().filter(|_| !self.has_all) else { return self.stacked(&cells) };
            left_out.push(part.heads[least].trim().replace('\n', " "));
            part = part.only(|column| column != least);
        }
        if left_out.is_empty() {
            return Ok(());
        }
        left_out.reverse();
        self.paragraph(2, &format!("Left out at this width: {}; --all has every column.", left_out.join(", ")))
    }

    /// Writes several tables with the first and the `kept` last columns in each, as few as possible, with the others evenly distributed.
    fn tables(&mut self, cells: &Cells<'_>, kept: usize) -> fmt::Result {
        let count = cells.columns.len();
        let between = 1..count.saturating_sub(kept).max(1);
        let takes = |layout: &[(usize, usize)]| layout.iter().map(|(gap, width)| gap + width).sum::<usize>();
        let needs = |layout: &Layout| {
            let each = layout[between.clone()].iter().map(|(gap, width)| gap + width).max().unwrap_or(1);
            let room = self.width.saturating_sub(takes(&layout[..1]) + takes(&layout[between.end..]));
            between.len().div_ceil((room / each).max(1)).max(1)
        };
        let (wide, close) = (cells.wide(), cells.close(&cells.heads));
        let wide = if needs(&close) < needs(&wide) { close } else { wide };
        let tables = needs(&wide);
        let columns: Vec<usize> = between.clone().collect();
        for (index, some) in columns.chunks(columns.len().div_ceil(tables).max(1)).enumerate() {
            if index > 0 {
                writeln!(self)?;
            }
            let part = cells.only(|column| column == 0 || column >= between.end || some.contains(&column));
            // All parts have the widths of the whole table.
            let layout = wide.iter().enumerate();
            let layout = layout.filter(|(column, _)| *column == 0 || *column >= between.end || some.contains(column));
            self.side_by_side(&part, &part.heads, &layout.map(|(_, layout)| *layout).collect())?;
        }
        Ok(())
    }

    fn side_by_side(&mut self, part: &Cells<'_>, heads: &[String], layout: &Layout) -> fmt::Result {
        let last = layout.len() - 1;
        // Heads of several lines are aligned at the bottom.
        let depth = heads.iter().map(|head| head.split('\n').count()).max().unwrap_or(1);
        let head_line = |line: usize| {
            let part = |head: &String| {
                let above = depth - head.split('\n').count();
                line.checked_sub(above).and_then(|line| head.split('\n').nth(line)).unwrap_or("").to_owned()
            };
            heads.iter().map(part).collect::<Vec<String>>()
        };
        let heads = (0..depth).map(head_line).filter(|head| head.iter().any(|cell| !cell.is_empty()));
        for row in heads.chain(part.rows.iter().cloned()) {
            let mut line = String::new();
            for (index, cell) in row.iter().enumerate() {
                let (gap, width) = layout[index];
                let space = width.saturating_sub(display_width(cell));
                let (before, behind) = if part.columns[index].left { (gap, space) } else { (gap + space, 0) };
                line.push_str(&" ".repeat(before));
                if index == last && part.columns[index].left {
                    let hang = display_width(&line);
                    let hanging = format!("\n{}", " ".repeat(hang));
                    line.push_str(&lines(cell, self.width.saturating_sub(hang).max(1)).join(&hanging));
                } else {
                    line.push_str(cell);
                    line.push_str(&" ".repeat(behind));
                }
            }
            // Spaces at the end of a line are omitted.
            writeln!(self, "{}", line.trim_end_matches(' '))?;
        }
        Ok(())
    }

    fn stacked(&mut self, cells: &Cells<'_>) -> fmt::Result {
        // A head of several lines is written in one line here.
        let heads: Vec<String> = cells.heads.iter().map(|head| head.trim().replace('\n', " ")).collect();
        let longest = heads.iter().map(|head| display_width(head)).max().unwrap_or(0);
        for (number, row) in cells.rows.iter().enumerate() {
            if number > 0 {
                writeln!(self)?;
            }
            for (head, cell) in heads.iter().zip(row).filter(|(_, cell)| !cell.is_empty()) {
                match head.as_str() {
                    // The number of a row is its head.
                    "" => writeln!(self, "  {cell}")?,
                    head => writeln!(self, "  {head:<longest$}  {cell}")?,
                }
            }
        }
        Ok(())
    }
}
