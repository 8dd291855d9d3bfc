"""Certificates for candidate corner impacts: that each exists and is the only one nearby, its map, and its verdict.

Reads one JSON document from stdin: the model's "follower" and "cam", "bits", and "candidates", places in doubles where corner impacts
are expected. Writes one to stdout:

    results     for each candidate a "certificate", with a ball for every number, or "refused" with the reason
    assumed     the mismatch of the cam's pieces, which is taken out, or null

Everything in a certificate is proved, for the machine whose constants are the decimals of the model. Candidates only say where corner
impacts are looked for. Three more keys of the input ask for more:

    orbits_at_rpm               adds "orbits", "complete" and "undecided"
    orbits_over_rpm [low, high] adds "counts", "undecided" and "events"
    resting_at_rpm              adds "bits", "releases", "looked_at", "periodic" and "pressed_rad"
"""

import json
import sys

try:
    from flint import arb, ctx
except ImportError:
    sys.exit("certify.py: the Python package python-flint is missing")

from balls.branches import ORBIT, UNDECIDED, Branches
from balls.corner_impact import CornerImpact
from balls.motion import Machine
from balls.nearby import followed
from balls.numbers import Refused, ball, decimal, hull
from balls.orbits import Orbits
from balls.profiles import missed_by
from balls.resting import MOST_IMPACTS, Resting
from balls.verdict import SIDES, Verdict

# Fewer bits prove nothing, and more bits take too long.
FEWEST_BITS, MOST_BITS = 16, 16384
# A motion that needs more bits until it rests is given up.
MOST_RESTING_BITS = 4096
# The cam's law before the corner holds on the minus side, and the law after it on the plus side.
LAW_OF = {"minus": "before", "plus": "after"}


def certificate(machine, candidate, apart):
    """Return everything that is proved of one candidate. `apart` is the mismatch of the cam's pieces. Raise Refused if the proof fails."""
    orbit = CornerImpact(machine, candidate)
    maps, borders = {}, {}
    for side in SIDES:
        maps[side], borders[side] = orbit.side_map(LAW_OF[side])
    # The distance of the flight from the cam when the corner passes does not depend on the impact.
    found = Verdict(maps, borders["minus"])
    return {
        "period_s": ball(orbit.period),
        "speed_rpm": ball(60 / orbit.period),
        "cam_angle_rad": ball(orbit.corner.angle),
        "alone_within": orbit.alone,
        "revolutions": orbit.revolutions,
        "section_angle_rad": ball(orbit.section),
        "state": [ball(x) for x in orbit.state],
        "state_origin_m": ball(machine.follower.origin),
        "impacts": [
            {
                "cam_angle_rad": ball(impact.angle),
                "velocity_before_m_s": ball(before),
                "velocity_after_m_s": ball(impact.velocity),
                "cam_velocity_m_s": ball(impact.cam_velocity),
            }
            for impact, before in zip(orbit.impacts, orbit.velocities_before)
        ],
        **{side: side_document(found, side, followed(orbit, LAW_OF[side])) for side in SIDES},
        "C": [ball(x) for x in found.c],
        "D": ball(found.d),
        "border": [ball(x) for x in found.border],
        "conditions": [{"name": one.name, "value": ball(one.value), "sign": one.sign} for one in found.conditions],
        "verdict": found.scenario,
        "period_two_orbit": found.period_two_orbit(),
        "assumed": apart,
        "proved": True,
    }


def side_document(found, side, beside):
    """Return one side of the map, with the range in which its fixed point is proved to exist. Raise Refused if both contradict each other."""
    a = found.a[side]
    if beside is not None and beside.exists_for != found.exists_for(side):
        raise Refused("the followed fixed point contradicts the verdict: one of them is wrong")
    return {
        "A": [[ball(a[row, column]) for column in range(2)] for row in range(2)],
        "B": [ball(x) for x in found.b[side]],
        "eigenvalues": [{"re": ball(re), "im": ball(im)} for re, im in found.eigenvalues[side]],
        "fixed_point_exists_for": found.exists_for(side),
        "stable": found.stable(side),
        "followed": beside
        and {"period_within_s": beside.period, "cam_angle_within_rad": beside.reach, "state_within": beside.state},
    }


def assumed(table):
    """Return the mismatch of lift and slope between the pieces of a cam as typed, which is taken out; None if there is none."""
    lift, slope = missed_by(table)
    return {"lift_m": float(lift), "slope_m_rad": float(slope)} if lift > 0 or slope > 0 else None


def answer(document, candidates):
    """Return a certificate or the reason for a refusal for each candidate, and the other parts that the document asks for."""
    bits = int(decimal(document.get("bits", 128)))
    if not FEWEST_BITS <= bits <= MOST_BITS:
        raise Refused(f"bits = {bits}: must be from {FEWEST_BITS} to {MOST_BITS}")
    ctx.prec = bits
    machine, results = Machine(document), []
    apart = assumed(document["cam"])
    for candidate in candidates:
        try:
            results.append({"certificate": certificate(machine, candidate, apart)})
        except (Refused, ZeroDivisionError) as error:
            results.append({"refused": str(error)})
    return {"results": results, "assumed": apart, **orbits(machine, document), **counts(machine, document), **resting(document)}


