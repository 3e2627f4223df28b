"""Labels as an xarray.Dataset."""
from __future__ import annotations

from ..presentation.xarray_maps import axis, xarray_module
from .ghost_names import ghost_name

_OF_CELLS = {  # attribute of Labels: name, unit
    "whole": ("whole", "W"), "dominant": ("dominant", ""), "mask": ("mask", ""), "above_noise": ("above_noise", ""),
    "object_map": ("object", ""), "ghost_map": ("ghost", ""), "certain": ("certain", "")}
_OF_PARTS = {"power": "W", "share": "1", "mean_power": "W", "mean_share": "1", "power_error": "W", "share_error": "1"}


def dataset_of(labels):
    """Labels as a Dataset; see Labels.to_xarray."""
    row = "velocity" if labels.azimuth is None else "azimuth"
    names = {"dominant": labels.part_names, "object_map": [label.name for label in labels.objects],
             "ghost_map": [ghost_name(label) for label in labels.ghosts]}
    variables = {}
    for field, (name, unit) in _OF_CELLS.items():
        if getattr(labels, field) is not None:
            attributes = {"units": unit} if unit else {"names": names[field]} if field in names else {}
            variables[name] = ((row, "range"), getattr(labels, field), attributes)
    for field, unit in _OF_PARTS.items():
        if getattr(labels, field) is not None:
            variables[field] = (("part", row, "range"), getattr(labels, field), {"units": unit})
    settings = {name: getattr(labels, name)
                for name in ("plane", "noise_power", "noise_margin_db", "dynamic_range_db", "seed")}
    coordinates = {"part": labels.part_names, row: axis(row, getattr(labels, row)), "range": axis("range", labels.range)}
    return xarray_module().Dataset(variables, coords=coordinates, attrs=settings)
