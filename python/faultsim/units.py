"""Units: numbers in SI, to be multiplied with. ``25 * deg`` is an angle, ``120 * m`` a length.

Every number that goes into faultsim or comes out of it is in SI: m, Pa, s, rad, K.
"""

from __future__ import annotations

import math
from typing import Final

#: Lengths, m.
m: Final = 1.0
mm: Final = 1e-3
cm: Final = 1e-2
km: Final = 1e3
#: Angles, rad.
rad: Final = 1.0
deg: Final = math.pi / 180
#: Pressures and moduli, Pa.
Pa: Final = 1.0
kPa: Final = 1e3
MPa: Final = 1e6
GPa: Final = 1e9
bar: Final = 1e5
#: Times, s; a year has 365.25 days.
s: Final = 1.0
hour: Final = 3600.0
day: Final = 86400.0
year: Final = 365.25 * 86400.0
#: Differences of temperature, K.
K: Final = 1.0
#: Densities, kg/m3.
kg_per_m3: Final = 1.0

__all__ = [
    "GPa", "K", "MPa", "Pa", "bar", "cm", "day", "deg", "hour", "kPa", "kg_per_m3", "km", "m", "mm", "rad", "s", "year",
]
