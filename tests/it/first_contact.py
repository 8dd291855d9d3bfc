"""Flights checked in ball arithmetic of 200 bits, sixty digits, from the text of a model: the slow reference of the event loop.

Each line of stdin is a flight: {"model": text, "omega", "angle", "position", "velocity", "time", "hit", "room", "early"}. "hit" is
null or [v, a bound on its rounding]. "room" is how far rounding may move the gap, m, and "early" how far it may move the time of an
impact, s. For each flight a line says what is wrong, or "right", "undecided" or "no reference". A flight is right if the follower is
never more than `room` below the cam before the end. If it hits, it must also be within `room` of the cam at the end.
"""

import json
import sys
import tomllib

from flint import arb, ctx

ctx.prec = 200
PI = arb.pi()
# The program uses the double next to a full turn.
TURN = arb(6.283185307179586)
# Most parts of a piece of the cam that are examined. A flight that stays within rounding of the cam is undecided then.
MOST_LOOKS = 5000


def cam(law):
    """Return the pieces of a turn: (start, rad, function). The function returns lift and its first two derivatives over a ball of angles."""
    radians = lambda degrees: arb(degrees) * PI / 180
    if law["law"] == "harmonic":
        terms = [(k + 1, arb(a), radians(p)) for k, (a, p) in enumerate(zip(law["amplitudes"], law["phases_deg"]))]

        def lift(x):
            waves = [(k, a * (k * x + p).cos(), a * (k * x + p).sin()) for k, a, p in terms]
            return (arb(law["offset"]) + sum(c for _, c, _ in waves), -sum(k * s for k, _, s in waves), -sum(k * k * c for k, c, _ in waves))

        return [(arb(0), lift)]
    if law["law"] == "rectified-sine":
        offset, size = arb(law["offset"]), arb(law["amplitude"])
        half = lambda sign: lambda x: (offset + sign * size * x.sin(), sign * size * x.cos(), -sign * size * x.sin())
        return [(arb(0), half(1)), (PI, half(-1))]
    if law["law"] == "polynomial":

        def polynomial(start, coefficients):
            def lift(x):
                u, value, slope, half = x - start, arb(0), arb(0), arb(0)
                for a in reversed(coefficients):
                    half, slope, value = half * u + slope, slope * u + value, value * u + arb(a)
                return value, slope, 2 * half

            return lift

        pieces = [(radians(part["start_deg"]), part["coefficients"]) for part in law["segment"]]
        last = pieces[-1]
        # The last piece continues through 360 degrees to the first.
        around = [(arb(0), polynomial(last[0] - TURN, last[1]))] if law["segment"][0]["start_deg"] > 0 else []
        return around + [(start, polynomial(start, coefficients)) for start, coefficients in pieces]
    if law["law"] == "arcs":
        base, flank, nose = (arb(law[name + "_radius"]) for name in ("base", "flank", "nose"))
        start, end = radians(law["flank_start_deg"]), radians(law["nose_end_deg"])

        def circle(distance, direction, radius, mirrored):
            def lift(x):
                phi = (2 * PI - x if mirrored else x) - direction
                sin, cos = phi.sin(), phi.cos()
                w = (radius**2 - distance**2 * sin**2).sqrt()
                w1 = -(distance**2) * sin * cos / w
                w2 = (-(distance**2) * (cos**2 - sin**2) - w1**2) / w
                slope = -distance * sin + w1
                return distance * cos + w, -slope if mirrored else slope, -distance * cos + w2

            return lift

        # The flank's centre is behind the axis, and the nose's is towards its end. The circles touch on the line through both centres.
        back = flank - base
        turn = end - start
        ahead = -back * turn.cos() + ((flank - nose) ** 2 - (back * turn.sin()) ** 2).sqrt()
        x = [ahead * f(end) + back * f(start) for f in (arb.cos, arb.sin)]
        touch = [flank / (flank - nose) * part - back * f(start) for part, f in zip(x, (arb.cos, arb.sin))]
        meets = arb.atan2(touch[1], touch[0])
        level = lambda radius: lambda x: (radius, arb(0), arb(0))
        parts = [(arb(0), start, level(base), level(base))]
        parts.append((start, meets, *(circle(back, start + PI, flank, side) for side in (False, True))))
        parts.append((meets, end, *(circle(ahead, end, nose, side) for side in (False, True))))
        parts.append((end, PI, level(ahead + nose), level(ahead + nose)))
        return [(low, lift) for low, _, lift, _ in parts] + [(2 * PI - high, lift) for _, high, _, lift in reversed(parts)]
    return None


