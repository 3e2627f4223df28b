"""Frame files: HDF5 with scene, radar, paths and what was computed from them (layout: data/README.md)."""
from .budget import min_power_of_budget
from .frame import LeftOut, left_out, load_frame, load_paths, read_frame, save_frame, save_paths
from .labels_file import load_labels, save_labels
from .scene import KeptMeshes

__all__ = ["KeptMeshes", "LeftOut", "left_out", "load_frame", "load_labels", "load_paths", "min_power_of_budget", "read_frame",
           "save_frame", "save_labels", "save_paths"]
