"""The materials that come with echopath, at 77 GHz and elsewhere."""
from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from typing import Any

from ... import _core
from ...arguments.checks import anything, carrier, checked, refused
from ...arguments.shown import writable
from ..storage.data_folder import data_folder
from .over_frequency import holds_at, is_near_library, values_at

KEPT = 64  # libraries of other frequencies, of those that were asked for last


class MaterialLibrary(Mapping[str, _core.Material]):
    """Read-only mapping: name -> Material at 77 GHz, from data/materials/*.toml; those at another frequency are in `at`.

    Raises KeyError naming the nearest right names.
    """

    def __init__(self, frequency: float | None = None):
        """frequency: Hz, None: as the files have them"""
        self._frequency = frequency

    def __getitem__(self, name: str) -> _core.Material:
        return self._entry(name)[0]

    @checked(self=anything, frequency=carrier)
    def at(self, frequency: float) -> MaterialLibrary:
        """The same names with their values at a frequency in Hz: `ep.materials.at(24e9)["skin"]`.

        They follow the laws that their sources give (`source`): building materials by Recommendation ITU-R P.2040, water and
        skin by their relaxations, foliage and grounds as their echoes go over frequency. What has no law there keeps its
        values at 77 GHz, and `not_given` names it. At 77 GHz, too, these are the values of the laws, by which concrete reflects
        0.2 dB more power and a pane of glass passes 1.7 dB more than in `ep.materials`, the others as much to 0.1 dB.
        Raises TypeError or ValueError naming the argument.
        """
        return _library_at(frequency)

    @cached_property
    def not_given(self) -> tuple[str, ...]:
        """The materials here that have no values of their own at this frequency and keep those at 77 GHz, in order of name."""
        return () if self._frequency is None else tuple(name for name in self if not _is_given(name, self._frequency))

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def _ipython_key_completions_(self) -> list[str]:
        """What the tab key offers behind `ep.materials["`."""
        return list(self)

    def source(self, name: str) -> str:
        """Where the values of a material come from. Raises KeyError."""
        return self._entry(name)[1]

    def name_of(self, material: object) -> str:
        """The name under which this very object is in the library, or in one of those of `at` that were asked for last, "" for
        any other."""
        return next((name for library in (self, *tuple(_kept.values())) for name, (known, _) in library._entries.items()
                     if known is material), "")

    def __repr__(self) -> str:
        return f"materials({', '.join(self)})"

    def _entry(self, name: str) -> tuple[_core.Material, str]:
        try:
            return self._entries[name]
        except (KeyError, TypeError):
            nearest = ", ".join(_core.nearest_names(writable(str(name)), list(self)))
            raise KeyError(f"unknown material {name!r}, the nearest known ones are {nearest}") from None

    @cached_property
    def _entries(self) -> dict[str, tuple[_core.Material, str]]:
        return {name: (_core.Material(**material_fields(_values(name, self._frequency))), table["source"])
                for name, table in _tables().items()}


_kept: dict[float, MaterialLibrary] = {}  # by frequency in Hz, what was asked for last at the end


def _library_at(frequency: float) -> MaterialLibrary:
    library = _kept.pop(frequency, None)
    _kept[frequency] = MaterialLibrary(frequency) if library is None else library
    if len(_kept) > KEPT:
        _kept.pop(next(iter(_kept)))
    return _kept[frequency]


@cache
def _tables() -> dict[str, dict[str, Any]]:
    """What the files hold, by name of the material, in order of name."""
    files = sorted((file for file in data_folder("materials").iterdir() if file.name.endswith(".toml")),
                   key=lambda file: file.name)
    return {file.name.removesuffix(".toml"): tomllib.loads(file.read_text(encoding="utf-8")) for file in files}


def _values(name: str, frequency: float | None) -> dict[str, Any]:
    """The keys of a material in its file, without those that say where they come from: at a frequency in Hz by its law, else,
    and for None, at 77 GHz."""
    values = {key: value for key, value in _tables()[name].items() if key not in ("source", "over_frequency")}
    law = _tables()[name].get("over_frequency")
    if frequency is not None and holds_at(law, frequency):
        values = values_at(values, law, frequency)
    if "layers" in values:
        values["layers"] = [_layer(layer, frequency) for layer in values["layers"]]
    return values


def _layer(layer: dict, frequency: float | None) -> dict:
    """A layer with the permittivity of the material that it names, if it names one."""
    if "material" not in layer:
        return layer
    return {"thickness": layer["thickness"], "permittivity": _values(layer["material"], frequency)["permittivity"]}


def _is_given(name: str, frequency: float) -> bool:
    """Whether a material has values of its own at a frequency in Hz: perfect conductors everywhere, sheets with their layers."""
    table = _tables()[name]
    if table.get("conductor") or is_near_library(frequency) or holds_at(table.get("over_frequency"), frequency):
        return True
    if "over_frequency" in table or "layers" not in table:
        return False
    return all(_is_given(layer["material"], frequency) if "material" in layer else layer["permittivity"] == 1.0
               for layer in table["layers"])


def material_fields(table: dict) -> dict:
    """The fields of a Material from the keys of a file: permittivities are eps' or [eps', eps''] for eps' - j eps'', layers are
    tables of the fields of a Layer."""
    fields = dict(table)
    if isinstance(fields.get("permittivity"), list):
        fields["permittivity"] = _complex(fields["permittivity"])
    if "layers" in fields:
        fields["layers"] = [_core.Layer(**{**layer, "permittivity": _complex(layer["permittivity"])})
                            for layer in fields["layers"]]
    return fields


def _complex(value):
    return complex(value[0], -value[1]) if isinstance(value, list) else value


materials = MaterialLibrary()


def known_material(material) -> tuple:
    """(Material, its name or "") of a Material or a name; raises ValueError or TypeError naming the argument `material`."""
    if isinstance(material, str):
        try:
            return materials[material], material
        except KeyError as error:
            raise ValueError(f"material: {error.args[0]}") from None
    if not isinstance(material, _core.Material):
        raise refused(TypeError, "material", "a Material or a name of one", material)
    return material, materials.name_of(material)


def known_with(name: str, frequency: float | None = None, **fields) -> _core.Material:
    """The material of a name, at a frequency in Hz, with other fields. Raises KeyError, and ValueError naming the field: for
    mirrors of layers, which there are none, with the name of the material that is alike and has none."""
    try:
        return (materials if frequency is None else materials.at(frequency))[name].replace(**fields)
    except ValueError:
        whole = _without_layers(name) if fields.get("mirror") else ""
        if not whole:
            raise
        raise ValueError(f"mirror: must be False for '{name}', which has layers, as flagged mirrors let nothing pass; '{whole}' "
                         "is the material without layers, got True") from None


def _without_layers(name: str) -> str:
    """The material without layers of which one with layers has its name, "glass" of "glass_pane"; "" where there is none."""
    stem = name.rpartition("_")[0]
    is_whole = stem in materials and materials[name].layers and not materials[stem].layers
    return stem if is_whole else ""
