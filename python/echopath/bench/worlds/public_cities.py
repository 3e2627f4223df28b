"""Public cities, those that Sionna RT ships: seconds of traces and of the search for mirrors, and its paths beside ours.

Nothing is marked as a mirror: which planes are larger than their Fresnel zone is found by rays. Sionna RT is asked for its
specular paths at the same frequency, with the same rays and bounces and walls of the same permittivity and conductivity,
half spaces in both programs. It looks for those paths alone; a trace of ours records the echo of every facet that a ray
meets, too, so that beside its seconds stand those of cheaper traces of ours, which say what that costs, and those of a trace
for the same work: where every plane is marked as a mirror, it looks for specular paths alone, by images and field vectors, and
needs next to no rays. Sionna RT's paths are those of geometrical optics, as ours over marked planes are, whose powers are held
against its. Over planes that nobody marked a path that bounces beside an edge has what the edge leaves of the field, and one
whose Fresnel zone does not fit the wall is none by images.
"""
from __future__ import annotations

import dataclasses
import functools
import statistics
import warnings
from pathlib import Path

import numpy as np

import echopath as ep

from ...base.process.stages import StageClock
from ...paths.absent import NO_STRATUM
from ..alone import alone
from ..suite import describe_judged, judged, judged_row
from ..timing import processor_time
from . import peer
from .city import BOUNCES, DELAY_LIMIT, LEVEL_LIMIT_DB

FREQUENCY = 3.5e9        # Hz
RAYS, QUICK_RAYS = 1_000_000, 20_000
SEARCH_RAYS = 1000       # of the search for mirrors, which needs none
CALLS = 3                # of a trace beside the peer's, after the first
MIB = 2.0 ** 20
PICO = 1e12
ALL_MARKED = "all planes marked, "
SPECULAR_ALONE = f"{ALL_MARKED}specular paths alone"
CHEAPER = {"field vectors left out": {"polarization": "scalar"},
           "facets without a footprint": {"polarization": "scalar", "footprint": "none"}}


@dataclasses.dataclass(frozen=True)
class City:
    """A scene below the folder of scenes, and places [3] in m."""

    name: str
    file: str
    transmitter: tuple
    receivers: tuple


MUNICH = City("Munich", "munich/munich.xml", (8.5, 21.0, 27.0),
              ((45.0, 90.0, 1.5), (0.0, 60.0, 1.5), (0.0, 100.0, 1.5), (40.0, 20.0, 1.5), (40.0, 60.0, 1.5),
               (40.0, 100.0, 1.5), (80.0, 60.0, 1.5)))
CITIES = (MUNICH, City("Etoile", "etoile/etoile.xml", (-154.0, 50.0, 20.0), ((-120.0, 50.0, 1.5), (30.0, 40.0, 1.5))),
          City("canyon", "simple_street_canyon/simple_street_canyon.xml", (-33.0, 0.0, 32.0),
               ((20.0, 0.0, 1.5), (-10.0, 3.0, 1.5))))
LIMITS = {f"Munich, {RAYS:,} rays, s": 3.0, "Munich, all planes mirrors, 1 bounce, s": 2.0,
          "Munich, all planes mirrors, 1 bounce, MiB": 500.0}
PEER_LIMITS = {"paths of Sionna RT missing": 0, "delays differ by, ps": DELAY_LIMIT * PICO,
               f"{ALL_MARKED}paths of Sionna RT missing": 0, f"{ALL_MARKED}delays differ by, ps": DELAY_LIMIT * PICO,
               f"{ALL_MARKED}powers differ by, dB": LEVEL_LIMIT_DB, "time over Sionna RT's": 1.0 / 3.0}


def rows(*, quick: bool = False, scenes=None, python: str | None = None) -> list[dict]:
    """A row for each figure: what, measured, limit and whether it holds, or why it was not measured.

    quick: few rays, for a look; scenes: folder of scenes as Sionna RT ships them, None: its own
    python: an interpreter that has sionna-rt, None: this one
    """
    shipped = peer.scenes_of(python)
    folder = Path(scenes) if scenes is not None else shipped
    if folder is None:
        return [{"what": "public cities", "not_measured": f"{peer.missing(python)}, and no folder of its scenes is given"}]
    rays = QUICK_RAYS if quick else RAYS
    found = _alone(folder, rays)
    if shipped is None:
        return [*found, {"what": "beside Sionna RT", "not_measured": peer.missing(python)}]
    return found + _beside_peer(folder, python, rays)


def describe(rows: list[dict]) -> list[str]:
    """What, the figure, its limit, and whether it holds; or why there is none."""
    return (describe_judged([row for row in rows if "measured" in row])
            + [f"{row['what']}: not measured: {row['not_measured']}" for row in rows if "not_measured" in row])


def radar(transmitter, receiver) -> ep.Radar:
    """An isotropic antenna each."""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=64, num_chirps=1)
    return ep.Radar(waveform, transmitters=[ep.Antenna(transmitter)], receivers=[ep.Antenna(receiver)])


def scene_of(file, materials) -> ep.Scene:
    """What one call reads, with these materials."""
    scene = ep.Scene()
    scene.add(ep.load_model(file, materials=materials), name="city")
    return scene


