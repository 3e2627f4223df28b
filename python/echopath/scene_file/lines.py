"""On which lines of a TOML file its tables and keys stand, for faults that are found by their dotted path."""
from __future__ import annotations

import re
import tomllib
from collections import Counter
from pathlib import Path

_HEADER = re.compile(r"\s*(\[\[?)([^][]+)\]\]?\s*(#.*)?$")    # [radar.waveform] or [[objects]]
_ASSIGNED = re.compile(r"""\s*((?:"[^"]*"|'[^']*'|[\w.-])+)\s*=""")  # num_chirps = 128, "left wall" = "..."


def key_lines(text: str) -> dict[str, int]:
    """{dotted path: line, from 1} of the tables and keys of a TOML file, entries of arrays of tables as objects[0]."""
    lines: dict[str, int] = {}
    counts: Counter[str] = Counter()
    table = ""
    for number, line in enumerate(text.split("\n"), 1):
        if (header := _HEADER.match(line)) and (words := _words(header[2])):
            table = _with_places(words, counts, header[1] == "[[")
            lines.setdefault(table, number)
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


def _with_places(words: list[str], counts: Counter[str], is_entry: bool) -> str:
    """The path of a header; counts: of the entries of arrays before, to which one is added where the header is an entry."""
    path = ""
    for index, word in enumerate(words):
        path = f"{path}.{word}" if path else word
        if is_entry and index == len(words) - 1:
            counts[path] += 1
        if counts[path]:
            path += f"[{counts[path] - 1}]"
    return path
