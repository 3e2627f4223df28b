"""Live scenes and how far their views are from fresh ones."""
import numpy as np

import echopath as ep
from echopath.bench.live.edits import crowded_street

RAYS = 1000


def make_live(**keywords) -> ep.Live:
    scene, radar, _ = crowded_street()
    return ep.Live(scene, radar.replace(waveform=radar.waveform.replace(num_chirps=8)), **{"num_rays": RAYS} | keywords)


def difference(view: ep.LiveView, fresh: ep.LiveView) -> float:
    return float(np.abs(view.cube - fresh.cube).max() / np.abs(fresh.cube).max())


def fresh_view(live: ep.Live, **keywords) -> ep.LiveView:
    return ep.Live(live.scene, live.radar, **{"num_rays": live.num_rays} | keywords).update()
