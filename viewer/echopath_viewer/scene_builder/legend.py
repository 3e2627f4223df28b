"""What the colours of rays mean, drawn into the picture."""
from __future__ import annotations

import pyvista as pv
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingAnnotation import vtkLegendBoxActor, vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkTextActor

from .polydata import set_point_colours

ROW_HEIGHT, LETTER_WIDTH = 16.0, 7.8  # pixels
SCALE_SIZE, EDGE = (300.0, 46.0), 26.0
TITLE_SIZE = 14  # points
TEXT_COLOUR = (0.0, 0.0, 0.0)
PAPER, PAPER_OPACITY = (1.0, 1.0, 1.0), 0.75


class LegendLayer:
    """Rows of labels or a scale in the lower right corner; made once, as pyvista's own take 50 ms each time."""

    def __init__(self, plotter):
        self._plotter, self._legend = plotter, None
        self._rows, self._scale, self._title = _new_rows(), _new_scale(), _new_title()
        plotter.add_actor(self._rows, name="legend rows", reset_camera=False, pickable=False, render=False)
        plotter.add_actor(self._scale, name="legend scale", reset_camera=False, pickable=False, render=False)
        plotter.add_actor(self._title, name="legend title", reset_camera=False, pickable=False, render=False)

    def show(self, legend) -> None:
        """legend: model.Legend."""
        if legend != self._legend:
            self._legend = legend
            self.place()

    def place(self) -> None:
        """In its usual size, whatever size the picture has."""
        legend = self._legend
        self._scale.SetVisibility(legend is not None and legend.clim is not None)
        self._title.SetVisibility(legend is not None and legend.clim is not None)
        self._rows.SetVisibility(legend is not None and bool(legend.rows))
        if legend is not None and legend.clim is not None:
            self._place_scale(legend)
        elif legend is not None and legend.rows:
            self._place_rows(legend)

    def _place_rows(self, legend) -> None:
        """Black text beside squares of the colour: pale letters would not be read."""
        texts = [legend.title, *legend.texts()]
        rows = self._rows
        rows.SetNumberOfEntries(len(texts))
        for number, text in enumerate(texts):
            has_colour = 0 < number <= len(legend.rows)
            rows.SetEntry(number, _square(legend.rows[number - 1][1]) if has_colour else vtkPlaneSource().GetOutput(), text,
                          TEXT_COLOUR)
        self._put(rows, 30.0 + LETTER_WIDTH * max(map(len, texts)), ROW_HEIGHT * len(texts))

    def _place_scale(self, legend) -> None:
        table = pv.LookupTable(cmap=legend.cmap, scalar_range=legend.clim, n_values=256)
        self._scale.SetLookupTable(table)
        self._put(self._scale, *SCALE_SIZE)
        self._title.SetInput(legend.title)
        corner = self._scale.GetPositionCoordinate().GetValue()
        picture_width, picture_height = (max(size, 1) for size in self._plotter.window_size)
        self._title.SetPosition(corner[0] * picture_width, corner[1] * picture_height + SCALE_SIZE[1] + 4.0)

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


def _square(rgb):
    """A square that has its colour itself, so that the text beside it need not have it."""
    square = vtkPlaneSource()
    square.Update()
    poly = pv.wrap(square.GetOutput())
    set_point_colours(poly, [rgb] * poly.n_points)
    return poly


def _new_scale() -> vtkScalarBarActor:
    """Without a title: VTK puts it over the labels where the bar is low."""
    scale = vtkScalarBarActor()
    scale.SetOrientationToHorizontal()
    scale.SetNumberOfLabels(5)
    scale.SetLabelFormat("%.3g")
    scale.UnconstrainedFontSizeOn()
    _set_text(scale.GetLabelTextProperty(), 12)
    return scale


def _new_title() -> vtkTextActor:
    title = vtkTextActor()
    _set_text(title.GetTextProperty(), TITLE_SIZE)
    return title


def _set_text(text, size: int) -> None:
    text.SetColor(TEXT_COLOUR)
    text.SetFontSize(size)
    text.ItalicOff()
    text.BoldOff()
    text.ShadowOff()
