"""Random machines with planted difficulties: laws of cams, followers, and an orbit where it is hard to find."""

import json
import math
import random
from pathlib import Path

import numpy as np
from mpmath import mp, mpf

from cams import MOTIONS, TURN, Cam, exact, hermite, radians
from orbits import Follower, Machine, angles_of, apart


def text(law, follower):
    """Return the text of a model file."""
    def value(one):
        if isinstance(one, str):
            return json.dumps(one)
        return "[" + ", ".join(map(value, one)) + "]" if isinstance(one, list) else repr(one)

    lines = ['name = "adversary"', "", "[follower]"]
    lines += [f"{name} = {value(number)}" for name, number in follower.items()]
    lines += ["", "[cam]", *(f"{name} = {value(one)}" for name, one in law.items() if name != "segment")]
    for part in law.get("segment", []):
        lines += ["", "[[cam.segment]]", *(f"{name} = {value(one)}" for name, one in part.items())]
    return "\n".join(lines) + "\n"


def arcs_law(rng, _):
    base = 0.2 + rng.random()
    flank, start = base * rng.uniform(1.05, 3.0), rng.uniform(10.0, 140.0)
    span = rng.uniform(10.0, 180.0 - start)
    sine, cosine = math.sin(math.radians(span)), math.cos(math.radians(span))
    largest = base if cosine > 0 else flank - (flank - base) * sine
    nose = min(largest, flank) * rng.uniform(0.05, 0.95)
    return {"law": "arcs", "base_radius": base, "flank_radius": flank, "nose_radius": nose, "flank_start_deg": start, "nose_end_deg": start + span}


def harmonic_law(rng, lobes):
    count = rng.randint(1, 4)
    sizes, phases = [0.0] * (lobes * count), [0.0] * (lobes * count)
    for k in range(count):
        sizes[lobes * (k + 1) - 1], phases[lobes * (k + 1) - 1] = rng.uniform(-0.1, 0.1) / (k + 1) ** 2, rng.uniform(0.0, 360.0)
    return {"law": "harmonic", "offset": rng.uniform(-0.2, 0.2), "amplitudes": sizes, "phases_deg": phases}


def rectified_law(rng, _):
    return {"law": "rectified-sine", "offset": rng.uniform(-0.5, 0.5), "amplitude": rng.choice([-1, 1]) * rng.uniform(0.05, 1.0)}


def program_law(rng, lobes, tiny=False):
    count = rng.randint(1, 4)
    spans = [rng.uniform(0.2, 1.0) for _ in range(count + 1)]
    turn = 360.0 / lobes
    spans = [span / sum(spans) * turn for span in spans]
    rises = [rng.uniform(-0.1, 0.1) for _ in range(count)]
    parts = [[rng.choice(list(MOTIONS)), span, rise] for span, rise in zip(spans, rises)]
    parts.append([rng.choice([name for name in MOTIONS if name != "dwell"]), spans[-1], 0.0])
    if tiny:
        for _ in range(rng.randint(1, 2)):
            span = 10 ** rng.uniform(-6, -1)
            parts.insert(rng.randrange(len(parts)), [rng.choice(list(MOTIONS)), span, math.radians(span) * rng.uniform(-0.05, 0.05)])
    segments, lift = [], 0.0
    for lobe in range(lobes):
        for index, (motion, span, rise) in enumerate(parts):
            if index + 1 == len(parts):
                rise = -lift
                span = turn * (lobe + 1) - sum(part["span_deg"] for part in segments)
            rise = 0.0 if motion == "dwell" else rise
            lift += rise
            if index + 1 == len(parts):
                lift = 0.0
            segments.append({"motion": motion, "span_deg": span, "rise": rise})
    return {"law": "program", "base": rng.uniform(-0.2, 0.2), "segment": segments}


def knots(rng, lobes, tiny=False):
    count = rng.randint(2, 4)
    first = rng.uniform(0.0, 0.15) * 360.0 / lobes / count
    starts = [first + (k + (rng.uniform(0, 0.8) if k else 0.0)) * 360.0 / lobes / count for k in range(count)]
    if tiny:
        for _ in range(rng.randint(1, 2)):
            starts.append(rng.choice(starts) + 10 ** rng.uniform(-7, -1))
    starts.sort()
    return [start + 360.0 / lobes * lobe for lobe in range(lobes) for start in starts]


