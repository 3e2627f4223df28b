"""Beams in plain NumPy, from the definition of the signal alone: s ~ e^{-jk x.u} e^{+j 2 pi f_D t}."""
import numpy as np

C = 299792458.0


def unit(azimuth, elevation):
    """Unit vectors [..., 3] toward angles in rad: azimuth to the left of +x, elevation up."""
    return np.stack([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
                     np.sin(elevation) + 0.0 * azimuth], axis=-1)


def channel_positions(radar):
    """[tx, rx, 3] in m."""
    transmitters = np.array([antenna.position for antenna in radar.transmitters])
    receivers = np.array([antenna.position for antenna in radar.receivers])
    return transmitters[:, None] + receivers[None]


def still_values(spectrum, radar, velocity=None):
    """values [tx, rx, velocity, range] without what motion adds between slots.

    velocity: m/s, for all cells, None: that of each
    """
    wavelength = C / (radar.waveform.start_frequency + 0.5 * radar.waveform.bandwidth)
    doppler = 2.0 * (spectrum.velocity if velocity is None else np.full(len(spectrum.velocity), velocity)) / wavelength
    slot = np.arange(len(radar.transmitters))[:, None] * radar.waveform.chirp_interval
    return spectrum.values * np.exp(-2j * np.pi * slot * doppler)[:, None, :, None]


def steering(radar, azimuth, elevation):
    """e^{-jk x.u} [directions, tx, rx] for angles [directions] in rad."""
    wavelength = C / (radar.waveform.start_frequency + 0.5 * radar.waveform.bandwidth)
    return np.exp(-2j * np.pi / wavelength * np.einsum("tri,di->dtr", channel_positions(radar), unit(azimuth, elevation)))


def bartlett(spectrum, radar, azimuth, elevation):
    """Power [directions, velocity, range] in W of the mean over channels."""
    beams = steering(radar, azimuth, elevation).conj() / channel_positions(radar)[..., 0].size
    return np.abs(np.einsum("dtr,trvn->dvn", beams, still_values(spectrum, radar))) ** 2


def capon(snapshots, own, steering_vectors, loading):
    """Power [directions] in W that w = R^-1 a / (a^H R^-1 a) passes of `own` [channels], R the mean over `snapshots`
    [channels, K] plus `loading` times its mean diagonal; steering_vectors [directions, channels]."""
    covariance = snapshots @ snapshots.conj().T / snapshots.shape[1]
    covariance += loading * np.trace(covariance).real / len(covariance) * np.eye(len(covariance))
    inverse = np.linalg.inv(covariance)
    weights = [inverse @ a / (a.conj() @ inverse @ a) for a in steering_vectors]
    return np.array([abs(w.conj() @ own) ** 2 for w in weights])
