"""Scene files: TOML read against a schema, faults told by their place (keys: data/README.md)."""
from .load import SceneFile, load_scene

__all__ = ["SceneFile", "load_scene"]
