"""What a frame knows beside its signals: labels of cells, objects and ghosts, detections, and what is true."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping

import numpy as np

from echopath.base.text.colours import colours_of
from echopath.labels.ghost_names import ghost_name
from echopath.plots.labels import CLASSES
from echopath.signals.measures import for_pictures

from ..palette import rgb_of

LAYERS = ("labels", "objects and ghosts", "detections", "truth", "ghost twins", "names")
LABELS, OBJECTS, DETECTIONS, TRUTH, TWINS, NAMES = LAYERS
OPACITY = 140             # of 255, of cells that have a label
NOISE_RGB, BACKGROUND_RGB = (150, 150, 150), (240, 240, 240)  # of detections that no object made
MAX_NAMED_GHOSTS = 8


@dataclasses.dataclass(frozen=True)
class Known:
    """How to come by what a frame knows; each is called once, when its layer is first shown, with a progress callable.

    labels: -> {group of a partition (group_of): ep.Labels}; detections: -> ep.Detections; truth: -> ep.Truth
    objects: without an argument, -> what of the scene is an object, as `ep.families` takes it
    """

    labels: Callable
    detections: Callable
    truth: Callable
    objects: Callable = lambda: None


@dataclasses.dataclass(frozen=True)
class Marker:
    """A place in a range-Doppler map: kind "object", "ghost", "detection" or "truth"; range in m, velocity in m/s.

    is_filled: a disc rather than a ring; detection: its index, None: it is none
    """

    kind: str
    range: float
    velocity: float
    text: str
    rgb: tuple
    is_filled: bool = False
    detection: int | None = None


def are_of_map(labels: Mapping) -> bool:
    """Whether {partition: ep.Labels} are of the range-Doppler map, over which they are shown."""
    return all(one.plane == "range_doppler" for one in labels.values())


def label_image(labels, layer: str) -> tuple:
    """(RGBA u8 [V, R, 4] of the cells, transparent where they have no label; legend rows ((name, rgb), ...)).

    labels: ep.Labels of a range-Doppler map; layer: LABELS, by the part that dominates, or OBJECTS, by class
    """
    if layer == LABELS:
        areas = [(name, rgb, labels.dominant == index)
                 for index, (name, rgb) in enumerate(zip(labels.part_names, colours_of(list(labels.part_names))))]
    else:
        types = np.array([*(ghost.ghost_type for ghost in labels.ghosts), 0])[labels.ghost_map]
        areas = [(CLASSES["real"][0], rgb_of(CLASSES["real"][1]), labels.object_map >= 0)]
        areas += [(CLASSES[kind][0], rgb_of(CLASSES[kind][1]), types == kind) for kind in (1, 2)]
    image = np.zeros((*labels.dominant.shape, 4), np.uint8)
    for _, rgb, is_inside in areas:
        image[is_inside] = (*rgb, OPACITY)
    return image, tuple((name, tuple(rgb)) for name, rgb, is_inside in areas if is_inside.any())


def label_markers(labels) -> list[Marker]:
    """Objects and the strongest ghosts at their highest cells."""
    found = [Marker("object", *label.peak[:2], label.name, rgb_of(CLASSES["real"][1]), True)
             for label in labels.objects if label.peak is not None]
    ghosts = sorted((ghost for ghost in labels.ghosts if ghost.peak is not None), key=lambda ghost: -ghost.power)
    return found + [Marker("ghost", *ghost.peak[:2], ghost_name(ghost), rgb_of(CLASSES[ghost.ghost_type][1]))
                    for ghost in ghosts[:MAX_NAMED_GHOSTS]]


def detection_markers(detections, spectrum, object_rgb: Mapping) -> list[Marker]:
    """A disc for each real echo, a ring for each ghost, at the cells where the map shows them; object_rgb: {object: rgb}."""
    markers = []
    for index, (velocity, distance) in enumerate(np.asarray(detections.cells)):
        name, ghost_type = str(detections.object[index]), int(detections.ghost_type[index])
        what = "noise" if detections.is_noise[index] else name or "surroundings"
        kind = f", ghost of type {ghost_type}, order {int(detections.order[index])}" if ghost_type else ""
        markers.append(Marker("detection", float(spectrum.range[distance]), float(spectrum.velocity[velocity]),
                              f"detection {index}: {what}{kind}, {detections.snr_db[index]:.0f} dB over the noise",
                              detection_rgb(detections, index, object_rgb), not ghost_type, index))
    return markers


def detection_rgb(detections, index: int, object_rgb: Mapping) -> tuple:
    """Of the object that made it."""
    if detections.is_noise[index]:
        return NOISE_RGB
    return tuple(object_rgb.get(str(detections.object[index]), BACKGROUND_RGB))


def truth_markers(truth, spectrum) -> list[Marker]:
    """A ring for each object at the range and radial velocity of the centre of its box; what is too fast for the velocities of
    the map (spectrum: for its axes) is where its echo is: turns of the phase from chirp to chirp are not told apart."""
    folded = _folded(truth.radial_velocity, np.asarray(spectrum.velocity))
    return [Marker("truth", float(distance), float(seen), f"{name}: true centre" + _true_speed(velocity, seen), (255, 255, 255))
            for name, distance, velocity, seen in zip(truth.name, truth.range, truth.radial_velocity, folded)]


def _folded(velocities, axis):
    """Velocities in m/s within the cells of an axis [V], by whole lengths of it; a single cell holds them all."""
    if len(axis) < 2:
        return np.full(len(velocities), axis[0])
    step = axis[1] - axis[0]
    span, lowest = step * len(axis), axis[0] - 0.5 * step
    return np.asarray(velocities) - span * np.floor((np.asarray(velocities) - lowest) / span)


def _true_speed(velocity: float, seen: float) -> str:
    return "" if velocity == seen else for_pictures(f", {velocity:+z.1f} m/s, beyond the velocities of the map")


# Of ep.Truth.corners, whose corners that differ in one axis are neighbours in its bit.
BOX_EDGES = np.array([(corner, corner | 1 << axis) for axis in range(3) for corner in range(8) if not corner >> axis & 1])
