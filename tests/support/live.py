"""Live scenes and how far their views are from fresh ones."""
import functools

import numpy as np
import pytest

import echopath as ep
from echopath.bench.crowd import scenes

RAYS = 1000


@functools.cache
def _coarse_scene() -> ep.Scene:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scenes, "BODY_EDGE", 4.0 * scenes.BODY_EDGE)
        patch.setattr(scenes, "TUBE_EDGE", 4.0 * scenes.TUBE_EDGE)
        patch.setattr(scenes.shapes, "capsule", lambda radius, length, edge=None, made=scenes.shapes.capsule: made(
            radius, length, edge=0.5 * radius))
        patch.setattr(ep.actors, "pedestrian", functools.partial(ep.actors.pedestrian, edge=0.06))
        patch.setattr(scenes, "street_objects", scenes.street_objects.__wrapped__)  # what it keeps is for others
        return scenes.street(mirrors=True)


def coarse_street() -> tuple[ep.Scene, ep.Radar]:
    """The crowded street of the benchmark, with wide triangles and 8 chirps: a fresh scene of its fine ones takes far longer to
    be made than its rays to be traced, and a view is that of a fresh scene however wide they are."""
    radar = scenes.radar()
    return ep.Scene(_coarse_scene()), radar.replace(waveform=radar.waveform.replace(num_chirps=8))


def make_live(**keywords) -> ep.Live:
    return ep.Live(*coarse_street(), **{"num_rays": RAYS} | keywords)


def difference(view: ep.LiveView, fresh: ep.LiveView) -> float:
    return float(np.abs(view.cube - fresh.cube).max() / np.abs(fresh.cube).max())


def fresh_view(live: ep.Live, **keywords) -> ep.LiveView:
    return ep.Live(live.scene, live.radar, **{"num_rays": live.num_rays} | keywords).update()
