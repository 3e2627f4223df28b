"""A scene file for a foreign scene, ready to run and to be edited."""
from __future__ import annotations

import json
import os
from pathlib import Path

from .. import _core
from ..base.storage.files import written_whole
from ..base.text.node_names import fit_name
from ..readers import Model, load_model
from ..scene.found_objects import find_objects, things_of
from ..scene.scene import Scene
from .vantage import vantage

CELLS = 256  # range cells up to the greatest distance
TEXT = """title = {title}
mark_mirrors = {mirrors}

[radar]  # 77 GHz, one transmitter and four receivers half a wavelength apart, {stands}
transmit_power = 0.01
noise_figure_db = 12.0
position = {position}
yaw_deg = {yaw:g}
pattern = {{kind = "cosine_power", exponent = 2.0}}

[radar.waveform]
start_frequency = {frequency:g}
bandwidth = {bandwidth:.4g}  # Hz: cells of {cell:.3g} m, {reach:.4g} m in all
num_samples = {samples}
sampling_rate = 10e6
num_chirps = 64
chirp_interval = 60e-6

[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
{receivers}
[[objects]]
name = {name}
model = {model}
{settings}{notes}
{labels}[trace]
num_rays = 200000
max_bounces = 3
"""
LABELS = """[labels]
objects = "found"  # what stands there{names}, and what is added to the scene

"""
NAMED = 12  # things of a town that a comment names
START_FREQUENCY = 77e9  # Hz

# By whether the radar stands within a town or a room: whether planes are mirrors, and where it stands.
_IN_TOWN = {True: ("true  # what is made of planes larger than their Fresnel zone, so that ghosts over them are found",
                   "in the open and looking at what stands there"),
            False: ("false  # true where walls and grounds are to make ghosts: a mirror has no echo but its image",
                    "before the object")}


def write_scene_file(path: str | os.PathLike[str], out: str | os.PathLike[str], *, unit: float | None = None,
                     up: str | None = None) -> Model:
    """Writes a scene file `out` whose one object is the foreign file `path`, and returns its Model.

    unit, up: as of load_model. The radar stands where `vantage` says. Raises as load_model does, and ep.FileError when the
    file cannot be written.
    """
    path, out = Path(path), Path(out)
    model = load_model(path, unit=unit, up=up)
    name, scene = fit_name(path.stem, "model"), Scene()
    scene.add(model, name=name)
    things = things_of(scene)
    position, yaw, reach, is_town = vantage(scene, things)
    mirrors, stands = _IN_TOWN[is_town]
    text = TEXT.format(mirrors=mirrors, stands=stands, title=_quoted(path.stem), position=position, yaw=yaw,
                       cell=reach / CELLS, reach=reach, samples=CELLS, frequency=START_FREQUENCY,
                       bandwidth=CELLS * _core.speed_of_light / (2.0 * reach), receivers=_receivers(),
                       name=_quoted(name), model=_quoted(_relative(path, out.parent)),
                       settings=_settings(unit, up), notes="".join(f"# {_plain(note)}\n" for note in model.notes),
                       labels=_labels(scene, position) if is_town else "")
    with written_whole(out) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return model


def _labels(scene: Scene, position: list[float]) -> str:
    """The table that asks for labels of what a town holds, with the names of that; nothing where it holds nothing."""
    waveform = _core.ChirpSequence(start_frequency=START_FREQUENCY, bandwidth=1e9, num_samples=CELLS, sampling_rate=10e6)
    radar = _core.Radar(waveform, transmitters=[_core.Antenna()], receivers=[_core.Antenna()], position=position)
    names = list(find_objects(scene, radar))
    more = f" and {len(names) - NAMED:,} more" if len(names) > NAMED else ""
    return LABELS.format(names=_plain(f" ({', '.join(names[:NAMED])}{more})")) if names else ""


def _receivers() -> str:
    spacing = _core.speed_of_light / START_FREQUENCY / 2.0
    return "".join(f"\n[[radar.receivers]]\nposition = [0.0, {index * spacing:.6f}, 0.0]\n" for index in range(4))


def _settings(unit: float | None, up: str | None) -> str:
    return (f"unit = {unit:.15g}\n" if unit is not None else "") + (f'up = "{up}"\n' if up is not None else "")


def _relative(path: Path, folder: Path) -> str:
    """The way from a folder to a path, which `..` goes through what links lead to."""
    try:
        way = os.path.relpath(path, folder)
        if os.path.realpath(folder / way) != os.path.realpath(path):
            way = os.path.relpath(Path(os.path.realpath(path.parent), path.name), os.path.realpath(folder))
        return Path(way).as_posix()
    except ValueError:  # on another drive
        return path.absolute().as_posix()


def _quoted(text: str) -> str:
    """Text as TOML writes it."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _plain(text: str) -> str:
    return "".join(letter if letter.isprintable() else " " for letter in text)
