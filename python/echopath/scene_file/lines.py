"""On which lines of a TOML file its tables and keys stand, for faults that are found by their dotted path."""
from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

_HEADER = re.compile(r"\s*(\[\[?)([^][]+)\]\]?\s*(#.*)?$")    # [radar.waveform] or [[objects]]
_ASSIGNED = re.compile(r"""\s*((?:"[^"]*"|'[^']*'|[\w.-])+)\s*=""")  # num_chirps = 128, "left wall" = "..."

# Tables whose keys are arguments of a simulation, which looks at some of them again: in view of the radar, or of each other.
_SETTINGS = ("trace", "replay", "spectrum", "labels", "detections", "truth", "angle", "sequence")


def key_lines(text: str) -> dict[str, int]:
    """{dotted path: line, from 1} of the tables and keys of a TOML file, entries of arrays of tables as objects[0]."""
    lines: dict[str, int] = {}
    counts: Counter[str] = Counter()
    table = ""
    for number, line in enumerate(text.split("\n"), 1):
        if (header := _HEADER.match(line)) and (words := _words(header[2])):
            table = _with_places(words, counts, header[1] == "[[")
            for end in range(1, len(words) + 1):
                lines.setdefault(_with_places(words[:end], counts), number)
        elif (assigned := _ASSIGNED.match(line)) and (words := _words(assigned[1])):
            lines.setdefault(".".join([table, *words] if table else words), number)
    return lines


def line_of(fault: str, lines: dict[str, int]) -> int | None:
    """The line of the key that a fault, "key: rule" or "key: argument: rule", is about, or of the nearest table or value that it
    is in; None where nothing is known of it."""
    key = ".".join(fault.split(": ", 2)[:2])
    while key and key not in lines and f"{key}[0]" not in lines:
        key = key[:max(key.rfind("."), key.rfind("["), 0)]
    return lines.get(key, lines.get(f"{key}[0]"))


def with_lines(error: Exception, path: Path, text: str) -> str:
    """The message of an error whose lines begin with the file and a dotted path, and the line in its text between these."""
    lines = key_lines(text)
    return "\n".join(_with_line(fault, path, lines) for fault in str(error).splitlines())


def with_table(fault: str, lines: dict[str, int]) -> str:
    """A fault "argument: rule" of a simulation with the table before it that has the argument as a key, where one alone does."""
    argument = fault.partition(": ")[0]
    tables = [table for table in _SETTINGS if f"{table}.{argument}" in lines]
    return f"{tables[0]}.{fault}" if len(tables) == 1 else fault


@contextmanager
def settings_told(path: Path, typed: Collection[str] = ()) -> Iterator[None]:
    """ValueErrors of a simulation in the block begin with the file, the line and the table of the setting that they name.

    path: of the scene file that has the settings; typed: names of those that have come from elsewhere
    """
    try:
        yield
    except ValueError as error:
        if not path.is_file():  # a pipe is read once
            raise
        lines = key_lines(path.read_text(encoding="utf-8-sig"))
        fault = with_table(str(error), lines)
        if fault == str(error) or fault.partition(": ")[0].rpartition(".")[2] in typed:
            raise
        raise ValueError(_with_line(fault, path, lines)) from None


def _with_line(told: str, path: Path, lines: dict[str, int]) -> str:
    fault = told.removeprefix(f"{path}: ")
    line = line_of(fault, lines)
    return told if line is None else f"{path}: line {line}: {fault}"


def _words(key: str) -> list[str]:
    """The words of a key as TOML writes it, dotted or in quotes; [] of what is none."""
    words = []
    try:
        table = tomllib.loads(f"{key} = 0")
    except ValueError:
        return []
    while isinstance(table, dict):
        (word, table), = table.items()
        words.append(word)
    return words


def _with_places(words: list[str], counts: Counter[str], is_entry: bool = False) -> str:
    """The path of a header; counts: of the entries of arrays before, to which one is added where the header is an entry."""
    path = ""
    for index, word in enumerate(words):
        path = f"{path}.{word}" if path else word
        if is_entry and index == len(words) - 1:
            counts[path] += 1
        if counts[path]:
            path += f"[{counts[path] - 1}]"
    return path
