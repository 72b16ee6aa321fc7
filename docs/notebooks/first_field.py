# %% [markdown]
# # A first field
#
# A scene is what is modelled: blocks, faults between them, rock, stress, pressures. `Scene.field` is the one that
# `faultsim init field` writes. All numbers are in SI; `faultsim.units` has the others.

# %%
import numpy as np

import faultsim
from faultsim.units import MPa, bar, deg, m, mm, year

scene = faultsim.Scene.field(tier="screening", offset=120 * m).set({"/numerics/plane_strain": "on"})
print(scene.plan())

# %% [markdown]
# What can be varied, with its unit and whether it costs a new operator:

# %%
for parameter in scene.parameters():
    if parameter.alias in ("friction_angle", "offset", "ratio_across", "fault_pressure"):
        print(f"{parameter.alias:16} {parameter.value:10} {parameter.range:24} new operator: {parameter.new_operator}")

# %% [markdown]
# A simulation holds a scene. Its first run builds the operator, the rock condensed onto its faults; further runs take
# milliseconds.

# %%
simulation = faultsim.Simulation(scene)
result = simulation.run(friction_angle=20 * deg)
result

# %% [markdown]
# Values are those of `result.json`, fields are arrays over load steps and nodes. Where the nodes are says the geometry.

# %%
fields, geometry = result.fields, result.geometry
print("fields", fields.traction.shape, "at nodes", geometry.position.shape)
step, node = np.unravel_index(fields.critical_index.argmax(), fields.critical_index.shape)
print(f"closest to sliding after {fields.times[step] / year:.1f} years, {-geometry.position[node, 2]:.0f} m deep")
normal, strike, dip = fields.traction[step, node] / MPa
print(f"effective traction there: normal {normal:.1f}, along strike {strike:.1f}, down dip {dip:.1f} MPa")

# %%
for fault in geometry.faults:
    nodes = slice(fault.first_node, fault.first_node + fault.n_nodes)
    slip = np.linalg.norm(fields.slip[:, nodes, 1:], axis=2).max()
    print(f"{fault.name}: largest slip {slip / mm:.1f} mm, length down dip {fault.profiles[0].length:.0f} m")

# %%
result.plot("section")

# %% [markdown]
# A change that is refused says everything that is wrong, with its cure:

# %%
try:
    simulation.run(friction_angle=120 * deg, cohesion=-1 * bar)
except faultsim.InputError as error:
    for problem in error.problems:
        print(f"{problem.pointer}: {problem.what}; {problem.cure}")
