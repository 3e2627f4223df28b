"""What lies under a pixel of the 3-D view."""
from __future__ import annotations

import numpy as np
from vtkmodules.vtkRenderingCore import vtkCellPicker

from ...model.rays.picking import nearest_segment

CLICK_REACH = 5.0  # pixels: a click moves no farther, and a ray that close is meant


class Picks:
    """Part of View3D. Pixels are those of Qt, from the upper left."""

    def clip_from_world(self):
        """[4, 4] of the camera with its perspective."""
        matrix = self.camera.GetCompositeProjectionTransformMatrix(self.width() / max(self.height(), 1), -1.0, 1.0)
        return np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])

    def ray_at(self, x: float, y: float) -> int | None:
        """The path whose ray is drawn at a pixel, None where there is none."""
        for layer in self.builder.drawn_layers():
            segments = layer.segments
            row = nearest_segment(segments.points, segments.ends, self.clip_from_world(), (self.width(), self.height()),
                                  (x, y), CLICK_REACH)
            if row is not None:
                return int(segments.rays[segments.ray[row]])
        return None

    def mesh_at(self, x: float, y: float, with_mirrors: bool) -> int | None:
        """The mesh drawn at a pixel; bodies come before mirrors, which are large and see-through."""
        is_mirror = [mesh.material.mirror for mesh in self.builder.session.scene.meshes]
        with self.builder.meshes.each() as actors:
            for mirrors in (False, True)[:1 + with_mirrors]:
                picker = vtkCellPicker()
                picker.PickFromListOn()
                for mesh, actor in enumerate(actors):
                    if is_mirror[mesh] == mirrors and actor.GetVisibility():
                        picker.AddPickList(actor)
                scale = self.devicePixelRatioF()
                if picker.Pick(x * scale, (self.height() - 1 - y) * scale, 0.0, self.renderer):
                    return next(mesh for mesh, actor in enumerate(actors) if actor is picker.GetActor())
        return None

    def world_at(self, x: float, y: float, height: float):
        """[3] m of a pixel on the horizontal plane at a height in m; None where that lies behind the camera."""
        across, up = 2.0 * x / self.width() - 1.0, 1.0 - 2.0 * y / self.height()
        world = np.linalg.inv(self.clip_from_world())
        near, far = (world @ (across, up, depth, 1.0) for depth in (-1.0, 1.0))
        near, far = near[:3] / near[3], far[:3] / far[3]
        share = (height - near[2]) / (far[2] - near[2]) if far[2] != near[2] else -1.0
        return near + share * (far - near) if 0.0 < share <= 1.0 else None
