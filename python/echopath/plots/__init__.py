"""Pictures of scenes, rays, maps, labels and detections with Matplotlib.

Functions named plot_* return a figure without a window, which `show` gives one and `save_png` writes; those named draw_* draw in
given axes, or in new ones of pyplot, and return the axes: they are what the methods `plot` of the results call.
"""
from .angles import draw_angle_spectrum
from .antennas import draw_array, draw_pattern
from .drive import Drive, Driving, film_pictures, plot_drive
from .frames import draw_frame
from .labels import draw_labels, plot_ghosts, plot_labels
from .maps import (
    colour_limits,
    draw_range_doppler,
    part_title,
    plot_overview,
    plot_partition,
    plot_range_doppler,
    power_dbm,
)
from .part_powers import plot_part_powers
from .points import draw_detections
from .scene_view import plot_scene
from .style import save_png, show
from .time_maps import draw_spectrogram_labels, draw_time_map
from .top_view import draw_range_azimuth, plot_range_azimuth
from .tracks import draw_tracks
from .truth import draw_truth

__all__ = ["Drive", "Driving", "colour_limits", "draw_angle_spectrum", "draw_array", "draw_detections", "draw_frame",
           "draw_labels", "draw_pattern", "draw_range_azimuth", "draw_range_doppler", "draw_spectrogram_labels", "draw_time_map",
           "draw_tracks", "draw_truth", "part_title", "plot_ghosts", "plot_labels", "plot_overview", "plot_part_powers",
           "plot_partition", "plot_range_azimuth", "plot_range_doppler", "plot_scene", "power_dbm", "save_png", "show"]


def __dir__() -> list[str]:
    """What users need, as completion at a prompt shows it; the modules behind it are there, but do not show."""
    return __all__