def pieces_law(starts, powers_of):
    """Return polynomials from each angle, degrees, to the next. `powers_of` takes an index and a width."""
    places = [radians(start) for start in starts]
    widths = [(places[(k + 1) % len(places)] - place) % TURN for k, place in enumerate(places)]
    segments = [{"start_deg": start, "coefficients": [float(c) for c in powers_of(k, widths[k])]} for k, start in enumerate(starts)]
    return {"law": "polynomial", "segment": segments}


def kinked_law(rng, lobes, tiny=False):
    """Return pieces that meet with different slopes."""
    starts = knots(rng, lobes, tiny)
    each = len(starts) // lobes
    lifts, bends = [rng.uniform(0.0, 0.1) for _ in range(each)], [(rng.uniform(-0.1, 0.1), rng.uniform(-0.03, 0.03)) for _ in range(each)]
    if tiny:
        lifts = smooth_lifts(rng, starts[:each])

    def powers_of(k, h):
        (y0, y1), (a2, a3) = [mpf(lifts[n % each]) for n in (k, k + 1)], map(mpf, bends[k % each])
        return [y0, (y1 - y0) / h - h * (a2 + h * a3), a2, a3]

    return pieces_law(starts, powers_of)


def smooth_lifts(rng, starts):
    """Return lifts of a smooth motion, so that two neighbouring angles have nearly the same lift."""
    sizes, phases = [rng.uniform(-0.06, 0.06) for _ in range(2)], [rng.uniform(0, 360.0) for _ in range(2)]
    return [sum(size * math.cos(math.radians(k * start + phase)) for k, (size, phase) in enumerate(zip(sizes, phases), 1)) for start in starts]


def smooth_law(rng, lobes, tiny=False):
    """Return cubics whose slopes agree where they meet."""
    starts = knots(rng, lobes, tiny)
    each = len(starts) // lobes
    if tiny:
        # Lifts and slopes of one motion, which are nearly the same at neighbouring knots.
        lifts = smooth_lifts(rng, [start + off for start in starts[:each] for off in (0.0, 1e-4)])
        ends = [(mpf(low), mpf(high - low) / mpf(math.radians(1e-4))) for low, high in zip(lifts[::2], lifts[1::2])]
    else:
        ends = [(mpf(rng.uniform(0.0, 0.1)), mpf(rng.uniform(-0.08, 0.08))) for _ in range(each)]
    return pieces_law(starts, lambda k, h: hermite(h, ends[k % each], ends[(k + 1) % each]))


def table_law(rng, lobes, equal=False):
    count = rng.randint(6, 14)
    angles = [360.0 / lobes * (k + 0.3 * rng.random()) / count for k in range(count)]
    if equal:
        for _ in range(rng.randint(1, 2)):
            at = rng.choice(angles)
            angles.append(at + 10 ** rng.uniform(-4, -1))
        angles = sorted(set(angles))
    lifts = [0.1 * math.cos(math.radians(lobes * angle)) + rng.uniform(-0.01, 0.01) * (not equal) for angle in angles]
    if equal:
        # A dwell of rows that differ in their last digits.
        level = rng.uniform(-0.1, 0.1)
        lifts = [max(lift, level) + (rng.choice([-1, 0, 1]) * 10 ** rng.uniform(-17, -11) if lift < level else 0.0) for lift in lifts]
    rows = [[angle + 360.0 / lobes * lobe, lift] for lobe in range(lobes) for angle, lift in zip(angles, lifts)]
    return {"law": "table", "spline": rng.choice(["cubic", "quintic"]), "rows": rows}


EVERY = [arcs_law, harmonic_law, rectified_law, program_law, kinked_law, smooth_law, table_law]


def follower_numbers(rng):
    mass, has_spring = 10 ** rng.uniform(-1, 1), rng.random() < 0.85
    stiffness = 10 ** rng.uniform(1, 3.5) if has_spring else 0.0
    damping = rng.choice([0.0, 0.0, 10 ** rng.uniform(-3, 0), 1.0, 10 ** rng.uniform(0, 0.7)])
    damping *= 2 * math.sqrt(stiffness * mass) if has_spring else mass
    return {"mass": mass, "damping": damping, "stiffness": stiffness, "gravity": rng.choice([0.0, 9.81]), "rest_position": 0.0,
            "restitution": rng.uniform(0.05, 0.95)}


