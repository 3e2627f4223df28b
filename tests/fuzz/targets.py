"""What the fuzzers in Python feed to the readers: {name: function that makes the seeds and returns case(number)}."""
from __future__ import annotations

from functools import partial

from fuzz.feeds.arrays import feed_arrays
from fuzz.feeds.datasets import feed_sequence, feed_template
from fuzz.feeds.foreign import feed_foreign, feed_frames_folder, feed_mtl, feed_serialized
from fuzz.feeds.frames import feed_frame_bytes, feed_frame_structure
from fuzz.feeds.gltf import feed_gltf_bin, feed_gltf_bytes, feed_gltf_json
from fuzz.feeds.texts import feed_antenna, feed_scene
from fuzz.feeds.tracks import GPX, SUMO, TABLES, feed_sensor, feed_tracks

TARGETS = {"frame_bytes": feed_frame_bytes, "frame_structure": feed_frame_structure, "arrays": feed_arrays,
           "scene": feed_scene, "antenna": feed_antenna, "gltf_bytes": feed_gltf_bytes, "gltf_json": feed_gltf_json,
           "gltf_bin": feed_gltf_bin, "frames_folder": feed_frames_folder, "mtl": feed_mtl,
           "serialized": feed_serialized,
           "table": partial(feed_tracks, ".csv", TABLES), "sumo": partial(feed_tracks, ".xml", SUMO),
           "gpx": partial(feed_tracks, ".gpx", GPX), "sensor": feed_sensor, "template": feed_template, "sequence": feed_sequence,
           **{name: partial(feed_foreign, f".{name}")
              for name in ("xml", "usda", "usdc", "usdz", "npz", "bvh", "obj", "stl", "off")}}
