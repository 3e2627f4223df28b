"""Foreign scenes as the content of a Scene."""
from __future__ import annotations

from pathlib import Path

from ..base.text.node_names import fit_name
from ..readers import load_model
from ..readers.options import ReadOptions
from ..scene.scene import Scene


def foreign_scene(path: Path, options: ReadOptions) -> Scene:
    """A Scene with the content of a foreign file below one object, named after the file."""
    scene = Scene()
    scene.add(load_model(path, **vars(options)), name=fit_name(path.stem, "model"))
    return scene