class Planted(Exception):
    """No machine of this kind was found in a fair number of tries."""


def pushed(cam, numbers, rpm, angle, turns):
    """Return (numbers, machine) whose law is 0 at an angle, or None. The law is linear in what pushes the follower: the spring's rest
    position, or gravity."""
    numbers = dict(numbers)
    lift, slope = cam.one(angle)
    if abs(slope) < 1e-6 * cam.stroke:
        # On a dwell the law is constant.
        return None
    name = "rest_position" if numbers["stiffness"] > 0 else "gravity"
    values = []
    for one in (0.0, 1.0):
        numbers[name] = one
        values.append(Machine(cam, Follower(**numbers), rpm, turns).law(lift, slope))
    if values[0] == values[1]:
        return None
    numbers[name] = float(values[0] / (values[0] - values[1]))
    if not abs(numbers[name]) < 1e3 * max(1.0, cam.size):
        return None
    return numbers, Machine(cam, Follower(**numbers), rpm, turns)


def speed(rng, numbers):
    """Return a speed of seven digits, rpm, with a period of some swings. Without a spring, a swing counts as one second."""
    rate = math.sqrt(numbers["stiffness"] / numbers["mass"]) or 2 * math.pi
    swings = rng.uniform(0.3, 1.6) if rng.random() < 0.8 else rng.uniform(1.0, 6.0)
    return float(f"{60 * rate / (math.tau * swings):.7g}")


def with_orbit(rng, cam, angle_of, restitution=None, turns=1, tries=60):
    """Return (numbers, machine, angle) with an orbit of one impact at an angle drawn by `angle_of`. Raise Planted if none is found."""
    for _ in range(tries):
        numbers = follower_numbers(rng)
        if restitution is not None:
            numbers["restitution"] = restitution
        rpm, angle = speed(rng, numbers), angle_of() % TURN
        found = pushed(cam, numbers, rpm, angle, turns)
        if not found:
            continue
        numbers, machine = found
        lift, slope = cam.one(angle)
        before, after = machine.velocities(lift, slope)
        if before - machine.omega * slope > 0:
            continue
        if machine.judged([(angle, before - machine.omega * slope, after - machine.omega * slope)], [machine.period]):
            return numbers, machine, angle
    raise Planted


def anywhere(rng):
    return lambda: mpf(rng.uniform(0.0, math.tau))


def near_seam(rng, cam, low, high):
    """Return a function that draws an angle near a seam, at a distance between two powers of ten."""
    return lambda: rng.choice(cam.exact[:-1]) + rng.choice([-1, 1]) * mpf(10 ** rng.uniform(low, high))


def plain(rng):
    law = rng.choice(EVERY)(rng, 1)
    cam, turns = Cam(law), rng.choice([1, 1, 2])
    return law, *with_orbit(rng, cam, anywhere(rng), turns=turns)[:2]


def velocity_jump(rng):
    law = rng.choice([kinked_law, kinked_law, rectified_law])(rng, 1)
    cam = Cam(law)
    return law, *with_orbit(rng, cam, near_seam(rng, cam, -3, -0.7))[:2]


def equal_lobes(rng):
    lobes = rng.choice([2, 2, 3])
    law = rng.choice([harmonic_law, rectified_law, program_law, kinked_law, smooth_law, table_law])(rng, lobes)
    return law, *with_orbit(rng, Cam(law), anywhere(rng))[:2]


def seam(rng):
    law = rng.choice([arcs_law, rectified_law, program_law, kinked_law, smooth_law, table_law])(rng, 1)
    cam = Cam(law)
    return law, *with_orbit(rng, cam, near_seam(rng, cam, -11, -9))[:2]


def restitutions(rng):
    law = rng.choice(EVERY)(rng, 1)
    restitution = rng.choice([1e-6, 1.0, 1.0 - 1e-9, 10 ** rng.uniform(-6, -1)])
    return law, *with_orbit(rng, Cam(law), anywhere(rng), restitution)[:2]


def tiny_segments(rng):
    law = rng.choice([program_law, kinked_law, smooth_law])(rng, 1, True)
    cam = Cam(law)
    return law, *with_orbit(rng, cam, rng.choice([anywhere(rng), near_seam(rng, cam, -9, -1)]))[:2]


def equal_rows(rng):
    law = table_law(rng, 1, True)
    cam = Cam(law)
    return law, *with_orbit(rng, cam, rng.choice([anywhere(rng), near_seam(rng, cam, -9, -1)]))[:2]


