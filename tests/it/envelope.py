"""Lifts of a follower on a cam of three circles, or on a contour, from points of the cam alone.

The lift is the lowest position of the follower in which no point of the cam is inside it.
"""

import json
import sys

import numpy as np
from scipy.interpolate import CubicSpline

PER_CIRCLE = 100_000


def contour(cam):
    """Return points of the cam, all round."""
    base, flank, nose = (cam[name] for name in ("base_radius", "flank_radius", "nose_radius"))
    start, end = np.radians([cam["flank_start_deg"], cam["nose_end_deg"]])
    ray = lambda angle: np.exp(1j * angle)
    flank_centre = (base - flank) * ray(start)
    # The nose's centre is on the ray at `end`, at the distance flank - nose from the flank's centre. It is found by bisection.
    low, high = 0.0, 4.0 * flank
    for _ in range(200):
        middle = 0.5 * (low + high)
        if abs(middle * ray(end) - flank_centre) < flank - nose:
            low = middle
        else:
            high = middle
    nose_centre = low * ray(end)
    normal = np.angle(nose_centre - flank_centre)
    arc = lambda centre, radius, first, last: centre + radius * ray(np.linspace(first, last, PER_CIRCLE))
    half = [arc(0.0, base, 0.0, start), arc(flank_centre, flank, start, normal), arc(nose_centre, nose, normal, end), arc(0.0, abs(nose_centre) + nose, end, np.pi)]
    half = np.concatenate(half)
    return np.concatenate([half, half.conj()])


def through(rows):
    """Return points of the periodic cubic spline of the radius through the rows."""
    angles, radii = np.array([[np.radians(row["angle_deg"]), row["lift"]] for row in rows]).T
    spline = CubicSpline(np.append(angles, angles[0] + 2.0 * np.pi), np.append(radii, radii[0]), bc_type="periodic")
    angles = np.linspace(0.0, 2.0 * np.pi, 8 * PER_CIRCLE, endpoint=False)
    return spline(angles) * np.exp(1j * angles)


def lift(points, contact, angle):
    """Return the lift of the follower when the cam has turned by an angle."""
    turned = points * np.exp(-1j * angle)
    along, left = turned.real, turned.imag
    if contact == "flat":
        return along.max()
    # A point follower has neither a radius nor an offset.
    radius, offset = (contact["roller_radius"], contact["offset"]) if isinstance(contact, dict) else (0.0, 0.0)
    if radius == 0.0:
        # Interpolate between the two points nearest to the line of motion, on the follower's side of the axis.
        order = np.argsort(np.where(along > 0, np.abs(left), np.inf))[:2]
        one, two = turned[order]
        return one.real + (two.real - one.real) * one.imag / (one.imag - two.imag)
    near = np.abs(left - offset) < radius
    return (along[near] + np.sqrt(radius**2 - (left[near] - offset) ** 2)).max()


found = []
asked = json.load(sys.stdin)
for cam in asked["cams"]:
    points = through(cam["rows"]) if cam["law"] == "contour" else contour(cam)
    found.append([lift(points, cam.get("contact", "point"), angle) for angle in asked["angles"]])
print(json.dumps(found))
