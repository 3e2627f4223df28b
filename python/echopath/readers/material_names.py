"""Names of materials in foreign files, and which of ours they mean."""
from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator, Mapping, MutableMapping

from .. import _core
from ..arguments.checks import refused
from ..base.materials import known_material, materials
from ..base.text.counts import counted
from ..base.text.node_names import composed

Meaning = _core.Material | str

DEFAULT = "concrete"  # of names that nothing takes
_OF_GLOB = {"*": ".*", "?": "."}  # all other letters of a pattern stand for themselves

# Patterns of names, the first that takes a name decides. A material of several words stands before those of one.
_NAMES: dict[str, str] = {
    # Recommendation ITU-R P.2040, as Sionna RT and others spell it
    "*ceiling*board*": "ceiling_board", "*very*dry*ground*": "dry_soil", "*medium*dry*ground*": "soil",
    "*wet*ground*": "wet_soil",
    "*chip*board*": "chipboard", "*ply*wood*": "plywood", "*floor*board*": "floorboard", "*plaster*board*": "plasterboard",
    # what would be taken for something else by a part of its name
    "*fib*glass*": "plastic", "*carbon*fib*": "plastic", "*road*line*": "asphalt", "*lane*mark*": "asphalt",
    "*road*mark*": "asphalt", "*road*sign*": "metal", "*street*light*": "metal", "*traffic*": "metal", "*guard*rail*": "metal",
    "*head*light*": "plastic", "*tail*light*": "plastic", "*car*body*": "metal", "*body*work*": "metal", "*clear*coat*": "metal",
    "*wood*fence*": "wood", "*fence*wood*": "wood", "*wood*pole*": "wood", "*snow*": "snow",
    "*glass*": "glass", "*window*": "glass", "*windshield*": "glass", "*windscreen*": "glass",
    "tree*": "wood", "*vegetation*": "wood", "*foliage*": "wood", "leaf*": "wood", "leaves": "wood", "bark*": "wood",
    "bush*": "wood", "hedge*": "wood", "trunk*": "wood",
    # roads and buildings
    "*asphalt*": "asphalt", "*tarmac*": "asphalt", "*bitum*": "asphalt", "road*": "asphalt", "street*": "asphalt",
    "*parking*": "asphalt", "*concrete*": "concrete", "*cement*": "concrete", "*sidewalk*": "concrete", "*pavement*": "concrete",
    "*paving*": "concrete", "curb*": "concrete", "kerb*": "concrete", "bridge*": "concrete", "*stucco*": "concrete",
    "*brick*": "brick", "tile": "brick", "*tiles": "brick", "*ceramic*": "brick", "*clinker*": "brick", "roof*": "brick",
    "*marble*": "marble", "*granite*": "marble", "stone*": "marble", "*sandstone*": "marble", "*limestone*": "marble",
    "rock*": "marble", "*cobble*": "marble", "*plaster*": "plasterboard", "*drywall*": "plasterboard", "*gypsum*": "plasterboard",
    "*building*": "concrete", "*facade*": "concrete", "wall*": "concrete",
    # ground
    "*soil*": "soil", "dirt*": "soil", "mud*": "wet_soil", "*grass*": "soil", "*terrain*": "soil", "sand*": "dry_soil",
    "gravel*": "dry_soil", "earth*": "soil", "*ground*": "soil", "lawn*": "soil", "*water*": "water",
    # metals and vehicles
    "*metal*": "metal", "*steel*": "metal", "iron*": "metal", "*alumin*": "metal", "*chrom*": "metal", "copper*": "metal",
    "brass*": "metal", "bronze*": "metal", "zinc*": "metal", "gold*": "metal", "silver*": "metal", "tin": "metal", "alu": "metal",
    "titanium*": "metal", "*conductor*": "metal", "pec": "metal", "*car*paint*": "metal", "*body*paint*": "metal",
    "*vehicle*": "metal", "*chassis*": "metal", "rim": "metal", "rims": "metal", "fence*": "metal", "pole*": "metal",
    "rail*": "metal", "*license*plate*": "metal", "*rubber*": "rubber", "tire*": "rubber", "tyre*": "rubber", "wheel*": "rubber",
    "*bumper*": "bumper", "*plastic*": "plastic", "*polymer*": "plastic", "vinyl*": "plastic", "nylon*": "plastic",
    "pvc": "plastic", "acrylic*": "plastic",
    # people and rooms
    "skin*": "skin", "face": "skin", "head": "skin", "hand": "skin", "hands": "skin", "body": "skin", "*cloth*": "clothing",
    "*fabric*": "clothing", "*textile*": "clothing", "shirt*": "clothing", "tshirt*": "clothing", "pants": "clothing",
    "trousers": "clothing", "jeans": "clothing", "denim*": "clothing", "jacket*": "clothing", "coat": "clothing",
    "dress": "clothing", "suit": "clothing", "cotton*": "clothing", "wool*": "clothing", "leather*": "clothing",
    "shoe*": "clothing", "hair*": "clothing", "hat": "clothing", "carpet*": "clothing", "*wood": "wood", "wood*": "wood",
    "*timber*": "wood", "*wooden*": "wood", "oak": "wood", "pine": "wood", "parquet*": "wood", "floor*": "concrete",
    "ceiling*": "plasterboard",
    "*light*": "plastic",  # of anything else that is light: wood, fabric
}


