"""The materials that come with echopath, and how they change over frequency."""
from .library import MaterialLibrary, known_material, known_with, material_fields, materials
from .over_frequency import LIBRARY_FREQUENCY, is_near_library

__all__ = ["LIBRARY_FREQUENCY", "MaterialLibrary", "is_near_library", "known_material", "known_with", "material_fields",
           "materials"]
