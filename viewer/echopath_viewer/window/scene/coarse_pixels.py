"""Pictures of fewer pixels than the screen has."""
from __future__ import annotations

from contextlib import contextmanager


@contextmanager
def coarse_pixels(render_window, times: int):
    """What VTK draws meanwhile has pixels `times` as wide as the screen's: pyvistaqt stretches it over the widget."""
    if times == 1:
        yield
        return
    size, dpi = render_window.GetSize(), render_window.GetDPI()
    render_window.SetSize(*(max(length // times, 1) for length in size))
    render_window.SetDPI(max(dpi // times, 1))  # names keep their size
    try:
        yield
    finally:
        render_window.SetSize(*size)
        render_window.SetDPI(dpi)