def fold(rng):
    """Plant a fold: the speed is next to one at which two roots of the law coincide. The push makes the law 0 at one of its extremes."""
    law = rng.choice(EVERY)(rng, 1)
    cam = Cam(law)
    for _ in range(60):
        numbers = follower_numbers(rng)
        rpm = speed(rng, numbers)
        machine = Machine(cam, Follower(**numbers), rpm)
        grid = np.linspace(0, math.tau, 2000)
        values = machine.law(*cam.at(grid))
        extremes = np.nonzero((values[1:-1] - values[:-2]) * (values[2:] - values[1:-1]) < 0)[0] + 1
        if not len(extremes):
            continue
        i = rng.choice(list(extremes))
        low, high, sign = grid[i - 1], grid[i + 1], np.sign(values[i] - values[i - 1])
        for _ in range(12):
            closer = np.linspace(low, high, 21)
            i = int(np.argmax(sign * machine.law(*cam.at(closer))))
            low, high = closer[max(i - 1, 0)], closer[min(i + 1, 20)]
        angle = mpf(float(0.5 * (low + high)))
        found = pushed(cam, numbers, rpm, angle, 1)
        if not found:
            continue
        numbers, machine = found
        off = 10 ** rng.uniform(-8, -3)
        sides = [machine.at_speed(rpm * (1 + sign * off)) for sign in (-1, 1)]
        is_there = [any(apart(angles_of(orbit)[0], angle) < 0.3 for orbit in side.one_impact(500)[0]) for side in sides]
        if any(is_there):
            return law, numbers, sides[is_there.index(True) if rng.random() < 0.7 else rng.randrange(2)]
    raise Planted


def graze(rng):
    """Plant a graze: the flight of an orbit passes close to a bump, or hits it, shortly before the impact."""
    law = smooth_law(rng, 1)
    cam = Cam(law)
    for _ in range(20):
        numbers, machine, angle = with_orbit(rng, cam, anywhere(rng))
        far = 10 ** rng.uniform(-3, -1)
        starts = [float(mp.degrees(angle - far * part)) for part in (1, 0.6, 0.3)]
        if starts[0] < 0 or cam.piece(radians(starts[0])) != cam.piece(angle) or starts[0] < float(mp.degrees(cam.exact[1])):
            continue
        before = [part for part in law["segment"] if part["start_deg"] < starts[0]]
        after = [part for part in law["segment"] if part["start_deg"] > starts[0]]
        if not before:
            continue
        lift, slope = cam.one(angle)
        leaves = machine.velocities(lift, slope)[1]
        places = [radians(start) for start in starts]
        part = (places[1] - angle + TURN) / TURN
        a, b, e, c, d, f = machine.follower.flow(machine.period * part)
        near = rng.choice([-1, 1, 1]) * mpf(10 ** rng.uniform(-9, -5)) * cam.stroke
        top = (a * lift + b * leaves + e - near, (c * lift + d * leaves + f) / machine.omega)
        ends = [cam.one(places[0]), top, cam.one(places[2])]
        own = [exact(c) for c in before[-1]["coefficients"]]
        off = places[2] - radians(before[-1]["start_deg"])
        rest = [mp.fsum(mp.binomial(n, k) * own[n] * off ** (n - k) for n in range(k, len(own))) for k in range(len(own))]
        pieces = [hermite(places[k + 1] - places[k], ends[k], ends[k + 1]) for k in (0, 1)] + [rest]
        bump = [{"start_deg": start, "coefficients": [float(c) for c in piece]} for start, piece in zip(starts, pieces)]
        law = {"law": "polynomial", "segment": before + bump + after}
        return law, numbers, Machine(Cam(law), machine.follower, machine.rpm)
    raise Planted


PLANTS = [velocity_jump, plain, seam, equal_lobes, fold, restitutions, graze, tiny_segments, equal_rows]


def drawn(index, folder):
    """Return (plant, law, file, machine) of a random machine; None if none was found in a fair number of tries."""
    rng, plant = random.Random(index), PLANTS[index % len(PLANTS)]
    try:
        law, numbers, machine = plant(rng)
    except Planted:
        return None
    file = Path(folder) / f"adversary-{index}.toml"
    file.write_text(text(law, numbers))
    return plant.__name__, law, file, machine
