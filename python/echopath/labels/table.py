"""The objects and ghosts of Labels as a table."""
from __future__ import annotations

from ..presentation.tables import make_table

_NOTHING = float("nan")
_UNITS = {"power": "W", "range": "m", "velocity": "m/s", "azimuth": "rad", "peak_power": "W", "range_min": "m", "range_max": "m",
          "velocity_min": "m/s", "velocity_max": "m/s", "azimuth_min": "rad", "azimuth_max": "rad", "received": "W",
          "received_low": "W", "received_high": "W"}


def table_of(labels):
    """Labels as a table of their objects and ghosts; see Labels.to_dataframe."""
    row = "velocity" if labels.azimuth is None else "azimuth"
    columns = ("kind", "name", "status", "via", "ghost_type", "order", "class_code", "cells", "power", "range", row,
               "peak_power", "range_min", "range_max", f"{row}_min", f"{row}_max", "visible_share", "received",
               "received_low", "received_high", "is_resolved")
    rows = [_object(label, row) for label in labels.objects] + [_ghost(label, row) for label in labels.ghosts]
    return make_table({name: [one[name] for one in rows] for name in columns}, _UNITS)


def _object(label, row: str) -> dict:
    is_there = label.power > 0.0
    return {"kind": "object", "name": label.name, "status": label.status, "via": "", "ghost_type": 0, "order": 1,
            "class_code": 111 if is_there else 0, "visible_share": label.visible_share} | _common(label, row)


def _ghost(label, row: str) -> dict:
    return {"kind": "ghost", "name": label.object, "status": "", "via": " > ".join(label.via), "ghost_type": label.ghost_type,
            "order": label.order, "class_code": label.class_code, "visible_share": _NOTHING} | _common(label, row)


def _common(label, row: str) -> dict:
    received = label.received or (_NOTHING,) * 3
    values = {"cells": label.cells, "power": label.power, "received": received[0], "received_low": received[1],
              "received_high": received[2], "is_resolved": bool(label.received and label.received.resolved)}
    values |= dict(zip(("range", row, "peak_power"), label.peak or (_NOTHING,) * 3))
    return values | dict(zip(("range_min", "range_max", f"{row}_min", f"{row}_max"), label.box or (_NOTHING,) * 4))
