"""Coefficients of reflection in records that are renewed, beside closed forms at the angles of their time."""
import numpy as np
import pytest

import echopath as ep
from support.radars import FREQUENCY, build_radar, chirp_times

PERMITTIVITY = 4.0
ASIDE = 3.0            # m, of each antenna from the middle
SPEED = 1000.0         # m/s, so that angles change within a frame
TIMES = np.array([0.0, 1.3e-3, 4.1e-3, 6.3e-3])
ROUNDING = 1e-6        # of weights, which are stored in single precision
IMAGES = 65535         # stratum of paths that no ray found
LEVEL, UPRIGHT = (0, 1, 0), (0, 0, 1)


def fresnel(cosine, across, permittivity=PERMITTIVITY):
    """The coefficient of a half space; across: the field stands across the plane of incidence (TE), else in it (TM)."""
    behind = np.sqrt(permittivity - 1.0 + cosine**2)
    if across:
        return (cosine - behind) / (cosine + behind)
    return (permittivity * cosine - behind) / (permittivity * cosine + behind)


def receding_wall(mirror, polarization, field, pane=False):
    """Paths over a wall of glass in front of two antennas, which goes away; pane: behind one of glass."""
    radar = build_radar(transmitters=[ep.Antenna((0, -ASIDE, 0), polarization=field)],
                        receivers=[ep.Antenna((0, ASIDE, 0), polarization=field)], num_chirps=64, chirp_interval=100e-6)
    scene = ep.Scene()
    plate = ep.Mesh([[0, -9, -9], [0, 9, -9], [0, 9, 9], [0, -9, 9]], [[0, 1, 2], [0, 2, 3]])
    scene.add(plate, name="wall", material=ep.Material(permittivity=PERMITTIVITY, mirror=mirror), position=(2, 0, 0),
              speed=SPEED)
    if pane:
        scene.add(plate, name="pane", material="glass_pane", position=(1, 0, 0))
    paths = ep.trace(scene, radar, num_rays=2000, max_bounces=1, polarization=polarization)
    return paths.select(paths.stratum == IMAGES)


def cosines(paths, times):
    away = 2.0 + SPEED * np.asarray(times)
    return away / np.hypot(away, ASIDE)


@pytest.mark.parametrize("mirror", [True, False])
@pytest.mark.parametrize("field", [UPRIGHT, LEVEL])
def test_weights_of_images_take_the_angles_of_their_time(mirror, field):
    paths = receding_wall(mirror, "scalar", field)
    assert paths.num_paths == 1
    then = fresnel(cosines(paths, paths.frame.trace_time), field == UPRIGHT)
    for time in TIMES:
        expected = paths.weight[0] * fresnel(cosines(paths, time), field == UPRIGHT) / then
        assert ep.renew(paths, time=time).paths.weight[0] == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("mirror", [True, False])
def test_coefficients_that_change_are_renewed_unless_told_how_often(mirror):
    """In the middle of each of the 16 stretches the echo is Fresnel's coefficient over the way, from near Brewster's angle on."""
    paths = receding_wall(mirror, "scalar", LEVEL)
    cube = ep.synthesize(paths, retrace="invalid")
    size = np.sqrt(np.mean(np.abs(cube[0, 0])**2, axis=1)).reshape(16, 4)[:, 1:3].mean(axis=1)
    times = chirp_times(paths.radar).reshape(16, 4).mean(axis=1)
    coefficient = np.abs(fresnel(cosines(paths, times), False))
    expected = coefficient / np.hypot(2.0 + SPEED * times, ASIDE)
    np.testing.assert_allclose(size / size[-1], expected / expected[-1], rtol=2e-3)
    assert coefficient[-1] / coefficient[0] > 2.0


