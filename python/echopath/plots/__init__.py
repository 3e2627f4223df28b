"""Pictures of scenes, rays, range-Doppler and range-azimuth maps, as matplotlib figures without a window."""
from .labels import plot_ghosts, plot_labels, plot_part_powers
from .maps import colour_limits, part_title, plot_overview, plot_partition, plot_range_doppler, power_dbm
from .scene_view import plot_scene
from .style import save_png
from .top_view import plot_range_azimuth

__all__ = ["colour_limits", "part_title", "plot_ghosts", "plot_labels", "plot_overview", "plot_part_powers",
           "plot_partition",
           "plot_range_azimuth", "plot_range_doppler", "plot_scene", "power_dbm", "save_png"]
