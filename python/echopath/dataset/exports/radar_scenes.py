"""Datasets in the layout of RadarScenes, which its own tools read (Schumann et al. 2021, doi 10.5281/zenodo.4559821).

The car's frame is that of the radar, level with the road. Sensors are where its antennas are in it: one, number 1, where they are
at the same place in all scenes.
"""
from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arguments.checks import checked, one_of, path as folder_rule, refused
from ...base.numerics.rates import radar_rate
from ...base.radar.antennas import centre_of
from ...base.radar.velocities import ambiguity_of, folded
from ...base.storage.files import write_texts, written_whole
from ...detections.detections import Detections
from ...detections.directions import toward
from ...frame_file.h5 import writing
from ..classes import CODES
from ..opened import Dataset, dataset_rule
from . import are_echoes, cross_sections_dbsm, detections_of, exported

FOLDER = "data"
MOST_SENSORS = 255  # of one byte, from 1 on
MICRO = 1e6  # timestamps are whole microseconds
Clutter = Literal["static", "omit"]
_CATEGORIES = {"train": "train", "val": "validation", "validation": "validation"}  # other splits keep their names

POINTS = np.dtype([("timestamp", "i8"), ("sensor_id", "u1"), ("range_sc", "f4"), ("azimuth_sc", "f4"), ("rcs", "f4"),
                   ("vr", "f4"), ("vr_compensated", "f4"), ("x_cc", "f4"), ("y_cc", "f4"), ("x_seq", "f4"), ("y_seq", "f4"),
                   ("uuid", "S32"), ("track_id", "S32"), ("label_id", "u1"), ("ghost_label", "i2")])
ODOMETRY = np.dtype([("timestamp", "i8"), ("x_seq", "f8"), ("y_seq", "f8"), ("yaw_seq", "f8"), ("vx", "f8"),
                     ("yaw_rate", "f8"), ("vy", "f8")])


