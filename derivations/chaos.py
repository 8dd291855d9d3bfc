"""Sets of chaotic motions, proved in ball arithmetic from the h-sets of golden/chaos.

    python derivations/chaos.py                    every h-set for one speed: two minutes
    python derivations/chaos.py --all              h-sets for ranges of speeds as well: ten seconds each
    python derivations/chaos.py --rpm 670          h-sets for that speed; LO:HI: h-sets for speeds within that range
    python derivations/chaos.py --json FILE ...    h-sets of other files, as one JSON document

Prints one line for each strip and each theorem as soon as it is known, and what is left out. The exit code is 1 if a proof fails. A
theorem says that a set of chaotic motions exists at every speed of its h-set. It does not say that other motions converge to this
set. docs/theorems.md gives the argument.
"""

import argparse
import json
import math
import sys
import tomllib
from pathlib import Path

try:
    from flint import ctx
except ImportError:
    sys.exit("chaos.py: the Python package python-flint is missing")

from balls.covering import HSet, Proof
from balls.motion import Machine
from balls.numbers import Refused, decimal

ROOT = Path(__file__).resolve().parent.parent
# Enough bits that the image of a box's middle, after the impacts of any strip, is far narrower than the smallest box.
BITS = 64
# An h-set for one speed covers at most this range, rpm, about a speed that is no decimal, such as that of the corner impact.
ONE_SPEED = decimal("0.03")
HYPOTHESES = [
    "the machine is the one whose numbers are the decimals of the model file, in SI units",
    "0 < restitution < 1, or restitution = 1 with damping: the impact map has an inverse, and shrinks areas u dtheta du",
    "after every impact in N the follower leaves the cam; the strips lie in N, apart",
    "every contact is proved to be the first of its flight, and the follower comes to the cam at it with a velocity",
]


def machine_of(name):
    """Return the machine of models/NAME.toml. Raise Refused if the theorem does not cover it."""
    document = tomllib.loads((ROOT / "models" / f"{name}.toml").read_text(), parse_float=str)
    if "units" in document:
        raise Refused("the model is not in SI units")
    machine = Machine(document)
    follower = machine.follower
    if not (follower.restitution > 0 and (follower.restitution < 1 or follower.zeta > 0)):
        raise Refused("the theorem needs restitution above 0, and a loss at impacts or in flight")
    return machine


def theorem(machine, h_set, say):
    """Prove one h-set, strip by strip. Return the results as a dictionary, in which `proved` is True if every strip is proved."""
    strips = []
    for strip in h_set.strips:
        proof, result = Proof(machine, h_set, strip), {"impacts": strip.impacts, "revolutions": strip.revolutions}
        try:
            proof.prove()
            result |= {"boxes": proof.boxes, "growth": proof.growth and below(proof.growth)}
            kept = f", and keeps the cones, stretching by a factor of at least {at_least(result['growth'])}" if proof.growth else ""
            say(True, f"the strip of {strip.impacts} impacts covers N{kept} ({proof.boxes} boxes)")
        except Refused as error:
            result["refused"] = str(error)
            say(False, str(error))
        strips.append(result)
    cones, symbols = h_set.cone_slope is not None, [strip.impacts for strip in h_set.strips]
    proved, entropy = all("refused" not in strip for strip in strips), below(h_set.entropy())
    told = ", ".join(map(str, symbols))
    how_many = "exactly one motion" if cones else "at least one motion"
    say(proved, f"for every sequence of {told}, endless in both directions, {how_many} passes through the strips; entropy at least {at_least(entropy)} a revolution")
    return {
        "symbols": symbols,
        "entropy_per_revolution": entropy,
        "cones": cones,
        "proved": proved,
        "hypotheses": HYPOTHESES,
        "strips": strips,
    }


def below(number):
    """Return a double that is a lower bound of a ball."""
    return math.nextafter(float(number.lower()), -math.inf)


def at_least(number):
    """Return a number as text, rounded down to six decimals."""
    return f"{math.floor(number * 10**6) / 10**6:g}"


def theorems(path, is_asked, say):
    """Yield the theorem of each h-set of a file whose speeds are asked for."""
    document = json.loads(path.read_text(), parse_float=str, parse_int=str)
    name = document["model"]
    machine = machine_of(name)
    for entry in document["h_sets"]:
        low, high = (decimal(speed) for speed in entry["rpm"])
        if not is_asked(low, high):
            continue
        at = f"{name}, {entry['rpm'][0]} rpm" if low == high else f"{name}, {' to '.join(entry['rpm'])} rpm"
        told = lambda proved, what, at=at: say(proved, f"{at}: {what}")  # noqa: E731
        try:
            result = theorem(machine, HSet(entry), told)
        except Refused as error:
            told(False, str(error))
            result = {"proved": False, "refused": str(error)}
        yield {"model": name, "rpm": [float(speed) for speed in entry["rpm"]], **result}


def main():
    parser = argparse.ArgumentParser(description="Prove sets of chaotic motions from their h-sets.")
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="files with h-sets; by default those of golden/chaos")
    parser.add_argument("--all", action="store_true", help="include the h-sets for ranges of speeds, if neither --rpm nor FILE is given")
    parser.add_argument("--rpm", help="only h-sets for this speed, or for speeds within LO:HI")
    parser.add_argument("--json", action="store_true", help="one JSON document instead of lines")
    options = parser.parse_args()
    ctx.prec = BITS

    def say(proved, what):
        if not options.json:
            print(f"{'proved    ' if proved else 'NOT PROVED'}  {what}", flush=True)

    found, left_out = [], []
    try:
        ends = options.rpm and options.rpm.split(":")
        speeds = ends and (decimal(ends[0]), decimal(ends[-1]))

        def is_asked(low, high):
            if speeds is not None:
                return speeds[0] <= low and high <= speeds[1]
            if not (options.all or options.files) and high - low > ONE_SPEED:
                left_out.append([float(low), float(high)])
                return False
            return True

        for path in options.files or sorted((ROOT / "golden" / "chaos").glob("*.json")):
            found += theorems(path, is_asked, say)
    except (Refused, OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"chaos.py: {error!r}")
    if options.json:
        print(json.dumps({"theorems": found, "left_out": left_out}, indent=1))
    elif left_out:
        print(f"LEFT OUT    {len(left_out)} h-sets for ranges of speeds, ten seconds each: --all or --rpm LO:HI includes them")
    if not found and not left_out:
        sys.exit("chaos.py: no stored h-set is for these speeds")
    sys.exit(0 if all(one["proved"] for one in found) else 1)


if __name__ == "__main__":
    main()