@functools.cache
def _matcher(pattern: str):
    letters = (_OF_GLOB.get(letter, re.escape(letter)) for letter in composed(pattern).lower())
    return re.compile("".join(letters), re.DOTALL).fullmatch


def _texts(name: str) -> list[str]:
    """A name and its words in small letters: "M_RoadLine.001" -> ["m_roadline.001", "m", "road", "line"]."""
    name = composed(name)
    return [text.lower() for text in (name, *re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[^\W\d_a-zA-Z]+", name))]


def _takes(pattern: str, texts: list[str]) -> bool:
    return any(map(_matcher(pattern), texts))


def _pattern(argument: str, value) -> str:
    if not isinstance(value, str):
        raise refused(TypeError, argument, "patterns of names as text", value)
    return value


class ForeignMaterials(MutableMapping):
    """Mapping of patterns of foreign names to a Material or the name of one: `ep.foreign_materials["*hedge*"] = "wood"`.

    A pattern is a glob, `*` any letters and `?` one, without regard to case. It takes a name if it takes the whole or one of
    its words, which end where letters end or a capital follows a small one: "road*" takes "M_RoadLine.001". What is assigned
    goes before everything that was there, so the latest decides; the iteration goes in the order of decision. Raises
    TypeError or ValueError for what is no Material and no name in `materials`, KeyError for a pattern that is not there.
    """

    def __init__(self, entries: Mapping[str, Meaning]):
        self._entries: dict[str, Meaning] = dict(reversed(entries.items()))  # the last decides

    def __getitem__(self, pattern: str) -> Meaning:
        return self._entries[pattern]

    def __setitem__(self, pattern: str, material: Meaning) -> None:
        _pattern("pattern", pattern)
        known_material(material)
        self._entries.pop(pattern, None)
        self._entries[pattern] = material

    def __delitem__(self, pattern: str) -> None:
        del self._entries[pattern]

    def __iter__(self) -> Iterator[str]:
        return reversed(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        return f"foreign_materials({len(self)} patterns)"


foreign_materials = ForeignMaterials(_NAMES)


def checked_materials(argument: str, value) -> dict[str, Meaning]:
    """The argument `materials` of a reader: {pattern: Material or name}, None: none."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise refused(TypeError, argument, "a mapping of names in the file to materials", value)
    for pattern, material in value.items():
        _pattern(argument, pattern)
        try:
            known_material(material)
        except (TypeError, ValueError) as error:
            raise type(error)(str(error).replace("material:", f"{argument}[{pattern!r}]:", 1)) from None
    return dict(value)


def material_of(name: str, own: Mapping[str, Meaning] | None = None) -> tuple[Meaning, str | None]:
    """(the material that a foreign name means, None or what to say of a name that nothing takes).

    own: patterns that go before `foreign_materials`, the first that takes the name decides; "*" also takes the name "".
    Names of ours mean themselves; what nothing takes is DEFAULT.
    """
    texts = _texts(name)
    for pattern, material in (own or {}).items():
        if _takes(pattern, texts):
            return material, None
    if name in materials:
        return name, None
    for pattern, material in foreign_materials.items():
        if _takes(pattern, texts):
            return material, None
    return DEFAULT, f"the material '{name}' is not known: {DEFAULT} is taken" if name else (
        f"a mesh has no material: {DEFAULT} is taken")


def note_of_unused(patterns: Iterable[str], names: Iterable[str]) -> list[str]:
    """A sentence on patterns that take none of the names in a file: they may be misspelt. "*" takes all."""
    names = sorted({name for name in names if name})
    texts = [_texts(name) for name in names]
    unused = [pattern for pattern in patterns if pattern != "*" and not any(_takes(pattern, one) for one in texts)]
    if not unused:
        return []
    there = f"{', '.join(names[:8])}{', ...' if len(names) > 8 else ''}" if names else "none"
    return [f"materials: nothing in the file is called {' or '.join(repr(one) for one in unused[:4])}; its materials are {there}"]


def note_of_unknown(names: Iterable[str]) -> list[str]:
    """Sentences that count meshes whose materials (their names, one per mesh) nothing took; none for no names."""
    names = list(names)
    known = sorted({name for name in names if name})
    more = ", ..." if len(known) > 8 else ""
    notes = []
    if known:
        notes.append(f"{counted(len(known), 'material')} without an entry in ep.foreign_materials "
                     f"{'are' if len(known) > 1 else 'is'} taken for {DEFAULT}: {', '.join(known[:8])}{more}")
    if "" in names:
        count = names.count("")
        notes.append(f"{counted(count, 'mesh')} without a material {'are' if count > 1 else 'is'} taken for "
                     f"{DEFAULT}, unless `materials` has one for \"*\"")
    return notes
