"""Detections as files of points that tools for lidar read: PCD 0.7 of the Point Cloud Library, and LAS 1.4."""
from __future__ import annotations

import numpy as np

from .._core import FileError
from ..arguments.checks import file
from ..base.process.libraries import needed_module
from ..base.storage.files import written_whole

# Of the detections, as PCD has them; LAS has them, and the ratio to the noise, as extra dimensions.
_PLACE_AND_SPEED = ("velocity", "range", "azimuth", "elevation")
_EXTRA = {"velocity": "m/s, receding positive", "range": "m, from between the antennas", "azimuth": "rad, left positive",
          "elevation": "rad, up positive", "snr_db": "dB over the noise"}  # with descriptions of at most 32 characters
_LAS_STEP = 1e-4  # m
_MEANINGS = ("radar detections: x ahead, y left, z up in m in the frame of the radar, NaN where no azimuth is known",
             "intensity in dB over the noise, velocity in m/s (receding positive), range in m from between the antennas,",
             "azimuth and elevation in rad (left and up positive)")


def write_pcd(detections, path) -> None:
    """Binary, float32: x, y, z (m, in the radar's frame), intensity (dB over the noise), velocity, range, azimuth, elevation."""
    columns = {**dict(zip("xyz", detections.points.T)), "intensity": detections.snr_db}
    columns |= {name: getattr(detections, name) for name in _PLACE_AND_SPEED}
    table = np.stack([np.asarray(column, "<f4") for column in columns.values()], axis=-1).astype("<f4")
    head = ["# .PCD v0.7 - Point Cloud Data file format", *(f"# {line}" for line in _MEANINGS), "VERSION 0.7",
            "FIELDS " + " ".join(columns),
            *(f"{word} " + " ".join([value] * len(columns)) for word, value in (("SIZE", "4"), ("TYPE", "F"), ("COUNT", "1"))),
            f"WIDTH {len(table)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(table)}", "DATA binary"]
    with written_whole(file("path", path)) as temporary:
        temporary.write_bytes(("\n".join(head) + "\n").encode("ascii") + table.tobytes())


def write_las(detections, path) -> int:
    """What stands somewhere, with the fields of _EXTRA as extra dimensions; returns how many detections have no azimuth and are
    left out."""
    laspy = needed_module("laspy", "Detections.to_las", extra="las")
    is_placed = np.isfinite(detections.points).all(axis=1)
    points = detections.points[is_placed]
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.offsets, header.scales = np.zeros(3), np.full(3, _LAS_STEP)
    header.add_extra_dims([laspy.ExtraBytesParams(name=name, type=np.float64, description=told) for name, told in _EXTRA.items()])
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points.T
    cloud.return_number = cloud.number_of_returns = np.ones(len(points), np.uint8)  # the first of one: LAS 1.4 counts from 1
    snr = np.nan_to_num(detections.snr_db[is_placed], posinf=655.35, neginf=0.0)
    cloud.intensity = np.clip(np.rint(100.0 * snr), 0, 65535).astype(np.uint16)
    for name in _EXTRA:
        cloud[name] = getattr(detections, name)[is_placed]
    with written_whole(file("path", path)) as temporary:
        try:
            cloud.write(str(temporary))
        except laspy.errors.LaspyException as error:  # nothing is there that packs .laz
            raise FileError(f"{path}: cannot be written ({error}); laspy[lazrs] packs .laz") from None
    return int(np.sum(~is_placed))
