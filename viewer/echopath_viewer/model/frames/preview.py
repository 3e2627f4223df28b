"""What a large frame file shows before all of it is read: its scene and its map."""
from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from echopath.frame_file.container import our_file
from echopath.frame_file.frame import without_lists
from echopath.frame_file.h5 import read_array, read_attribute, read_group
from echopath.frame_file.radar import read_radar
from echopath.frame_file.scene import read_scene

from ..maps.part_set import PartSet
from ..maps.signals import Signals
from .inputs import ViewInput, whole_part
from .maps_input import no_paths, with_values

LARGE = 32 << 20  # bytes of a file: what is smaller is read in about a second
READING = "the rays of this file are being read"


def preview_of(path) -> ViewInput | None:
    """Meshes and map of a large frame file, without a ray; None for a small one and for one without signals.

    Raises ep.FileError for a file whose head, scene, radar or map is damaged.
    """
    if not Path(path).is_file() or Path(path).stat().st_size < LARGE:
        return None
    with our_file(path) as file:
        if "spectra" not in file or "record" not in file:
            return None
        scene, radar = read_scene(read_group(file, "scene")), read_radar(read_group(file, "radar"))
        head, spectra = read_group(read_group(file, "record"), "frame"), read_group(file, "spectra")
        start_time, seed = read_attribute(head, "start_time", float), read_attribute(head, "seed", int)
        settings = json.loads(read_attribute(spectra, "settings", str))
        values = read_array(spectra, "values", np.complex128, (len(radar.transmitters), len(radar.receivers), None, None))
    signals = Signals(no_paths(scene, radar, start_time, seed), {name: without_lists(value) for name, value in settings.items()})
    cube = signals.whole()
    spectrum = with_values(signals.map_of(cube), values)
    return ViewInput(signals.paths, PartSet(whole_part(spectrum)), signals, cube, str(path), note=READING)
