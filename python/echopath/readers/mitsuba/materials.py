"""What a Mitsuba file says of materials: names of BSDFs, and values of those for radio waves."""
from __future__ import annotations

from ... import _core
from .elements import Element

WRAPPERS = ("twosided", "mask", "bumpmap", "normalmap", "blendbsdf")
# plugins that are a kind of matter, for those without a name or of a name that is not known
PLUGINS = {"conductor": "metal", "roughconductor": "metal", "dielectric": "glass", "roughdielectric": "glass",
           "thindielectric": "glass", "plastic": "plastic", "roughplastic": "plastic"}
PERFECT = 1e5  # S/m, from which on a material is taken for a perfect conductor


def bsdf_of(shape: Element, known: dict[str, Element]) -> Element | None:
    """The BSDF within a shape or the one that it refers to, None without one. Raises FileError for an unknown id."""
    for child in shape.children:
        if child.tag == "bsdf":
            return child
        if child.tag == "ref" and child.get("name", "bsdf") == "bsdf":
            if child.get("id") not in known:
                child.refuse(f"there is no element with the id '{child.get('id')[:60]}'")
            if known[child.get("id")].tag == "bsdf":
                return known[child.get("id")]
    return None


def kind_of(bsdf: Element | None) -> str:
    """The material that the plugin of a BSDF stands for, whatever its id; "" for those that many materials have."""
    if bsdf is not None and bsdf.get("type") in WRAPPERS:
        return kind_of(next((child for child in bsdf.children if child.tag == "bsdf"), None))
    return "" if bsdf is None else PLUGINS.get(bsdf.get("type"), "")


def foreign_name(bsdf: Element | None) -> str:
    """The name that tells what a BSDF is made of; that of the ITU for what Sionna RT calls so."""
    if bsdf is None:
        return ""
    if bsdf.get("type") == "itu-radio-material":
        return f"itu_{bsdf.value('type', 'string') or ''}"
    if bsdf.get("id"):
        return bsdf.get("id").removeprefix("mat-")
    if bsdf.get("type") in WRAPPERS:
        return foreign_name(next((child for child in bsdf.children if child.tag == "bsdf"), None))
    return kind_of(bsdf)


def radio_material(bsdf: Element | None) -> _core.Material | None:
    """The Material of a BSDF of the type radio-material, which gives values instead of a name; None for all others.

    One that says its thickness (m) is a sheet, through which waves pass; without, it is as thick as they go.
    """
    if bsdf is None or bsdf.get("type") != "radio-material":
        return None
    conductivity = bsdf.number("conductivity", 0.0)
    if conductivity >= PERFECT:
        return _core.Material.metal()
    permittivity, scattering = bsdf.number("relative_permittivity", 1.0), bsdf.number("scattering_coefficient", 0.0)
    try:
        if bsdf.named("thickness", "float", "integer") is None:
            return _core.Material(permittivity=permittivity, conductivity=conductivity, scattering=scattering)
        pane = _core.Layer(bsdf.number("thickness", 0.0), permittivity, conductivity)
        return _core.Material(layers=[pane], scattering=scattering)
    except (TypeError, ValueError) as error:
        bsdf.refuse(str(error))
