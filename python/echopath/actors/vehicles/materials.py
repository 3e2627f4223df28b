"""Materials of road vehicles at 77 GHz that stand for more than one surface; the others are in echopath.materials."""
from ... import _core

# A painted bumper over its metal crash beam, effective: the beam's echo after two passes through painted plastic of 1.5 dB
# each, which is in the middle of what bumpers are said to lose (1 to 2 dB one way for suitable paints; quoted from memory).
BUMPER = _core.Material(reflectivity=0.5, scattering=0.3)
# A slotted cover before radiator fins and pipes, effective: half of the power comes back, in all directions.
GRILLE = _core.Material(reflectivity=0.5, scattering=1.0)
# Floor panels, exhaust and axles, effective: metal whose relief is large against the wavelength.
UNDERSIDE = _core.Material(conductor=True, scattering=1.0)
# A lamp's clear cover over metallised reflectors that point ahead but are faceted, effective.
LAMP = _core.Material(reflectivity=0.3, scattering=1.0)

BODY_MATERIALS = {"body": "metal", "glass": "glass", "bumper": BUMPER, "bumper/grille": GRILLE, "lamp": LAMP,
                  "underside": UNDERSIDE}
