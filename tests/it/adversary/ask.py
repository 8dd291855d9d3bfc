"""Looks for periodic orbits by brute force, and reports where the program's complete lists disagree.

The machines are random, with planted difficulties. Dense scans give orbits of one impact and of two, which Newton's method confirms
in 60 digits. The questions are `orbit`, `pairs` (orbits of two impacts), `proofs`, `certify`, `counts` (over a range of speeds) and
`locate`. `proofs` calls the script behind `certify`; the others run the commands that anybody would use. Each line printed is the
document of a machine: what was planted, how many orbits were confirmed, how many lists were said to be complete, and what is `wrong`.

The search uses nothing of the proofs: flights are Taylor series squared, derivatives are differences, and a flight is checked for
being clear of the cam at thousands of its moments. An orbit nearer to a graze, a fold or a corner than rounding resolves is
`doubtful` and left out.
"""

import argparse
import json
import math
import random
import subprocess
import sys
import tomllib
from pathlib import Path

from mpmath import mp, mpf

from cams import Cam
from machines import drawn
from orbits import Follower, Machine, angles_of, apart, corner_impact, corner_impacts, corner_roots, same


# Longest wait for an answer, s. The speed of an answer is not tested here.
PATIENCE = 200
DERIVATIONS = str(Path(__file__).parents[3] / "derivations")


