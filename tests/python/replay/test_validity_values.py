"""Reports of validity as values: bits, empty ones, bad arguments."""
from importlib.resources import as_file

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from support import shapes
from support.slides import ROUGH, Ball
from support.validity_scenes import BALL, radar_of, scene_of

GRAZING_SHARE = 1e-6         # of the power: rays within single precision of a facet's horizon
LITTLE = 1e-5           # rad: hits in single precision; 4e-7 found


def test_nothing_is_wrong_at_the_trace_time():
    """Each leg that the trace recorded is free, each point of reflection in its place, between co-located antennas."""
    rough = ep.Material(permittivity=5 - 0.3j, scattering=0.5)
    scene = shapes.scene_of(ball=(shapes.sphere((5, 0, 1), 0.5, 4), rough, True),
                            plate=(shapes.plate((4.5, 1.5, 1), (-1, -0.3, 0), 1.0), rough),
                            dish=(Ball((6, -2, 1), (-0.9, 0.3, 0.3), -2.0).mesh(12), rough, True),
                            floor=(shapes.rectangle((0, -4, 0), (9, 0, 0), (0, 8, 0)), rough.replace(mirror=True)),
                            wall=(shapes.rectangle((0, 4, 0), (9, 0, 0), (0, 0, 5)), rough.replace(mirror=True)))
    paths = ep.trace(scene, radar_of(), num_rays=20000)
    report = ep.validity(paths, times=[paths.frame.trace_time])
    assert paths.num_bounces.max() == 4
    for share in ("slid", "left", "blocked", "turned", "new_surface"):
        assert getattr(report.shares, share) < GRAZING_SHARE, share
    assert report.rms_phase_error < LITTLE


@pytest.mark.hard
def test_report_has_the_same_bits_for_any_number_of_threads():
    with as_file(data_folder("scenes") / "street.toml") as path:
        street = ep.load_scene(path)
    paths = ep.trace(street.scene, street.radar, settings=street.trace, num_rays=1000, max_bounces=2)
    middle = paths.frame.trace_time
    texts = []
    try:
        for threads in (1, 3):
            ep.set_num_threads(threads)
            report = ep.validity(paths, street.radar, times=[0.3 * middle, 1.7 * middle], arrays=True)
            texts.append((str(report), report.shares.power, report.shares.blocked, report.power.tobytes(),
                          report.blocked.tobytes()))
    finally:
        ep.set_num_threads(0)
    assert texts[0] == texts[1]


@pytest.mark.hard
def test_no_paths_make_an_empty_report():
    scene = scene_of(ball=(BALL, ROUGH, (6, 0, 1), None))
    paths = ep.trace(scene, radar_of(), num_rays=1000).select("T 'ball' 'ball' R")
    report = ep.validity(paths, arrays=True)
    assert report.ok and report.num_paths == 0 and report.power.shape == (0,)


@pytest.mark.parametrize("keywords, error, text", [
    ({"times": [np.nan]}, ValueError, "times"),
    ({"time": [0.0]}, TypeError, "times"),
])
def test_bad_arguments_are_named(keywords, error, text):
    paths = ep.trace(scene_of(ball=(BALL, ROUGH, (6, 0, 1), None)), radar_of(), num_rays=100)
    with pytest.raises(error, match=text):
        ep.validity(paths, **keywords)
