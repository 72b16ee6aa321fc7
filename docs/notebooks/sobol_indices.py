# %% [markdown]
# # 10,000 samples and Sobol' indices
#
# `run_many` is a function from arrays to arrays, as libraries for sensitivity, calibration and surrogates call it.
# Here Saltelli's design: `problem` is as SALib has it, its `sample.sobol` gives such rows in another order. The indices are by the
# estimators of Saltelli et al. (2010) and Jansen (1999).

# %%
import numpy as np

import faultsim
from faultsim.units import MPa, deg

problem = {
    "names": ["friction_angle", "ratio_across", "fault_pressure_fraction"],
    "bounds": [[18 * deg, 32 * deg], [0.65, 0.85], [0.0, 1.0]],
}
n_base, n_parameters = 2000, len(problem["names"])  # (n + 2) x 2000 = 10,000 rows

random = np.random.default_rng(2)
low, high = np.array(problem["bounds"]).T


def saltelli_rows(n: int) -> np.ndarray:
    """A, B and, for each parameter, A with its column of B, one after the other: (n_parameters + 2) n rows."""
    a, b = (low + (high - low) * random.random((n, n_parameters)) for _ in range(2))
    mixed = [np.where(np.arange(n_parameters) == i, b, a) for i in range(n_parameters)]
    return np.concatenate([a, b, *mixed])


X = saltelli_rows(n_base)
X.shape

# %% [markdown]
# Two threads share one operator. The bits do not depend on how many there are.

# %%
scene = faultsim.Scene.field(tier="screening", fault_pressure="fraction").set({"/numerics/plane_strain": "on"})
simulation = faultsim.Simulation(scene)
runs = simulation.run_many(X, parameters=problem["names"], outputs=["chi_bar", "slides", "F2.max_slip"], threads=2)
print(f"a fault slides in {100 * runs['slides'].mean():.1f} % of {len(X)} cases")

# %%


def sobol(y: np.ndarray) -> dict[str, np.ndarray]:
    """First-order and total indices of each parameter."""
    y = (y - y.mean()) / y.std()
    a, b, *mixed = y.reshape(n_parameters + 2, n_base)
    variance = np.concatenate([a, b]).var()
    return {
        "S1": np.array([np.mean(b * (m - a)) for m in mixed]) / variance,
        "ST": np.array([np.mean((a - m) ** 2) for m in mixed]) / 2 / variance,
    }


for output in runs:
    indices = sobol(runs[output])
    for name, first, total in zip(problem["names"], indices["S1"], indices["ST"]):
        print(f"{output:12} {name:24} alone {first:5.2f}, with others {total:5.2f}")

# %% [markdown]
# As a table, for scikit-learn or a neural network:

# %%
table = runs.to_pandas()
table.describe()
