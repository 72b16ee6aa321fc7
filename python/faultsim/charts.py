"""Charts: the project's own, as SVG."""

from __future__ import annotations

import os
from pathlib import Path


class Chart:
    """A chart. A notebook shows it; ``svg`` is its text, ``save`` writes it to a file."""

    def __init__(self, svg: str) -> None:
        self.svg: str = svg  #: an SVG document.

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the SVG to a file, which is replaced."""
        Path(file).write_text(self.svg, encoding="utf-8")
