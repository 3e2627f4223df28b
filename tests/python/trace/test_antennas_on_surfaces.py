"""Antennas that lie exactly on surfaces and rims, as those of a radar that an object is dragged over: echoes stay finite.

Embree ends the whole program over a ray without a direction, as that between an antenna on a plane and its image there.
"""
import numpy as np
import pytest

import echopath as ep

ANTENNA = (0.0, 0.0, 0.5)
CHIRPS = ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=64, sampling_rate=10e6, num_chirps=4,
                          chirp_interval=30e-6)
pytestmark = pytest.mark.filterwarnings("ignore:of [0-9]+ rays:RuntimeWarning")  # that met a surface at the radar
SINGLE = 1e-6  # relative: weights are of single precision
METAL_MIRROR = ep.Material.metal(mirror=True)


def street(material, place, yaw: float = np.pi) -> ep.Scene:
    """A box ahead of the antenna, and a plate of 30 cm through the antenna."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((20.0, 20.0)), name="ground", material="asphalt", position=(0.0, 0.0, -0.1))
    scene.add(ep.actors.box(0.8), name="box", material="metal", position=(5.0, 0.0, 0.5))
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material=material, position=place, yaw=yaw)
    return scene


@pytest.mark.parametrize("receiver", [ANTENNA, (0.0, 0.01, 0.5)], ids=["one place", "1 cm apart"])
@pytest.mark.parametrize("place", [(0.0, 0.15, 0.5), (0.0, 0.0, 0.5), (0.0, 0.15, 0.35)], ids=["rim", "middle", "corner"])
@pytest.mark.parametrize("material", ["metal", "glass_pane", METAL_MIRROR], ids=["metal", "pane", "mirror"])
def test_a_plate_through_an_antenna_leaves_a_finite_signal(material, place, receiver):
    radar = ep.Radar(CHIRPS, transmitters=[ep.Antenna(ANTENNA)], receivers=[ep.Antenna(receiver)])
    frame = ep.simulate(street(material, place), radar, num_rays=200, noise_seed=None)  # with the guard, which looks at legs
    assert np.isfinite(frame.cube).all()


def test_edges_have_no_legs_over_a_plane_on_which_the_antenna_lies():
    """The plane's bounce is at the antenna itself: weights of such paths were no numbers, and refused."""
    scene = ep.Scene()
    scene.add(ep.actors.trihedral(0.3), name="corner", material="metal", position=(6.0, 0.0, 0.5), yaw=np.pi)
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(0.0, 0.15, 0.35), yaw=np.pi)
    radar = ep.Radar(CHIRPS, transmitters=[ep.Antenna(ANTENNA)], receivers=[ep.Antenna(ANTENNA)])
    paths = ep.trace(scene, radar, num_rays=2000, edges=True)
    assert np.isfinite(paths.weight).all()
    assert paths.select("T 'corner' R").num_paths > 0


def test_an_antenna_has_no_image_in_a_mirror_on_which_it_lies():
    """A radar that drives through it: the bounce was beside the antenna, and the echo of a way without a length no number."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=METAL_MIRROR, position=(2.8, -0.5, 0.7))
    antenna = ep.Antenna((2.8, -1 / 3, 0.8666666666666666))
    radar = ep.Radar(CHIRPS, transmitters=[antenna], receivers=[antenna], speed=3.0)
    paths = ep.trace(scene, radar, num_rays=200)
    assert np.isfinite(ep.synthesize(paths, radar)).all()
    assert paths.select("T 'plate' R").num_paths == 0


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_mirror_that_leaves_the_antenna_is_heard_from_a_millimetre_on(polarization):
    """As an object without a position is, whose front begins at the radar. The way to it and back is 2 v t, the echo that of an
    image, wavelength sqrt(P) / (4 pi 2 v t); it was without bounds, and no number at the begin."""
    speed = 100.0
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", speed=speed)
    radar = ep.Radar(CHIRPS, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    paths = ep.trace(scene, radar, num_rays=200, polarization=polarization)
    assert paths.num_paths == 1
    times = np.array([0.0, 1e-9, 4.9e-6, 5.1e-6, 1e-5, 1e-4])  # s: the way is 1 mm long after 5 us
    way = 2.0 * speed * times
    wavelength = ep.speed_of_light / CHIRPS.start_frequency
    image = np.divide(wavelength * np.sqrt(radar.transmit_power), 4.0 * np.pi * way, out=np.zeros(6), where=way > 1e-3)
    np.testing.assert_allclose(np.abs(paths.amplitudes(times, 0, 0)[:, 0]), image, rtol=SINGLE)
    cube = ep.synthesize(paths, radar)
    assert np.abs(cube[0, 0, 0]).max() == 0.0 and 0.0 < np.abs(cube).max() <= image.max()


def test_a_rim_beside_the_antenna_hides_nothing_ahead_of_it():
    """The plane of the plate holds the antenna and its way to the box: the plate ends at the antenna, behind that way."""
    radar = ep.Radar(CHIRPS, transmitters=[ep.Antenna(ANTENNA)], receivers=[ep.Antenna(ANTENNA)])
    levels = []
    for place in ((-0.15, 0.0, 0.5), (-5.0, 0.0, 0.5)):  # at the antenna, and far behind it
        paths = ep.trace(street("metal", place, np.pi / 2), radar, num_rays=500)
        levels.append(np.abs(ep.synthesize(paths.select("T 'box' R"), radar)).max())
    assert levels[0] == pytest.approx(levels[1], rel=1e-3)


def test_why_nothing_is_heard_is_told_where_a_path_begins_at_the_antenna():
    """On the seam of the two triangles of a face of a box, beside a plate behind it."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="concrete", position=(0.8, 3.8, -0.4))
    scene.add(ep.actors.box(1.0), name="box", material=ep.Material(permittivity=5.0, scattering=0.5), position=(-1.7, 1.8, -0.5),
              yaw=np.pi / 2)
    corners = scene.world_vertices(scene["box"].meshes[0].id, 0.0)
    antenna = ep.Antenna(0.5 * (corners[0] + corners[3]))
    radar = ep.Radar(CHIRPS, transmitters=[antenna], receivers=[antenna])
    with pytest.warns(RuntimeWarning, match="no signal of .* paths"):
        frame = ep.simulate(scene, radar, num_rays=200, max_bounces=2, edges=True, polarization="jones", scatterers="surface",
                            noise_seed=None, guard=False)
    assert not frame.cube.any()
