"""Attractors at twenty speeds: seed, continue and match by a plain loop over the baseline, beside `speeds`.

Global continuation makes this loop over any integrator. At each speed, some starts are random, and others are where the attractors of
the speed before ended. Runs have a fixed length, and their last revolutions are compared. Runs that are alike are one attractor.
"""

import collections
import json
import math
import random
import subprocess
import time

SPEEDS = [660.0 + 5.0 * k for k in range(20)]
STARTS = 50
# Revolutions of a run, revolutions at its end that are compared, and the longest period among them.
LENGTH, LOOKED_AT, LONGEST = 800, 64, 16
# Angles closer than this, rad, are the same. A relative velocity below this, m/s, is a rest.
ALIKE, RESTS = 1e-4, 1e-5
IRREGULAR = "does not repeat"


def lift(circles, theta):
    """Return c and dc/dtheta in doubles."""
    circle = [one for one in circles if one[0] <= theta][-1]
    _, distance, direction, radius = circle
    sin, cos = math.sin(theta - direction), math.cos(theta - direction)
    root = math.sqrt(radius**2 - (distance * sin) ** 2)
    return distance * cos + root, -distance * sin - distance**2 * sin * cos / root


def on_cam(circles, rpm, restitution, chance):
    """Return a random start on the cam, with a relative velocity up to what impacts keep up."""
    steepest = max(abs(lift(circles, math.tau * k / 720)[1]) for k in range(720))
    omega, theta = rpm * math.tau / 60, math.tau * chance.random()
    height, slope = lift(circles, theta)
    fastest = 2 * omega * steepest * restitution / (1 - restitution)
    return [theta, height, omega * slope + fastest * chance.random()]


def look(impacts, cam_velocity):
    """Return (revolutions, impacts) of the last revolutions of a run, or IRREGULAR."""
    begin = (LENGTH - LOOKED_AT) * math.tau
    turns = collections.defaultdict(list)
    for turned, angle, _, after in impacts:
        if turned >= begin:
            turns[int((turned - begin) / math.tau)].append((angle, after - cam_velocity(angle)))
    if any(abs(relative) < RESTS for turn in turns.values() for _, relative in turn):
        return IRREGULAR
    for period in range(1, LONGEST + 1):
        same = all(alike(turns[turn], turns[turn + period]) for turn in range(LOOKED_AT - period - 1))
        if same:
            return period, sum(len(turns[turn]) for turn in range(period))
    return IRREGULAR


def alike(one, other):
    return len(one) == len(other) and all(abs(a - b) < ALIKE for (a, _), (b, _) in zip(one, other))


def by_loop(program, model, circles, restitution):
    """Return the attractors at each speed, with the number of starts that end on each, and the time that it took."""
    chance, before, found = random.Random(1), {}, {}
    began = time.perf_counter()
    for rpm in SPEEDS:
        starts = [on_cam(circles, rpm, restitution, chance) for _ in range(STARTS)] + list(before.values())
        task = {"model": str(model), "rpm": rpm, "starts": starts, "turn": LENGTH * math.tau, "repeats": 1}
        done = subprocess.run([str(program)], input=json.dumps(task), capture_output=True, text=True, check=True)
        omega = rpm * math.tau / 60
        counts, before = collections.Counter(), {}
        for index, (start, run) in enumerate(zip(starts, json.loads(done.stdout))):
            kind = look(run["impacts"], lambda angle: omega * lift(circles, angle)[1])
            counts[kind] += index < STARTS
            before.setdefault(kind, [start[0], *run["state"]])
        found[rpm] = counts
    return found, time.perf_counter() - began


def by_speeds(program, model):
    """Return the same from `speeds`. A motion that rests, or does not repeat, is IRREGULAR there as well."""
    began = time.perf_counter()
    words = ["speeds", str(model), "--rpm", f"{SPEEDS[0]}:{SPEEDS[-1]}", "--step", "5", "--starts", str(STARTS), "--json"]
    done = subprocess.run([str(program), *words], capture_output=True, text=True, check=True)
    took = time.perf_counter() - began
    found = {rpm: collections.Counter() for rpm in SPEEDS}
    for attractor in json.loads(done.stdout)["attractors"]:
        for share in attractor["shares"]:
            repeats = share["kind"] == "periodic"
            kind = (share["revolutions"], share["impacts"]) if repeats else IRREGULAR
            found[share["speed_rpm"]][kind] += round(share["share"] * STARTS)
    return found, took


def words(counts):
    def one(kind):
        return kind if kind == IRREGULAR else f"{kind[1]} impacts in {kind[0]} rev."

    return "; ".join(f"{one(kind)} {count}" for kind, count in sorted(counts.items(), key=str))


def table(loop, program, model, circles, restitution):
    """Return head and rows. Speeds at which both find the same single attractor are only counted."""
    (there, slow), (here, fast) = by_loop(loop, model, circles, restitution), by_speeds(program, model)
    rows = [["time", f"{slow:.1f} s", f"{fast:.1f} s"]]
    same = [rpm for rpm in SPEEDS if set(there[rpm]) == set(here[rpm])]
    rows.append([f"the same attractors at {len(same)} of {len(SPEEDS)} speeds", "", ""])
    rows += [[f"{rpm:g} rpm", words(there[rpm]), words(here[rpm])] for rpm in SPEEDS if rpm not in same or len(here[rpm]) > 1]
    return [f"{len(SPEEDS)} speeds, {STARTS} starts", "loop over the baseline", "speeds"], rows
