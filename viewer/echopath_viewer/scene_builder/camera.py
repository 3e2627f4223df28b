"""Where the scene is looked at from."""
from __future__ import annotations

import numpy as np

VIEWS = ("radar", "top", "side", "fit")
OBLIQUE = np.array([-0.62, -0.60, 0.50])  # from behind, right and above the radar, which looks along +x
MARGIN, NUM_CENTRINGS = 1.06, 4
USUAL_ANGLE, WIDE_ANGLE = 30.0, 50.0      # degrees, of view
BACK, ABOVE = 0.06, 0.014                 # of the scene's size behind and above the antenna, which is then in the picture


def look(plotter, view: str, corners, world_from_antenna) -> None:
    """Turns the camera.

    view: "radar" (over the antenna's shoulder, along its boresight), "top" (down, x to the right), "side" (along +y, x to
        the right) or "fit" (oblique)
    corners: [N, 3] m, what must be in the picture; world_from_antenna: [4, 4].
    """
    if view not in VIEWS:
        raise ValueError(f"view: must be one of {', '.join(VIEWS)}, got {view!r}")
    corners = np.asarray(corners)
    low, high = corners.min(axis=0), corners.max(axis=0)
    if view == "radar":
        _look_from_antenna(plotter.camera, low, high, np.asarray(world_from_antenna))
        plotter.reset_camera_clipping_range()
        return
    direction, up = {"top": ((0, 0, 1), (0, 1, 0)), "side": ((0, -1, 0), (0, 0, 1)), "fit": (OBLIQUE, (0, 0, 1))}[view]
    _look_at_box(plotter.camera, low, high, np.asarray(direction, float), np.asarray(up, float), aspect_of(plotter))
    plotter.reset_camera_clipping_range()


def aspect_of(plotter) -> float:
    """Width over height of the picture."""
    width, height = plotter.window_size
    return width / max(height, 1)


def _look_at_box(camera, low, high, direction, up, aspect: float) -> None:
    """As near as the box fits; direction: from it to the eye."""
    ahead = -direction / np.linalg.norm(direction)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    upward = np.cross(right, ahead)
    corners = np.stack(np.meshgrid(*np.stack([low, high], axis=1)), axis=-1).reshape(-1, 3)
    slope = np.array([aspect, 1.0]) * np.tan(0.5 * np.radians(USUAL_ANGLE)) / MARGIN
    centre = 0.5 * (low + high)
    for _ in range(NUM_CENTRINGS):
        local = (corners - centre) @ np.stack([right, upward, ahead], axis=1)
        distance = float((np.abs(local[:, :2]) / slope - local[:, 2:]).max())
        seen = local[:, :2] / (distance + local[:, 2:])
        middle = 0.5 * (seen.min(axis=0) + seen.max(axis=0)) * distance
        centre = centre + middle[0] * right + middle[1] * upward
    camera.view_angle = USUAL_ANGLE
    camera.focal_point, camera.up = centre, upward
    camera.position = centre - distance * ahead


def _look_from_antenna(camera, low, high, world_from_antenna) -> None:
    ahead, _, up, origin = world_from_antenna[:3].T
    size = float(np.linalg.norm(high - low))
    depth = max(float((0.5 * (low + high) - origin) @ ahead), 0.1 * size)
    camera.position = origin - BACK * size * ahead + ABOVE * size * up
    camera.focal_point = origin + depth * ahead
    camera.up = up
    camera.view_angle = WIDE_ANGLE
