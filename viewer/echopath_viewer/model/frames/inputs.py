"""What a view can be opened on: a frame file, a frame, or paths with parts."""
from __future__ import annotations

import dataclasses
from functools import cache

import numpy as np

import echopath as ep
from echopath.base.storage.files import file_state
from echopath.frame_file import KeptMeshes, read_frame
from echopath.paths.subset import part_of_path
from echopath.scene.lifetimes import scene_in_frame
from echopath.signals.same_radar import difference
from echopath.weather.weather import weather_of

from ..maps.layers import Known, are_of_map
from ..maps.part_set import WHOLE, Part, PartSet, group_of
from ..maps.signals import Signals, all_paths, selections_of
from .kept_orders import KeptOrders, read_kept
from .told_objects import told_objects


@dataclasses.dataclass
class ViewInput:
    """Paths and parts.

    known: what the frame knows beside its signals, None for paths alone; note: what it lacks, in words
    kept_maps: ep.FrameMaps of a file without rays and signals, None: both are there
    kept: what an earlier view has kept in the file, None: nothing
    file_state: of the file from before it was read, None: there is no file
    angles: keywords of `range_azimuth` that the frame was asked for, None: there is no frame
    weather: ep.Weather that weakens the echoes, which scenes of records do not tell; None: none does
    signals: how theirs are made; cube: the whole [tx, rx, chirp, sample] in sqrt(W); title: of the window
    """

    paths: object
    parts: PartSet
    signals: Signals
    cube: np.ndarray
    title: str = ""
    known: Known | None = None
    note: str = ""
    kept_maps: object = None
    kept: KeptOrders | None = None
    file_state: tuple | None = None
    angles: dict | None = None
    weather: ep.Weather | None = None


def from_file(path, meshes: KeptMeshes | None = None) -> ViewInput:
    """Reads a frame file. Raises ep.FileError, with its name, where it is not ours or damaged.

    meshes: of the frame before, which this one shares, unread, where its file has the same; None: of none
    """
    state = file_state(path)
    frame = read_frame(path, meshes)
    try:
        view_input = from_frame(frame, title=str(path))
    except (ValueError, IndexError) as error:  # what it holds does not fit together
        raise ep.FileError(f"{path}: {error}") from None
    view_input.file_state = state
    view_input.kept = read_kept(path, view_input)
    return view_input


def from_frame(frame, title: str = "") -> ViewInput:
    """A simulated frame; one that is only a record of paths is synthesised."""
    if frame.cube is None:
        return from_paths(frame.scene, frame.paths, title=title)
    parts = [Part(group_of(partition), name, frame.part_spectra[partition][name], (frame.part_of_path[partition], index),
                  selection)
             for partition, cubes in frame.parts.items()
             for index, (name, selection) in enumerate(zip(cubes, selections_of(frame.selections[partition])))]
    signals = Signals(frame.paths, dict(frame.spectrum_settings), frame.evaluate, frame.retrace,
                      getattr(frame, "keyframes", 0), frame.replay)
    return ViewInput(frame.paths, PartSet(whole_part(frame.spectrum), parts), signals, frame.cube, title, _known(frame),
                     angles=dict(frame.angle_settings), weather=_weather_of(frame.scene, frame.paths))


def _weather_of(scene, paths) -> ep.Weather | None:
    """What weakens the echoes of paths in a scene: weather whose effect was switched off does not."""
    return weather_of(scene) if paths.frame.attenuation > 0.0 else None


def _known(frame) -> Known:
    """Taken from the frame where it has it, else made when it is asked for."""
    objects = cache(lambda: told_objects(frame))
    return Known(labels=lambda progress: _map_labels(frame, objects, progress),
                 detections=lambda progress: frame.detections or ep.detect_frame(frame, objects=objects(), progress=progress),
                 truth=lambda progress: ep.truth(frame, objects()) if frame.kept_truth is None else frame.kept_truth,
                 objects=objects)


def _map_labels(frame, objects, progress) -> dict:
    """{group of a partition: Labels} of the range-Doppler map: those of its range-azimuth map lie on other axes."""
    are_there = frame.labels and are_of_map(frame.labels)
    labels = frame.labels if are_there else ep.annotate_frame(frame, objects=objects(), progress=progress)
    return {group_of(partition): one for partition, one in labels.items()}


def from_paths(scene, paths, parts=None, *, window="hann", zero_pad=1, evaluate="interpolated", retrace="never",
               keyframes=0, title: str = "") -> ViewInput:
    """Paths of a trace with parts of them.

    scene: that of the paths, or None; parts: of `decompose`, or selections {name: selection}, one partition or several
    window, zero_pad: of the maps; evaluate, retrace, keyframes: of the signals, as in `synthesize`
    Raises ValueError for another scene and for parts of another radar.
    """
    check_scene(scene, paths)
    signals = Signals(paths, {"window": window, "zero_pad": zero_pad}, evaluate, retrace, keyframes)
    made = [part for partition, group in _partitions(parts).items() for part in _parts_of(group_of(partition), group, signals)]
    cube = signals.whole()
    return ViewInput(paths, PartSet(whole_part(signals.map_of(cube)), made), signals, cube, title,
                     weather=_weather_of(scene, paths))


def check_scene(scene, paths) -> None:
    """Raises ValueError for a scene, unless it is None, that is not the one of the paths."""
    there = paths.scene if scene is None else scene_in_frame(scene, paths.radar, paths.frame.start_time)
    if len(there.meshes) != len(paths.scene.meshes):
        raise ValueError(f"scene: must be the one that was traced, with {len(paths.scene.meshes)} meshes, "
                         f"got one with {len(there.meshes)}")


def whole_part(spectrum) -> Part:
    """The whole signal as a part, by its map."""
    return Part(WHOLE, WHOLE, spectrum, selection=all_paths())


def _partitions(parts) -> dict:
    """{partition: Parts or dict}, with Parts kept as they are."""
    if isinstance(parts, dict) and parts and all(isinstance(group, dict) for group in parts.values()):
        return parts
    return {"parts": parts} if parts else {}


def _parts_of(partition: str, group, signals: Signals) -> list[Part]:
    _check_radar(group, signals.paths)
    cubes, selections = group, getattr(group, "selections", None)
    if not any(isinstance(value, np.ndarray) for value in group.values()):
        cubes, selections = ep.decompose(signals.paths, None, group, **signals.settings), group
    spectra = {str(name): signals.map_of(cube) for name, cube in cubes.items()}
    if selections is None:
        none = np.zeros(signals.paths.num_paths, bool)
        return [Part(partition, name, spectrum, none, is_known=False) for name, spectrum in spectra.items()]
    labels = part_of_path(signals.paths, selections)
    return [Part(partition, name, spectrum, (labels, index), selection)
            for index, ((name, spectrum), selection) in enumerate(zip(spectra.items(), selections_of(selections)))]


def _check_radar(group, paths) -> None:
    """The axes of a map, the cells of paths and where the antennas are belong to the radar of the trace."""
    radar = getattr(group, "radar", None)
    name = "" if radar is None else difference(radar, paths.radar, paths.frame.start_time)
    if name:
        raise ValueError(f"parts: must be of the radar that traced the paths, got signals of one with another {name}; "
                         "trace with that radar to view them")
