"""What the frame knows beside its signals, over the maps and in the scene."""
from __future__ import annotations

import numpy as np

from .maps.cell_index import CellBox
from .maps.ghost_twins import ghost_twins, twin_rows
from .maps.layers import (
    DETECTIONS,
    LABELS,
    LAYERS,
    NAMES,
    OBJECTS,
    TRUTH,
    TWINS,
    detection_markers,
    label_image,
    label_markers,
    truth_markers,
)
from .palette import objects_of


class SessionLayers:
    """Part of Session: layers are made when they are first shown."""

    def set_layer(self, layer: str, is_shown: bool, progress=None) -> None:
        """Shows or hides a layer, a name of LAYERS; what it shows is made the first time.

        Raises ValueError for another name, and where the frame does not know that.
        """
        if layer not in LAYERS:
            raise ValueError(f"layer: must be one of {', '.join(LAYERS)}, got {layer!r}")
        if is_shown:
            self._make_known(layer, progress)
        self.layers = self.layers | {layer} if is_shown else self.layers - {layer}
        self._tell("layers")

    def _make_known(self, layer: str, progress) -> None:
        name = LABELS if layer == OBJECTS else layer
        if name in self._known_data or name == NAMES:
            return
        if name == TWINS:
            self._known_data[TWINS] = ghost_twins(self.paths, self.columns, self.told_objects())
            return
        if self.known is None:
            raise ValueError(f"{layer}: only frames have them, not paths alone or live views")
        self._known_data[name] = getattr(self.known, name)(progress)

    def known_data(self, layer: str):
        """What a layer shows: ep.Labels of the partition on display, ep.Detections, ep.Truth or twins."""
        if layer not in (LABELS, OBJECTS):
            return self._known_data[layer]
        labels = self._known_data[LABELS]
        return labels.get(self.partition, next(iter(labels.values())))

    def told_objects(self):
        """What of the scene is an object, as `ep.families` takes it; None: each child of the root."""
        return None if self.known is None else self.known.objects()

    def object_colours(self) -> dict:
        """{object: rgb}, the mean of the shades of its meshes."""
        names, object_of_mesh = objects_of(self.scene)
        return {name: tuple(int(value) for value in self.palette[object_of_mesh == number].mean(axis=0))
                for number, name in enumerate(names)}

    def map_layers(self) -> tuple:
        """(RGBA image u8 [V, R, 4] or None, legend rows, markers) over the maps, by the layers that are shown."""
        image, rows, markers, spectrum = None, (), [], self.parts.whole.spectrum
        for layer in LAYERS[:2]:  # objects and ghosts hide the parts below
            if layer in self.layers:
                image, rows = label_image(self.known_data(layer), layer)
        if OBJECTS in self.layers:
            markers += label_markers(self.known_data(OBJECTS))
        if TRUTH in self.layers:
            markers += truth_markers(self.known_data(TRUTH), spectrum)
        if DETECTIONS in self.layers:
            markers += detection_markers(self.known_data(DETECTIONS), spectrum, self.object_colours())
        if TWINS in self.layers:
            rows += tuple(row for row in twin_rows(self.known_data(TWINS)) if row not in rows)
        return image, rows, markers

    def select_detection(self, index: int, reach: int = 0) -> None:
        """Selects the cell of a detection; where its paths are known, those are lit, else all within `reach` cells."""
        detections = self.known_data(DETECTIONS)
        velocity, distance = (int(value) for value in detections.cells[index])
        self.select_cells(CellBox.around(distance, velocity, reach), (distance, velocity))
        if detections.echoes is not None and not detections.is_noise[index]:
            self._light(f"detection {index}", np.isin(np.arange(self.paths.num_paths), detections.paths(index)[0]))