def orbits(machine, document):
    """Return all orbits of one impact and of two in one revolution at "orbits_at_rpm", each with its kind; {} if not asked for.
    "complete" has the numbers of impacts for which the list is proved complete, and "undecided" the places where it is not."""
    if "orbits_at_rpm" not in document:
        return {}
    all_of = Orbits(machine, machine.cam.turn * arb(decimal(document["orbits_at_rpm"])) / 60)
    found, complete, places = [], [], []
    for count in (1, 2):
        some, undecided = all_of.of(count)
        found += [
            {
                "revolutions": 1,
                "impacts": [
                    {"cam_angle_rad": ball(one_turn(machine, angle)), "relative_velocity_m_s": ball(velocity)}
                    for angle, velocity in orbit.impacts
                ],
                "kind": orbit.kind,
            }
            for orbit in some
        ]
        complete += [] if undecided else [count]
        places += [{"impacts": count, "cam_angles_rad": place} for place in joined(undecided)]
    return {"orbits": found, "complete": complete, "undecided": places}


def joined(undecided):
    """Return the ranges of the impacts' angles of undecided places, and join places that overlap. Each place has the angle of the
    first impact and the angle turned until the next."""
    whole = []
    for first, *others in sorted(undecided, key=lambda balls: float(balls[0].lower())):
        angles = [first] + [first + other for other in others]
        if whole and all(one.overlaps(other) for one, other in zip(whole[-1], angles)):
            whole[-1] = [hull(pair) for pair in zip(whole[-1], angles)]
        else:
            whole.append(angles)
    return [[[float(angle.lower()), float(angle.upper())] for angle in angles] for angles in whole]


def counts(machine, document):
    """Return the number and the kinds of the orbits of one impact in one revolution at every speed of "orbits_over_rpm"; {} if not
    asked for. "counts" has ranges of speeds between the doubles nearest to the balls of "events". "undecided" has the ranges that are
    not decided."""
    if "orbits_over_rpm" not in document:
        return {}
    stretches = Branches(machine).over(*(float(decimal(bound)) for bound in document["orbits_over_rpm"]))
    decided = [one for one in stretches if UNDECIDED not in one.kinds]
    kinds = {id(one): [None if kind == ORBIT else kind for kind in one.kinds] for one in decided}
    events = [(before, after) for before, after in zip(stretches, stretches[1:]) if after.event is not None and after.event.kind]
    return {
        "counts": [
            {"from_rpm": float(one.low), "to_rpm": float(one.high), "one_impact_orbits": len(one.kinds), "kinds": kinds[id(one)]}
            for one in decided
        ],
        "undecided": [[float(one.low), float(one.high)] for one in stretches if UNDECIDED in one.kinds],
        "events": [
            {
                "kind": after.event.kind,
                "speed_rpm": ball(60 / after.event.period),
                "cam_angle_rad": ball(one_turn(machine, after.event.angle)),
                "before": kinds.get(id(before)),
                "after": kinds.get(id(after)),
            }
            for before, after in events
        ],
    }


def resting(document):
    """Return the motions that rest at "resting_at_rpm": the motion after each release, the periodic ones, and the bits that were
    needed. The bits are doubled while the balls are too wide. Return {} if not asked for."""
    if "resting_at_rpm" not in document:
        return {}
    machine, speed = Machine(document), decimal(document["resting_at_rpm"])
    while True:
        found = Resting(machine, machine.cam.turn * arb(speed) / 60)
        try:
            hops = [found.hop(index) for index in range(len(found.releases))]
            break
        except Refused:
            if ctx.prec >= MOST_RESTING_BITS:
                raise
        ctx.prec *= 2
        machine = Machine(document)
    places = [
        {
            "cam_angle_rad": ball(release.angle),
            "next": hop
            and {"impacts": hop.impacts, "rests_by_rad": float(one_turn(machine, hop.rests).upper()), "release": hop.to, "revolutions": hop.revolutions},
        }
        for release, hop in zip(found.releases, hops)
    ]
    rounds = [once_around(hops, index) for index in range(len(hops))]
    return {
        "bits": ctx.prec,
        "releases": places,
        "looked_at": MOST_IMPACTS,
        "periodic": [
            {"releases": around, "impacts": sum(hops[one].impacts for one in around), "revolutions": sum(hops[one].revolutions for one in around)}
            for around in rounds
            if around and around[0] == min(around)
        ],
        "pressed_rad": pressed(found.stretches),
    }


def pressed(stretches):
    """Return the ranges of angles in which a is below 0. The first range may continue the last one of the turn before."""
    ranges = []
    for (low, high, _, sign), before in zip(stretches, [None, *stretches]):
        if sign < 0 and before is not None and before[-1] < 0:
            ranges[-1][1] = float(high)
        elif sign < 0:
            ranges.append([float(low), float(high)])
    return ranges


def once_around(hops, first):
    """Return the releases from `first` on until the motion returns to it; [] if it does not return."""
    around, at = [], first
    while hops[at] is not None and at not in around:
        around.append(at)
        at = hops[at].to
    return around if at == first and hops[at] is not None else []


def one_turn(machine, angle):
    """Return an angle less whole turns."""
    return angle - machine.cam.turn * int(float(angle) // float(machine.cam.turn))


def main():
    try:
        text = sys.stdin.read()
        # The model's numbers keep all their digits, and guesses are doubles.
        document, guesses = json.loads(text, parse_float=str, parse_int=str), json.loads(text).get("candidates", ())
        found = answer(document, guesses)
    except (Refused, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"certify.py: {error}")
    json.dump(found, sys.stdout)
    print()


if __name__ == "__main__":
    main()
