"""Changes operators, conditions and values in the formulas, one at a time; each change must fail a test.

All changes are compiled at once, as mutant schemata (Untch, Offutt, Harrold 1993). Where the source says `a + b`, a copy of it says
"a + b, but a - b in mutant 17 and a * b in mutant 18". An environment variable names the mutant of a process. So one build serves
thousands of mutants. Each mutant is tried on the tests that reach it, quickest first, up to the first that fails. failing.toml lists,
for each file, tests that have failed; they are asked first. A mutant that passes them is asked all tests that reach it, which a first
run of each test notes. The time of each test is kept beside the build.

    python tests/mutants/mutants.py                   every mutant of every stage: some hours
    python tests/mutants/mutants.py simulate/again    mutants in files whose path has these words
    python tests/mutants/mutants.py --parts 100 --seed 7       one part of a hundred, drawn by the seed; or --seconds 60, as many as fit
    python tests/mutants/mutants.py --changed --most 120       mutants of the files that have changed since all their mutants were asked
    python tests/mutants/mutants.py --out tried.jsonl          in several sittings: the next run continues where one was broken off
    python tests/mutants/mutants.py --learn tried.jsonl        no mutant: adds to failing.toml what has failed there, and notes in
                                                               asked.toml the files of which all have been asked, in open.toml what has passed

Mutants that survive are listed, and the exit code is then 1. Mutants with a reason in explained.toml are not asked. With --most,
those in open.toml, which are still to be decided, are not asked either.
"""

import argparse
import hashlib
import json
import math
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from collections import Counter, defaultdict
from multiprocessing.pool import ThreadPool
from pathlib import Path

import tree_sitter
import tree_sitter_rust

ROOT = Path(__file__).resolve().parents[2]
COPY = ROOT / "target" / "mutants"
REACHED = COPY / "reached.json"
SECONDS = COPY / "seconds.json"
FAILING = ROOT / "tests" / "mutants" / "failing.toml"
EXPLAINED = ROOT / "tests" / "mutants" / "explained.toml"
ASKED = ROOT / "tests" / "mutants" / "asked.toml"
OPEN = ROOT / "tests" / "mutants" / "open.toml"
UNVIABLE = COPY / "unviable.json"
STAGES = ["model", "cam", "flight", "impact", "simulate", "section", "orbit", "corner", "border_collision", "study", "interval"]

ARITHMETIC = {"+": "-*", "-": "+/", "*": "+/", "/": "*%", "%": "/+"}
COMPARISONS = {"==": ["!="], "!=": ["=="], "<": ["<=", ">"], ">": [">=", "<"], "<=": ["<", ">"], ">=": [">", "<"]}
LOGICAL = ["left alone", "right alone"]
VALUES = {"bool": ["true", "false"], "f64": ["0.0", "1.0", "-1.0"], "usize": ["0", "1"], "u32": ["0", "1"], "u64": ["0", "1"]}
# A hundred random cases: a test of thousands would take too long to be asked at all.
ENVIRONMENT = {"RAYON_NUM_THREADS": "1", "INSTA_UPDATE": "no", "PROPTEST_CASES": "100"}
# Nodes in which nothing can be switched at run time, or in which an operator is not arithmetic.
PASSED_OVER = {"const_item", "static_item", "const_block", "attribute_item", "macro_invocation", "macro_definition", "type_arguments",
               "array_type", "enum_variant", "string_literal", "line_comment", "block_comment", "use_declaration"}

