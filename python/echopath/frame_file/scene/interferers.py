"""Other radars of a scene in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

from ...scene.interferers import Interferer, interferers_of
from ..h5 import blames_group, read_attribute, read_group, write_attribute
from ..radar import read_radar, write_radar

NAME = "interferers"
_LIFETIME = "lifetime_begin", "lifetime_end"  # of those that have one


def write_interferers(file, scene) -> None:
    """Writes a group for each of a scene that has some; file: or the group above."""
    found = interferers_of(scene)
    folder = file.create_group(NAME) if found else None
    for index, one in enumerate(found):
        group = folder.create_group(str(index))
        write_radar(group.create_group("radar"), one.radar)
        write_attribute(group, "offset", one.offset)
        if one.interval is not None:
            write_attribute(group, "interval", one.interval)
        write_attribute(group, "over", one.over)
        for name, time in zip(_LIFETIME, one.lifetime or ()):
            write_attribute(group, name, time)


def read_interferers(file) -> tuple[Interferer, ...]:
    """Those of a file, () where it has none."""
    if NAME not in file:
        return ()
    folder = read_group(file, NAME)
    return tuple(_one(read_group(folder, str(index))) for index in range(len(folder)))


@blames_group
def _one(group) -> Interferer:
    lifetime = tuple(read_attribute(group, name, float) for name in _LIFETIME if name in group.attrs)
    interval = read_attribute(group, "interval", float) if "interval" in group.attrs else None
    return Interferer(radar=read_radar(read_group(group, "radar")), offset=read_attribute(group, "offset", float),
                      interval=interval, over=read_attribute(group, "over", str), lifetime=lifetime or None)
