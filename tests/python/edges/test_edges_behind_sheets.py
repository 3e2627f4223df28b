"""Edges behind panes: what both passages leave of each polarisation, by Airy's formula."""
import numpy as np
import pytest

import echopath as ep
from support.behind_sheets import GLASS, INSTANT, LEVEL_E, SLANTED, UPRIGHT, field, over_free, square

ANGLES = 0.03   # of the field: directions that differ over the plate and the array
SAME = 1e-5     # single precision of weights
YAW = 1.1       # rad: at this angle both modes differ by 6 dB


def slanted(angle):
    """Turns rows of coordinates about the x-axis; angle: rad."""
    return np.array([[1, 0, 0], [0, np.cos(angle), np.sin(angle)], [0, -np.sin(angle), np.cos(angle)]])


def edges_of_plate(pane=None, *, transmit, receive=(UPRIGHT, LEVEL_E), mirror=False, **settings):
    """The echoes of a metal strip's rims 8 m away, which stand slanted, so that all channels have their part."""
    scene = ep.Scene()
    strip = ep.Mesh(square(0.05).vertices @ np.diag((1.0, 0.1, 1.0)) @ slanted(0.6), square().triangles)
    scene.add(strip, name="plate", material="metal", position=(8, 0, 1), yaw=0.4)
    if pane is not None:
        scene.add(square(2.0), name="pane", material=pane, position=(6, 0, 1), yaw=YAW)
    if mirror:
        scene.add(ep.actors.ground((40.0, 40.0)), name="ground", material=ep.Material.metal(mirror=True))
    antennas = [[ep.Antenna((0, y, 1), polarization=one) for one in ends] for y, ends in ((0.0, transmit), (0.01, receive))]
    radar = ep.Radar(INSTANT, transmitters=antennas[0], receivers=antennas[1])
    return ep.trace(scene, radar, num_rays=200, edges=True, polarization="jones", **settings)


@pytest.mark.parametrize("transmit", [(UPRIGHT, LEVEL_E), (LEVEL_E, UPRIGHT)])
def test_each_channel_passes_in_its_own_polarisations(transmit):
    te, tm = over_free(YAW)
    of = {UPRIGHT: te, LEVEL_E: tm}
    free = edges_of_plate(transmit=transmit, max_bounces=1).select("T E R")
    behind = edges_of_plate(GLASS, transmit=transmit, max_bounces=1).select("T E R")
    assert behind.num_paths == free.num_paths > 0
    for tx, sent in enumerate(transmit):
        for rx, taken in enumerate((UPRIGHT, LEVEL_E)):
            ratio = field(behind, tx=tx, rx=rx) / field(free, tx=tx, rx=rx) / (of[sent] * of[taken])
            assert abs(ratio - 1.0) < ANGLES, (sent, taken)


def test_a_slanted_wave_is_the_sum_of_both_modes():
    """Linearity: the field from a slanted antenna is that of its two components."""
    paths = edges_of_plate(GLASS, transmit=(SLANTED, UPRIGHT, LEVEL_E), max_bounces=1).select("T E R")
    for rx in range(2):
        slanted, upright, level = (field(paths, tx=tx, rx=rx) for tx in range(3))
        assert slanted == pytest.approx((upright + level) / np.sqrt(2.0), rel=SAME)


def test_the_way_over_a_mirror_passes_in_its_own_polarisation_too():
    """The order of the transmitters is no part of the physics."""
    def channels(transmit):
        paths = edges_of_plate(GLASS, transmit=transmit, mirror=True, max_bounces=3).select("T S E S R")
        assert paths.num_paths > 0 and len(paths.passes) > 0
        return {(sent, rx): field(paths, tx=tx, rx=rx) for tx, sent in enumerate(transmit) for rx in range(2)}

    one, other = channels((UPRIGHT, LEVEL_E)), channels((LEVEL_E, UPRIGHT))
    for channel, there in one.items():
        assert there == pytest.approx(other[channel], rel=SAME)