SWITCH = """
/// Which mutant this process is: MUTANT is its number, or the name of a file for what is reached.
pub mod mutants {
    use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};
    const NONE: u32 = u32::MAX - 2;
    const NOTES: u32 = u32::MAX - 1;
    const UNKNOWN: u32 = u32::MAX;
    static MUTANT: AtomicU32 = AtomicU32::new(UNKNOWN);
    static SEEN: [AtomicU8; COUNT] = [const { AtomicU8::new(0) }; COUNT];

    #[inline(always)]
    pub fn is(id: u32) -> bool {
        let now = MUTANT.load(Relaxed);
        (if now >= NOTES { note(id) } else { now }) == id
    }

    #[inline(always)]
    pub fn none(first: u32, count: u32) -> bool {
        let now = MUTANT.load(Relaxed);
        (if now >= NOTES { note(first) } else { now }).wrapping_sub(first) >= count
    }

    #[cold]
    fn note(id: u32) -> u32 {
        use std::io::Write;
        if MUTANT.load(Relaxed) == NOTES && SEEN[id as usize].load(Relaxed) == 1 { return NOTES }
        let name = std::env::var("MUTANT").unwrap_or_default();
        let now = name.parse().unwrap_or(if name.is_empty() { NONE } else { NOTES });
        MUTANT.store(now, Relaxed);
        if now == NOTES && SEEN[id as usize].swap(1, Relaxed) == 0 {
            let file = std::fs::OpenOptions::new().create(true).append(true).open(name);
            let _ = file.and_then(|mut file| file.write_all(format!("{id}\\n").as_bytes()));
        }
        now
    }
}
"""


def flat(text):
    return " ".join(text.split())


