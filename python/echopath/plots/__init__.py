"""Pictures of scenes, rays and range-Doppler maps, as matplotlib figures without a window."""
from .maps import colour_limits, plot_overview, plot_partition, plot_range_doppler, power_dbm
from .scene_view import plot_scene
from .style import save_png

__all__ = ["colour_limits", "plot_overview", "plot_partition", "plot_range_doppler", "plot_scene", "power_dbm", "save_png"]