class _Pose(NamedTuple):
    """Where the radar is: world_from_radar [4, 4], and its rate [4, 4] per s."""

    world: NDArray[np.float64]
    rate: NDArray[np.float64]

    @property
    def yaw(self) -> float:
        return float(np.arctan2(self.world[1, 0], self.world[0, 0]))

    @property
    def yaw_rate(self) -> float:
        return float((self.rate[:3, :3] @ self.world[:3, :3].T)[1, 0])

    def velocity_of(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """[3] m/s over ground of a place [3] in m of the radar's frame, in its axes."""
        return np.asarray((self.rate[:3, :3] @ place + self.rate[:3, 3]) @ self.world[:3, :3])


@checked(dataset=dataset_rule, folder=folder_rule, clutter=one_of(Clutter))
def write_radar_scenes(dataset: Dataset, folder: str | os.PathLike[str], *, clutter: Clutter = "static") -> None:
    """Writes the detections of a dataset as RadarScenes has them: data/sequences.json, data/sensors.json, and for each scene
    data/sequence_<k>/radar_data.h5 and scenes.json, k from 1.

    dataset: as of `open`, of a template with an array that tells azimuths apart and [detections]; else with keep = "all", or
        its `remade()`: then detections are those of `ep.detect_frame`
    folder: new or empty; it gets the folder data, whole or not at all: after a kill, the same call writes it anew.
    clutter: what becomes of detections that are no echoes: noise, interference, rain, leakage, residues of codes. "static":
        points of label_id 11 (static) without a track, as RadarScenes, which has no class of its own for them, labels all
        points that no moving road user makes; "omit": they are left out. `write_osi` has them as CLUTTER of
        existence_probability 0
    Fields of radar_data, in its order: timestamp (us), sensor_id, range_sc (m), azimuth_sc (rad, left positive), rcs (dBsm, by
    the radar equation with the gains of the first antennas, NaN of leakage and nearer than a wavelength), vr and vr_compensated
    (m/s, receding positive; the second without the radar's own motion, the smallest of those that look the same, with `folds`
    in [detections] to the transmitters in turns; 0 of frames of one chirp, to which all do), x_cc, y_cc (m, car frame), x_seq,
    y_seq (m, world), uuid, track_id ("" of what is static or clutter), label_id; and behind them ghost_label, the label of the
    Radar Ghost Dataset (Kraus et al. 2021): 1000 times its class and 111 for real echoes, 112, 122, 124 for ghosts, 0 for the
    background. A ghost has the track and the label_id of its object.
    Ranges and azimuths count from where sensors.json has the sensor in the car: between transmitters and receivers
    (`Detections.centre`). odometry has timestamp, x_seq, y_seq, yaw_seq, vx (m/s), yaw_rate (rad/s), a row for each frame, and
    behind them vy (m/s), which is not 0 where the radar's frame does not look to where it drives: x_cc is ahead of the car
    where antennas at its corners have yaws of their own in a frame that is the car's.
    Raises ValueError naming `dataset` where it has no frames, no detections with azimuths, or antennas at more than 255 places,
    and naming `folder` where that has a folder data; ep.FileError where files cannot be written.
    """
    with exported(dataset, folder, FOLDER) as data:
        sequences: dict[str, dict[str, Any]] = {}
        sensors: dict[tuple[float, float], int] = {}
        for number, scene in enumerate(dataset.scenes, 1):
            name, place = f"sequence_{number}", centre_of(dataset.sequence(scene).radar)
            sensor = sensors.setdefault((float(place[0]), float(place[1])), len(sensors) + 1)
            if sensor > MOST_SENSORS:
                raise refused(ValueError, "dataset", f"of antennas at {MOST_SENSORS} places of the car at most",
                              str(dataset.folder))
            sequences[name] = _write_sequence(dataset, scene, data / name, name, sensor, clutter)
        write_texts(data, {"sequences.json": _json({"sequences": sequences}),
                           "sensors.json": _json({f"radar_{sensor}": {"id": sensor, "x": x, "y": y, "yaw": 0.0}
                                                  for (x, y), sensor in sensors.items()})})


def _write_sequence(dataset: Dataset, scene: int, folder: Path, name: str, sensor: int, clutter: Clutter) -> dict[str, Any]:
    """Writes one scene of the sensor of a number; returns what sequences.json says of it."""
    stored, template = dataset.sequence(scene), dataset.template
    radar = stored.radar
    ambiguity = ambiguity_of(radar, (stored.settings.get("detections") or {}).get("folds", 0))
    classes = dataset.classes(scene)
    frames = dataset.of_scene(scene)
    points, odometry = [], np.zeros(len(frames), ODOMETRY)
    for row, one in enumerate(frames):
        time = radar.middle_of_frame(float(stored.times[one.place]))
        pose = _pose(radar, time)
        ahead, aside, _ = pose.velocity_of(np.zeros(3))
        odometry[row] = (round(MICRO * time), *pose.world[:2, 3], pose.yaw, ahead, pose.yaw_rate, aside)
        found = detections_of(dataset, one)
        rows = _points_of(found, one.number, scene, radar, time, pose, classes, ambiguity)
        rows["sensor_id"] = sensor
        points.append(rows if clutter == "static" else rows[are_echoes(found)])
    _write_data(folder / "radar_data.h5", np.concatenate(points), odometry)
    category = _CATEGORIES.get(template.split_of(scene), template.split_of(scene))
    scenes = _scenes(odometry["timestamp"], [len(one) for one in points], sensor)
    ends = {"first_timestamp": int(odometry["timestamp"][0]), "last_timestamp": int(odometry["timestamp"][-1])}
    head = {"sequence_name": name, "category": category} | ends
    write_texts(folder, {"scenes.json": _json(head | {"scenes": scenes})})
    return {"category": category, "n_scenes": len(scenes), "n_detections": int(sum(map(len, points)))} | ends


def _pose(radar: Any, time: float) -> _Pose:
    return _Pose(np.asarray(radar.world_from_radar(time)), radar_rate(radar, time))


def _points_of(found: Detections, number: int, scene: int, radar: Any, time: float, pose: _Pose,
               classes: dict[str, Any], ambiguity: float) -> NDArray[Any]:
    """The rows of one frame, but for the number of the sensor. ambiguity: m/s, of the velocities found"""
    rows = np.zeros(len(found), POINTS)
    own = found.points                                     # in the radar's frame
    world = own @ pose.world[:3, :3].T + pose.world[:3, 3]
    kinds = [classes.get(name, "static") for name in found.object]
    rows["timestamp"] = round(MICRO * time)
    rows["range_sc"], rows["azimuth_sc"] = found.range, found.azimuth
    rows["rcs"] = cross_sections_dbsm(found, radar, time)
    rows["vr"] = found.velocity
    if ambiguity > 0.0:  # else all velocities look the same, of which 0 is the smallest
        rows["vr_compensated"] = folded(found.velocity - _own_velocity(found, pose), ambiguity)
    rows["x_cc"], rows["y_cc"], rows["x_seq"], rows["y_seq"] = own[:, 0], own[:, 1], world[:, 0], world[:, 1]
    rows["uuid"] = [_identity(number, index) for index in range(len(found))]
    rows["track_id"] = ["" if kind == "static" else _identity(scene, name) for kind, name in zip(kinds, found.object)]
    rows["label_id"] = [CODES[kind].radar_scenes for kind in kinds]
    rows["ghost_label"] = [code and 1000 * CODES[kind].ghost + code for kind, code in zip(kinds, found.class_code.tolist())]
    return rows


def _own_velocity(found: Detections, pose: _Pose) -> NDArray[np.float64]:
    """Radial velocity in m/s that a point at rest would have, [D]: what the radar's own motion makes."""
    directions = toward(found.azimuth, np.nan_to_num(found.elevation))
    return np.asarray(-directions @ pose.velocity_of(found.centre))


def _identity(*parts: object) -> str:
    """32 hexadecimal digits, the same in every run."""
    return hashlib.md5("/".join(map(str, parts)).encode("utf-8", "surrogatepass"), usedforsecurity=False).hexdigest()


def _scenes(timestamps: NDArray[np.int64], counts: list[int], sensor: int) -> dict[str, Any]:
    """What scenes.json says of each frame, by its timestamp."""
    times, ends = [int(time) for time in timestamps], np.cumsum([0, *counts]).tolist()
    scenes = {}
    for index, time in enumerate(times):
        before = times[index - 1] if index else None
        after = times[index + 1] if index + 1 < len(times) else None
        scenes[str(time)] = {
            "sensor_id": sensor, "prev_timestamp": before, "next_timestamp": after, "prev_timestamp_same_sensor": before,
            "next_timestamp_same_sensor": after, "odometry_timestamp": time, "odometry_index": index,
            "image_name": f"{time}.jpg", "radar_indices": [ends[index], ends[index + 1]]}
    return scenes


def _write_data(path: Path, points: NDArray[Any], odometry: NDArray[Any]) -> None:
    with written_whole(path) as temporary, writing(temporary) as file:
        file.create_dataset("radar_data", data=points)
        file.create_dataset("odometry", data=odometry)


def _json(value: Any) -> str:
    return json.dumps(value, indent=1) + "\n"
