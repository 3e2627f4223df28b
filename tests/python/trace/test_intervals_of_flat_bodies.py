"""Boxes aslant: their planes send back next to nothing, and intervals of few rays say so."""
import numpy as np
import pytest

import echopath as ep
from echopath.bench.physics import targets

FREQUENCY = 15e9  # Hz, low enough for the rays of the truth
FEW, MANY = 800, 1_000_000
WIDE_DB = 6.0     # the upper end over the truth, at most: launch cells alone may hold 13 to 17 dB more than there is


def _power(yaw, num_rays, pole=False, wall=False, of="T 'box' R"):
    scene = ep.Scene()
    scene.add(ep.actors.box((1.2, 2.0, 1.5)), name="box", material=ep.Material.metal(), position=(12.0, 0.5, 0.3), yaw=yaw)
    if wall:
        scene.add(ep.actors.box((40.0, 0.2, 8.0)), name="wall", material=ep.Material.metal().replace(mirror=True),
                  position=(10.0, 4.0, 0.0))
    if pole:
        scene.add(ep.actors.box((0.1, 0.1, 4.0)), name="pole", material=ep.Material(reflectivity=0.5, scattering=1.0),
                  position=(6.0, 0.2, 0.0))
    antennas = [ep.Antenna((0.0, 0.0, 0.0))]
    radar = ep.Radar(targets.radar().waveform.replace(start_frequency=FREQUENCY), transmitters=antennas, receivers=antennas)
    return ep.received_power(ep.trace(scene, radar, num_rays=num_rays, max_bounces=3 if wall else 1).select(of))


@pytest.mark.parametrize("yaw", [0.4, 0.8])
def test_few_rays_bound_what_boxes_aslant_send_back(yaw):
    truth, few = _power(yaw, MANY), _power(yaw, FEW)
    assert truth.interval_db < 1.0 and not few.resolved
    assert few.low <= truth.power <= few.high <= 10.0 ** (0.1 * WIDE_DB) * truth.power


def test_what_hides_a_part_of_a_plane_adds_rims():
    truth, few = _power(0.7, MANY, pole=True), _power(0.7, FEW, pole=True)
    assert truth.interval_db < 1.0 and few.low <= truth.power <= few.high


def test_few_rays_do_not_bound_a_box_that_faces_the_radar_by_its_rims():
    truth, few = _power(np.arctan2(0.5, 12.0), MANY), _power(np.arctan2(0.5, 12.0), FEW)
    assert few.low <= truth.power <= few.high


@pytest.mark.parametrize("ghost", ["T 'box' 'wall' R", "T 'wall' 'box' R", "T 'wall' 'box' 'wall' R"])
def test_few_rays_bound_what_boxes_aslant_send_back_over_a_wall(ghost):
    truth, few = (_power(0.8, num_rays, wall=True, of=ghost) for num_rays in (MANY, FEW))
    assert truth.interval_db < 1.5 and not few.resolved
    assert few.low <= truth.power <= few.high <= 10.0 ** (0.1 * WIDE_DB) * truth.power
