"""Standard errors of cell labels against the spread over independent traces."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

BATCHES, SEEDS = 8, 40
NUM_RAYS = 4000  # with 1500, 60 of a batch on the metal sphere, batches share the aliases of their lattices
PARTS = {"rough": "T 'rough' R", "metal": "T 'metal' R"}
# Variances over 40 seeds have an error of 22 % each; cells of one echo vary together, so that their mean has hardly less.
SPREAD = 0.45
SPECKLE = 0.2  # relative, three times the error of the mean of 40 independent sums over few cells
HANN_BANDWIDTH = 1.5  # cells
ROUNDING = 1e-9
IMAGE = 1e-3  # relative: what the edges of the mirror leave of its image, and spreading over the array


def make_radar(num_rx=2):
    return build_radar([(0, 0, 1)], [(0, 0.002 * i, 1) for i in range(num_rx)], num_chirps=4, transmit_power=1.0)


def spheres():
    """Two rough spheres and a metal one in the same cells: a smooth echo, and speckle of two strengths."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    scene.add(ep.actors.sphere(0.3), name="rough", material=rough, position=(5, 0.6, 1))
    scene.add(ep.actors.sphere(0.2), name="dull", material=rough, position=(5, -0.6, 1))
    scene.add(ep.actors.sphere(0.1), name="metal", material=ep.Material.metal(), position=(4.9, 0, 1), smooth=True)
    return scene


def labels_of(seed, window="hann", num_rays=NUM_RAYS, **keywords):
    paths = ep.trace(spheres(), make_radar(), num_rays=num_rays, batches=BATCHES, seed=seed)
    return paths, ep.annotate(paths, PARTS, errors=True, window=window, **keywords)


@pytest.fixture(scope="module")
def traces():
    return [labels_of(seed) for seed in range(SEEDS)]


@pytest.fixture(scope="module")
def seeds(traces):
    return [labels for _, labels in traces]


def stacked(seeds, name):
    return np.array([getattr(labels, name) for labels in seeds])


@pytest.mark.parametrize("value, error", [("mean_power", "power_error"), ("mean_share", "share_error")])
def test_errors_are_the_spread_over_seeds(seeds, value, error):
    spread = stacked(seeds, value).var(axis=0, ddof=1)
    stated = (stacked(seeds, error) ** 2).mean(axis=0)
    power = stacked(seeds, "mean_power").mean(axis=0)
    strong = np.broadcast_to(power.sum(axis=0) > 0.05 * power.sum(axis=0).max(), power.shape)
    for part in range(len(power)):
        lit = strong[part] & (power[part] > 0.02 * power.sum(axis=0))
        assert lit.sum() > 3
        ratio = stated[part][lit].mean() / spread[part][lit].mean()
        assert abs(np.log(ratio)) < SPREAD, (part, ratio)


def test_mean_powers_add_up_to_the_received_power(traces):
    """Over all cells, divided by the noise bandwidth of the window on both axes (Parseval); in the mean over the seeds."""
    for part, selection in enumerate([*PARTS.values(), "T 'dull' R"]):
        received = np.mean([ep.received_power(paths.select(selection)).power for paths, _ in traces])
        found = np.mean([labels.mean_power[part].sum() for _, labels in traces]) / HANN_BANDWIDTH**2
        assert abs(found / received - 1) < SPECKLE, part


def test_an_echo_of_a_mirror_is_known_without_an_error():
    """No ray tells it, so that it belongs to every batch: Pt lambda^2 / ((4 pi)^2 (2 d)^2), that of the antenna's image."""
    radar, scene, distance = make_radar(num_rx=1), ep.Scene(), 7.0
    scene.add(ep.actors.sphere(0.3), name="rough", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(5, 0.6, 1))
    scene.add(ep.actors.plate(20.0, 20.0), name="mirror", material=ep.Material.metal(mirror=True), position=(distance, 0, 1),
              yaw=np.pi)
    paths = ep.trace(scene, radar, num_rays=500, batches=2, max_bounces=1)
    found = ep.annotate(paths, {"mirror": "T 'mirror' R"}, errors=True)
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    expected = radar.transmit_power * wavelength**2 / ((4 * np.pi) ** 2 * (2 * distance) ** 2)
    assert found.mean_power[0].sum() / HANN_BANDWIDTH**2 == pytest.approx(expected, rel=IMAGE)
    assert found.power_error[0].max() <= ROUNDING * expected and found.power_error[1].max() > 0


def test_labels_of_the_map_do_not_depend_on_the_errors_asked_for():
    paths, labels = labels_of(1)
    plain = ep.annotate(paths, PARTS)
    for name in ("power", "share", "dominant", "mask", "object_map"):
        assert np.array_equal(getattr(plain, name), getattr(labels, name)), name
    assert plain.certain is None and plain.share_error is None and plain.mean_power is None


def test_certain_cells_keep_their_label_from_seed_to_seed(seeds):
    certain, dominant = stacked(seeds, "certain"), stacked(seeds, "mean_share").argmax(axis=1)
    usual = np.median(dominant, axis=0)
    assert np.any(certain) and np.any(~certain & stacked(seeds, "mask"))
    assert not np.any(certain & ~stacked(seeds, "mask"))
    assert np.mean((dominant == usual)[certain]) > 0.95 > np.mean((dominant == usual)[~certain & stacked(seeds, "mask")])


def test_mean_shares_sum_to_one_where_there_is_power(seeds):
    total = seeds[0].mean_share.sum(axis=0)
    assert np.all((np.abs(total - 1) < ROUNDING) | (total == 0)) and np.any(total > 0)


def test_beams_have_errors_where_their_power_is_a_mean():
    paths = ep.trace(spheres(), make_radar(num_rx=4), num_rays=1000, batches=4)
    labels = ep.annotate(paths, PARTS, plane="range_azimuth", angles={"combine": "sum"}, errors=True)
    assert labels.share_error.shape == labels.share.shape and np.any(labels.certain)
    with pytest.raises(ValueError, match="errors: in the plane 'range_azimuth' need angles"):
        ep.annotate(paths, PARTS, plane="range_azimuth", errors=True)


def test_errors_need_the_selections_of_the_parts():
    paths, labels = labels_of(0)
    made = ep.decompose(paths, None, PARTS)
    again = ep.annotate(paths, made, errors=True)
    assert np.array_equal(again.share_error, labels.share_error)
    with pytest.raises(ValueError, match="errors: need the selections"):
        ep.annotate(paths, dict(made), errors=True)


def test_sums_of_no_parts_are_refused():
    none = np.zeros((0, 2, 3, 4))
    with pytest.raises(ValueError, match="parts: must be one or more, got none"):
        ep._core.share_errors(none, none, none, np.full((3, 4), -1, np.int16))
