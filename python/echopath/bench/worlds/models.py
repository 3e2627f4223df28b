"""Files of others, each read in one call: what they hold, and what that takes; of bodies that an animation moves, whether the
parts add up and move as it says.

The truth of speeds are differences of posed vertices over a short time, of one point of each part; beside it stands the speed
that the phases of its diffuse echo tell (those of coherent echoes turn as their launch cells move over the facets, too). A file
that is refused counts as one that does not load, whatever the reason; the reason stands beside it.
"""
from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

import echopath as ep

from ...readers.load import is_foreign
from ..suite import describe_judged, judged_row
from ..timing import processor_time

STEP = 1e-4              # s, of differences
FREQUENCY = 77e9         # Hz
RAYS, QUICK_RAYS = 30_000, 2_000
SIZE, DISTANCE = 1.8, 5.0  # m: bodies are read as if so large, and seen from so far
CHIRPS, INTERVAL = 8, 3e-5  # s from chirp to chirp
BEGIN = 0.3              # of the animation, where the frame begins
ROUGH = ep.Material(reflectivity=0.5, scattering=0.7)
MOVING = 0.05            # m/s: what is slower than this hardly shows
LIMITS = {"files refused": 0, "sum of parts over whole - 1": 1e-12, "speeds of echoes differ by, m/s": 0.05}


def rows(*, quick: bool = False, folder=None) -> list[dict]:
    """A row for each file below a folder, and judged ones of what all of them reach.

    quick: few rays, for a look; folder: None: nothing is read; `meshes` beside a Mitsuba scene are those that it reads
    """
    if folder is None:
        return [{"what": "models", "not_measured": "no folder of models is given"}]
    files = [file for file in sorted(Path(folder).rglob("*")) if file.is_file() and is_foreign(file)]
    scenes = {file.parent for file in files if file.suffix.lower() == ".xml"}
    files = [file for file in files if not any(above.name == "meshes" and above.parent in scenes for above in file.parents)]
    if not files:
        return [{"what": "models", "not_measured": f"{folder} holds no file of a kind that is read"}]
    found = [_file_row(file, str(file.relative_to(folder)), QUICK_RAYS if quick else RAYS) for file in files]
    return found + [_judged(found, what, limit) for what, limit in LIMITS.items()]


def describe(rows: list[dict]) -> list[str]:
    """A line for each file, then the figures of all of them."""
    files = [_told(row) for row in rows if "file" in row]
    lines = [f"{'file':<52}{'meshes':>8}{'triangles':>11}{'seconds':>9}{'1 - sum':>10}{'speeds':>8}", *files] if files else []
    lines += [f"{row['what']}: not measured: {row['not_measured']}" for row in rows if "not_measured" in row]
    return lines + describe_judged([row for row in rows if "measured" in row])


def _told(row: dict) -> str:
    if "refused" in row:
        return f"{row['file']:<52}refused: {row['refused']}"
    line = f"{row['file']:<52}{row['meshes']:>8,}{row['triangles']:>11,}{row['seconds']:>9.2f}"
    return line + (f"{row['sum of parts over whole - 1']:>10.1e}{row['speeds of echoes differ by, m/s']:>8.3f}"
                   if "speeds of echoes differ by, m/s" in row else "")


def _judged(found: list[dict], what: str, limit: float) -> dict:
    """The row of the worst of all files."""
    if what == "files refused":
        return judged_row(what, sum("refused" in row for row in found), limit)
    values = [row[what] for row in found if what in row]
    return judged_row(what, max(values), limit) if values else {"what": what, "not_measured": "no body that deforms has an echo"}


def _file_row(file: Path, name: str, rays: int) -> dict:
    try:
        seconds, model = processor_time(lambda: ep.load_model(file))
    except (OSError, ValueError, ModuleNotFoundError) as error:
        return {"file": name, "refused": str(error)}
    row = {"file": name, "seconds": seconds, "meshes": sum(node.mesh is not None for node in model.nodes),
           "triangles": model.num_triangles, "animations": len(model.animations), "notes": list(model.notes)}
    return row | _moving_row(model, file, rays) if any(node.deformation is not None for node in model.nodes) else row


