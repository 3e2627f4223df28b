"""What lies too far away, or too late, is refused by name. Each of these once ended the process or was silently wrong."""
import os
import re
import subprocess
import sys

import pytest

import echopath as ep
from support.radars import build_radar

# The far things are tried in a process of their own, which a failed assertion of Embree ends.
CASES = {
    "rcs of a body in micrometres": (r"scene: must fit into a sphere of radius 7\d\d\.?\d* m at this frequency "
                                     r"\(are its vertices in metres\?\), radius in m, got 1000000"),
    "vertex": r"scene: from the radar, vertices of mesh 'far' must lie within 1e12 m, got .*1e\+19",
    "whole scene": r"scene: what is next to the radar must lie within 1e12 m, got .*1e\+19",
    "radar": r"position: the antenna must lie within 1e12 m, got 1e\+20 +0 +0",
    "velocity": r"velocity: must be below the speed of light, 299792458 m/s, got 1e\+39",
    "turning": r"scene: the motions of mesh '.*' must turn it by finite angles, got one that is not finite at 0\.00\d+ s",
    "start_time": r"start_time: must lie in \[-1e10, 1e10\] s, got 1e\+40",
    "start_time without a motion": r"start_time: must lie in \[-1e10, 1e10\] s, got 1e\+40",
    "time of a renewal": r"time: must be a finite number in s, got nan",
    "time of a visibility": r"time: must (lie in|be finite).*got 1e\+40|time: .*e\+39",
}

SCRIPT = """
import numpy as np
import echopath as ep
from support.radars import build_radar
from support.shapes import METAL, plate, sphere

def one(mesh, name="near", **place):
    scene = ep.Scene()
    scene.add(mesh, name=name, material=METAL, **place)
    return scene

def trace(scene, transmitters=((0, 0, 0),), **settings):
    return ep.trace(scene, build_radar(transmitters, num_chirps=8), num_rays=1000, **settings)

near = plate((9, 0, 0), (-1, 0, 0), 1.0)
spread = one(near)
spread.add(ep.Mesh([[5, 0, 0], [0, 1e19, 0], [1e19, 0, 0]], [[0, 1, 2]]), name="far", material=METAL)
cases = {
    "rcs of a body in micrometres": lambda: ep.rcs(one(sphere((0, 0, 0), 1e6, 1)), frequency=77e9, incidence=(1, 0, 0),
                                                   num_rays=1000),
    "vertex": lambda: trace(spread),
    "whole scene": lambda: trace(one(plate((1e19, 0, 0), (-1, 0, 0), 1e18))),
    "radar": lambda: trace(one(near), ((1e20, 0, 0),)),
    "velocity": lambda: trace(one(near, motion=ep.LinearMotion(velocity=(1e39, 0, 0)))),
    "turning": lambda: trace(one(near, motion=ep.LinearMotion(angular_velocity=(0, 0, 1e300)))),
    "start_time": lambda: trace(one(near, motion=ep.LinearMotion(velocity=(1, 0, 0))), start_time=1e40),
    "start_time without a motion": lambda: trace(one(near), start_time=1e40),
    "time of a renewal": lambda: ep.renew(trace(one(near)), time=float("nan")),
    "time of a visibility": lambda: ep.visibility(one(near), build_radar(), time=1e40),
}
for name, case in cases.items():
    try:
        answer = repr(case())
    except ValueError as error:
        answer = str(error)
    print(name + "|" + answer, flush=True)
"""


@pytest.fixture(scope="module")
def answers(request):
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=120,
                          cwd=request.path.parents[2])
    return dict(line.split("|", 1) for line in done.stdout.splitlines()) | {"the end": done.stderr}


@pytest.mark.parametrize("case", CASES)
def test_what_is_out_of_range_is_refused_by_name(answers, case):
    assert re.match(CASES[case], answers.get(case, answers["the end"]))


def test_more_rays_than_there_may_be_are_refused_at_once():
    scene, radar = a_sphere()
    for settings in ({"num_rays": 10**18}, {"target_error_db": 1.0, "max_rays": 10**18}):
        told = f"{list(settings)[-1]}: must be a whole number from 1 to 10000000000, got 1000000000000000000"
        with pytest.raises(ValueError, match=told):
            ep.trace(scene, radar, **settings)


@pytest.mark.skipif(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") > 300e9, reason="the memory would do")
def test_rays_whose_record_the_memory_cannot_hold_are_refused_at_once():
    """Each of them meets the sphere around the radar: at least 32 bytes of a path and 16 of a hit."""
    scene, radar = a_sphere()
    told = r"num_rays: must be so few that their paths, about \d{3,4} GB, fit into the memory .*, got 10000000000$"
    with pytest.raises(ValueError, match=told):
        ep.trace(scene, radar, num_rays=10**10, max_bounces=1)


def a_sphere():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(3.0), name="around", material="concrete", position=(-3.0, 0.0, 0.0))
    return scene, build_radar()
