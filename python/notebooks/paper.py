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
# # The paper's figures
#
# Osorio, di Bernardo and Santini, *Corner-Impact Bifurcations*: a follower bounces on a cam whose acceleration jumps, and at some
# speed the stable motion has its impact right at the jump. Here are the cam, that motion, what becomes of it, and what else there is.
#
# Open it as a notebook with `jupytext --to ipynb paper.py`; it needs `pip install 'corner-impact[charts]' matplotlib`.

# %%
import matplotlib.pyplot as plt
import numpy as np

from corner_impact import EVENTS, Chart, Model
from corner_impact.charts import dataset

model = Model.paper()
model

# %% [markdown]
# ## The cam
# Three arcs: the lift and its slope are continuous, the curvature jumps.

# %%
angle = np.linspace(0, 2 * np.pi, 2001)
cam = model.cam(angle)
figure, panels = plt.subplots(2, 1, sharex=True, layout="constrained")
for panel, name, label in zip(panels, ["lift_m", "curvature_m_rad2"], ["lift (m)", "curvature (m/rad²)"]):
    panel.plot(np.degrees(angle), cam[name])
    panel.set_ylabel(label)
panels[-1].set_xlabel("cam angle (°)")
plt.show()

# %% [markdown]
# ## A stable motion: one impact in each revolution at 700 rpm
# Between impacts the follower flies freely; a spring brings it back.

# %%
rpm = 700.0
start = model.strobe_map(rpm, [4.4], [-30.0], revolutions=400)
events = model.simulate(
    rpm, 3, position=float(start["position_m"][0]), velocity=float(start["velocity_m_s"][0])
)
impacts = events["event"] == EVENTS.index("impact")
print("impacts at", np.degrees(events["cam_angle_rad"][impacts]).round(6), "degrees")
assert np.ptp(events["cam_angle_rad"][impacts]) < 1e-9

# %% [markdown]
# ## From 660 to 750 rpm
# Where the impacts are: below the corner impact the stable motion is gone, and what is left is chaotic.

# %%
found = model.diagram((660, 750, 400), transient=300, record=60)
impact = found["event"] == EVENTS.index("impact")
plt.figure(layout="constrained")
plt.plot(found["rpm"][impact], np.degrees(found["cam_angle_rad"][impact]), ",")
located = model.locate((660, 750))["corner_impacts"]
for one in located:
    plt.axvline(one["speed_rpm"], linewidth=0.5, color="black")
plt.xlabel("speed (rpm)")
plt.ylabel("cam angle of impacts (°)")
plt.show()

# %% [markdown]
# ## The corner impact, by every route
# Closed forms, differences of the simulator, and least squares have to agree.

# %%
verified = model.verify(external=False)
print("corner impact at", located[0]["speed_rpm"], "rpm:", verified["classification"]["scenario"])
assert verified["agrees"] and abs(located[0]["speed_rpm"] - 673.234445) < 1e-6

# %% [markdown]
# ## Two parameters
# What a run comes to, over the speed and the coefficient of restitution.

# %%
axes = {"restitution": np.linspace(0.5, 0.95, 60), "rpm": np.linspace(600, 760, 80)}
chart = dataset(Chart(model, axes))
periodic = chart.revolutions.where(chart["class"] == chart["class"].attrs["flag_meanings"].split().index("periodic"))
plt.figure(layout="constrained")
periodic.plot.pcolormesh(x="rpm", levels=[0.5, 1.5, 2.5, 3.5, 4.5], extend="max")
plt.title("periodic motions, by period; white is all else")
plt.show()
