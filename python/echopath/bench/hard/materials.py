"""Materials at the ends of their ranges."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from ..physics.read_outs import rcs_of
from .case import Cases
from .scenes import METAL, decibels, make_radar, scene_of, traced

cases = Cases("Materials")


def reflectivity_of(material) -> float:
    """Power reflectivity at normal incidence: the echo of a plate over that of metal."""
    levels = [rcs_of(traced(scene_of(("plate", shapes.plate(0.1, 0.1), one, {"position": (200.0, 0.0, 0.0)})), make_radar(),
                            4096,
                            max_bounces=1), 200.0) for one in (material, METAL)]
    return levels[0] / levels[1]


def fresnel_power(permittivity: complex) -> float:
    root = np.sqrt(np.complex128(permittivity))
    return abs((1 - root) / (1 + root)) ** 2


@cases("permittivities from 1e-9 to 1e18",
       "huge, tiny, lossless, negative: power reflectivity beside Fresnel's at normal incidence",
       bound=1e-3, unit="of full reflection",
       broken="the other root of a lossy permittivity: 0.040")
def permittivities() -> float:
    values = (1e18 - 1e18j, 1e18, 1e-9, 1e-9 - 1e-12j, 4 - 1e-15j, 4.0, 4 - 4e9j, -4 - 0.1j, -4 - 1e-12j, 2.0)
    return max(abs(reflectivity_of(ep.Material(permittivity=value)) - fresnel_power(value)) for value in values)


@cases("permittivity 1", "what is like air does not reflect", bound=1e-30, unit="of metal",
       broken="Fresnel's root in single precision: 3.6e-21")
def like_air() -> float:
    return reflectivity_of(ep.Material(permittivity=1.0))


@cases("a dielectric sphere", "both polarisations meet at its middle: level of pi a^2 times Fresnel's reflectivity",
       bound=0.1, unit="dB",
       broken="TM not turned where waves turn back: 30 dB")
def dielectric_sphere() -> float:
    ball = ("ball", shapes.sphere(0.3, subdivisions=40), ep.Material(permittivity=4 - 0.2j),
            {"position": (200.0, 0.0, 0.0), "smooth": True})
    truth = np.pi * 0.3 ** 2 * fresnel_power(4 - 0.2j)
    return max(abs(decibels(rcs_of(traced(scene_of(ball), make_radar(), 2 ** 14, max_bounces=1, polarization=model),
                                   200.0) / truth))
               for model in ("scalar", "jones"))


@cases("bad materials", "permittivity 0, NaN, of gain; scattering above 1: refused by name", bound=0.0, unit="accepted",
       broken="no validation: 8")
def bad_materials() -> float:
    wrong = [("permittivity", dict(permittivity=0.0)), ("permittivity", dict(permittivity=complex(np.nan, 0))),
             ("permittivity", dict(permittivity=4 + 1j)), ("permittivity", dict(permittivity=np.inf)),
             ("scattering", dict(reflectivity=0.5, scattering=1.0001)), ("reflectivity", dict(reflectivity=1.0 + 1e-9)),
             ("roughness_height", dict(reflectivity=0.5, roughness_height=-1e-9)),
             ("conductivity", dict(permittivity=4.0, conductivity=np.nan))]
    accepted = 0
    for name, keywords in wrong:
        try:
            ep.Material(**keywords)
            accepted += 1
        except ValueError as error:
            accepted += name not in str(error)
    return float(accepted)