@pytest.mark.parametrize("is_from_behind", [False, True])
def test_weights_of_a_wall_of_two_layers_are_those_of_the_side_that_is_seen(is_from_behind):
    """Each layer is so thick and lossy that nothing comes back from beyond it."""
    sides = 4.0 - 0.4j, 12.0 - 1.2j
    radar = build_radar([ep.Antenna((0, -ASIDE, 0), polarization=UPRIGHT)], [ep.Antenna((0, ASIDE, 0), polarization=UPRIGHT)],
                        num_chirps=64, chirp_interval=100e-6)
    turned = [[0, 1, 2], [0, 2, 3]] if is_from_behind else [[0, 2, 1], [0, 3, 2]]  # else the normal is toward the radar
    scene = ep.Scene()
    scene.add(ep.Mesh([[0, -9, -9], [0, 9, -9], [0, 9, 9], [0, -9, 9]], turned), name="wall", position=(2, 0, 0), speed=SPEED,
              material=ep.Material(layers=[ep.Layer(0.2, side) for side in sides]))
    paths = ep.trace(scene, radar, num_rays=2000, max_bounces=1, polarization="scalar")
    seen = sides[is_from_behind]
    assert paths.num_paths == 1
    for time in (paths.frame.trace_time, *TIMES):
        expected = fresnel(cosines(paths, time), True, seen)
        assert ep.renew(paths, time=time).paths.weight[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("mirror", [True, False])
def test_matrices_of_images_take_the_angles_of_their_time(mirror):
    paths = receding_wall(mirror, "jones", UPRIGHT)
    assert paths.num_paths == 1
    for time in TIMES:
        cosine = cosines(paths, time)
        level = np.abs(fresnel(cosine, False))  # horizontal axes turn round with the wave
        renewed = ep.renew(paths, time=time).paths
        assert renewed.weight[0] == paths.weight[0]
        assert np.ravel(renewed.jones[0])[[1, 2]] == pytest.approx(0.0, abs=ROUNDING)
        assert np.ravel(renewed.jones[0])[3] == pytest.approx(fresnel(cosine, True), rel=ROUNDING)
        assert np.abs(np.ravel(renewed.jones[0])[0]) == pytest.approx(level, rel=ROUNDING)


def test_matrices_of_what_passes_a_pane_keep_what_it_makes_of_polarisations():
    paths = receding_wall(True, "jones", UPRIGHT, pane=True)
    through = paths.select("T P ('wall') P R")
    renewed = ep.renew(through, time=paths.frame.trace_time + 1e-9).paths
    assert renewed.num_paths == 1 and np.allclose(renewed.jones, through.jones, rtol=0, atol=ROUNDING)
    cosine = cosines(paths, paths.frame.trace_time)
    assert abs(abs(np.ravel(through.jones[0])[0]) - abs(fresnel(cosine, False))) > 1e-2  # without the pane


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_record_hardly_later_is_as_it_was(polarization):
    """Before walls, antennas and smooth bodies that stand apart, some of whose rims are met."""
    upright = [ep.Antenna((0, aside, 0), polarization=UPRIGHT) for aside in (0.2, -0.2)]
    radar = build_radar(upright[:1], upright[1:], motion=ep.LinearMotion(velocity=(20, 0, 0)))
    scene, glass = ep.Scene(), ep.Material(permittivity=PERMITTIVITY)
    for k, place in enumerate([(4, 0.3, 0), (4.5, -0.4, 0.2), (5, 0, -0.3)]):
        scene.add(ep.actors.sphere(0.25, edge=0.03), name=f"ball {k}", smooth=True, material=glass, position=place)
    scene.add(ep.actors.wall(9, 3), name="wall", material=ep.Material(permittivity=5.0, mirror=True), position=(3, 2, 0))
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=2, polarization=polarization)
    direct = paths.select(paths.num_bounces == 1)  # points of reflection between bounces are found anew, with other hits
    later = ep.renew(direct, time=paths.frame.trace_time + 1e-9).paths
    direct = direct.select(np.isin(direct.offsets, later.offsets))  # a few more hide behind the rims
    assert later.num_paths == direct.num_paths > 1000
    kept = np.asarray(direct.weight) if polarization == "scalar" else np.asarray(direct.jones)
    found = np.asarray(later.weight) if polarization == "scalar" else np.asarray(later.jones)
    assert np.max(np.abs(found - kept)) < 1e-4 * np.max(np.abs(kept))


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_ball_of_glass_that_spins_has_the_echo_of_one_at_rest(polarization):
    radius, distance, num_chirps = 0.1, 5.0, 16
    radar = build_radar(num_chirps=num_chirps, chirp_interval=400e-6, bandwidth=0.3e9, num_samples=16)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius, edge=0.01), name="ball", smooth=True, material=ep.Material(permittivity=PERMITTIVITY),
              position=(distance, 0, 0), motion=ep.LinearMotion(angular_velocity=(0, 0, 2 * np.pi / radar.frame_duration)))
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=1, polarization=polarization)
    cube = ep.synthesize(paths, retrace="invalid", keyframes=num_chirps)[0, 0]
    nearest, wavelength = distance - radius, ep.speed_of_light / FREQUENCY
    at_rest = np.sqrt(radar.transmit_power) * fresnel(1.0, True) * wavelength / (4 * np.pi) * radius / (2 * nearest * distance)
    errors = np.sqrt(np.mean(np.abs(cube) ** 2, axis=1)) / abs(at_rest) - 1
    # The rim of the record faces the radar in some chirps; with the coefficients of the record these are 0.2 and 0.6.
    assert np.median(np.abs(errors)) < 0.02 and np.sqrt(np.mean(errors**2)) < 0.2