class Asked:
    """The program's answers about a model file, and the errors in them."""

    def __init__(self, program, file, machine, drop):
        self.program, self.file, self.machine, self.drop = program, Path(file), machine, drop
        self.counts = {name: 0 for name in ("asked", "refused", "complete", "confirmed", "proved", "doubtful", "left_out")}
        self.wrong, self.refusals = [], []

    def say(self, question, what):
        self.wrong.append(f"{question}: {what}")

    def document(self, *words):
        self.counts["asked"] += 1
        words = [self.program, words[0], str(self.file), *map(str, words[1:]), "--json"]
        try:
            done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.counts["refused"] += 1
            self.refusals.append(" ".join(words[1:]) + f": no answer within {PATIENCE} s")
            return None
        if done.returncode not in (0, 1) or not done.stdout:
            self.counts["refused"] += 1
            self.refusals.append(" ".join(words[1:]) + ": " + done.stderr.strip()[-300:])
            if done.returncode not in (0, 1, 2):
                self.say(words[1], f"exit code {done.returncode}: {done.stderr[-500:]}")
            return None
        return json.loads(done.stdout)

    def all(self, questions, rng):
        turns = self.machine.turns
        if "orbit" in questions:
            self.orbit(1)
        # The program finds pairs in more than one revolution by a search, without a claim that it has all. `certify` does not cover them.
        if "pairs" in questions and turns == 1:
            self.orbit(2)
        if "proofs" in questions and turns == 1:
            self.proofs()
        if "certify" in questions and turns == 1:
            self.certify()
        if "counts" in questions and turns == 1:
            self.over_range(rng)
        if "locate" in questions:
            self.locate(rng)

    def orbit(self, impacts):
        rpm, turns = repr(self.machine.rpm), self.machine.turns
        told = self.document("orbit", "--rpm", rpm, "--impacts", impacts, "--revolutions", turns)
        if not told:
            return
        is_complete = any(one["impacts"] == impacts and one["revolutions"] == turns and one["known"] == "proved" for one in told["complete"])
        undecided = [one["cam_angles_rad"] for one in told["undecided"]]
        listed = []
        for one in told["orbits"]:
            if one["course"] == "impacts" and len(one["impacts"]) == impacts:
                listed.append(([mpf(impact["cam_angle_rad"]) for impact in one["impacts"]], None, one["known"] == "proved", None))
        self.held("orbit", impacts, listed, undecided, is_complete)

    def certify(self):
        told = self.document("certify", "--orbits", "--rpm", repr(self.machine.rpm))
        if not told:
            return
        for impacts in (1, 2):
            undecided = [one["cam_angles_rad"] for one in told["undecided"] if one["impacts"] == impacts]
            listed = []
            for one in told["orbits"]:
                if len(one["impacts"]) == impacts:
                    balls = [impact["cam_angle_rad"] for impact in one["impacts"]]
                    listed.append(([mpf(ball["mid"]) for ball in balls], [mpf(ball["rad"]) for ball in balls], True, one["kind"]))
            self.held("certify --orbits", impacts, listed, undecided, impacts in told["complete"])

    def proofs(self):
        """Check the list of one impact of `certify --orbits`, from its script alone: the command continues with lists of two for a minute."""
        if DERIVATIONS not in sys.path:
            sys.path.append(DERIVATIONS)
        from balls import motion, numbers, orbits
        from flint import arb, ctx

        ctx.prec = 128
        model = tomllib.loads(self.file.read_text(), parse_float=str)
        if "rows" in model["cam"]:
            model["cam"]["rows"] = [{"angle_deg": angle, "lift": lift} for angle, lift in model["cam"]["rows"]]
        proved = motion.Machine({"follower": model["follower"], "cam": model["cam"]})
        speed = proved.cam.turn * arb(numbers.decimal(repr(self.machine.rpm))) / 60
        try:
            found, undecided = orbits.Orbits(proved, speed).of(1)
        except numbers.Refused as error:
            self.counts["refused"] += 1
            self.refusals.append(f"proofs: {error}")
            return
        self.counts["asked"] += 1
        listed = []
        for one in found:
            ball = numbers.ball(one.impacts[0][0])
            listed.append(([mpf(ball["mid"])], [mpf(ball["rad"])], True, one.kind))
        ranges = [[[float(ball.lower()), float(ball.upper())] for ball in place] for place in undecided]
        self.held("certify --orbits", 1, listed, ranges, not undecided)

    def held(self, question, impacts, listed, undecided, is_complete):
        """Compare a list with the orbits that were found, and each of its orbits with the laws."""
        question = f"{question}, {impacts} impact(s) at {self.machine.rpm!r} rpm"
        if self.drop and listed:
            listed = listed[1:]
            self.counts["left_out"] += 1
        self.counts["complete"] += is_complete
        orbits, doubtful = self.found(impacts)
        for orbit in orbits:
            angles, within = angles_of(orbit), 1e-9 + 1e3 * orbit["blur"]
            if orbit["blur"] > 1e-8 or any(same(angles, [mpf(a) for a in other], 1e-6) for other in doubtful):
                continue
            self.counts["confirmed"] += 1
            if not any(same(angles, one, within) for one, *_ in listed) and not any(inside(angles, ranges) for ranges in undecided):
                degrees = [mp.nstr(mp.degrees(angle), 15) for angle in angles]
                said = "said to be complete" if is_complete else "and no range that is undecided has it"
                self.say(question, f"the list, {said}, lacks the orbit at {degrees} deg, {[mp.nstr(a, 40) for a in angles]} rad")
        seen = []
        for angles, radii, is_proved, kind in listed:
            if not is_proved:
                continue
            self.counts["proved"] += 1
            orbit = self.machine.confirmed(angles)
            told = [mp.nstr(angle, 20) for angle in angles]
            if orbit == "doubtful":
                self.counts["doubtful"] += 1
            elif orbit is None:
                self.say(question, f"the orbit at {told} rad is said to be proved, and is none")
            elif any(same(angles_of(orbit), other, mpf(10) ** -14) for other in seen):
                self.say(question, f"the orbit at {told} rad is there twice")
            else:
                seen.append(angles_of(orbit))
                rounding = mpf(10) ** -30 if self.machine.cam.is_exact else 1e-13 + 1e3 * orbit["blur"]
                if radii and not all(apart(a, b) <= rad + rounding for a, b, rad in zip(angles_of(orbit), angles, radii)):
                    self.say(question, f"the ball about {told} rad does not hold {[mp.nstr(a, 40) for a in angles_of(orbit)]}")
                own = kind and self.machine.kind(orbit)
                if own and own != kind:
                    self.say(question, f"the orbit at {told} rad is said to be {kind}, and is {own}")

    def found(self, impacts):
        if impacts not in self.machine.searched:
            self.machine.searched[impacts] = self.machine.one_impact() if impacts == 1 else self.machine.two_impacts()
        return self.machine.searched[impacts]

    def over_range(self, rng):
        """Check the number of orbits of one impact at speeds of a range."""
        low, high = (float(f"{self.machine.rpm * part:.9g}") for part in (1 - rng.uniform(0.001, 0.03), 1 + rng.uniform(0.001, 0.03)))
        told = self.document("certify", "--orbits", "--rpm", f"{low!r}:{high!r}")
        if not told:
            return
        self.counts["complete"] += not told["undecided"]
        for count in told["counts"]:
            start, end = count["from_rpm"], count["to_rpm"]
            off = [rng.random() for _ in range(3)] + [1e-6, 1 - 1e-6, 1e-9, 1 - 1e-9]
            for rpm in sorted(start + part * (end - start) for part in off):
                if not start < rpm < end:
                    continue
                machine = self.machine.at_speed(rpm)
                orbits, doubtful = machine.one_impact(2000)
                number = count["one_impact_orbits"] - (self.drop and count["one_impact_orbits"] > 0)
                self.counts["confirmed"] += len(orbits)
                self.counts["doubtful"] += len(doubtful)
                if not len(orbits) <= number <= len(orbits) + len(doubtful):
                    angles = [mp.nstr(mp.degrees(a), 12) for orbit in orbits for a in angles_of(orbit)]
                    self.say("certify --orbits over a range", f"{number} orbits from {start!r} to {end!r} rpm, and at {rpm!r} those at {angles} deg")
                elif not doubtful and not self.drop and None not in (count["kinds"] or [None]):
                    kinds = [machine.kind(orbit) for orbit in orbits]
                    if None not in kinds and sorted(kinds) != sorted(count["kinds"]):
                        self.say("certify --orbits over a range", f"{count['kinds']} from {start!r} to {end!r} rpm, and at {rpm!r} {kinds}")

    def locate(self, rng):
        """Check the corner impacts of one impact, about the speed of one if there is one."""
        machine = self.machine
        roots = list(corner_roots(machine.cam, machine.follower, 0.8 * machine.rpm, 1.25 * machine.rpm, machine.turns))
        rng.shuffle(roots)
        places = (corner_impact(machine.cam, machine.follower, machine.turns, root) for root in roots[:12])
        near = next(([place[0]] for place in places if place and not place[3]), [])
        middle = near[0] if near else machine.rpm
        low, high = (float(f"{middle * part:.9g}") for part in (1 - rng.uniform(0.001, 0.02), 1 + rng.uniform(0.001, 0.02)))
        told = self.document("locate", "--rpm", f"{low!r}:{high!r}", "--revolutions", machine.turns)
        if not told:
            return
        is_complete = any(one["impacts"] == 1 and one["revolutions"] == machine.turns and one["known"] == "proved" for one in told["complete"])
        self.counts["complete"] += is_complete
        of_one = [one for one in told["corner_impacts"] if one["impacts"] == 1 and one["revolutions"] == machine.turns]
        if self.drop and of_one:
            of_one = of_one[1:]
            self.counts["left_out"] += 1
        listed = [[one["speed_rpm"], one["cam_angle_rad"], {"minus": -1, "plus": 1, None: 0}[one.get("side")]] for one in of_one]
        places = corner_impacts(machine.cam, machine.follower, low, high, machine.turns)
        found, doubtful = ([place for place in places if place[3] == is_doubtful] for is_doubtful in (False, True))
        alike = lambda one, other: apart(one[1], other[1]) < 1e-9 and abs(one[0] / other[0] - 1) < 1e-7
        for place in found:
            self.counts["confirmed"] += 1
            ranges = [one["speeds_rpm"] for one in told["undecided"] if apart(one["cam_angle_rad"], place[1]) < 1e-9]
            is_undecided = any(least * (1 - 1e-9) <= place[0] <= most * (1 + 1e-9) for least, most in ranges)
            if not is_undecided and not any(alike(place, one) and place[2] == one[2] for one in listed):
                said = "said to be complete" if is_complete else "and no range that is undecided has it"
                self.say("locate", f"{low!r}:{high!r} rpm: the list, {said}, lacks {place[0]!r} rpm at {math.degrees(place[1])!r} deg, side {place[2]}")
        orders = {round(float(angle), 9): order for angle, order in machine.cam.corners()}
        for one in listed:
            known = round(one[1], 9) in orders
            if is_complete and known and not any(alike(one, other) and one[2] == other[2] for other in found) and not any(alike(one, other) for other in doubtful):
                self.say("locate", f"{low!r}:{high!r} rpm: {one[0]!r} rpm at {math.degrees(one[1])!r} deg, side {one[2]}, is no corner impact")


