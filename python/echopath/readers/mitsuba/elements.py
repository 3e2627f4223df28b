"""The elements of a Mitsuba file: XML without entities, parameters filled in, included files in their places."""
from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

from ...base.storage.files import named_file
from ...base.storage.lines import refuse
from ...base.storage.markup import parse

MAX_INCLUDES = 15    # files within files
MAX_FOLDERS = 100    # where files are looked for
MAX_ELEMENTS = 10_000_000
_OF_PICTURES = {"sensor", "film", "sampler", "rfilter", "integrator", "emitter"}  # where a sensor stands tells which way is up


@dataclass(eq=False)
class Element:
    """One element: tag, attributes, children, and where it stands.

    folders: of its scene, in which files are looked for, from the first one on
    """

    tag: str
    attributes: dict[str, str]
    file: Path
    line: int
    folders: list[Path]
    children: list[Element] = field(default_factory=list)

    def get(self, name: str, default: str = "") -> str:
        """An attribute, `default` where there is none."""
        return self.attributes.get(name, default)

    def named(self, name: str, *tags: str) -> Element | None:
        """The child of one of some tags whose attribute `name` is that."""
        return next((child for child in self.children if child.tag in tags and child.get("name") == name), None)

    def value(self, name: str, *tags: str) -> str | None:
        """The attribute `value` of such a child."""
        child = self.named(name, *tags)
        return None if child is None else child.get("value")

    def number(self, name: str, default: float) -> float:
        """The number of a child `<float name=... value=...>`."""
        child = self.named(name, "float", "integer")
        return default if child is None else child.numbers("value", 1)[0]

    def whole(self, name: str, default: int) -> int:
        """The whole number of a child `<integer name=... value=...>`."""
        value = self.number(name, default)
        if value != int(value):
            self.refuse(f"{name} must be a whole number, got {value:g}")
        return int(value)

    def point(self, name: str, default: tuple) -> list[float]:
        """The three numbers of a child `<point>` or `<vector>`, as x, y, z or as value."""
        child = self.named(name, "point", "vector")
        return list(default) if child is None else child.vector()

    def numbers(self, name: str, *counts: int) -> list[float]:
        """The numbers of an attribute, of one of some counts."""
        words = re.split(r"[\s,]+", self.get(name).strip())
        try:
            values = [float(word) for word in words]
        except ValueError:
            self.refuse(f"{name} must be numbers, got '{self.get(name)[:60]}'")
        if len(values) not in counts or not all(abs(value) < 1e70 for value in values):
            self.refuse(f"{name} must be {' or '.join(map(str, counts))} finite numbers, got '{self.get(name)[:60]}'")
        return values

    def vector(self, default: float = 0.0) -> list[float]:
        """Attributes x, y and z (`default` where one is missing), or the three numbers of value."""
        if "value" in self.attributes:
            values = self.numbers("value", 1, 3)
            return values * 3 if len(values) == 1 else values
        return [self.numbers(axis, 1)[0] if axis in self.attributes else default for axis in "xyz"]

    def refuse(self, what: str) -> NoReturn:
        """Raises FileError naming the file, the line and the element."""
        refuse(self.file, self.line, f"<{self.tag}>: {what}")


def read_elements(path: Path) -> Element:
    """The element <scene> of a file with those of the files that it includes, parameters `$name` filled in."""
    return _Reader(path).read(path)


class _Reader:
    def __init__(self, path: Path):
        self._parameters: dict[str, str] = {}
        self._including: list[Path] = []
        self._folders = [path.parent]
        self._count = 0

    def read(self, path: Path) -> Element:
        root = self._parse(path)
        if root.tag != "scene":
            hint = "; ep.read_trajectories reads what SUMO writes" if root.tag == "fcd-export" else ""
            root.refuse(f"the file must be a scene of Mitsuba, whose first element is <scene>{hint}")
        self._including.append(path)
        root.children = list(self._filled(root))
        self._including.pop()
        return root

    def _filled(self, element: Element, is_read: bool = True) -> Iterator[Element]:
        """The children of an element, with parameters, and included files instead of what includes them.

        is_read: whether anything but transforms of the element is looked at; else parameters may be unknown
        """
        for child in element.children:
            of_scene = child.tag == "transform" or is_read and child.tag not in _OF_PICTURES
            child.attributes = {name: self._text(child, value, of_scene) for name, value in child.attributes.items()}
            if child.tag == "default":
                self._parameters.setdefault(child.get("name"), child.get("value"))
            elif child.tag == "include":
                yield from self._included(child)
            elif child.tag == "path":
                self._look_in(child)
            else:
                child.children = list(self._filled(child, of_scene))
                yield child

    def _text(self, element: Element, text: str, must_be_known: bool) -> str:
        if "$" not in text:
            return text

        def value(match) -> str:
            if must_be_known and match[1] not in self._parameters:
                element.refuse(f"the parameter '${match[1]}' has no default")
            return self._parameters.get(match[1], match[0])

        filled = re.sub(r"\$(\w+)", value, text)
        if len(filled) > 100_000:
            element.refuse("parameters make it longer than 100000 letters")
        return filled

    def _included(self, element: Element) -> list[Element]:
        path = file_of(element, element.get("filename"))
        if path in self._including or len(self._including) >= MAX_INCLUDES:
            element.refuse(f"'{path}' includes itself, or files are included more than {MAX_INCLUDES} deep")
        return self.read(path).children

    def _look_in(self, element: Element) -> None:
        """Has files looked for in a folder, before the others that are known."""
        if len(self._folders) >= MAX_FOLDERS:
            element.refuse(f"more than {MAX_FOLDERS} folders")
        named = (named_file(folder, element.get("value")) for folder in (element.file.parent, *self._folders))
        self._folders[:0] = [*filter(os.path.isdir, named)][:1]

    def _parse(self, path: Path) -> Element:
        stack: list[Element] = []
        roots: list[Element] = []

        def begin(tag, attributes, line):
            self._count += 1
            element = _of_today(Element(tag, attributes, path, line, self._folders))
            if self._count > MAX_ELEMENTS:
                element.refuse(f"more than {MAX_ELEMENTS} elements in all")
            (stack[-1].children if stack else roots).append(element)
            stack.append(element)

        parse(path, begin, lambda tag, line: stack.pop())
        return roots[0]


def _of_today(element: Element) -> Element:
    """The element as Mitsuba writes it from version 2 on: names that were "toWorld" are "to_world", and lookAt is lookat."""
    if element.tag == "lookAt":
        element.tag = "lookat"
    if element.tag != "default" and "name" in element.attributes:  # else of a parameter, which may have any
        element.attributes["name"] = re.sub(r"(?<=[a-z0-9])[A-Z]", lambda letter: f"_{letter[0].lower()}", element.get("name"))
    return element


def file_of(element: Element, name: str) -> Path:
    """The regular file that an element names, relative to one of the folders of its scene or to the file that it stands in."""
    if not name:
        element.refuse("names no file")
    named = (named_file(folder, name) for folder in (*element.folders, element.file.parent))
    path = next(filter(os.path.isfile, named), None)
    if path is None:
        element.refuse(f"the file '{name}' is not there")
    return path
