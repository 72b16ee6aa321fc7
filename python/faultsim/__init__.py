"""faultsim: quasi-static reactivation of faults in a linear elastic rock.

    import faultsim
    from faultsim.units import deg, m

    scene = faultsim.Scene.field(tier="screening").set(offset=120 * m, friction_angle=25 * deg)
    simulation = faultsim.Simulation(scene)
    result = simulation.run()                                       # builds the operator, then runs
    result.whole.chi_bar, result.fields.traction                    # values of result.json, arrays
    runs = simulation.run_many(angles[:, None], parameters=["friction_angle"], threads=2)
    runs["slides"].mean()

Scene is what is modelled, Simulation holds one and runs it, Result and Runs are what became of a case and of many;
Campaign reads a store of faultsweep. What is wrong is an InputError, with all problems.

All numbers are in SI (faultsim.units); the equations stand in docs/model.md, the words in docs/words.md.
"""

from __future__ import annotations

import os as _os

# OpenBLAS starts a thread per core as it is loaded, and ours computes with one. Only while it is loaded, so that
# numpy's is as the user wants it.
_threads = _os.environ.get("OPENBLAS_NUM_THREADS")
_os.environ["OPENBLAS_NUM_THREADS"] = "1"
try:
    from . import _core
finally:
    if _threads is None:
        del _os.environ["OPENBLAS_NUM_THREADS"]
    else:
        _os.environ["OPENBLAS_NUM_THREADS"] = _threads

from . import units
from ._core import Fault, Fields, Geometry, Influence, Operator, Profile
from .campaign import Answer, Campaign, Case, Setting, Table, campaigns, metrics
from .charts import Chart
from .errors import Error, InputError, InternalError, Interrupted, Problem, ResourceError, StorageError
from .records import Record
from .result import Result
from .runs import Runs
from .scene import Parameter, Plan, Scene
from .simulation import Simulation

__version__ = _core.version


def outputs() -> list[str]:
    """What ``Simulation.run_many`` can be asked for of a whole case; of faults and stages likewise."""
    return _core.output_names()


def charts() -> dict[str, str]:
    """The charts of ``Result.plot``, and what they show."""
    return dict(_core.charts())


def environment() -> dict[str, str]:
    """What results may depend on: the linear algebra and its kernel, and the version of the numerics."""
    return {
        "version": __version__,
        "numerics_version": str(_core.numerics_version),
        "blas": _core.blas(),
        "blas_kernel_reason": _core.blas_reason(),
    }


__all__ = [
    "Answer", "Campaign", "Case", "Chart", "Error", "Fault", "Fields", "Geometry", "Influence", "InputError",
    "InternalError", "Interrupted", "Operator", "Parameter", "Plan", "Problem", "Profile", "Record", "ResourceError",
    "Result", "Runs", "Scene", "Setting", "Simulation", "StorageError", "Table", "campaigns", "charts", "environment",
    "metrics", "outputs", "units",
]