def _moving_row(model: ep.Model, file: Path, rays: int) -> dict:
    """Whether the parts of a body that deforms add up, and how far speeds of their echoes are from those of its vertices."""
    scene, radar = _seen(file, model)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ep.TessellationWarning)
        paths = ep.trace(scene, radar, num_rays=rays, max_bounces=2, start_time=BEGIN * model.duration)
    whole = ep.synthesize(paths, radar)
    limbs = _meets(paths, range(0, len(scene.meshes), 2))
    apart = ep.synthesize(paths.select(limbs), radar) + ep.synthesize(paths.select(~limbs), radar)
    speeds = [_speeds(scene, radar, paths, index) for index in _strongest_diffuse(paths)]
    row = {"parts with an echo": len(speeds), "parts that move": sum(abs(posed) > MOVING for _, posed in speeds)}
    if speeds:
        row |= {"sum of parts over whole - 1": float(np.linalg.norm(apart - whole) / np.linalg.norm(whole)),
                "speeds of echoes differ by, m/s": max(abs(echo - posed) for echo, posed in speeds)}
    return row


def _seen(file: Path, model: ep.Model):
    """(scene, radar) of a body that is as high as a person, from ahead."""
    low, high = _bounds(model)
    size = float((high - low).max())
    scene = ep.Scene()
    scene.add(ep.load_model(file, unit=model.unit * SIZE / size, loop=True), name="body", material=ROUGH)
    middle = 0.5 * (low + high) * SIZE / size
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=5e8, num_samples=64, num_chirps=CHIRPS,
                                chirp_interval=INTERVAL)
    return scene, ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()],
                           position=middle + np.array([DISTANCE, 0.5, 0.2]), yaw=np.pi)


def _bounds(model: ep.Model):
    """Corners [3], [3] in m of what is seen at the begin of its animation."""
    scene = ep.Scene()
    scene.add(model, name="body")
    points = np.concatenate([scene.world_vertices(mesh) for mesh in range(len(scene.meshes))])
    return points.min(axis=0), points.max(axis=0)


def _meets(paths: ep.Paths, meshes) -> np.ndarray:
    """Which paths, bool [P], meet one of the meshes."""
    first, bounces = np.asarray(paths.offsets, int), np.asarray(paths.num_bounces, int)
    among = np.concatenate([[0], np.cumsum(np.isin(np.asarray(paths.mesh_id), list(meshes)))])
    return among[first + bounces] > among[first]


def _strongest_diffuse(paths: ep.Paths) -> list[int]:
    """Of each mesh that has a diffuse path of one bounce, the index of the strongest."""
    direct, best = np.flatnonzero((np.asarray(paths.num_bounces) == 1) & (np.asarray(paths.diffuse) == 1)), {}
    power = np.asarray(paths.power)
    for index in direct[np.argsort(power[direct])]:
        best[int(paths.mesh_id[paths.offsets[index]])] = int(index)
    return list(best.values())


def _speeds(scene: ep.Scene, radar: ep.Radar, paths: ep.Paths, index: int) -> tuple[float, float]:
    """Radial speeds in m/s of one path's point, receding positive: by the phases of its echo, and by posed vertices."""
    mask = np.zeros(paths.num_paths, bool)
    mask[index] = True
    chirps = ep.synthesize(paths.select(mask), radar)[0, 0]
    turn, wave = np.angle((chirps[1:] * chirps[:-1].conj()).sum()), radar.waveform
    echo = turn * ep.speed_of_light / (4.0 * np.pi * (wave.start_frequency + 0.5 * wave.bandwidth) * INTERVAL)
    hit, time = int(paths.offsets[index]), paths.frame.trace_time
    before, after = (_distance(scene, radar, paths, hit, time + away) for away in (-STEP, STEP))
    posed = (after - before) / (2.0 * STEP)
    return float(echo), float(posed)


def _distance(scene: ep.Scene, radar: ep.Radar, paths: ep.Paths, hit: int, time: float) -> float:
    """Of the point of a hit from the radar in m, as its triangle is posed."""
    mesh, u, v = int(paths.mesh_id[hit]), float(paths.u[hit]), float(paths.v[hit])
    corners = scene.world_vertices(mesh, time)[scene.meshes[mesh].triangles[int(paths.triangle_id[hit])]]
    return float(np.linalg.norm((1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2] - radar.position))
