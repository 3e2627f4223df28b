"""Which effects a run models, which it leaves out, and why."""
from __future__ import annotations

import dataclasses

import numpy as np

from . import _core
from .tessellation import COHERENT_SHARE, coherent_share

MAX_NAMES = 3        # of meshes or materials in a reason
CO_POLARISED = 0.99  # cosine between the polarisations of two antennas that count as equal


@dataclasses.dataclass(frozen=True)
class Effect:
    """One effect. name; modelled: whether it is; reason: what in the scene or the settings asks for it, or why not."""

    name: str
    modelled: bool
    reason: str


def effects(scene, radar, *, max_bounces: int = 4, footprint: str = "second_order",
            polarization: str = "scalar") -> list[Effect]:
    """Which effects a trace of `scene` with `radar` models, and why.

    max_bounces, footprint, polarization: as in `trace`. Returns a list [E] of Effect, modelled ones first. Effects that no scene can ask
    for stand last, under reasons that begin with "out of scope" or "not modelled".
    """
    found = [*_of_surfaces(scene, radar, max_bounces, footprint), *_of_motion(scene, radar), *_of_radar(radar),
             *_of_polarization(scene, radar, polarization)]
    return sorted(found, key=lambda effect: not effect.modelled) + OUT_OF_SCOPE


def of_paths(paths) -> list[Effect]:
    """The effects of a trace, from the scene, radar and settings that it recorded."""
    return effects(paths.scene, paths.radar, max_bounces=paths.frame.max_bounces, footprint=paths.frame.footprint,
                   polarization=paths.frame.polarization)


def _of_surfaces(scene, radar, max_bounces: int, footprint: str) -> list[Effect]:
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    meshes, nodes = list(scene.meshes), scene.nodes
    mirrors = [mesh for mesh in meshes if mesh.material.mirror]
    coherent = [mesh for mesh in meshes
                if not mesh.material.mirror and coherent_share(mesh.material, wavelength) >= COHERENT_SHARE]
    diffuse = [mesh for mesh in meshes if coherent_share(mesh.material, wavelength) < 1.0]
    ament = [mesh for mesh in meshes if mesh.material.roughness_height > 0.0]
    dielectric = [mesh for mesh in meshes if mesh.material.permittivity is not None]
    smooth = [mesh for mesh in meshes if nodes[mesh.node].smooth]
    filtered = bool(coherent) and footprint != "none"
    return [
        Effect("coherent physical optics", bool(coherent),
               _because(coherent, "no mesh but mirrors has a specular share")),
        Effect("footprint filter", filtered, _footprint_reason(coherent, footprint)),
        Effect("smooth surfaces", bool(smooth), _because(smooth, "no mesh is marked smooth")),
        Effect("diffuse lobe, random phase", bool(diffuse), _because(diffuse, "no material scatters diffusely")),
        Effect("loss by roughness height", bool(ament), _because(ament, "no material has a roughness height")),
        Effect("Fresnel coefficients", bool(dielectric), _because(dielectric, "no material has a permittivity")),
        Effect("mirrors by images", bool(mirrors), _because(mirrors, "no mesh is marked mirror")),
        Effect("multiple bounces", max_bounces > 1, f"max_bounces = {max_bounces}"),
        Effect("Russian roulette behind bounce 3", max_bounces > 3, f"max_bounces = {max_bounces}"),
        Effect("reversals behind small mirrors", bool(coherent) and max_bounces > 1,
               _reversal_reason(coherent, max_bounces)),
    ]


def _footprint_reason(coherent, footprint: str) -> str:
    if footprint == "none":
        return 'footprint = "none"'
    return f"{footprint.replace('_', ' ')}, for the coherent echoes" if coherent else "no coherent echoes to filter"


def _reversal_reason(coherent, max_bounces: int) -> str:
    if max_bounces == 1:
        return "max_bounces = 1"
    return "surfaces below their Fresnel zone" if coherent else "no coherent echoes"


