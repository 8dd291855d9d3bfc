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
# Osorio, di Bernardo and Santini, *Corner-Impact Bifurcations*: a follower bounces on a cam whose acceleration jumps. At one speed the
# impact of the stable motion is at the jump. This notebook shows the cam, that motion, and the motions at other speeds.
#
# Open it as a notebook with `jupytext --to ipynb paper.py`; it needs `pip install 'corner-impact[plot,xarray]'`.

# %%
import matplotlib.pyplot as plt
import numpy as np

from corner_impact import Chart, LocalMap, Model

model = Model.paper()
model

# %% [markdown]
# ## The cam
# The cam has three arcs. Its lift and slope are continuous, and its curvature jumps.

# %%
cam = model.cam(angle_deg=np.linspace(0, 360, 2001))
figure, panels = plt.subplots(2, 1, sharex=True, layout="constrained")
cam.plot(panels[0], linestyle="-", marker="")
cam.plot(panels[1], y="curvature_m_rad2", linestyle="-", marker="")
plt.show()

# %% [markdown]
# ## A stable motion: one impact in each revolution at 700 rpm
# Between impacts the follower flies freely, and a spring brings it back.

# %%
rpm = 700.0
start = model.strobe_map(rpm, 4.4, -30.0, revolutions=400)
events = model.simulate(rpm, 3, position=float(start.position_m), velocity=float(start.velocity_m_s))
print("impacts at", events.impacts.cam_angle_deg.round(6), "degrees")
assert np.ptp(events.impacts.cam_angle_deg) < 1e-7

# %% [markdown]
# ## From 660 to 750 rpm
# The diagram shows the cam angles of the impacts. Below the corner impact the stable motion is gone, and the motion is chaotic.

# %%
axes = model.diagram(np.linspace(660, 750, 400), transient=300, record=60).impacts.plot()
located = model.locate((660, 750)).corner_impacts
for one in located:
    axes.axvline(one.speed_rpm, linewidth=0.5, color="black")
plt.show()

# %% [markdown]
# ## The corner impact, by every route
# Closed forms, differences of the simulator, and least squares must agree.

# %%
verified = model.verify(external=False)
print("corner impact at", located[0].speed_rpm, "rpm:", verified.classification.scenario)
assert verified.agrees and abs(located[0].speed_rpm - 673.234445) < 1e-6

# %% [markdown]
# ## The local map
# A deviation from the orbit at the corner impact moves by one of two matrices. Just above that speed, where the period is shorter, an orbit
# with its impacts after the corner is stable.

# %%
local = LocalMap(model)
orbit = local.orbit("R", dT=-1e-4)
nearby = orbit.points[0] + np.array([[1e-3, 0.0], [0.0, 1e-2]])
print("multipliers", orbit.multipliers)
assert orbit.stable and np.allclose(local(nearby, -1e-4, steps=200), orbit.points[0])
local

# %% [markdown]
# ## Basins of attraction
# At 678 rpm a stable motion and a chaotic one coexist. The start decides between them.

# %%
model.basins(678, (60, 45), strobe_rad=local.corner_impact.section_angle_rad).plot()
plt.show()

# %% [markdown]
# ## Two parameters
# Class of the motion over the speed and the coefficient of restitution.

# %%
axes_of_chart = {"restitution": np.linspace(0.5, 0.95, 60), "rpm": np.linspace(600, 760, 80)}
chart = Chart(model, axes_of_chart).compute()
chart.plot()
plt.show()
print(chart.sel(restitution=0.8, method="nearest").revolutions.values)
