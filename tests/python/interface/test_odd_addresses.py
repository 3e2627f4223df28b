"""Arrays whose numbers stand at odd addresses, as in the midst of a binary file, are read as any others."""
import numpy as np
import pytest

import echopath as ep
from echopath import _core

RANDOM = np.random.default_rng(1)
RADAR = ep.Radar(ep.ChirpSequence(num_samples=32, num_chirps=16), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
POWER = RANDOM.random((3, 16, 33))
PLATE = ep.Scene()
PLATE.add(ep.Mesh([[5, -1, -1], [5, 1, -1], [5, 1, 1], [5, -1, 1]], [[0, 2, 1], [0, 3, 2]]), name="plate",
          material=ep.Material(permittivity=4, scattering=0.5))
PATHS = ep.trace(PLATE, RADAR, num_rays=500)


def at_odd_address(array: np.ndarray) -> np.ndarray:
    """The same numbers behind a header of one byte."""
    moved = np.frombuffer(b"." + array.tobytes(), array.dtype, offset=1).reshape(array.shape)
    assert moved.flags.c_contiguous and moved.ctypes.data % 2 == 1
    return moved


@pytest.mark.parametrize("call, values", [
    (lambda cube: ep.range_doppler(cube, RADAR).values, RANDOM.normal(size=(1, 1, 16, 64)).view(complex)),
    (_core.power_shares, POWER),
    (lambda power: _core.strongest_part(power, np.ones(power.shape[1:], bool)), POWER),
    (lambda label: _core.label_regions(label, POWER[0], 3, False), RANDOM.integers(-1, 3, POWER.shape[1:], dtype=np.int16)),
    (lambda points: ep.Mesh(points, [[0, 1, 2]]).vertices, RANDOM.random((3, 3))),
    (lambda groups: [each.power for each in ep.received_powers(PATHS, groups, 2)],
     RANDOM.integers(0, 2, PATHS.num_paths, dtype=np.uint32)),
], ids=["cube", "shares", "strongest", "regions", "mesh", "groups"])
def test_arrays_at_odd_addresses_are_read_as_others(call, values):
    expected, found = call(values), call(at_odd_address(values))
    assert np.array_equal(expected, found) if isinstance(expected, np.ndarray) else expected == found


def test_structured_arrays_at_odd_addresses_are_read_as_others():
    state = PATHS.__getstate__()
    made = ep.Paths.from_arrays(**state | {"hits": at_odd_address(state["hits"])})
    assert PATHS.num_paths > 100 and np.array_equal(made.hits, PATHS.hits) and np.array_equal(made.amplitude, PATHS.amplitude)
