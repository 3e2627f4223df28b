"""Effects that surfaces and the number of bounces ask for."""
from __future__ import annotations

import math

import numpy as np

from .. import _core
from .._core import speed_of_light
from ..base.numerics.decibels import in_dbm
from ..base.text.counts import counted
from ..scene.sheets import sheet_coefficients
from ..tracing.edges import edges_matter, strongest_edge
from ..tracing.lost_rays import unfollowed_frusta, unfollowed_sheets
from ..tracing.tessellation import coarse_meshes
from .planes import imaged_planes
from .rules import Case, rule

VALID_WIDTH = 2.0 / 3.0  # wavelengths, from which on physical optics is within 0.6 dB on rods (python/docs/theory/limits.md)
VALID_FOCK = 2.0     # cosine at the point that mirrors over the width of the shadow's edge
MOST_AT_CORNER = 4   # bounces whose orders are told apart from images (trace/mirrors/plane_images.cpp)
TOLD_CHANGE_DB = 0.5  # of what a sheet passes or reflects over the band, from which on it is told
MOST_CHANGE_DB = 40.0  # that is told as a number
MOST_FREQUENCIES = 257
GOLDEN_RATIO = 0.5 * (5.0**0.5 - 1.0)
LEAST_PASSED = 1e-6  # share of the power, below which a sheet counts as opaque
ROULETTE_BOUNCE = 3  # from which on rays end by chance (trace/scatter/lobe_probabilities.h)


@rule("coherent physical optics", "Material.scattering")
def _coherent(case: Case):
    return case.meshes_or(case.coherent, "no mesh but mirrors has a specular share")


@rule("footprint filter", "trace.footprint")
def _footprint(case: Case):
    order = case.settings.footprint
    if order == "none":
        return False, 'footprint = "none"'
    if len(case.coherent) == 0:
        return False, "no coherent echoes to filter"
    kind = {"first_order": "phases linear across a ray's footprint",
            "edges": "quadratic phases on curved surfaces, kept at their edges, flat-top on flat ones",
            "second_order": "quadratic phases on curved surfaces, flat-top on flat ones"}[order]
    return True, f"{order.replace('_', ' ')}, for the coherent echoes: {kind}"


@rule("smooth surfaces", "Node.smooth")
def _smooth(case: Case):
    return case.meshes_or(case.smooth, "no mesh is marked smooth")


@rule("tubes behind curved bounces")
def _curved_bounces(case: Case):
    if case.settings.max_bounces == 1:
        return False, "max_bounces = 1"
    return case.meshes_or(case.curved, "no smooth mesh has a specular share")


@rule("caustics")
def _caustics(case: Case):
    modelled, reason = _curved_bounces(case)
    return modelled, "quarter turns of the phase and a least width of tubes, behind smooth meshes" if modelled else reason


@rule("shadow's edge of curved surfaces")
def _shadow_edge(case: Case):
    if len(case.curved) == 0:
        return False, "no smooth mesh has a specular share"
    if case.settings.footprint not in ("second_order", "edges"):
        return False, f'footprint = "{case.settings.footprint}" leaves the edge wave of physical optics'
    angles = [bistatic_limit_deg(radius, case.radar.waveform.start_frequency) for radius in (0.1, 1.0)]
    return True, ("currents fade out toward it; without creeping waves and the forward lobe, so that bodies of 0.1 m and 1 m "
                  f"radius are wrong beyond {angles[0]:.0f} and {angles[1]:.0f} degrees between both ways")


def bistatic_limit_deg(radius: float, frequency: float) -> float:
    """Angle in degrees between the ways to both antennas from which physical optics errs by some tenths of a decibel on a
    sphere (`echopath bench targets`): there the cosine at the point that mirrors is twice the width (2/ka)^(1/3) of the
    shadow's edge (Fock 1946). 0 where the sphere is too small at any angle."""
    size = 2.0 * math.pi * frequency / speed_of_light * radius
    return 2.0 * math.degrees(math.acos(min(1.0, VALID_FOCK * (2.0 / size) ** (1.0 / 3.0))))


@rule("bodies wide against the wavelength")
def _widths(case: Case):
    if len(case.coherent) == 0:
        return False, "no coherent echoes"
    least = VALID_WIDTH * case.wavelength
    limit = f"narrower than two thirds of a wavelength ({1e3 * least:.2g} mm)"
    narrow = case.coherent[np.array(_core.mesh_widths(case.scene, case.coherent, case.time)) < least]
    if len(narrow) == 0:
        return True, f"none with a specular share is {limit}"
    return False, (f"{case.named(narrow)}, {limit}: without the currents around them metal rods are off by up to 4 dB at a sixth "
                   "of a wavelength, 9 dB at a twelfth")


