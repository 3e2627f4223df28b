"""A floor and a wall that is a sheet: one so thick that nothing comes back from its other side is a half space."""
import numpy as np
import pytest

import echopath as ep

PERMITTIVITY = 2.73 - 0.3j
HALF_SPACE = ep.Material(permittivity=PERMITTIVITY)
THICK_SHEET = ep.Material(layers=[ep.Layer(0.3, PERMITTIVITY)])


def powers(material, polarization):
    """W, of the wall, and of the corner in both orders and together."""
    scene = ep.Scene()
    scene.add(ep.actors.ground(6.0), name="floor", material=ep.Material(permittivity=5.3 - 0.3j), position=(1, 0, 0))
    scene.add(ep.Mesh([(4, -3, 0), (4, 3, 0), (4, 3, 3), (4, -3, 3)], [(0, 1, 2), (0, 2, 3)]), name="wall", material=material)
    antenna = ep.Antenna((1, 0, 1.2))
    radar = ep.Radar(ep.ChirpSequence(start_frequency=60e9, bandwidth=1e9, num_samples=128, num_chirps=2),
                     transmitters=[antenna], receivers=[antenna])
    paths = ep.trace(scene, radar, num_rays=20_000, polarization=polarization)
    orders = "T 'wall' R", "T 'wall' 'floor' R", "T 'floor' 'wall' R", "T S S R"
    return np.array([ep.received_power(paths.select(order)).power for order in orders])


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_thick_sheet_on_a_floor_is_a_half_space_in_both_orders(polarization):
    """The order over the wall first had 6 dB less: the floor was taken to end at an edge below the sheet."""
    expected = powers(HALF_SPACE, polarization)
    assert expected[1] == pytest.approx(expected[2], rel=1e-3)
    assert powers(THICK_SHEET, polarization) == pytest.approx(expected, rel=1e-3)
