"""Latitude, longitude and height in a level plane: east, north and up about an origin on the WGS 84 ellipsoid.

Closed forms of B. Hofmann-Wellenhof, H. Lichtenegger, J. Collins, "GPS: Theory and Practice" (5th ed. 2001), section 10.2.
"""
import numpy as np

SEMI_MAJOR_AXIS = 6378137.0            # m, of WGS 84
FLATTENING = 1.0 / 298.257223563
SQUARED_ECCENTRICITY = FLATTENING * (2.0 - FLATTENING)


def east_north_up(latitude, longitude, height, origin):
    """Positions [N, 3] in m of latitudes, longitudes in degrees and heights in m [N], about an origin of these three."""
    about = _earth_centred(*(np.atleast_1d(np.float64(value)) for value in origin))
    phi, lam = np.radians(origin[0]), np.radians(origin[1])
    axes = np.array([[-np.sin(lam), np.cos(lam), 0.0],
                     [-np.sin(phi) * np.cos(lam), -np.sin(phi) * np.sin(lam), np.cos(phi)],
                     [np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)]])
    return (_earth_centred(latitude, longitude, height) - about) @ axes.T


def _earth_centred(latitude, longitude, height):
    """[N, 3] in m, x through latitude and longitude 0, z through the north pole."""
    phi, lam = np.radians(latitude), np.radians(longitude)
    across = SEMI_MAJOR_AXIS / np.sqrt(1.0 - SQUARED_ECCENTRICITY * np.sin(phi) ** 2)
    level = (across + height) * np.cos(phi)
    along = (across * (1.0 - SQUARED_ECCENTRICITY) + height) * np.sin(phi)
    return np.stack([level * np.cos(lam), level * np.sin(lam), along], axis=-1)
