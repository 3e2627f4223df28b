"""Pictures of frames in time: their maps, simulated or read once, and films of these."""
from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ..arguments.checks import Progress
from ..base.process.progress import with_progress
from ..scene.lifetimes import scene_in_frame
from ..signals.beside import leakage_map
from ..spectra.moving import static_speed
from .movers import movers_at, own_speed

if TYPE_CHECKING:
    from .. import _core
    from ..plots import Drive, Driving
    from ..scene.scene import Scene

FASTEST = 25.0  # pictures of a film in a second


class Frames(Protocol):
    """What has maps, as a `Row`."""

    radar: _core.Radar
    scene: Scene

    def _maps(self) -> tuple[int, Iterator[tuple], dict]: ...


def drive_of(frames: Frames, progress: Progress = None) -> Drive:
    """Maps of the frames that are there, taken one after the other; of those before 2 bytes for each cell are kept.

    progress: as of `Row.plot`. Raises ValueError without frames or maps.
    """
    from ..plots import Drive, power_dbm

    count, maps, looks = frames._maps()
    drive = None
    for place, (time, level, velocity, range) in enumerate(with_progress(maps, count, progress)):
        if drive is None:
            leaked = leakage_map(frames.radar, **looks)
            num_channels = len(frames.radar.transmitters) * len(frames.radar.receivers)
            drive = Drive(np.empty(count), np.empty((count, *level.shape), np.float16), velocity, range,
                          static_speed(velocity, **looks), None if leaked is None else power_dbm(leaked), num_channels)
        drive.times[place], drive.level[place] = time, level
    if drive is None:
        raise ValueError("frames: must be one at least, got none")
    return drive if not frames.radar.is_moving else drive._replace(driving=_driving(frames, drive.times))


def _driving(frames: Frames, times) -> Driving:
    """What the maps of a radar that moves do not tell: how fast it went ahead, and where what moves in the world was."""
    from ..plots import Driving

    scene, radar, middles = frames.scene, frames.radar, [frames.radar.middle_of_frame(time) for time in times]
    return Driving(np.array([own_speed(radar, time) for time in middles]),
                   [movers_at(scene_in_frame(scene, radar, start), radar, middle) for start, middle in zip(times, middles)])


def write_film_of(drive: Drive, path, *, frames_per_second=None, vmin=None, vmax=None, title="") -> None:
    """Writes a film of the maps as `Row.film` has it."""
    from ..base.storage.film import write_film
    from ..plots import film_pictures

    pace = _real_pace(drive.times) if frames_per_second is None else frames_per_second
    write_film(path, film_pictures(drive, vmin=vmin, vmax=vmax, title=title), pace)


def _real_pace(times) -> float:
    """Pictures in a second of a film as fast as the frames were, as far as it can be."""
    steps = np.abs(np.diff(times))
    return min(1.0 / float(np.median(steps)), FASTEST) if len(steps) else FASTEST