def test_a_metal_corner_that_turns_about_the_line_of_sight_turns_polarisations_by_twice_its_angle():
    rate = 40.0  # rad/s
    upright, level = (ep.Antenna((0, 0, 0), polarization=field) for field in (UPRIGHT, LEVEL))
    radar = build_radar([upright], [upright, level], num_chirps=16, chirp_interval=400e-6, bandwidth=0.3e9, num_samples=16)
    scene = ep.Scene()
    scene.add(ep.actors.dihedral(0.3), name="corner", material="metal", position=(5, 0, 0),
              motion=ep.LinearMotion(angular_velocity=(rate, 0, 0)))
    paths = ep.trace(scene, radar, num_rays=5000, max_bounces=2, polarization="jones")
    same, across = np.mean(ep.synthesize(paths, retrace="invalid", keyframes=16)[0], axis=2)
    angles = np.arctan(-np.real(across / same)) / 2
    assert angles == pytest.approx(rate * chirp_times(radar), abs=2e-3)  # of 0.25 rad


def test_weights_of_a_body_beside_a_mirror_take_the_angles_at_which_the_image_lights_it():
    """A glass ball drives past a metal wall, y = 2, by which the wave comes: at each of its points by Fresnel's formula."""
    radius, center, speed = 0.25, np.array([4.0, 0.0, 0.0]), 500.0
    radar = build_radar([ep.Antenna((0, 0, 0), polarization=UPRIGHT)], num_chirps=64, chirp_interval=100e-6)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius, edge=0.03), name="ball", smooth=True, material=ep.Material(permittivity=PERMITTIVITY),
              position=center, motion=ep.LinearMotion(velocity=(-speed, 0, 0)))
    scene.add(ep.actors.wall(40, 3), name="wall", material=ep.Material.metal(mirror=True), position=(3, 2, -1))
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=2, polarization="scalar").select("T 'wall' S'ball' R")
    later = paths.frame.trace_time + 2e-3
    renewed = ep.renew(paths, time=later).paths
    kept = paths.select(np.isin(paths.offsets, renewed.offsets))
    assert kept.num_paths == renewed.num_paths

    def coefficients(time):
        line = kept.points(time)[kept.offsets + 1] - (0, 4, 0)
        outward = kept.points(time)[kept.offsets + 1] - center + (speed * time, 0, 0)
        cosine = -np.sum(line * outward, axis=1) / np.linalg.norm(line, axis=1) / np.linalg.norm(outward, axis=1)
        return fresnel(cosine, True), (np.abs(outward[:, 2]) < 0.02 * radius) & (cosine > 0.3)

    (then, is_met_then), (now, is_met_now) = coefficients(paths.frame.trace_time), coefficients(later)
    is_level = is_met_then & is_met_now  # where the upright field lies across the plane of incidence
    assert is_level.sum() > 5 and np.ptp(now[is_level] / then[is_level]) > 0.1
    assert (renewed.weight / kept.weight)[is_level] == pytest.approx((now / then)[is_level], rel=0.01)