class Schema:
    """File with all its mutants in it."""

    def __init__(self, path, parser, viable, mutants):
        self.path, self.viable, self.mutants = path, viable, mutants
        self.source = (ROOT / path).read_bytes()
        # Ranges of the written text with their mutants, to find the mutant that the compiler complains about.
        self.places = []
        self.function = ""
        self.repeated, self.seen = Counter(), Counter()
        self.out, self.length = [], 0
        self.node(parser.parse(self.source).root_node)
        self.text = "".join(self.out)

    def put(self, text):
        self.out.append(text)
        self.length += len(text.encode())

    def said(self, node):
        return self.source[node.start_byte : node.end_byte].decode()

    def take(self, node, operator, replacements):
        """Return the replacements that compile, each with its number. The name of a mutant is its function, the operator, and the
        ordinal of this operator in the function, from 1."""
        code, ids = flat(self.said(node)), []
        self.seen[self.function, operator] += 1
        for replacement in replacements:
            mutant = {"file": str(self.path), "function": self.function, "code": code, "replacement": replacement}
            key = json.dumps(mutant)
            self.repeated[key] += 1
            mutant |= {"operator": operator, "ordinal": self.seen[self.function, operator]}
            mutant |= {"line": node.start_point[0] + 1, "key": f"{key}#{self.repeated[key]}"}
            if self.viable(mutant["key"]):
                ids.append((len(self.mutants), replacement))
                self.mutants.append(mutant)
        return ids

    def variants(self, ids, original, variant, end="}"):
        """Write `if none { original } else if is(17) { .. }`. The original comes first, so that the compiler takes its type from it."""
        first, count = ids[0][0], len(ids)
        self.put(f"if crate::mutants::none({first}, {count}) {{ {original} }}")
        for number, (id, replacement) in enumerate(ids):
            begin = self.length
            test = f" if crate::mutants::is({id})" if number + 1 < count else ""
            self.put(f" else{test} {{ {variant(replacement)} }}")
            self.places.append((begin, self.length, [id]))
        self.put(end)

    def wrapped(self, ids, write):
        begin = self.length
        write()
        self.places.append((begin, self.length, [id for id, _ in ids]))

    def children(self, node):
        at = node.start_byte
        for child in node.children:
            self.put(self.source[at : child.start_byte].decode())
            self.node(child)
            at = child.end_byte
        self.put(self.source[at : node.end_byte].decode())

    def node(self, node):
        if node.type in PASSED_OVER:
            return self.put(self.said(node))
        write = getattr(self, node.type, None)
        if not (write and write(node)):
            self.children(node)

    def function_item(self, node):
        if any(child.type == "function_modifiers" and "const" in self.said(child) for child in node.children):
            self.put(self.said(node))
            return True
        outer, name = self.function, self.said(node.child_by_field_name("name"))
        owner, above = "", node.parent
        while above is not None and not owner:
            owner = self.said(above.child_by_field_name("type")).split("<")[0] + "::" if above.type == "impl_item" else ""
            above = above.parent
        self.function = owner + name
        body, returned = node.child_by_field_name("body"), node.child_by_field_name("return_type")
        kind = flat(self.said(returned)) if returned else "()"
        values = VALUES.get(kind, [])
        inner = re.fullmatch(r"Option<(.*)>", kind)
        if inner:
            values = ["None"] + [f"Some({value})" for value in VALUES.get(inner[1], [])]
        elif kind.startswith("Vec<"):
            values = ["Vec::new()"]
        elif kind.startswith("Result<(),"):
            values = ["Ok(())"]
        elif kind == "String":
            values = ["String::new()"]
        at = node.start_byte
        for child in node.children:
            self.put(self.source[at : child.start_byte].decode())
            at = child.end_byte
            if child == body:
                self.put("{")
                # The function's name stands for the code, since a body is too long.
                for id, value in self.take(node.child_by_field_name("name"), "returns", values):
                    self.wrapped([(id, value)], lambda: self.put(f"if crate::mutants::is({id}) {{ return {value}; }}"))
                self.put("{")
                self.children(child)
                self.put("}}")
            else:
                self.put(self.said(child))
        self.function = outer
        return True

    def binary_expression(self, node):
        left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
        operator = self.said(node.child_by_field_name("operator"))
        replacements = ARITHMETIC.get(operator) or COMPARISONS.get(operator) or (operator in ("&&", "||") and LOGICAL)
        if not replacements or "let_condition" in str(node):
            return False
        ids = self.take(node, operator, list(replacements))
        if not ids:
            return False

        def write():
            if operator in ("&&", "||"):
                on = {name: "false" for name in LOGICAL} | {name: f"crate::mutants::is({id})" for id, name in ids}
                self.put("({ let l__: bool = ")
                self.node(left)
                sign = "!" if operator == "&&" else ""
                self.put(f"; if {sign}l__ && !{on['right alone']} || {on['left alone']} {{ l__ }} else {{ ")
                self.node(right)
                self.put(" } })")
                return
            compares = operator in COMPARISONS
            self.put("(match (&(" if compares else "(match (")
            self.node(left)
            self.put("), &(" if compares else ", ")
            self.node(right)
            self.put(")) { (l__, r__) => " if compares else ") { (l__, r__) => ")
            star = "*" if compares else ""
            self.variants(ids, f"{star}l__ {operator} {star}r__", lambda other: f"{star}l__ {other} {star}r__", "})")

        self.wrapped(ids, write)
        return True

    def compound_assignment_expr(self, node):
        left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
        operator = self.said(node.child_by_field_name("operator"))
        ids = self.take(node, operator, [other + "=" for other in ARITHMETIC.get(operator[:-1], "")])
        if not ids:
            return False

        def write():
            self.put("match ")
            self.node(right)
            self.put(" { r__ => ")
            place = self.said(left)
            self.variants(ids, f"{place} {operator} r__", lambda other: f"{place} {other} r__")

        self.wrapped(ids, write)
        return True

    def unary_expression(self, node):
        operator = node.children[0].type
        ids = self.take(node, f"{operator}x", ["without it"]) if operator in "-!" else []
        if not ids:
            return False

        def write():
            self.put("(match ")
            self.node(node.children[1])
            self.put(" { x__ => ")
            self.variants(ids, f"{operator}x__", lambda _: "x__", "})")

        self.wrapped(ids, write)
        return True

    def match_block(self, node):
        """Write a match in which a guard, and an arm before an arm that takes everything, may be left out."""
        arms = [child for child in node.children if child.type == "match_arm"]
        patterns = [arm.child_by_field_name("pattern") for arm in arms]
        takes_all = bool(patterns) and self.said(patterns[-1]) == "_"
        at = node.start_byte
        for child in node.children:
            self.put(self.source[at : child.start_byte].decode())
            at = child.end_byte
            if child.type != "match_arm":
                self.put(self.said(child))
                continue
            pattern = child.child_by_field_name("pattern")
            guard = pattern.child_by_field_name("condition")
            value = child.child_by_field_name("value")
            if guard is not None and ("let_condition" in str(guard) or guard.type == "let_chain"):
                self.node(child)
                continue
            left_out = takes_all and child != arms[-1]
            ids = dict((name, id) for id, name in self.take(pattern, "arm", (["arm left out"] if left_out else []) + (["guard left out"] if guard else [])))
            begin = self.length
            self.put(self.source[child.start_byte : (guard.start_byte if guard else pattern.end_byte)].decode())
            conditions = []
            if "arm left out" in ids:
                conditions.append(f"!crate::mutants::is({ids['arm left out']})")
            if conditions or guard:
                self.put(("" if guard else " if ") + " && ".join(conditions + [""]) if guard else " if " + conditions[0])
            if guard:
                self.put(f"(crate::mutants::is({ids['guard left out']}) || (" if "guard left out" in ids else "((")
                self.node(guard)
                self.put("))")
            if ids:
                self.places.append((begin, self.length, list(ids.values())))
            self.put(self.source[pattern.end_byte : value.start_byte].decode())
            self.node(value)
            self.put(self.source[value.end_byte : child.end_byte].decode())
        self.put(self.source[at : node.end_byte].decode())
        return True


