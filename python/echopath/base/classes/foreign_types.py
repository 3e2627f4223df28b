"""Types of libraries that only some calls need, for annotations: nothing of them is imported when the program runs."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes
    from matplotlib.colors import Colormap as Colormap
    from matplotlib.figure import Figure as Figure, SubFigure as SubFigure
    from pandas import DataFrame as DataFrame  # type: ignore[import-untyped,import-not-found,unused-ignore]
    from PySide6.QtWidgets import QMainWindow as QMainWindow  # type: ignore[import-not-found,unused-ignore]
    from pyvista import Plotter as Plotter  # type: ignore[import-not-found,unused-ignore]
    from xarray import (
        DataArray as DataArray,  # type: ignore[import-not-found,unused-ignore]
        Dataset as Dataset,  # type: ignore[import-not-found,unused-ignore]
    )


class Page(Protocol):
    """A web page that a notebook shows: what `Frame.show` returns."""

    def html(self, whole: bool = True) -> str:
        """Its text; whole: with a head, as a file has it."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it to a file."""

    def _repr_html_(self) -> str: ...
