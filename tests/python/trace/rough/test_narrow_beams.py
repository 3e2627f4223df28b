"""Rays in the beams of antennas: the level of a ground that a narrow beam lights, beside the integral of the radar equation."""
import numpy as np
import pytest

import echopath as ep
from support.shapes import lambert

RAYS, SEEDS = 20_000, 4
HEIGHT, HALF, REFLECTIVITY = 5.0, 400.0, 0.3  # m, m, of power
WAVEFORM = ep.ChirpSequence(start_frequency=76e9, bandwidth=100e6, num_samples=64, sampling_rate=10e6, num_chirps=4)


def radar_of(pitch_deg, **widths_deg):
    beam = ep.GaussianBeam(**{axis: np.radians(width) for axis, width in widths_deg.items()})
    antennas = [ep.Antenna((0.0, 0.0, HEIGHT), pattern=beam, pitch=np.radians(pitch_deg))]
    return ep.Radar(WAVEFORM, transmitters=antennas, receivers=antennas)


def field_with_plates():
    """A ground that is one mesh, and ten plates, to which most rays go."""
    scene = ep.Scene()
    scene.add(ep.actors.ground(2.0 * HALF), name="field", material=lambert(REFLECTIVITY))
    for k in range(10):
        scene.add(ep.actors.plate(1.0, 2.0), name=f"plate_{k}", material="metal", position=(20.0 + 10.0 * k, 5.0 * k - 25.0, 1.0))
    return scene


def power_of_ground(radar, pitch_deg):
    """W, by the sum over rings and sectors: what a Lambert surface sends back of what it meets."""
    edges, azimuth = np.geomspace(0.5, HALF, 1000), np.radians(np.linspace(-90.0, 90.0, 721))
    distance, around = np.meshgrid(0.5 * (edges[1:] + edges[:-1]), azimuth, indexing="ij")
    area = distance * np.diff(edges)[:, None] * (azimuth[1] - azimuth[0])
    way = np.stack([distance * np.cos(around), distance * np.sin(around), np.full_like(distance, -HEIGHT)], axis=-1)
    length = np.linalg.norm(way, axis=-1)
    cosine, sine = np.cos(np.radians(pitch_deg)), np.sin(np.radians(pitch_deg))
    turned = way @ np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]]) / length[..., None]
    gain = np.abs(radar.transmitters[0].pattern.field(turned.reshape(-1, 3)).reshape(length.shape)) ** 2
    wavelength = ep.speed_of_light / WAVEFORM.centre_frequency
    falls_in = HEIGHT / length
    back = REFLECTIVITY / np.pi * falls_in ** 2 * gain ** 2 * (wavelength / (4.0 * np.pi)) ** 2 / length ** 4
    return radar.transmit_power * np.sum(back * area)


@pytest.mark.parametrize("azimuth, elevation, pitch", [(3.0, 10.0, -5.0), (5.0, 5.0, -10.0), (10.0, 10.0, -5.0)])
def test_rays_know_what_a_narrow_beam_lights(azimuth, elevation, pitch):
    """Before rays followed beams, errors of 1 to 8 dB."""
    radar = radar_of(pitch, azimuth=azimuth, elevation=elevation)
    scene, expected = field_with_plates(), power_of_ground(radar, pitch)
    for seed in range(1, SEEDS + 1):
        paths = ep.trace(scene, radar, num_rays=RAYS, max_bounces=1, seed=seed)
        found = ep.received_power(paths.select("T 'field' R"))
        assert abs(10.0 * np.log10(found.power / expected)) < 0.15
        assert found.low < expected < found.high < 1.2 * found.low


def test_a_focus_about_the_beam_has_half_of_the_field_of_view():
    paths = ep.trace(field_with_plates(), radar_of(-5.0, azimuth=5.0, elevation=5.0), num_rays=RAYS, max_bounces=1)
    view = {stratum.name: stratum for stratum in paths.frame.strata if stratum.name.startswith("field of view")}
    focus = view["field of view, focus 1"]
    assert focus.num_rays == pytest.approx(view["field of view"].num_rays, rel=0.05)
    np.testing.assert_allclose(focus.axis, [np.cos(np.radians(5.0)), 0.0, -np.sin(np.radians(5.0))], atol=1e-12)


@pytest.mark.parametrize("widths", [{"azimuth": 60.0, "elevation": 10.0}, {"azimuth": 120.0, "elevation": 60.0}])
def test_wide_beams_leave_the_rays_as_they_are(widths):
    paths = ep.trace(field_with_plates(), radar_of(-5.0, **widths), num_rays=RAYS, max_bounces=1)
    assert not any("field of view, focus" in stratum.name for stratum in paths.frame.strata)