def _of_motion(scene, radar) -> list[Effect]:
    moving = [mesh for mesh in scene.meshes if scene.is_moving(mesh.id)]
    own = radar.motion is not None
    reason = "; ".join(["the radar moves"] * own + [_because(moving, "")] * bool(moving)) or "nothing moves"
    deforming = [mesh for mesh in moving if scene.nodes[mesh.node].sequence is not None]
    return [Effect("motion over chirps", bool(moving) or own, reason),
            Effect("motion within chirps", bool(moving) or own, "linear; with motion" if moving or own else reason),
            Effect("deforming meshes", bool(deforming), _because(deforming, "no mesh has a vertex sequence"))]


def _of_radar(radar) -> list[Effect]:
    slots = len(radar.transmitters)
    antennas = [*radar.transmitters, *radar.receivers]
    shaped = sorted({antenna.pattern.kind for antenna in antennas} - {"isotropic"})
    phased = any(antenna.pattern.table_phase is not None for antenna in antennas)
    return [Effect("antenna patterns", bool(shaped), ", ".join(shaped) or "all antennas are isotropic"),
            Effect("antenna phases", phased, "phase of a table" if phased else "no pattern has a phase"),
            Effect("transmitters take turns (TDM)", slots > 1, f"{slots} transmitter" + "s" * (slots > 1)),
            Effect("real samples", radar.waveform.real, "real = true" if radar.waveform.real else "complex samples")]


def _of_polarization(scene, radar, polarization: str) -> list[Effect]:
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    turning = [mesh for mesh in scene.meshes
               if mesh.material.cross_polarization > 0.0 and coherent_share(mesh.material, wavelength) < 1.0]
    if polarization == "jones":
        return [Effect("polarised fields", True, 'polarization = "jones"'),
                Effect("depolarisation by roughness", bool(turning),
                       _because(turning, "no rough material has a cross_polarization"))]
    reason = "each hit takes the TE or TM coefficient nearer to the polarization"
    if _has_crossed_antennas(radar):
        reason += '; antennas of other polarisation count as co-polarised: polarization = "jones" tells them apart'
    return [Effect("polarised fields", False, reason),
            Effect("depolarisation by roughness", False, 'polarization = "scalar"')]


def _has_crossed_antennas(radar) -> bool:
    first, *others = [_polarization_of(antenna) for antenna in [*radar.transmitters, *radar.receivers]]
    return any(abs(first @ other) < CO_POLARISED for other in others)


def _polarization_of(antenna) -> np.ndarray:
    """[3] unit vector in the radar's frame."""
    real, imaginary = antenna.orientation[0], antenna.orientation[1:]
    cross = np.cross(imaginary, antenna.polarization)
    return antenna.polarization + 2.0 * (real * cross + np.cross(imaginary, cross))


def _because(meshes, otherwise: str) -> str:
    """Count of meshes and the first of their names, or what to say when there are none."""
    if not meshes:
        return otherwise
    names = list(dict.fromkeys(mesh.name for mesh in meshes))
    shown = ", ".join(names[:MAX_NAMES]) + (", ..." if len(names) > MAX_NAMES else "")
    return f"{len(meshes)} mesh{'es' * (len(meshes) > 1)}: {shown}"


OUT_OF_SCOPE = [
    Effect("transmission through sheets", False, "not modelled"),
    Effect("edge diffraction, creeping waves", False, "out of scope: deep sidelobes are wrong, main lobes within 1 dB"),
    Effect("atmospheric loss", False, "not modelled: about 0.4 dB/km"),
    Effect("phase noise, quantisation", False, "not modelled"),
    Effect("interference", False, "not modelled"),
]

# The core knows no reports: its record of paths gets this property here.
_core.Paths.effects = property(of_paths, doc="list of Effect: what the trace modelled, what not, and why")
