"""Small scenes of the tests."""

import faultsim

PLANE = {"tier": "screening", "/numerics/plane_strain": "on"}


def plane_scene(**changes):
    """The starter field in plane strain: a case takes less than a millisecond."""
    return faultsim.Scene.field().set({**PLANE, **changes})


def bits(result):
    """All values of a result but times of the clock."""
    values = result if isinstance(result, dict) else result.to_dict()
    return without_clock(values)


def without_clock(value):
    if isinstance(value, dict):
        return {key: without_clock(one) for key, one in value.items() if key not in ("wall_s", "setup_s", "solve_s")}
    if isinstance(value, list):
        return [without_clock(one) for one in value]
    return value
