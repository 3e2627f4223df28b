"""Functions of the package that the extension calls by name: each is there, although no import would miss it."""
import importlib
import re
from pathlib import Path

import pytest

BINDINGS = Path(__file__).parents[3] / "python" / "bindings"
CALL = re.compile(r'(?:from|in)_package\(\s*"([\w.]+)",\s*"(\w+)"\s*\)')
NAMED = sorted({pair for file in BINDINGS.rglob("*.cpp") for pair in CALL.findall(file.read_text(encoding="utf-8"))})


def test_calls_by_name_are_found():
    """None is written in another way, which the pattern would miss."""
    calls = sum(len(re.findall(r"\b(?:from|in)_package\(", file.read_text(encoding="utf-8"))) for file in BINDINGS.rglob("*.cpp"))
    found = sum(len(CALL.findall(file.read_text(encoding="utf-8"))) for file in BINDINGS.rglob("*.cpp"))
    assert calls == found and {("presentation.tables", "paths_table"), ("base.process.progress", "automatic_bars")} <= set(NAMED)


@pytest.mark.parametrize("module, function", NAMED, ids=[".".join(pair) for pair in NAMED])
def test_what_bindings_name_is_a_function_of_the_package(module, function):
    assert callable(getattr(importlib.import_module(f"echopath.{module}"), function))