def sources(words):
    for stage in STAGES:
        one = ROOT / "src" / f"{stage}.rs"
        for path in [one] if one.is_file() else sorted((ROOT / "src" / stage).rglob("*.rs")):
            if not words or any(word in str(path.relative_to(ROOT)) for word in words):
                yield path.relative_to(ROOT)


def schemata(viable, words):
    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language()))
    mutants = []
    return [Schema(path, parser, viable, mutants) for path in sources(words)], mutants


def number(text):
    return int.from_bytes(hashlib.sha256(text.encode()).digest())


def changed(path, text):
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def copied():
    """Copy the package to write the mutants into. The files that its tests read stay where they are."""
    COPY.mkdir(parents=True, exist_ok=True)
    shutil.copytree(ROOT / "src", COPY / "src", dirs_exist_ok=True)
    for name in subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n"):
        top = name.split("/")[0]
        if top and top not in ("src", "Cargo.toml") and not (COPY / top).exists():
            (COPY / top).symlink_to(ROOT / top)
    if (ROOT / ".venv").exists() and not (COPY / ".venv").exists():
        (COPY / ".venv").symlink_to(ROOT / ".venv")
    # A mutant may be unreachable, unused or absurd, so no lint applies.
    manifest = re.sub(r"(\[workspace\.lints\.\w+\]\n)(.+\n)*", r"\1", (ROOT / "Cargo.toml").read_text())
    changed(COPY / "Cargo.toml", manifest)


def compiled(again):
    environment = os.environ | {"CARGO_TARGET_DIR": str(COPY / "target"), "CARGO_INCREMENTAL": str(int(again)), "RUSTFLAGS": os.environ.get("RUSTFLAGS", "")}
    words = ["cargo", "test", "--no-run", "--test", "it", "--release", "--locked", "--message-format=json"]
    done = subprocess.run(words, cwd=COPY, env=environment, capture_output=True, text=True)
    return done, [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def refused_by_compiler():
    return set(json.loads(UNVIABLE.read_text())) if UNVIABLE.exists() else set()


def name_of(mutant):
    return tuple(mutant[key] for key in ("file", "function", "operator", "ordinal", "replacement"))


def names_of(files):
    """Return the names of mutants in a table of files. Rows have function, operator, its ordinal and the replacements."""
    return {(file, *place, other) for file, known in files.items() if file != "why" for *place, others in known for other in others}


def explained():
    """Return the names of the mutants that explained.toml has a reason for."""
    return set().union(*map(names_of, tomllib.loads(EXPLAINED.read_text())["reason"]))


def undecided():
    """Return the names of the mutants that have passed the tests that they were asked, without a reason."""
    return names_of(tomllib.loads(OPEN.read_text())) if OPEN.exists() else set()


def digest(path):
    """Return a digest of the code of a file, without layout, comments and string literals."""
    words, left = [], [tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language())).parse((ROOT / path).read_bytes()).root_node]
    while left:
        node = left.pop()
        if node.type in ("line_comment", "block_comment", "string_literal", "raw_string_literal"):
            continue
        left.extend(reversed(node.children))
        if not node.children:
            words.append(node.text.decode())
    return hashlib.sha256(" ".join(words).encode()).hexdigest()[:16]


