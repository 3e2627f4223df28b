"""The materials that come with echopath."""
from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cached_property

from .. import _core
from ..arguments.checks import refused
from ..arguments.shown import writable
from .storage.data_folder import data_folder


class MaterialLibrary(Mapping[str, _core.Material]):
    """Read-only mapping: name -> Material at 77 GHz, from data/materials/*.toml.

    Raises KeyError naming the nearest right names.
    """

    def __getitem__(self, name: str) -> _core.Material:
        return self._entry(name)[0]

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
        """The name under which this very object is in the library, "" for any other."""
        return next((name for name, (known, _) in self._entries.items() if known is material), "")

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
        files = sorted((file for file in data_folder("materials").iterdir() if file.name.endswith(".toml")),
                       key=lambda file: file.name)
        return {file.name.removesuffix(".toml"): _read(file) for file in files}


def _read(file):
    """A material file -> (Material, source)."""
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    source = table.pop("source")
    return _core.Material(**material_fields(table)), source


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


def known_with(name: str, **fields) -> _core.Material:
    """The material of a name with other fields. Raises KeyError, and ValueError naming the field: for mirrors of layers, which
    there are none, with the name of the material that is alike and has none."""
    try:
        return materials[name].replace(**fields)
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
