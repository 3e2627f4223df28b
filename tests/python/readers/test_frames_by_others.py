"""Frame files read by h5py and NumPy alone, as the page of the format says: whoever has no Echopath finds the same target."""
import h5py
import numpy as np
import pytest

import echopath as ep

RANGE, AZIMUTH, SPEED, RADIUS = 3.2, 0.3, 1.5, 0.1  # m, rad, m/s of a sphere that recedes, m
LIGHT = 299792458.0


KINDS = {"plain": {}, "uneven": {"extra_idle": [3e-6, 0.0, 1e-6]}, "real": {"real": True}, "falling": {"bandwidth": -1e9},
         "real_falling": {"bandwidth": -1e9, "real": True}}


@pytest.fixture(scope="module", params=KINDS.values(), ids=KINDS)
def file(request, tmp_path_factory):
    waveform = ep.ChirpSequence(**{"start_frequency": 77e9, "bandwidth": 1e9, "num_samples": 64, "sampling_rate": 8e6,
                                   "num_chirps": 32, "chirp_interval": 2e-5} | request.param)
    half = 0.5 * waveform.wavelength
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 2 * half * m, 0.0)) for m in range(3)],
                     receivers=[ep.Antenna((0.0, half * n, 0.0)) for n in range(2)], transmit_power=1.0)
    scene, ahead = ep.Scene(), np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    scene.add(ep.actors.sphere(RADIUS), name="Kugel, grün", material=ep.Material.metal(), smooth=True, position=RANGE * ahead,
              motion=ep.LinearMotion(velocity=SPEED * ahead))
    path = tmp_path_factory.mktemp("others") / "frame.h5"
    ep.simulate(scene, radar, num_rays=2000, guard=False).save(path)
    with h5py.File(path) as opened:
        yield opened


def delays(file) -> np.ndarray:
    """[tx, rx, chirp, sample] s, of the way to the sphere and back at the time of each sample."""
    waveform, turns = file["radar/waveform"], len(file["radar/transmitters/position"])
    rate, chirps = waveform.attrs["sampling_rate"], waveform.attrs["num_chirps"]
    idle = file["radar/extra_idle"][:] if "radar/extra_idle" in file else np.zeros(1)
    gaps = waveform.attrs["chirp_interval"] + np.resize(idle, chirps * turns)
    begins = (np.cumsum(gaps) - gaps).reshape(chirps, turns).T
    times = begins[..., None] + np.arange(waveform.attrs["num_samples"]) / rate
    centre = (RANGE + SPEED * times)[..., None] * [np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0]
    to, back = (file[f"radar/{name}/position"][:] for name in ("transmitters", "receivers"))
    outward = np.linalg.norm(centre - to[:, None, None], axis=-1)[:, None]
    homeward = np.linalg.norm(centre[:, None] - back[:, None, None], axis=-1)
    return (outward + homeward - 2.0 * RADIUS) / LIGHT


def test_samples_have_the_phases_that_the_page_tells(file):
    """The whole cube is one constant, that of the reflection, times the tones of the way."""
    cube, waveform = file["signal/cube"][:], file["radar/waveform"].attrs
    time, delay = np.arange(waveform["num_samples"]) / waveform["sampling_rate"], delays(file)
    slope = waveform["bandwidth"] * waveform["sampling_rate"] / waveform["num_samples"]
    phase = 2.0 * np.pi * (waveform["start_frequency"] * delay + slope * time * delay - 0.5 * slope * delay**2).ravel()
    tones = np.stack([np.cos(phase), np.sin(phase)] if waveform["real"] else [np.exp(1j * phase)], axis=1)
    explained = np.linalg.norm(np.linalg.qr(tones)[0].conj().T @ cube.ravel()) / np.linalg.norm(cube)
    assert explained == pytest.approx(1.0, abs=1e-3)


def test_spectra_are_transforms_of_the_samples(file):
    cube, found = file["signal/noisy_cube"][:], file["spectra/values"][:]
    windows = [np.hanning(count + 1)[:-1] for count in cube.shape[2:]]  # the settings' "hann", periodic
    weights = np.outer(*(window / window.sum() for window in windows))
    falls = file["radar/waveform"].attrs["bandwidth"] < 0.0
    over_samples = np.fft.ifft(cube * weights, norm="forward") if falls else np.fft.fft(cube * weights)
    told = np.fft.fftshift(np.fft.fft(over_samples, axis=2), axes=2)
    if file["radar/waveform"].attrs["real"]:
        told = np.sqrt(2.0) * told[..., :cube.shape[3] // 2]
    np.testing.assert_allclose(found, told, rtol=0.0, atol=1e-12 * abs(found).max())


def test_the_strongest_cell_is_that_of_the_target(file):
    values, velocity, distance = (file[f"spectra/{name}"][:] for name in ("values", "velocity", "range"))
    power = (abs(values)**2).mean(axis=(0, 1))
    row, column = np.unravel_index(power.argmax(), power.shape)
    assert abs(distance[column] - (RANGE - RADIUS)) < 0.6 * (distance[1] - distance[0])
    assert abs(velocity[row] - SPEED) < 0.6 * (velocity[1] - velocity[0])
    waveform = file["radar/waveform"].attrs
    wavelength = LIGHT / (waveform["start_frequency"] + 0.5 * waveform["bandwidth"])
    to, back = (file[f"radar/{name}/position"][:, 1] for name in ("transmitters", "receivers"))
    idle = file["radar/extra_idle"][:].mean() if "radar/extra_idle" in file else 0.0
    later = np.arange(len(to)) * (waveform["chirp_interval"] + idle)
    angles = np.radians(np.arange(-80.0, 80.0, 0.5))
    ways = np.sin(angles)[:, None, None] * (to[:, None] + back) - 2.0 * SPEED * later[:, None]
    beams = abs((values[:, :, row, column] * np.exp(2j * np.pi * ways / wavelength)).sum(axis=(1, 2)))
    assert angles[beams.argmax()] == pytest.approx(AZIMUTH, abs=np.radians(2.0))


def test_texts_are_read_as_such(file):
    assert file["scene/name"].asstr()[:].tolist() == ["Kugel, grün"]
