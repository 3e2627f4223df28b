"""Label maps as images: one index per cell, with the names and colours of the indices beside them."""
from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..arguments.checks import an, checked, path, refused, text
from ..base.storage.files import written_whole
from ..base.storage.origin import origin_texts, png_info
from ..base.text.colours import colours_of
from .ghost_names import ghost_name
from .labels import Labels

NO_LABEL = "none"                   # name of index 0
NO_LABEL_COLOUR = (0, 0, 0)
MAX_PALETTE = 256                   # colours of a PNG; with more labels it holds 16-bit indices without colours


def label_images(labels) -> dict:
    """The maps of Labels as images: {name: (map [V, R] of indices from -1 on, list of entries of its palette)}.

    labels: Labels. The names: "parts" (the dominant part), "objects", "ghosts".
    """
    ghosts = [{"name": ghost_name(ghost), "object": ghost.object, "ghost_type": ghost.ghost_type, "order": ghost.order,
               "via": list(ghost.via), "class_code": ghost.class_code, **_received(ghost)} for ghost in labels.ghosts]
    objects = [{"name": label.name, "status": label.status, "is_occluded": label.is_occluded,
                "visible_share": label.visible_share, "occluders": label.occluders, **_received(label)}
               for label in labels.objects]
    return {"parts": (labels.dominant, [{"name": name} for name in labels.part_names]),
            "objects": (labels.object_map, objects),
            "ghosts": (labels.ghost_map, ghosts)}


def _received(label) -> dict:
    """Mean received power in W with its interval, and whether the rays know it; {} where nobody does."""
    if label.received is None:
        return {}
    return {"received": label.received._asdict() | {"resolved": label.received.resolved}}


MAPS = {"parts": "parts", "objects": "objects", "ghosts": "ghosts"}  # and the names of their files


def _names(argument: str, value) -> dict:
    """{one of MAPS: name of its files}"""
    if not isinstance(value, Mapping):
        raise refused(TypeError, argument, f"a dict of {', '.join(MAPS)} and names of files", value)
    for kind, name in value.items():
        if kind not in MAPS:
            raise refused(ValueError, argument, f"a dict of {', '.join(MAPS)} and names of files", value)
        text(argument, name)
    return dict(value)


@checked(labels=an(Labels), folder=path, names=_names)
def save_label_images(labels: Labels, folder: str | os.PathLike[str], names: Mapping[str, str] = MAPS) -> list[Path]:
    """Writes the maps of Labels as PNG files for programs, each with a JSON file that names and colours its indices.

    labels: Labels of maps [V, R]; folder: where the files are written
    names: {"parts" (the dominant part), "objects" or "ghosts": name of the files without .png and .json}
    A pixel is the index of a label + 1, 0: none; row i of the image is row i of the map, column j its range j. Returns the
    paths of the PNG files. Raises ep.FileError.
    """
    by_velocity = labels.azimuth is None
    rows = _axis("velocity", "m/s", labels.velocity) if by_velocity else _axis("azimuth", "rad", labels.azimuth)
    axes = {"rows": rows, "columns": _axis("range", "m", labels.range)}
    images, written = label_images(labels), []
    for kind, name in names.items():
        written.append(Path(folder) / f"{name}.png")
        _write_label_image(written[-1], *images[kind], axes, origin_texts(labels.seed))
    return written


def _axis(name: str, unit: str, values) -> dict:
    return {"name": name, "unit": unit, "values": np.asarray(values).tolist()}


def _write_label_image(path: Path, indices, entries: list, axes: dict, origin: dict) -> None:
    colours = [NO_LABEL_COLOUR, *colours_of([entry["name"] for entry in entries])]
    rows = [{"index": index, **entry, "colour": "#{:02x}{:02x}{:02x}".format(*colour)}
            for index, (entry, colour) in enumerate(zip([{"name": NO_LABEL}, *entries], colours))]
    with written_whole(path) as temporary:
        _write_png(temporary, np.asarray(indices, np.int32) + 1, colours, png_info(origin))
    with written_whole(path.with_suffix(".json")) as temporary:
        temporary.write_text(_palette_text(path.name, origin, axes, rows), encoding="utf-8")


def _palette_text(image: str, origin: dict, axes: dict, rows: list) -> str:
    """JSON with a line for each axis and label."""
    lines = [f' "image": {json.dumps(image)},', f' "origin": {json.dumps(origin)},', ' "axes": {',
             ",\n".join(f"  {json.dumps(side)}: {json.dumps(axis)}" for side, axis in axes.items()), " },", ' "labels": [',
             ",\n".join(f"  {json.dumps(row, ensure_ascii=False)}" for row in rows), " ]"]
    return "\n".join(["{", *lines, "}"]) + "\n"


def _write_png(path, pixels, colours: list, info) -> None:
    from PIL import Image

    if len(colours) > MAX_PALETTE:
        Image.fromarray(pixels.astype(np.uint16)).save(path, format="PNG", pnginfo=info)
        return
    image = Image.fromarray(pixels.astype(np.uint8), mode="L")
    image.putpalette([value for colour in colours for value in colour])
    image.save(path, format="PNG", optimize=True, pnginfo=info)
