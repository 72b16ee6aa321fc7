# %% [markdown]
# # A pressure field as an array
#
# Pressures of a flow simulator, or of a network that replaces one, vary from cell to cell. The influence block says what
# stress in each cell of the compartments does to closed faults: a field is an array over its cells, and costs one
# product.

# %%
import numpy as np

import faultsim
from faultsim.units import MPa, bar, m

scene = faultsim.Scene.field(tier="screening", offset=120 * m).set({"/numerics/plane_strain": "on"})
simulation = faultsim.Simulation(scene)
operator, block = simulation.operator, simulation.influence()
print(f"{len(block.cell)} cells in {', '.join(block.region_names)}; {operator.geometry.n_dofs} components of jumps")

# %% [markdown]
# A depletion by 100 bar in one compartment, once as one number, which is a load of the operator, and once cell by cell.
# Stress is Biot's coefficient times the change of pressure; here that is 1.

# %%
of_first = block.region == 0
uniform = np.where(of_first, -100 * bar, 0.0) * block.fraction
loads = [i for i, name in enumerate(operator.load_names) if name.startswith("pressure:0:")]
by_load = -100 * bar * operator.load_traction[:, loads].sum(axis=1)
by_cells = block.locked_change(uniform[:, None])[:, 0]
print(f"largest difference {np.abs(by_load - by_cells).max() / np.abs(by_load).max():.1e} of the largest traction")
assert np.allclose(by_load, by_cells, atol=1e-6 * np.abs(by_load).max())

# %% [markdown]
# Fields that fall off from a well: one column each. The change of the shear traction beside that of the normal one, at
# the nodes of the faults.

# %%
x = block.centroid[:, 0]
wells = np.linspace(x.min(), x.max(), 5)
fields = np.stack([-100 * bar * np.exp(-((x - well) / (500 * m)) ** 2) * block.fraction for well in wells], axis=1)
change = block.locked_change(fields, threads=2)

dof = operator.geometry.dof
normal = np.where(dof[:, [0]] >= 0, change[dof[:, 0]], 0)
along_dip = np.where(dof[:, [2]] >= 0, change[dof[:, 2]], 0)
for i, well in enumerate(wells):
    print(f"well at x = {well:7.0f} m: normal traction up to {np.abs(normal[:, i]).max() / MPa:.2f} MPa, "
          f"down dip {np.abs(along_dip[:, i]).max() / MPa:.2f} MPa")

# %% [markdown]
# The same arrays are what a linear surrogate, or the gradient of a misfit in every cell's pressure, is made of.

# %%
gradient = block.traction[0]  # of the first component of traction, Pa per Pa
print("gradient of the first traction in all cells' stress:", gradient.shape)
