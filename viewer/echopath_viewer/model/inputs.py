"""What a view can be opened on: a frame file, a frame, or paths with parts."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep
from echopath.path_subset import part_of_path
from echopath.simulate import as_partitions

from .part_set import WHOLE, Part, PartSet, spectrum_of


@dataclasses.dataclass
class ViewInput:
    """Paths and parts with the settings of the maps; cube: the whole [tx, rx, chirp, sample]; title: of the window."""

    paths: object
    parts: PartSet
    spectrum_settings: dict
    cube: np.ndarray
    title: str = ""


def from_file(path) -> ViewInput:
    """Reads a frame file. Raises ep.FileError where it is not ours or damaged."""
    return from_frame(ep.load_frame(path), title=str(path))


def from_frame(frame, title: str = "") -> ViewInput:
    """A simulated frame; one that is only a record of paths is synthesised."""
    if frame.cube is None:
        return from_paths(frame.scene, frame.paths, title=title)
    parts = [Part(partition, name, frame.part_spectra[partition][name], frame.part_of_path[partition] == index)
             for partition, cubes in frame.parts.items() for index, name in enumerate(cubes)]
    return ViewInput(frame.paths, PartSet(Part(WHOLE, WHOLE, frame.spectrum), parts), dict(frame.spectrum_settings),
                     frame.cube, title)


def from_paths(scene, paths, parts=None, *, window="hann", zero_pad=1, title: str = "") -> ViewInput:
    """Paths of a trace with parts of them.

    scene: that of the paths, or None; parts: of `decompose`, or selections {name: selection}, one partition or several
    window, zero_pad: of the maps.
    """
    if scene is not None and len(scene.meshes) != len(paths.scene.meshes):
        raise ValueError(f"scene: must be the one that was traced, with {len(paths.scene.meshes)} meshes, "
                         f"got one with {len(scene.meshes)}")
    settings = {"window": window, "zero_pad": zero_pad}
    cube = ep.synthesize(paths)
    made = [part for partition, group in _partitions(parts).items() for part in _parts_of(partition, group, paths, settings)]
    whole = Part(WHOLE, WHOLE, ep.range_doppler(cube, paths.radar, **settings))
    return ViewInput(paths, PartSet(whole, made), settings, cube, title)


def _partitions(parts) -> dict:
    """{partition: Parts or dict}, with Parts kept as they are."""
    if isinstance(parts, dict) and parts and all(isinstance(group, dict) for group in parts.values()):
        return parts
    return as_partitions(parts) and {"parts": parts}


def _parts_of(partition: str, group, paths, settings: dict) -> list[Part]:
    cubes, selections = group, getattr(group, "selections", None)
    if not any(isinstance(value, np.ndarray) for value in group.values()):
        cubes, selections = ep.decompose(paths, None, group), group
    spectra = {name: ep.range_doppler(cube, paths.radar, **settings) for name, cube in cubes.items()}
    if selections is None:
        return [Part(partition, name, spectrum, is_known=False) for name, spectrum in spectra.items()]
    labels = part_of_path(paths, selections)
    return [Part(partition, name, spectrum, labels == index) for index, (name, spectrum) in enumerate(spectra.items())]
