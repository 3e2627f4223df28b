"""The street demo, simulated on the spot."""
from __future__ import annotations

from importlib.resources import as_file

from echopath.base.storage.data_folder import data_folder
from echopath.cli.demo import limb_partitions
from echopath.cli.run import simulate_file
from echopath.scene_file import load_scene

NUM_RAYS = 20_000


def simulate_demo(progress, num_rays: int = NUM_RAYS):
    """The frame of data/scenes/street.toml; progress: callable (stage, fraction); num_rays: few, unless asked otherwise."""
    with as_file(data_folder("scenes") / "street.toml") as path:
        street = load_scene(path)
    return simulate_file(street, num_rays=num_rays, extra_parts=limb_partitions(street.parts["route"]), progress=progress)
