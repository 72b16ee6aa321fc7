# %% [markdown]
# # Calibrating friction to what was observed
#
# A fault was seen to begin to slide at some depletion. Which friction angles agree with that? The history of the index
# chi bar of each fault at the end of each load step, for many angles at once, says when each of them lets it slide.

# %%
import numpy as np

import faultsim
from faultsim.units import bar, deg, year

scene = faultsim.Scene.field(tier="screening", offset="120 m").set({"/numerics/plane_strain": "on"})
simulation = faultsim.Simulation(scene)

# %% [markdown]
# The observation, made up by a run with an angle that the calibration does not know: the load step in which a fault
# first slides, with an error of one step either way.

# %%
TRUTH = 21.3 * deg
truth = simulation.run(friction_angle=TRUTH, fields=False)
slides = truth.history("activated") > 0
fault = int(slides.any(axis=0).argmax())
seen = int(slides[:, fault].argmax())
print(f"{truth.fault_names[fault]} slides first in load step {seen}, after {truth.times[seen] / year:.1f} years")

# %% [markdown]
# A first look at all angles, then a bisection on the exact model for the bounds of those that agree.

# %%


def first_step(angles: np.ndarray) -> np.ndarray:
    """The load step in which the fault slides first, for each angle; one beyond the last where it does not."""
    runs = simulation.run_many(angles[:, None], parameters=["friction_angle"], outputs=[], histories=["activated"])
    begun = runs.histories["activated"][:, :, fault] > 0
    return np.where(begun.any(axis=1), begun.argmax(axis=1), begun.shape[1])


angles = np.linspace(12, 35, 47) * deg
steps = first_step(angles)
agrees = np.abs(steps - seen) <= 1
print("load steps:", steps)
print(f"agree: {angles[agrees].min() / deg:.1f} to {angles[agrees].max() / deg:.1f} deg")

# %%


def bound(outside: float, inside: float) -> float:
    """Between an angle that does not agree and one that does, to 0.001 deg."""
    while abs(inside - outside) > 1e-3 * deg:
        middle = (outside + inside) / 2
        if abs(first_step(np.array([middle]))[0] - seen) <= 1:
            inside = middle
        else:
            outside = middle
    return inside


first, last = np.flatnonzero(agrees)[[0, -1]]
low = bound(angles[first - 1], angles[first]) if first > 0 else angles[first]
high = bound(angles[last + 1], angles[last]) if last + 1 < len(angles) else angles[last]
print(f"friction angle {low / deg:.3f} to {high / deg:.3f} deg; the truth is {TRUTH / deg:.1f}")
assert low <= TRUTH <= high

# %%
simulation.run(friction_angle=(low + high) / 2).plot("history")
