"""The signal of hidden objects around edges: diffraction into shadows, to be added to that of a trace."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import Progress, checked, count
from ..arguments.number_rules import start_time_rule
from ..arguments.shown import shown
from ..paths.absent import NO_MESH
from ..scene.lifetimes import scene_in_frame
from ..tracing.around_corners import Hidden, hidden_objects, level_of, ways_to
from ..transmit import signal_shape
from .rows import row_times, signal_of_rows

_STREAM = 0x65646765  # tells these random numbers from others of the same seed
NODES = np.array([0.0, 0.5, 1.0])  # of the frame, between which lengths are parabolas
LARGEST_BEND = 0.1  # m, of what keeps its edge


@checked(start_time=start_time_rule, seed=count(0, 2**32 - 1), num_rays=count(1, 2**24))
def synthesize_around_corners(scene: _core.Scene, radar: _core.Radar, *, start_time: float = 0.0, seed: int = 1,
                              num_rays: int = 5000, progress: Progress = None) -> np.ndarray:
    """The signal that hidden objects send around one edge there and one back: what `synthesize` of a trace does not have.

    The hidden points of `around_corners` are scatterers with phases of their own, fast to the material, whose ways around
    their edges are followed over the frame; on the average over `seed` the power is that which `around_corners` tells of the
    middle of the frame, `resolved` there or not. A point that comes into sight, or whose edge changes within the frame, is left
    out.
    scene: without what is absent from the frame (`SceneNode.lifetime`)
    radar: whose transmitters take turns, with chirps that are all alike
    start_time: s, within 1e9 s of zero; seed: of the phases
    num_rays, progress: as there
    Returns an array in the shape of `synthesize`, in sqrt(W), without noise. Raises ValueError for transmitters that send at
    once and for steps of frequency or bandwidth.
    """
    for steps in ("frequency_steps", "bandwidth_steps"):
        if any(getattr(radar.waveform, steps)):
            raise ValueError(f"radar: must have chirps that are all alike, got {steps} {shown(getattr(radar.waveform, steps))}")
    if len(radar.transmitters) > 1 and radar.multiplexing != "tdm":
        raise ValueError(f'radar: must have multiplexing "tdm", got {radar.multiplexing!r}')
    scene = scene_in_frame(scene, radar, start_time)
    cube = np.zeros(signal_shape(radar), complex)
    middle = radar.middle_of_frame(start_time)
    for number, hidden in enumerate(hidden_objects(scene, radar, middle, progress)):
        level = level_of(hidden.alone, radar, middle, num_rays, progress).power / len(hidden.points)
        phases = np.random.default_rng([_STREAM, seed, number]).random(len(hidden.points))
        _add(cube, scene, radar, hidden, np.sqrt(level) * hidden.shares * np.exp(2j * np.pi * phases), start_time)
    return cube


def _add(cube, scene, radar, hidden: Hidden, amplitudes, start_time) -> None:
    """Adds the echoes of one object, amplitudes [N] in sqrt(W), to every channel."""
    times = start_time + NODES * radar.frame_duration
    points = [hidden.points.at(scene, time) for time in times]
    ends = {end: [_legs(scene, radar, end, points, times) for end in antennas]
            for end, antennas in (("out", radar.transmitters), ("back", radar.receivers))}
    kept = np.all([is_kept for ways in ends.values() for _, is_kept, _ in ways], axis=0) & (amplitudes != 0.0)
    if not kept.any():
        return
    for i, (out, _, sent) in enumerate(ends["out"]):
        share = row_times(radar, i) / radar.frame_duration
        for j, (back, _, received) in enumerate(ends["back"]):
            delays = _parabolas(share) @ (out + back)[:, kept] / _core.speed_of_light
            fields = (amplitudes * sent * received)[kept]
            cube[i, j] += signal_of_rows(radar, delays, np.tile(fields, (radar.waveform.num_chirps, 1)))


def _legs(scene, radar, antenna, points, times) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """m [nodes, N] from an antenna, which points [N] keep their edge, and the antenna's pattern [N] in the frame's middle."""
    ways = [ways_to(scene, radar, antenna, at, time) for at, time in zip(points, times)]
    meshes = np.array([way["mesh_id"] for way in ways])
    goes_on = _bend([way["point"] for way in ways]) <= _bend(points) + LARGEST_BEND
    is_kept = np.all(meshes == meshes[0], axis=0) & (goes_on | (meshes[0] == NO_MESH))
    return (np.array([way["length"] for way in ways]), is_kept & np.all([way["share"] > 0.0 for way in ways], axis=0),
            ways[1]["pattern"])


def _bend(places) -> np.ndarray:
    """m [N], by which the second half of ways [nodes, N, 3] differs from the first: along an edge a point goes on evenly,
    from one edge to another it leaps."""
    return np.linalg.norm(np.diff(places, n=2, axis=0)[0], axis=-1)


def _parabolas(share) -> np.ndarray:
    """Weights [N, nodes] of parabolas through the nodes, at shares [N] of the frame."""
    factors = [[(share - other) / (node - other) for other in NODES if other != node] for node in NODES]
    return np.stack([np.prod(of_node, axis=0) for of_node in factors], axis=-1)
