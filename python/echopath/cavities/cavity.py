"""A hollow in metal: its walls and its mouth."""
from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..arguments.checks import array, refused

FLAT = 1e-6  # of the mouth's extent, how far a corner may lie beside its plane

_CORNERS = array("[N, 3]", finite=True)


@dataclasses.dataclass(frozen=True)
class Cavity:
    """A hollow in metal that opens at a mouth: `rcs` computes its inside by waves in place of rays.

    walls: full name of a mesh, or of a node above meshes, or several names: all meshes that line the hollow, and no others.
        With the mouth they must close it
    mouth: [N, 3], m, in the world at time 0: three or more corners of a flat convex polygon, in their order; kept as tuples
    Raises TypeError or ValueError naming the field.
    """

    walls: str | tuple[str, ...]
    mouth: ArrayLike

    def __post_init__(self):
        names = (self.walls,) if isinstance(self.walls, str) else self.walls
        if not isinstance(names, (list, tuple)) or not names or not all(isinstance(name, str) for name in names):
            raise refused(TypeError, "walls", "a name of the scene or several", self.walls)
        corners = np.asarray(_CORNERS("mouth", self.mouth), float)
        if not _is_convex(corners):
            raise refused(ValueError, "mouth", "the corners of a flat convex polygon in their order", self.mouth)
        object.__setattr__(self, "walls", tuple(names))
        object.__setattr__(self, "mouth", tuple(tuple(map(float, corner)) for corner in corners))

    def meshes_in(self, scene: _core.Scene) -> list[_core.SceneMesh]:
        """Its walls in a scene, a list of SceneMesh. Raises KeyError naming what the scene does not have."""
        names = [scene[name].name for name in self.walls]
        return [mesh for mesh in scene.meshes if any(f"{mesh.name}/".startswith(f"{name}/") for name in names)]

    @property
    def triangles_of_mouth(self) -> np.ndarray:
        """Corners [T, 3, 3] in m of triangles that make up the mouth, without those of corners that lie on one side."""
        corners = np.array(self.mouth)
        fan = np.array([corners[[0, i, i + 1]] for i in range(1, len(corners) - 1)])
        sizes = np.linalg.norm(np.cross(fan[:, 1] - fan[:, 0], fan[:, 2] - fan[:, 0]), axis=1)
        return fan[sizes > FLAT * sizes.sum()]


def _is_convex(corners) -> bool:
    """Whether points [N, 3] are the corners of a flat convex polygon in their order."""
    if len(corners) < 3:
        return False
    sides = np.roll(corners, -1, axis=0) - corners
    turns = np.cross(sides, np.roll(sides, -1, axis=0))
    normal = turns.sum(axis=0)
    size = np.linalg.norm(normal)
    if not size > 0.0:
        return False
    heights = (corners - corners.mean(axis=0)) @ (normal / size)
    return bool(np.all(turns @ normal >= -FLAT * size ** 2) and np.abs(heights).max() <= FLAT * np.ptp(corners, axis=0).max())
