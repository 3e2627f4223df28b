"""A rectangular guide that is shorted at some depth, by the sum of its modes; Kirchhoff's approximation in its mouth."""
import numpy as np

STEPS = 2000  # of the integrals across the guide


def echo_of_shorted_guide(wavenumber, width, height, depth, azimuth, polarization):
    """Field of the monostatic echo, complex [N], m, whose phase counts from the middle of the mouth; e^{jwt}.

    The mouth lies across x and opens toward +x, `width` along y and `height` along z, m. azimuth: [N], rad, in the xy-plane;
    polarization: "vv" or "hh". E (hh) or H (vv) along y has the form cos or sin(n pi y/W) sin or cos(m pi z/H); by
    reciprocity a mode sends what it receives. Modes that are cut off are left out.
    """
    is_horizontal = polarization == "hh"
    y = ((np.arange(STEPS) + 0.5) / STEPS - 0.5) * width
    field = np.zeros(len(azimuth), complex)
    for n in range(0 if is_horizontal else 1, int(wavenumber * width / np.pi) + 1):
        across = n * np.pi / width
        form = np.cos(across * (y + 0.5 * width)) if is_horizontal else np.sin(across * (y + 0.5 * width))
        along_y = (form * np.exp(1j * wavenumber * np.sin(azimuth)[:, None] * y)).sum(axis=1) * width / STEPS
        square = wavenumber ** 2 - across ** 2
        for m in range(1, int(height * np.sqrt(square) / np.pi) + 1, 2) if is_horizontal else (0,):
            travel = np.sqrt(square - (m * np.pi / height) ** 2)
            along_z, norm_z = (2.0 * height / (m * np.pi), height / 2.0) if is_horizontal else (height, height)
            received = along_y * along_z * (square / wavenumber + travel * np.cos(azimuth))
            norm = travel * square * (form ** 2).sum() * width / STEPS * norm_z
            field += -1j * wavenumber ** 2 / (8.0 * np.pi) * received ** 2 / norm * np.exp(-2j * travel * depth)
    return field
