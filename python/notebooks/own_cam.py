# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#     text_representation:
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # A cam of one's own
#
# This notebook goes from lifts in numpy to the speed at which the follower leaves its cam, and to the impacts above it. The cam has a
# rise of 10 mm by a modified sine, a dwell, and a return. A spring of 30 N/mm presses a follower of 0.11 kg with 220 N. The units are
# metres, newtons and kilograms.
#
# Open it as a notebook with `jupytext --to ipynb own_cam.py`; it needs `pip install 'corner-impact[plot]'`.

# %%
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

from corner_impact import Model

RISE, DWELL = 80.0, 60.0  # degrees


def modified_sine(part: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lift from 0 to 1: a sine of the acceleration whose middle is stretched."""
    quarter = np.pi / (4 + np.pi)
    return np.select(
        [part < 1 / 8, part < 7 / 8],
        [
            quarter * (part - np.sin(4 * np.pi * part) / (4 * np.pi)),
            quarter * (2 / np.pi + part - 9 / (4 * np.pi) * np.sin(np.pi / 3 * (1 + 4 * part))),
        ],
        quarter * (4 / np.pi + part - np.sin(4 * np.pi * part) / (4 * np.pi)),
    )


angle = np.arange(0.0, 360.0, 1.0)
rise = modified_sine(np.clip(angle / RISE, 0, 1))
fall = modified_sine(np.clip((angle - RISE - DWELL) / RISE, 0, 1))
base, height = 0.020, 0.010
lift = base + height * (rise - fall)

# %% [markdown]
# The spring is slack at `rest_position`: 220 N at the lowest lift.

# %%
stiffness, preload = 30e3, 220.0
follower = {
    "mass": 0.11,
    "damping": 0.0,
    "stiffness": stiffness,
    "gravity": 9.81,
    "rest_position": base - preload / stiffness,
    "restitution": 0.4,
}
table = {"law": "table", "spline": "quintic", "rows": np.column_stack([angle, lift])}
model = Model.from_dict({"name": "modified sine", "follower": follower, "cam": table})
model

# %% [markdown]
# ## Does it jump?
# The survey finds the motions on which runs settle between two speeds, and the speed at which the follower first leaves the cam.

# %%
speeds = model.speeds((2500, 4500), speeds=60, starts=16)
for attractor in speeds.attractors:
    print(f"{attractor.from_rpm:8.2f} to {attractor.to_rpm:8.2f} rpm: {attractor.kind}")
print("leaves its cam first at", speeds.detachment_rpm, "rpm")

# %% [markdown]
# By hand: the follower stays on the cam while m (c'' ω² + g) + k (c - rest) is positive at every angle.

# %%
fine = np.linspace(0, 2 * np.pi, 20001)
cam = model.cam(angle_rad=fine)
mass = follower["mass"]
spring = stiffness * (cam.lift_m - follower["rest_position"]) + mass * follower["gravity"]
falling = cam.curvature_m_rad2 < 0
omega = np.sqrt(np.min(spring[falling] / (-mass * cam.curvature_m_rad2[falling])))
leaves = omega * 30 / np.pi
print(f"it leaves its cam at {leaves:.2f} rpm")
assert abs(leaves - speeds.detachment_rpm) < 1e-3 * leaves

# %% [markdown]
# ## How hard does it hit?
# Impact speeds against the speed of the cam.

# %%
impacts = model.diagram(np.linspace(0.97, 1.3, 200) * leaves, transient=200, record=40).impacts
speed = impacts.velocity_after_m_s - impacts.velocity_before_m_s
plt.figure(layout="constrained")
plt.plot(impacts.rpm, speed / (1 + follower["restitution"]), ".", markersize=1)
plt.axvline(leaves, linewidth=0.5, color="black")
plt.xlabel("speed (rpm)")
plt.ylabel("impact speed (m/s)")
plt.show()
assert impacts.rpm.min() > leaves

# %% [markdown]
# ## A stiffer spring
# A stiffer spring changes one number of the model.

# %%
for factor in [1.0, 1.25, 1.5]:
    stiffer = model.with_number("stiffness", factor * stiffness)
    impacts = stiffer.simulate(1.15 * leaves, 100, transient=200).impacts
    hardest = np.max(impacts.cam_velocity_m_s - impacts.velocity_before_m_s, initial=0.0)
    print(f"{factor * stiffness / 1000:.1f} N/mm: hardest impact {hardest:.3f} m/s")
