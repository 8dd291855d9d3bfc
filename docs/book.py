"""Makes chapters of the book out of the pages of docs/: a preprocessor of mdBook, called by `make book`.

The pages are written for the project's own site, where formulas and links to files of the project work as they are. Here formulas become
MathML, links that leave docs/ lead to the repository that Cargo.toml names, each command's page ends with the help that the program
prints, and the page about the live page contains it.
"""

import json
import posixpath
import re
import subprocess
import sys
import tomllib
from pathlib import Path

from latex2mathml.converter import convert

ROOT = Path(__file__).parent.parent
REPOSITORY = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["repository"]
PROGRAM = ROOT / "target/release/corner-impact"
LIVE = (
    '<p><a href="live.html" target="_blank">Open the live page in a tab of its own.</a></p>\n\n'
    '<iframe class="live" src="live.html" title="The live page of the paper\'s model"></iframe>'
)

CODE = re.compile(r"(^```.*?^```$|``.+?``|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
FORMULA = re.compile(r"\$([^$`]+?)\$")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def link(target, page):
    """Return where a link of a page leads in the book: what is no page of docs/ is in the repository."""
    if "://" in target or target.startswith("#"):
        return target
    path = posixpath.normpath(posixpath.join("docs", posixpath.dirname(page), target))
    if path == "docs/SUMMARY.md":
        return posixpath.relpath("toc.html", posixpath.dirname(page) or ".")
    return target if path.startswith("docs/") else f"{REPOSITORY}/blob/main/{path}"


def prose(text, page):
    """Convert formulas and links of a piece of text without code."""
    text = FORMULA.sub(lambda found: convert(found[1].strip()), text)
    return LINK.sub(lambda found: f"]({link(found[1], page)})", text)


def converted(text, page):
    """Convert a page: displayed formulas, formulas in lines, links; code stays."""
    pieces = CODE.split(text)
    for index, piece in enumerate(pieces):
        if piece.startswith("```math"):
            formula = piece.removeprefix("```math").removesuffix("```").strip()
            pieces[index] = convert(" ".join(formula.split()), display="block")
        elif index % 2 == 0:
            pieces[index] = prose(piece, page)
    return "".join(pieces)


def commands_help(name):
    """Return what `corner-impact NAME --help` prints, 90 columns wide."""
    ran = subprocess.run(
        [PROGRAM, name, "--help"], check=True, capture_output=True, text=True, env={"COLUMNS": "90", "NO_COLOR": "1"}
    )
    return f"\n\n## Options\n\nPrinted by `corner-impact {name} --help`:\n\n```text\n{ran.stdout.rstrip()}\n```\n"


def convert_chapter(chapter):
    """Convert a chapter and those below it."""
    page = chapter["path"]
    if page:
        text = converted(chapter["content"], page)
        if page.startswith("commands/"):
            text += commands_help(Path(page).stem)
        if page == "explore.md":
            title, rest = text.split("\n", 1)
            text = f"{title}\n\n{LIVE}\n{rest}"
        chapter["content"] = text
    for item in chapter["sub_items"]:
        if isinstance(item, dict) and "Chapter" in item:
            convert_chapter(item["Chapter"])


def main():
    """Answer mdBook: any renderer is supported; a book comes in, and goes out converted."""
    if len(sys.argv) > 1 and sys.argv[1] == "supports":
        return
    _, book = json.load(sys.stdin)
    for item in book.get("items", book.get("sections", [])):
        if isinstance(item, dict) and "Chapter" in item:
            convert_chapter(item["Chapter"])
    json.dump(book, sys.stdout)


main()