def inside(angles, ranges):
    """Return True if each angle is in one of the ranges, and each range has one of the angles."""
    holds = lambda low, high, angle: any(low - 1e-8 <= float(angle) + k * math.tau <= high + 1e-8 for k in (-1, 0, 1))
    return all(any(holds(low, high, angle) for low, high in ranges) for angle in angles) and all(
        any(holds(low, high, angle) for angle in angles) for low, high in ranges)


def read(file):
    """Return (law, numbers of the follower) of a model file."""
    model = tomllib.loads(Path(file).read_text())
    return model["cam"], model["follower"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--seeds", nargs=2, type=int, metavar=("FIRST", "END"), help="draw the machines of these seeds")
    parser.add_argument("--folder", default=".", help="where their model files go")
    parser.add_argument("--model", nargs=2, metavar=("FILE", "RPM"), help="look at one machine, with every question")
    parser.add_argument("--ask", action="append", default=[], metavar="QUESTION:N", help="ask it of each Nth machine")
    parser.add_argument("--drop", action="store_true", help="take one orbit out of each answer, to see that it is missed")
    given = parser.parse_args()
    every = {name: int(often) for name, _, often in (question.partition(":") for question in given.ask)}
    if given.model:
        law, numbers = read(given.model[0])
        machine = Machine(Cam(law), Follower(**numbers), float(given.model[1]))
        machines = [(0, ("given", law, given.model[0], machine))]
    else:
        machines = ((index, drawn(index, given.folder)) for index in range(*given.seeds))
    for index, found in machines:
        if not found:
            continue
        plant, law, file, machine = found
        asked = Asked(given.program, file, machine, given.drop)
        asked.all([name for name, often in every.items() if index % often == 0], random.Random(index))
        print(json.dumps({"index": index, "plant": plant, "law": law["law"], "file": str(file), "rpm": machine.rpm, "turns": machine.turns,
                          **asked.counts, "wrong": asked.wrong, "refusals": asked.refusals}), flush=True)


if __name__ == "__main__":
    main()
