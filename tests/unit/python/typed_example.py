"""What mypy --strict reads."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import faultsim
from faultsim.units import MPa, deg, m


def share_that_slides(angles: npt.NDArray[np.float64]) -> float:
    scene = faultsim.Scene.field(tier="screening").set({"/numerics/plane_strain": "on"}, offset=120 * m)
    simulation = faultsim.Simulation(scene, cache=None)
    runs = simulation.run_many(angles[:, None], parameters=["friction_angle"], threads=2, progress=print)
    return float(runs["slides"].mean())


def traction_at(result: faultsim.Result, step: int) -> npt.NDArray[np.float64]:
    fields = result.fields
    if fields is None:
        raise ValueError("run with fields=True")
    one: npt.NDArray[np.float64] = fields.traction[step] / MPa
    return one


def problems_of(scene: faultsim.Scene) -> list[str]:
    try:
        scene.check()
    except faultsim.InputError as error:
        return [f"{one.pointer}: {one.what}; {one.cure}" for one in error.problems]
    return []


def lines(geometry: faultsim.Geometry) -> list[float]:
    return [line.length for fault in geometry.faults for line in fault.profiles]


if __name__ == "__main__":
    print(share_that_slides(np.linspace(15 * deg, 35 * deg, 100)))
