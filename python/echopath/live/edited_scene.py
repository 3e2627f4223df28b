"""The scene of a live scene, of which each edit is a change."""
from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

from .. import _core
from ..base.classes.known_attributes import known_attributes
from ..scene.scene import Scene
from .changes import Changes


@known_attributes
class EditedScene(Scene):
    """A Scene whose edits are made one at a time and are counted; copies of it, and what is pickled, are plain Scenes."""

    def __init__(self, scene: _core.Scene, changes: Changes):
        self._changes = None  # what it is made of is no edit
        super().__init__(scene)
        self._changes = changes

    def _edit(self) -> AbstractContextManager:
        return nullcontext() if self._changes is None else self._changes.one()

    def __setattr__(self, name: str, value) -> None:
        if name.startswith("_"):
            return super().__setattr__(name, value)
        with self._edit():  # weather, interferers
            super().__setattr__(name, value)

    def __copy__(self) -> Scene:
        return Scene(self)

    def __deepcopy__(self, memo) -> Scene:
        return Scene(self)

    def __reduce_ex__(self, protocol):
        return _scene_of, (Scene(self).__getstate__(),)


def _scene_of(state) -> Scene:
    scene = Scene.__new__(Scene)
    scene.__setstate__(state)
    return scene