@rule("check of the tessellation")
def _tessellation(case: Case):
    if len(case.coherent) == 0:
        return False, "no coherent echoes"
    coarse = [one.mesh_id for one in coarse_meshes(case.scene, case.radar.waveform.start_frequency)]
    return True, f"too coarse: {case.named(coarse)}" if coarse else "errs by 0.3 dB at most"


@rule("perfect conductors", "Material.conductor")
def _conductors(case: Case):
    return case.meshes_or(case.of_material(lambda material: material.conductor), "no material is a conductor")


@rule("Fresnel coefficients", "Material.permittivity", "Material.conductivity")
def _fresnel(case: Case):
    dielectric = case.of_material(lambda material: material.permittivity is not None)
    return case.meshes_or(dielectric, "no material has a permittivity")


@rule("constant reflectivity", "Material.reflectivity")
def _reflectivity(case: Case):
    constant = case.of_material(lambda material: material.reflectivity is not None)
    return case.meshes_or(constant, "no material has a reflectivity")


@rule("transmission through sheets", "Material.layers")
def _sheets(case: Case):
    sheets = case.of_material(lambda material: material.layers)
    if len(sheets) == 0:
        return False, "no material has layers"
    reason = f"{case.named(sheets)}; {_passed_power(case, sheets)}"
    if case.paths is not None:
        reason += f"; {_found_passes(case.paths)}"
    left_out = unfollowed_sheets(case.statistics) if case.statistics else ""
    return True, f"{reason}; {left_out}" if left_out else reason


def _passed_power(case: Case, sheets) -> str:
    """How much of the power passes each kind of sheet once, at normal incidence."""
    meshes = list(case.scene.meshes)
    materials = dict.fromkeys(meshes[index].material for index in sheets)  # each once, in order
    frequency = case.radar.waveform.start_frequency
    shares = [sheet_coefficients(one, frequency=frequency, incidence=0.0).passed_power()[0] for one in materials]
    levels = ", ".join(f"{10.0 * math.log10(max(share, 1e-30)):.1f} dB" for share in shares)
    return f"at normal incidence the power that passes is {levels}{_change_over_band(case, materials)}"


def _change_over_band(case: Case, materials) -> str:
    """By how much sheets pass and reflect otherwise over the band than at its start, which is taken for all of it."""
    changes = np.array([_changes_db(material, case.radar.waveform) for material in materials]).max(axis=0)
    if changes.max() < TOLD_CHANGE_DB:
        return ""
    passed, reflected = (f"{change:.1f} dB" if change < MOST_CHANGE_DB else f"more than {MOST_CHANGE_DB:.0f} dB"
                         for change in changes)
    return (f", taken from the start of the chirp, from which over the band it differs by up to {passed}, and the power that is "
            f"reflected by {reflected}")


def _changes_db(material, waveform) -> tuple[float, float]:
    """Largest change in dB of the power that a sheet passes and of that which it reflects, at normal incidence."""
    ways = sum(layer.thickness * abs(layer.permittivity) ** 0.5 for layer in material.layers)  # m, of light
    ripples = 2.0 * ways * abs(waveform.bandwidth) / speed_of_light
    count = int(min(MOST_FREQUENCIES, 9.0 + 8.0 * ripples))
    # Too few for all ripples are laid at irrational places, which no ripple repeats with.
    places = np.linspace(0.0, 1.0, count) if count < MOST_FREQUENCIES else np.arange(count) * GOLDEN_RATIO % 1.0
    frequencies = waveform.start_frequency + waveform.bandwidth * places
    sheets = [sheet_coefficients(material, frequency=float(one), incidence=0.0) for one in frequencies]
    passed = np.array([one.passed_power()[0] for one in sheets])
    reflected = np.array([abs(one.te_reflection[0]) ** 2 for one in sheets])
    is_opaque = passed.max() < LEAST_PASSED
    return 0.0 if is_opaque else _largest_change_db(passed), _largest_change_db(reflected)


def _largest_change_db(powers: np.ndarray) -> float:
    """From the first of them."""
    levels = 10.0 * np.log10(np.maximum(powers, 1e-30))
    return float(np.max(np.abs(levels - levels[0])))


def _found_passes(paths) -> str:
    through = paths.select("T .* P .* R") if len(paths.passes) else None
    if through is None or through.num_paths == 0:
        return "no path goes through them"
    go = "go" if through.num_paths > 1 else "goes"
    power = _core.received_power(through).power
    return f"{counted(through.num_paths, 'path')} {go} through them, {in_dbm(power):.1f} dBm in all"


@rule("diffuse lobe, random phase", "Material.scattering")
def _diffuse(case: Case):
    return case.meshes_or(case.diffuse, "no material scatters diffusely")


@rule("directive lobes and backscatter", "Material.lobe_exponent", "Material.backscatter_share",
      "Material.backscatter_exponent")
def _lobes(case: Case):
    lobed = case.of_material(lambda material: case.share(material) < 1.0 and material.lobe_exponent > 0)
    return case.meshes_or(lobed, "all that is rough scatters as Lambert's law says")


