"""Makes reStructuredText of docstrings as this project writes them: lines of `name: what it is, unit, shape` between sentences.

A line that begins with names and a colon becomes an item of a list, with what is indented below it and with lines that go
on in small letters; everything else is a paragraph. Nothing in a docstring is taken for markup but `code`.
"""
from __future__ import annotations

import re

NAMES = r"\*{0,2}\w+(?:\(\))?(?:(?:, | and | or )\*{0,2}\w+)*"
ITEM = re.compile(rf"^({NAMES}(?: \[[^\]]*\][^:.]*)?): (.*)$")
QUOTED_ITEM = re.compile(r'^("[^"]+"(?:, "[^"]+")*): (.*)$')
PARAGRAPHS = ("Returns", "Raises", "Warns", "Model", "Source", "Memory")
SIGNATURE = re.compile(r"^(?:\d+\. )?\w+\((.*)\)(?: -> .*)?$")


def as_rst(lines: list[str]) -> list[str]:
    """The same docstring as reStructuredText."""
    blocks: list[list[str]] = []  # each: indent and mark of its first line, then its text
    for line in lines:
        text, indent = line.strip(), len(line) - len(line.lstrip())
        if not text or text == "Overloaded function." or SIGNATURE.match(text):
            blocks.append([""])
        elif (item := QUOTED_ITEM.match(text)) and indent:
            blocks.append([f"  * {literal(item[1])}: {escaped(item[2])}"])
        elif (item := ITEM.match(text)) and not indent and not text.startswith(PARAGRAPHS):
            blocks.append([f"* **{escaped(item[1])}**: {escaped(item[2])}"])
        elif continues(text, indent, blocks):
            blocks[-1].append(escaped(text))
        else:
            blocks.append([escaped(text)])
    return [line for block in blocks for line in (indented(block) if block != [""] else [""])]


def continues(text: str, indent: int, blocks: list) -> bool:
    """Whether a line goes on with what stands before it."""
    if not blocks or blocks[-1] == [""]:
        return False
    is_item = blocks[-1][0].lstrip().startswith("* ")
    if is_item:
        return bool(indent) or not text[0].isupper()
    return not text.startswith(PARAGRAPHS)


def indented(block: list[str]) -> list[str]:
    """The block as one line between empty ones."""
    return ["", " ".join(block), ""]


def literal(text: str) -> str:
    return f"``{text}``"


def escaped(text: str) -> str:
    """Text in which nothing but `code` is markup."""
    pieces = re.split(r"`([^`]+)`", text)
    return "".join(literal(piece) if number % 2 else re.sub(r"([\\*|`])|_(?!\w)", r"\\\g<0>", piece)
                   for number, piece in enumerate(pieces))


def rewrite(app, what: str, name: str, obj, options, lines: list[str]) -> None:
    if what != "module" and (getattr(obj, "__module__", None) or "echopath").startswith("echopath"):
        lines[:] = as_rst(lines)


def setup(app) -> dict:
    app.connect("autodoc-process-docstring", rewrite)
    return {"version": "1", "parallel_read_safe": True}
