"""Readers of foreign scenes: each makes a Model of a file, which Scene.add takes as it takes a mesh or an actor."""
from .load import load_model
from .material_names import ForeignMaterials, foreign_materials
from .model import Model, ModelNode

__all__ = ["Model", "ModelNode", "foreign_materials", "load_model"]