def traced(scene: ep.Scene, transmitter, receiver, **settings) -> ep.Paths:
    """A trace; coarse curves of the scene are nobody's concern here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ep.TessellationWarning)
        return ep.trace(scene, radar(transmitter, receiver), **settings)


def image_paths(paths: ep.Paths) -> np.ndarray:
    """(delay in s, received over transmitted power) of the paths over mirrors alone, [N, 2]."""
    own = np.asarray(paths.stratum) == NO_STRATUM
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    return np.stack([lengths / ep.speed_of_light, np.asarray(paths.power) / paths.radar.transmit_power], axis=1)[own]


def compare(found, peers) -> dict:
    """The peer's paths one by one: how many, how many of ours are not within the limit of delay, the worst differences of delay
    in ps and of power in dB of those that are, and how many of them have the peer's power within its limit.

    found, peers: [N, 2] of (delay in s, power)
    """
    missing, delays, powers = 0, [0.0], [0.0]
    for delay, power in peers:
        gaps = np.abs(np.asarray(found)[:, 0] - delay) if len(found) else np.array([np.inf])
        if gaps.min() > DELAY_LIMIT:
            missing += 1
            continue
        delays.append(gaps.min() * PICO)
        powers.append(abs(10.0 * np.log10(found[int(gaps.argmin())][1] / power)))
    return {"paths of Sionna RT": len(peers), "paths of Sionna RT missing": missing,
            "delays differ by, ps": float(max(delays)), "powers differ by, dB": float(max(powers)),
            "paths of its power": sum(power <= LEVEL_LIMIT_DB for power in powers[1:])}


def _alone(folder: Path, rays: int) -> list[dict]:
    """What needs no peer, each in a process of its own."""
    file = str(folder / MUNICH.file)
    first = alone(_first_trace, file, {}, {"num_rays": rays, "max_bounces": BOUNCES})
    marked = {"*": ep.Material.metal(mirror=True)}
    searches = {bounces: alone(_first_trace, file, marked, {"num_rays": SEARCH_RAYS, "max_bounces": bounces})
                for bounces in (1, BOUNCES)}
    found = {f"Munich, {rays:,} rays, s": first["seconds"], f"Munich, {rays:,} rays, MiB": first["memory"] / MIB,
             "Munich, paths by images": first["by_images"], "Munich, paths": first["paths"]}
    for bounces, one in searches.items():
        name = f"Munich, all planes mirrors, {bounces} bounce{'s' if bounces > 1 else ''}"
        found |= {f"{name}, s": one["seconds"], f"{name}, MiB": one["memory"] / MIB}
    return judged(found, LIMITS)


def _first_trace(file: str, materials: dict, settings: dict) -> dict:
    """Of a scene that was just read: s of the processor, growth of the memory at its peak in bytes, and numbers of paths."""
    clock = StageClock()
    scene = scene_of(file, materials)
    with clock("before"):
        pass
    with clock("trace"):
        paths = traced(scene, MUNICH.transmitter, MUNICH.receivers[0], **settings)
    before, trace = clock.stages
    return {"seconds": trace.processor_seconds, "memory": trace.peak_memory - before.peak_memory, "paths": paths.num_paths,
            "by_images": len(image_paths(paths))}


def _beside_peer(folder: Path, python: str | None, rays: int) -> list[dict]:
    asked = [{"name": city.name, "file": str(folder / city.file), "transmitter": city.transmitter, "receivers": city.receivers}
             for city in CITIES]
    answer = peer.asked(python, {"frequency": FREQUENCY, "bounces": BOUNCES, "rays": rays, "cities": asked})
    return [row for city in CITIES for row in _city_beside_peer(folder, city, rays, answer["cities"][city.name])]


def _city_beside_peer(folder: Path, city: City, rays: int, answer: dict) -> list[dict]:
    materials = {f"*{name}": ep.Material(permittivity=permittivity, conductivity=conductivity)
                 for name, (permittivity, conductivity) in answer["materials"].items()}
    scene = scene_of(folder / city.file, materials)
    settings = {"num_rays": rays, "max_bounces": BOUNCES}
    found = _compared(scene, city, answer["paths"], settings)
    if not found["paths of Sionna RT"]:
        return [{"what": f"{city.name}, beside Sionna RT", "not_measured": "it finds no path"}]
    marked = scene_of(folder / city.file, {name: material.replace(mirror=True) for name, material in materials.items()})
    of_search = settings | {"num_rays": SEARCH_RAYS}
    of_marked = _compared(marked, city, answer["paths"], of_search)
    found |= {f"{ALL_MARKED}{what}": value for what, value in of_marked.items()}
    found |= _over_peer(functools.partial(traced, scene, city.transmitter, city.receivers[0], **settings),
                        functools.partial(traced, marked, city.transmitter, city.receivers[0], polarization="jones", **of_search),
                        statistics.median(answer["seconds"]))
    return [judged_row(f"{city.name}, {what}", value, PEER_LIMITS.get(what)) for what, value in found.items()]


def _compared(scene: ep.Scene, city: City, peers: list, settings: dict) -> dict:
    """`compare` over all receivers: sums of paths, and the worst differences."""
    compared = [compare(image_paths(traced(scene, city.transmitter, place, polarization="jones", **settings)),
                        np.reshape([path[:2] for path in paths], (-1, 2))) for place, paths in zip(city.receivers, peers)]
    return {what: (sum if what.startswith("paths") else max)(one[what] for one in compared) for what in compared[0]}


def _over_peer(trace, search, peers: float) -> dict:
    """Medians of the processor's time of traces over the peer's, in s: as they come, of cheaper kinds, and of the search for
    specular paths alone."""
    kinds = {"time over Sionna RT's": trace}
    kinds |= {f"time over its, {name}": functools.partial(trace, **keywords) for name, keywords in CHEAPER.items()}
    kinds[f"time over its, {SPECULAR_ALONE}"] = search
    return {"time of Sionna RT, its median, s": peers} | {
        name: statistics.median(processor_time(work)[0] for _ in range(CALLS)) / peers for name, work in kinds.items()}
