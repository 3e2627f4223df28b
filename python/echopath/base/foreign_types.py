"""Types of libraries that only some calls need, for annotations: nothing of them is imported when the program runs."""
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes
    from matplotlib.colors import Colormap as Colormap
    from pandas import DataFrame as DataFrame  # type: ignore[import-untyped,import-not-found,unused-ignore]
    from pyvista import Plotter as Plotter  # type: ignore[import-not-found,unused-ignore]
    from PySide6.QtWidgets import QMainWindow as QMainWindow  # type: ignore[import-not-found,unused-ignore]
    from xarray import DataArray as DataArray  # type: ignore[import-not-found,unused-ignore]
    from xarray import Dataset as Dataset  # type: ignore[import-not-found,unused-ignore]