def unasked():
    """Return the files that have changed since all their mutants were asked."""
    asked = tomllib.loads(ASKED.read_text()) if ASKED.exists() else {}
    return [str(path) for path in sources([]) if asked.get(str(path)) != digest(path)]


def built(words, drawn, again):
    """Return the test binary with all drawn mutants of these files that compile, and the mutants. `again` is True if others of them
    are compiled soon."""
    copied()
    if not (COPY / "target" / "release").exists() and (ROOT / "target" / "release").exists():
        # The dependencies are compiled already. They are copied, not linked, because cargo writes into these folders. Files that
        # another build removes meanwhile are compiled again.
        (COPY / "target" / "release").mkdir(parents=True)
        for part in ("deps", "build", ".fingerprint"):
            subprocess.run(["cp", "-a", ROOT / "target" / "release" / part, COPY / "target" / "release" / part], stderr=subprocess.DEVNULL)
    unviable = refused_by_compiler()
    while True:
        files, mutants = schemata(lambda key: key not in unviable and drawn(key), words)
        for file in files:
            changed(COPY / file.path, file.text)
        library = (ROOT / "src" / "lib.rs").read_text() + SWITCH.replace("COUNT", str(len(mutants)))
        changed(COPY / "src" / "lib.rs", library)
        done, messages = compiled(again)
        refused = set()
        for message in messages:
            message = message.get("message", {})
            if message.get("level") != "error":
                continue
            for span in message["spans"]:
                file = next((file for file in files if str(file.path) == span["file_name"]), None)
                if not span["is_primary"] or file is None:
                    continue
                around = [place for place in file.places if place[0] <= span["byte_start"] and span["byte_end"] <= place[1]]
                if around:
                    refused.update(min(around, key=lambda place: place[1] - place[0])[2])
                else:
                    print("nowhere:", message["rendered"])
        print(f"{len(mutants)} mutants, of which the compiler refuses {len(refused)}", flush=True)
        if not refused:
            if done.returncode:
                errors = [message["message"]["rendered"] for message in messages if message.get("message", {}).get("level") == "error"]
                sys.exit("\n".join(errors) or done.stderr)
            break
        unviable |= {mutants[id]["key"] for id in refused}
        UNVIABLE.write_text(json.dumps(sorted(unviable)))
    binary = next(message["executable"] for message in messages if message.get("executable") and message["target"]["name"] == "it")
    return binary, mutants


