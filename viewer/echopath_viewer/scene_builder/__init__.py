"""Fills any pyvista.Plotter (a window's, an off-screen or a notebook's one) with scene, antennas and rays."""
from .without_pyplot import import_pyvista

import_pyvista()

from .blocks import blocks_of
from .builder import SceneBuilder
from .camera import VIEWS, look
from .export import export_meshes, export_rays

__all__ = ["SceneBuilder", "VIEWS", "blocks_of", "export_meshes", "export_rays", "look"]