@rule("edge diffraction", "trace.edges")
def _edges(case: Case):
    conductors = case.of_material(lambda material: (material.conductor or material.reflectivity is not None)
                                  and not material.mirror)
    if len(conductors) == 0:
        return False, "no material reflects like a conductor but flagged mirrors"
    power, noise = strongest_edge(case.scene, case.radar, case.time)
    asked = case.settings.edges
    is_on = edges_matter(power, noise) if asked == "auto" else asked
    found = _found_edges(case.paths) if is_on and case.paths else _expected_edge(power, noise)
    beside = "" if is_on else "; without them deep sidelobes of plates and boxes are wrong, main lobes within 1 dB"
    how = "edges = 'auto'" if asked == "auto" else "looked for" if is_on else "not looked for"
    return is_on, f"{how}: {found}{beside}{_without_edges(case, conductors)}"


def _found_edges(paths) -> str:
    on_edges = paths.select("T .* E .* R")
    if on_edges.num_paths == 0:
        return "the radar sees none"
    power = _core.received_power(on_edges).power
    return f"{on_edges.num_paths} pieces of edges, {in_dbm(power):.1f} dBm in all"


def _expected_edge(power: float, noise: float) -> str:
    if power <= 0.0:
        return "no sharp edge lies in the pattern"
    return (f"the strongest would carry {in_dbm(power):.1f} dBm straight back, and may carry more over mirrors; the noise of a "
            f"cell is {in_dbm(noise):.1f} dBm")


def _without_edges(case: Case, conductors) -> str:
    """Whose edges are left out."""
    deforming = np.intersect1d(conductors, case.deforming)
    dielectric = np.setdiff1d(case.coherent, conductors)
    texts = [f"; left out: those of {case.named(meshes)}, {why}"
             for meshes, why in ((deforming, "which deform"), (dielectric, "of dielectrics")) if len(meshes)]
    return "".join(texts)


@rule("speckle that goes on from frame to frame", "trace.scatterers")
def _scatterers(case: Case):
    if len(case.diffuse) == 0:
        return False, "no material scatters diffusely"
    return case.settings.scatterers == "surface", f'scatterers = "{case.settings.scatterers}"'


@rule("loss by roughness height", "Material.roughness_height")
def _roughness(case: Case):
    rough = case.of_material(lambda material: material.roughness_height > 0.0)
    return case.meshes_or(rough, "no material has a roughness height")


@rule("mirrors by images", "Material.mirror")
def _mirrors(case: Case):
    modelled, reason = case.meshes_or(case.mirrors, "no mesh is marked mirror")
    missing = unfollowed_frusta(case.statistics) if case.statistics else ""
    return modelled, f"{reason}; {missing}" if missing else reason


@rule("large planes by images")
def _planes(case: Case):
    if len(case.coherent) == 0:
        return False, "no coherent echoes"
    if case.paths is None:
        return True, "planes that cover their Fresnel zones where they mirror, for all rays over them; a trace tells which"
    count, meshes = imaged_planes(case.paths)
    if count == 0:
        return False, "no plane that is not marked covers its Fresnel zone where it would mirror"
    corners = f"; orders of over {MOST_AT_CORNER} bounces about one corner may count twice"
    return True, (f"{counted(count, 'plane')} of {case.named(meshes)}; their Fresnel zones are covered"
                  f"{corners if case.settings.max_bounces > MOST_AT_CORNER else ''}")


@rule("legs over images")
def _image_legs(case: Case):
    if case.settings.max_bounces == 1:
        return False, "max_bounces = 1"
    if len(case.mirrors) == 0 or len(case.objects) == 0:
        return False, "no mesh is marked mirror" if len(case.mirrors) == 0 else "nothing but mirrors"
    return True, "to and from each object and each rough mirror, over up to two mirrors"


@rule("multiple bounces", "trace.max_bounces")
def _bounces(case: Case):
    return case.settings.max_bounces > 1, f"max_bounces = {case.settings.max_bounces}"


@rule(f"Russian roulette behind bounce {ROULETTE_BOUNCE}")
def _roulette(case: Case):
    return case.settings.max_bounces > ROULETTE_BOUNCE, f"max_bounces = {case.settings.max_bounces}"


@rule("edges and orders of mirrors")
def _orders(case: Case):
    if case.settings.max_bounces == 1:
        return False, "max_bounces = 1"
    reason = "edges of surfaces below their Fresnel zone, the better of two orders"
    return len(case.coherent) > 0, reason if len(case.coherent) else "no coherent echoes"


@rule("both orders of diffuse chains")
def _pairs(case: Case):
    if case.settings.max_bounces == 1:
        return False, "max_bounces = 1"
    return len(case.diffuse) > 0, "two or more diffuse hits share their phases" if len(case.diffuse) else "nothing is rough"