def flight(follower, position, velocity):
    """Return a function for position, velocity and acceleration over a ball of times; None if the damping may be critical."""
    mass, damping, stiffness, gravity = (arb(follower[name]) for name in ("mass", "damping", "stiffness", "gravity"))
    zeta, square = damping / (2 * mass), stiffness / mass
    rest, q0, v0 = arb(follower["rest_position"]), arb(position), arb(velocity)
    if stiffness == 0:
        if damping == 0:
            at = lambda t: (q0 + v0 * t - gravity * t * t / 2, v0 - gravity * t)
        else:
            end = -gravity / (2 * zeta)
            at = lambda t: (q0 + end * t + (v0 - end) * (1 - (-2 * zeta * t).exp()) / (2 * zeta), end + (v0 - end) * (-2 * zeta * t).exp())
    else:
        level = rest - gravity / square
        x = q0 - level
        left = square - zeta**2
        if not (left > 0 or left < 0):
            return None
        # Near critical damping two exponentials would nearly cancel; w cancels in the hyperbolic sine.
        w, sine, cosine = (left.sqrt(), arb.sin, arb.cos) if left > 0 else ((-left).sqrt(), arb.sinh, arb.cosh)

        def at(t):
            fade, sin, cos = (-zeta * t).exp(), sine(w * t), cosine(w * t)
            return level + fade * (x * cos + (v0 + zeta * x) / w * sin), fade * (v0 * cos - (square * x + zeta * v0) / w * sin)

    def whole(t):
        q, v = at(t)
        return q, v, -2 * zeta * v - square * (q - rest) - gravity

    return whole


def ball(low, high):
    return low.union(high)


def deeper(gap, low, high, room):
    """Return the first time in a range at which the gap is, or may be, below -room; None if there is certainly none."""
    left, looks = [(low, high)], 0
    while left:
        looks += 1
        if looks > MOST_LOOKS:
            raise TimeoutError
        low, high = left.pop()
        over, middle = ball(low, high), ((low + high) / 2).mid()
        value, rate, bend = gap(over)
        g, g1, _ = gap(middle)
        off = over - middle
        if value + room > 0 or g + g1 * off + bend * off**2 / 2 + room > 0 or g + rate * off + room > 0:
            continue
        if high - low < arb(1e-26) * (1 + abs(high)) or g + room < 0:
            return low
        left += [(middle, high), (low, middle)]
    return None


def judged(case, pieces, whole):
    omega, begin, room = arb(case["omega"]), arb(case["angle"]), arb(case["room"])
    end, early = arb(case["time"]), arb(case["early"])
    starts = [start for start, _ in pieces]
    last = end - early if case["hit"] else end
    turn = 0
    while True:
        for index, (start, lift) in enumerate(pieces):
            stop = starts[index + 1] if index + 1 < len(pieces) else TURN
            low, high = ((angle + turn * TURN - begin) / omega for angle in (start, stop))
            low, high = (low.mid() if low > 0 else arb(0)), (high.mid() if high < last else last)

            def gap(t):
                q, v, a = whole(t)
                c, c1, c2 = lift(begin + omega * t - turn * TURN)
                return q - c, v - omega * c1, a - omega**2 * c2

            if low < high and (where := deeper(gap, low, high, room)) is not None:
                return f"below the cam at {where.str(20)} s of {end.str(20)} s: {gap(where.mid())[0].str(10)}"
            if case["hit"] and high + early >= end and low <= end + early:
                g, g1, _ = gap(end)
                if not abs(g) < room + abs(g1) * early:
                    return f"hits {g.str(10)} m off the cam, {g1.str(10)} m/s"
                v, blur = case["hit"]
                if not abs(whole(end)[1] - arb(v)) < blur:
                    return f"hits at {v} m/s, not at {whole(end)[1].str(20)}"
                return ""
        turn += 1
        if not (turn * TURN - begin) / omega < end:
            return "ends on no piece of the cam" if case["hit"] else ""


for line in sys.stdin:
    case = json.loads(line)
    model = tomllib.loads(case["model"])
    pieces, whole = cam(model["cam"]), flight(model["follower"], case["position"], case["velocity"])
    try:
        said = "no reference" if pieces is None or whole is None else judged(case, pieces, whole) or "right"
    except TimeoutError:
        said = "undecided"
    print(said, flush=True)
