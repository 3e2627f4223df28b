"""Labels as an xarray.Dataset."""
from __future__ import annotations

import numpy as np

from ..presentation.xarray_maps import attributes_of, axis, index_of, words_of, xarray_module
from .ghost_names import ghost_name

_OF_CELLS = {  # attribute of Labels: name, unit
    "whole": ("whole", "W"), "dominant": ("dominant", ""), "mask": ("mask", ""), "above_noise": ("above_noise", ""),
    "object_map": ("object", ""), "ghost_map": ("ghost", ""), "certain": ("certain", "")}
_OF_PARTS = {"power": "W", "share": "1", "mean_power": "W", "mean_share": "1", "power_error": "W", "share_error": "1"}


def dataset_of(labels):
    """Labels as a Dataset; see Labels.to_xarray."""
    row = "velocity" if labels.azimuth is None else "azimuth"
    names = {"dominant": labels.part_names, "object": [label.name for label in labels.objects],
             "ghost": [ghost_name(label) for label in labels.ghosts]}
    variables = {}
    for field, (name, unit) in _OF_CELLS.items():
        if getattr(labels, field) is not None:
            variables[name] = ((row, "range"), getattr(labels, field),
                               {"units": unit} if unit else index_of(name) if name in names else {})
    for field, unit in _OF_PARTS.items():
        if getattr(labels, field) is not None:
            variables[field] = (("part", row, "range"), getattr(labels, field), {"units": unit})
    settings = attributes_of(labels, "plane", "noise_power", "noise_margin_db", "dynamic_range_db", "seed")
    coordinates = {"part": np.array(labels.part_names, dtype=str), row: axis(row, getattr(labels, row)),
                   "range": axis("range", labels.range)}
    for name, words in names.items():
        coordinates |= words_of(name, words)
    return xarray_module().Dataset(variables, coords=coordinates, attrs=settings)
