"""All derivations, from the equation of motion to golden/derived.

    python derivations/derive.py            prove everything, print a line for each proof, write golden/derived
    python derivations/derive.py --check    prove everything, write nothing, and fail if golden/derived is stale

The exit code is 1 if a proof fails or a file is stale. Nothing is written unless every proof holds.
"""

import argparse
import json
import sys
import time
from pathlib import Path

from mpmath import mpf

import border_collision
import closed_forms
import corner_map
import flight
import impact
import impact_oscillator
import jump_order
import normal_form
import points
import printed_equations
import recover
import smoothing_spline
from proof import PLANTED, Measurement, refuses, show

GOLDEN = Path(__file__).resolve().parent.parent / "golden" / "derived"
# Largest relative error of doubles at a point. The Rust code is held to the same.
DOUBLE = 1e-12


def lines(document, key):
    """Return a JSON document as text, with the entries of one list on a line each."""
    entries = ",\n".join("  " + json.dumps(entry) for entry in document[key])
    head = json.dumps({name: value for name, value in document.items() if name != key}, indent=1)
    return f'{head[:-2]},\n "{key}": [\n{entries}\n ]\n}}\n'


def pretty(document):
    return json.dumps(document, indent=1) + "\n"


def run():
    """Prove each stage. Return the files, and True if every proof holds and every false identity is refused."""
    complete, stated = refuses(), []
    print(f"refused       {len(PLANTED)} planted identities that are false" if complete else "NOT REFUSED: `vanishes` accepts a false identity, so it proves nothing")

    def stage(title, proofs):
        nonlocal complete
        proofs = list(proofs)
        complete = show(title, proofs) and complete
        kinds = {"proved": [], "measured": []}
        for proof in proofs:
            kinds["measured" if isinstance(proof, Measurement) else "proved"].append(proof.statement)
        stated.append({"stage": title} | {kind: statements for kind, statements in kinds.items() if statements})

    stage("flight", flight.proofs())
    stage("impact", impact.proofs())
    stage("corner map", corner_map.proofs())
    stage("normal form", normal_form.proofs())
    stage("impact oscillator", impact_oscillator.proofs())
    stage("jump order", jump_order.proofs())
    stage("border collision", border_collision.proofs())
    verdicts, results = printed_equations.examined()
    stage("printed", results)
    stage("one slip", printed_equations.slips())
    stage("recovered", recover.proofs())

    expressions = corner_map.expressions()
    rows = points.points(expressions)
    apart, rounding = points.disagreement(rows), points.in_doubles(rows)
    stage("points", [
        Measurement(f"{len(rows)} points: the derived expressions and closed_forms.py agree to 60 digits", apart < mpf(10) ** -60),
        Measurement(f"closed_forms.py in double precision agrees with them to {DOUBLE}", rounding < DOUBLE),
    ])  # fmt: skip

    apart = smoothing_spline.scipys()
    stage("smoothing spline", [
        Measurement(f"the B-splines of splines.py agree with scipy's to {DOUBLE}", apart < DOUBLE),
    ])  # fmt: skip

    note = "written by derivations/derive.py; do not edit"
    files = {
        "closed_forms.json": pretty({
            "note": note,
            "inputs": closed_forms.INPUTS,
            "lines": [{"name": name, "expression": text} for name, text in closed_forms.CLOSED_FORMS.items()],
        }),
        "corner_map.json": pretty({"note": note, "inputs": closed_forms.INPUTS, "expressions": expressions}),
        "impact_oscillator.json": pretty({"note": note, **impact_oscillator.document()}),
        "points.json": lines({"note": note, "seed": points.SEED, "digits": points.DIGITS, "points": [points.entry(row) for row in rows]}, "points"),
        "printed_equations.json": pretty({"note": note, "equations": verdicts}),
        "recovery.json": pretty({"note": note, **recover.document()}),
        "smoothing_spline.json": pretty({"note": note, **smoothing_spline.document()}),
        "proofs.json": pretty({"note": note, "refused": [planted.statement for planted in PLANTED], "stages": stated}),
    }  # fmt: skip
    return files, complete


def stale(files):
    """Yield the files that differ from what was derived, and the files that nothing derives."""
    for name, text in files.items():
        path = GOLDEN / name
        if not path.exists() or path.read_text() != text:
            yield path
    for path in sorted(GOLDEN.glob("*")):
        if path.name not in files:
            yield path


def main():
    parser = argparse.ArgumentParser(description="Prove the derivations and write golden/derived.")
    parser.add_argument("--check", action="store_true", help="write nothing; fail where golden/derived is stale")
    check = parser.parse_args().check
    begun = time.monotonic()
    files, complete = run()
    print(f"{time.monotonic() - begun:.0f} s")
    if not complete:
        sys.exit("derive.py: a proof failed; golden/derived is unchanged")
    if check:
        names = [str(path) for path in stale(files)]
        if names:
            sys.exit("derive.py: out of date (make derive writes them): " + ", ".join(names))
        return
    GOLDEN.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (GOLDEN / name).write_text(text)


if __name__ == "__main__":
    main()
