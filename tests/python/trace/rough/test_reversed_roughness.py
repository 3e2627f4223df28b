"""A rough patch behind an unflagged wall: each order of both has the share of the angle at which the wave comes to the patch."""
import numpy as np
import pytest

import echopath as ep

FREQUENCY, HEIGHT = 24e9, 0.6e-3
RADAR = ep.Radar(ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=16, num_chirps=2),
                 transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
WALL = ep.Mesh([(7, -9, -5), (7, 9, -5), (7, 9, 9), (7, -9, 9)], [(0, 3, 2), (0, 2, 1)])


def scattered(cosine: float) -> float:
    """S^2 by Ament's factor."""
    return 1.0 - np.exp(-(4.0 * np.pi * FREQUENCY / ep.speed_of_light * HEIGHT * cosine) ** 2)


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_way_back_over_a_wall_has_the_roughness_of_its_own_angle(polarization):
    scene = ep.Scene()
    scene.add(ep.actors.ground((0.1, 0.1)), name="patch", material=ep.Material(conductor=True, roughness_height=HEIGHT),
              position=(5, 0, -1))
    scene.add(WALL, name="wall", material="metal")
    paths = ep.trace(scene, RADAR, num_rays=100_000, polarization=polarization)
    first, last = (ep.received_power(paths.select(order)).power for order in ("T D'patch' 'wall' R", "T 'wall' D'patch' R"))
    straight, over_wall = 1.0 / np.hypot(5.0, 1.0), 1.0 / np.hypot(9.0, 1.0)  # cosines, of the radar and of its image at x = 14
    assert first / last == pytest.approx(scattered(straight) / scattered(over_wall), rel=0.02)
