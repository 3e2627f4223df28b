"""Pictures of a scene with its strongest rays.

picture -> drawing (what is shown, in world coordinates) -> perspective, flat (the views) -> view_names; looks has what all views
share.
"""
from .picture import plot_scene

__all__ = ["plot_scene"]