def limited(seconds):
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    # The process is limited to the millisecond, and its children in whole seconds.
    signal.setitimer(signal.ITIMER_PROF, seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.setpgid(0, 0)


def became(binary, tests, seconds, mutant):
    """Run tests on a mutant. Return "pass", "fail" or "too long"; the tests that failed, or the one that was running at the end; and
    the seconds of a core that all took. The limit is in seconds of a core, whatever else the machine does, so that a test may wait."""
    words = [binary, "--include-ignored", "--exact", "--test-threads=1", *tests]
    # The output goes to a file, which is read once the test has ended. Children of the test may still hold a pipe.
    with tempfile.TemporaryFile() as said:
        run = subprocess.Popen(words, cwd=COPY, env=os.environ | {"MUTANT": mutant} | ENVIRONMENT,
                               stdout=said, stderr=subprocess.DEVNULL, preexec_fn=lambda: limited(seconds))
        waited = threading.Timer(10 * seconds, lambda: ended(run.pid))
        waited.start()
        try:
            _, status, used = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
        finally:
            waited.cancel()
            ended(run.pid)
        said.seek(0)
        ended_as = dict(re.findall(r"^test (\S+) \.\.\. (ok|FAILED)$", said.read().decode(errors="replace"), re.MULTILINE))
    done = "pass" if run.returncode == 0 else "too long" if run.returncode in (-signal.SIGPROF, -signal.SIGXCPU, -signal.SIGKILL) else "fail"
    failed = [test for test, end in ended_as.items() if end == "FAILED"] or [test for test in sorted(tests) if test not in ended_as][:1]
    return done, failed if done != "pass" else [], used.ru_utime + used.ru_stime


def ended(group):
    try:
        os.killpg(group, signal.SIGKILL)
    except ProcessLookupError:
        pass


def named(binary):
    listed = subprocess.run([binary, "--list"], cwd=COPY, capture_output=True, text=True, check=True).stdout
    return [line.removesuffix(": test") for line in listed.splitlines() if line.endswith(": test")]


def reached(binary, longest, words, jobs):
    """Return, for each test that passes in time, the seconds that it takes and the places that it reaches."""
    stamp = hashlib.sha256(Path(binary).read_bytes()).hexdigest()
    known = json.loads(REACHED.read_text()) if REACHED.exists() else {"asked": [], "slow": {}}
    asked = [stamp, longest, words]
    if known["asked"] == asked:
        return known["tests"]
    # A test that took too long in another build is not tried again.
    slow = known["slow"]
    names = [name for name in named(binary) if not words or any(word in name for word in words)]
    tests = {}

    def note(name):
        if slow.get(name, 0) >= longest:
            return
        notes = COPY / "notes" / name.replace("::", ".")
        notes.unlink(missing_ok=True)
        done, _, took = became(binary, [name], longest, str(notes))
        # Its children count as well.
        if done == "too long" or took > longest:
            slow[name] = longest
        elif done == "pass":
            tests[name] = [took, sorted({int(line) for line in notes.read_text().split()}) if notes.exists() else []]

    (COPY / "notes").mkdir(exist_ok=True)
    with ThreadPool(jobs) as pool:
        pool.map(note, names, chunksize=1)
    print(f"{len(tests)} of {len(names)} tests pass within {longest} s each", flush=True)
    REACHED.write_text(json.dumps({"asked": asked, "slow": slow, "tests": dict(sorted(tests.items()))}))
    return tests


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("words", nargs="*", help="parts of the paths of the files to look at")
    ask.add_argument("--parts", type=int, default=1, help="one part of so many, the same mutants each time that it is drawn")
    ask.add_argument("--changed", action="store_true", help="look at the files alone that have changed since all their mutants were asked")
    ask.add_argument("--most", type=int, help="at most about so many, in place of --parts")
    ask.add_argument("--seed", default="", help="what draws the part, and the order")
    ask.add_argument("--seconds", type=float, default=float("inf"), help="begin no mutant after so long")
    ask.add_argument("--longest", type=float, default=10.0, help="no test that takes longer, s")
    ask.add_argument("--tests", nargs="*", default=[], help="parts of the names of the tests to ask, instead of all")
    ask.add_argument("--enough", type=float, default=float("inf"), help="ask no further test of a mutant that has passed so many seconds of them")
    ask.add_argument("--jobs", type=int, default=1, help="so many mutants at a time")
    ask.add_argument("--out", help="write what became of each, as JSON lines; what has failed a test there already is not asked again")
    ask.add_argument("--learn", metavar="TRIED", help="add to failing.toml what has failed in this --out, and run none")
    ask.add_argument("--list", action="store_true", help="list them, and run none")
    asked = ask.parse_args()
    if asked.learn:
        return learned(asked.learn)
    begun = time.monotonic()
    told, still_open = explained(), undecided()
    gone = told - {name_of(mutant) for mutant in schemata(lambda key: True, [])[1]}
    if gone:
        sys.exit(f"listed, and there is no such mutant: {sorted(gone)}")
    if asked.changed:
        asked.words = [path for path in unasked() if not asked.words or any(word in path for word in asked.words)]
        if not asked.words:
            return print("no file has changed since all its mutants were asked")
        print("changed since all their mutants were asked:", *asked.words, flush=True)
    if asked.most:
        asked.parts = max(1, round(len(schemata(lambda key: True, asked.words)[1]) / asked.most))
    binary, mutants = built(asked.words, lambda key: (number(key) - number(asked.seed)) % asked.parts == 0, asked.parts == 1 and not asked.changed)
    # A place notes the number of its first mutant.
    chosen = list(range(len(mutants)))
    stage = lambda id: Path(mutants[id]["file"]).parts[1].removesuffix(".rs")
    in_all = Counter(map(stage, chosen))
    random.Random(asked.seed).shuffle(chosen)
    if asked.list:
        for id in sorted(chosen):
            print(*name_of(mutants[id]), mutants[id]["code"], sep=" | ")
        return
    print(f"ready after {time.monotonic() - begun:.0f} s", flush=True)

    before = {}
    if asked.out and Path(asked.out).exists():
        lines = [json.loads(line) for line in Path(asked.out).read_text().splitlines()]
        before = {line["key"]: (line["tests"], line["failed"]) for line in lines if line["tests"] != "pass"}
    out = open(asked.out, "a") if asked.out else None
    end_of = {id: before[mutants[id]["key"]] for id in chosen if mutants[id]["key"] in before}
    end_of |= {id: ("explained", []) for id in chosen if name_of(mutants[id]) in told}
    # With --most, mutants that are known to be open are left out. Other runs ask them again.
    end_of |= {id: ("open", []) for id in chosen if name_of(mutants[id]) in still_open and asked.most}
    left = {}
    kills = Counter()
    turn = threading.Lock()
    began = time.monotonic()

    def ask_all(ids, seconds, tests_of):
        """Ask these mutants their tests in turn, and return those that pass them."""

        def ask_one(id):
            mutant = mutants[id]
            with turn:
                if time.monotonic() - began > asked.seconds:
                    return
                tests = tests_of(id)
            done, failed, most, passed = "pass", [], 0.5, 0.0
            while tests and done == "pass" and passed < asked.enough:
                batch = [tests.pop(0)]
                total = seconds[batch[0]]
                while tests and total + seconds[tests[0]] < most:
                    batch.append(tests.pop(0))
                    total += seconds[batch[-1]]
                most *= 2
                passed += total
                done, failed, took = became(binary, batch, 2 + 8 * total, str(id))
                if done == "pass" and len(batch) == 1:
                    seconds[batch[0]] = took
            with turn:
                kills.update((mutant["file"], test) for test in failed)
                end_of[id], left[id] = (done, failed), len(tests)
                # A mutant that passes may be asked more tests.
                if out and done != "pass":
                    print(json.dumps(mutant | {"tests": done, "failed": failed}), file=out, flush=True)

        with ThreadPool(asked.jobs) as pool:
            pool.map(ask_one, ids, chunksize=1)
        return [id for id in ids if end_of.get(id, ("", []))[0] == "pass"]

    failing = tomllib.loads(FAILING.read_text())
    # A test that has not run yet counts for more seconds than most take.
    seconds = defaultdict(lambda: 1.0, json.loads(SECONDS.read_text()) if SECONDS.exists() else {})
    there = {test for test in named(binary) if not asked.tests or any(word in test for word in asked.tests)}
    of_file = lambda id: [test for test in failing["of"].get(mutants[id]["file"], []) if test in there]
    alive = ask_all([id for id in chosen if id not in end_of], seconds, of_file)
    # Tests that catch mutants of neighbouring files catch most of the rest, and take much less time than every test once.
    folder = lambda file: Path(file).parent
    beside = lambda id: [test for file, tests in failing["of"].items() if folder(file) == folder(mutants[id]["file"])
                         for test in tests if test in there and test not in of_file(id)]
    for id in alive:
        del end_of[id]
    alive = ask_all(alive, seconds, lambda id: sorted(set(beside(id)), key=lambda test: seconds[test]))
    # A test that fails without a mutant proves nothing.
    told_by = sorted({test for _, test in kills})
    done, failed, _ = became(binary, told_by, 2 + 8 * sum(seconds[test] for test in told_by), "") if told_by else ("pass", [], 0)
    if done != "pass":
        sys.exit(f"fails without a mutant, or takes too long: {failed}")
    if alive:
        print(f"{len(alive)} pass what is listed of their files and the files beside, after {time.monotonic() - began:.0f} s", flush=True)
        tests = reached(binary, asked.longest, asked.tests, asked.jobs)
        places = defaultdict(list)
        for test, (_, noted) in tests.items():
            for id in noted:
                places[id].append(test)
        place = {}
        for id, mutant in enumerate(mutants):
            place[id] = id if id in places or id == 0 else place[id - 1] if same_place(mutants[id - 1], mutant) else id
        # Tests that have caught other mutants of this file come first, then quick tests.
        likely = lambda id: sorted(places[place[id]], key=lambda test: tests[test][0] / (1 + kills[mutants[id]["file"], test]))
        # A mutant that is not begun in time has not been tried.
        for id in alive:
            del end_of[id]
        seconds.update((test, took) for test, (took, _) in tests.items())
        alive = ask_all(alive, seconds, likely)

    SECONDS.write_text(json.dumps(dict(sorted(seconds.items()))))
    if out:
        out.writelines(json.dumps(mutants[id] | {"tests": "pass", "failed": []}) + "\n" for id in alive)
    for id in sorted(alive):
        mutant = mutants[id]
        print("survives:", f"{mutant['file']}:{mutant['line']}", mutant["function"], mutant["operator"], mutant["ordinal"], "|", mutant["code"], "|", mutant["replacement"],
              "(reached by no test)" if not places[place[id]] else f"(of {left[id]} tests not asked)" if left[id] else "")
    count = Counter((stage(id), end) for id, (end, _) in end_of.items())
    for part in in_all:
        print(f"{part}: {in_all[part]} mutants, {sum(number for (of, _), number in count.items() if of == part)} tried, {count[part, 'fail']} fail a test, "
              f"{count[part, 'too long']} take eight times as long, {count[part, 'explained']} explained, {count[part, 'open']} open, "
              f"{count[part, 'pass']} survive")
    print(f"{len(end_of)} mutants in {time.monotonic() - began:.0f} s")
    sys.exit(bool(alive))


def learned(tried):
    """Add tests to the list of each file until each of its mutants that failed a test fails one of the list. The next test is the one
    that catches most of the remaining mutants for its time. Also note the mutants that have passed, and the files of which each
    mutant has been asked, is explained or does not compile."""
    listed = tomllib.loads(FAILING.read_text())["of"]
    seconds = defaultdict(lambda: 1.0, json.loads(SECONDS.read_text()))
    failed = defaultdict(dict)
    for line in map(json.loads, Path(tried).read_text().splitlines()):
        failed[line["file"]][line["key"]] = set(line["failed"])
    for file, of_file in failed.items():
        tests = listed.setdefault(file, [])
        while left := [those for those in of_file.values() if those and not those & set(tests)]:
            counts = Counter(test for those in left for test in those)
            # Starting a process takes time as well.
            tests.append(max(sorted(counts), key=lambda test: counts[test] / (0.05 + seconds[test])))
    lines = ["# Tests that the mutants of a file fail, those first that most of them do: by mutants.py --learn.", "", "[of]"]
    lines += [f"{json.dumps(file)} = {json.dumps(tests, indent=4)}" for file, tests in sorted(listed.items())]
    FAILING.write_text("\n".join(lines) + "\n")
    tried_keys = {key for of_file in failed.values() for key in of_file}
    settled = refused_by_compiler() | {key for of_file in failed.values() for key, tests in of_file.items() if tests}
    told, unasked_files, passed = explained(), set(), defaultdict(lambda: defaultdict(list))
    for mutant in schemata(lambda key: True, [])[1]:
        file, *place, other = name_of(mutant)
        if mutant["key"] in settled or name_of(mutant) in told:
            continue
        if mutant["key"] in tried_keys:
            passed[file][tuple(place)].append(other)
        else:
            unasked_files.add(file)
    lines = ["# Digests of the files of which each mutant has been asked, is explained or does not compile: by mutants.py --learn."]
    lines += [f"{json.dumps(str(path))} = {json.dumps(digest(path))}" for path in sources([]) if str(path) not in unasked_files]
    ASKED.write_text("\n".join(lines) + "\n")
    lines = ["# Mutants that have passed the tests that they were asked, each to be decided by a test or a reason: by mutants.py --learn."]
    for file, places in sorted(passed.items()):
        rows = [f"    {json.dumps([*place, others])}," for place, others in places.items()]
        lines += [f"{json.dumps(file)} = [", *rows, "]"]
    OPEN.write_text("\n".join(lines) + "\n")


def same_place(one, other):
    return all(one[key] == other[key] for key in ("file", "function", "code", "line"))


if __name__ == "__main__":
    main()
