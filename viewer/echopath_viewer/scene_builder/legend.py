"""What the colours of rays mean, drawn into the picture."""
from __future__ import annotations

import pyvista as pv
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingAnnotation import vtkLegendBoxActor, vtkScalarBarActor

ROW_HEIGHT, LETTER_WIDTH = 16.0, 7.8  # pixels
SCALE_SIZE, EDGE = (300.0, 64.0), 26.0
TITLE_GAP = 6  # pixels
TEXT_COLOUR = (0.0, 0.0, 0.0)
PAPER, PAPER_OPACITY = (1.0, 1.0, 1.0), 0.75


class LegendLayer:
    """Rows of labels or a scale in the lower right corner; made once, as pyvista's own take 50 ms each time."""

    def __init__(self, plotter):
        self._plotter, self._legend = plotter, None
        self._rows, self._scale = _new_rows(), _new_scale()
        plotter.add_actor(self._rows, name="legend rows", reset_camera=False, pickable=False, render=False)
        plotter.add_actor(self._scale, name="legend scale", reset_camera=False, pickable=False, render=False)

    def show(self, legend) -> None:
        """legend: model.Legend."""
        if legend != self._legend:
            self._legend = legend
            self.place()

    def place(self) -> None:
        """In its usual size, whatever size the picture has."""
        legend = self._legend
        self._scale.SetVisibility(legend is not None and legend.clim is not None)
        self._rows.SetVisibility(legend is not None and bool(legend.rows))
        if legend is not None and legend.clim is not None:
            self._place_scale(legend)
        elif legend is not None and legend.rows:
            self._place_rows(legend)

    def _place_rows(self, legend) -> None:
        rows, square = self._rows, vtkPlaneSource()
        square.Update()
        rows.SetNumberOfEntries(len(legend.rows) + 1)
        rows.SetEntry(0, vtkPlaneSource().GetOutput(), legend.title, TEXT_COLOUR)
        for number, (label, rgb) in enumerate(legend.rows):
            rows.SetEntry(number + 1, square.GetOutput(), label, [value / 255.0 for value in rgb])
        longest = max(len(text) for text in [legend.title, *(label for label, _ in legend.rows)])
        self._put(rows, 30.0 + LETTER_WIDTH * longest, ROW_HEIGHT * (len(legend.rows) + 1))

    def _place_scale(self, legend) -> None:
        table = pv.LookupTable(cmap=legend.cmap, scalar_range=legend.clim, n_values=256)
        self._scale.SetLookupTable(table)
        self._scale.SetTitle(legend.title)
        self._put(self._scale, *SCALE_SIZE)

    def _put(self, actor, width: float, height: float) -> None:
        """A box of that size in pixels, at most half of the picture, into the corner."""
        picture_width, picture_height = (max(size, 1) for size in self._plotter.window_size)
        width, height = min(0.5, width / picture_width), min(0.5, height / picture_height)
        actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        actor.GetPosition2Coordinate().SetCoordinateSystemToNormalizedViewport()
        actor.SetPosition(1.0 - width - EDGE / picture_width, EDGE / picture_height)
        actor.SetPosition2(width, height)


def _new_rows() -> vtkLegendBoxActor:
    rows = vtkLegendBoxActor()
    rows.UseBackgroundOn()
    rows.SetBackgroundColor(PAPER)
    rows.SetBackgroundOpacity(PAPER_OPACITY)
    rows.BorderOff()
    return rows


def _new_scale() -> vtkScalarBarActor:
    scale = vtkScalarBarActor()
    scale.SetOrientationToHorizontal()
    scale.SetNumberOfLabels(5)
    scale.SetLabelFormat("%.3g")
    scale.UnconstrainedFontSizeOn()
    scale.SetVerticalTitleSeparation(TITLE_GAP)
    for text, size in ((scale.GetTitleTextProperty(), 14), (scale.GetLabelTextProperty(), 12)):
        text.SetColor(TEXT_COLOUR)
        text.SetFontSize(size)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    return scale
