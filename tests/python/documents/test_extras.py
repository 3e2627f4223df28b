"""Messages about libraries that are not installed name the extra of pyproject.toml that brings them."""
import ast
import re
import tomllib
from pathlib import Path

from echopath.readers.gltf import packed

ROOT = Path(__file__).parents[3]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]


def named_libraries() -> list:
    """(library, extra) of each call of needed_module whose arguments are literals."""
    found = []
    for file in (*(ROOT / "python" / "echopath").rglob("*.py"), *(ROOT / "viewer" / "echopath_viewer").rglob("*.py")):
        for call in ast.walk(ast.parse(file.read_text())):
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "needed_module":
                given = {keyword.arg: getattr(keyword.value, "value", None) for keyword in call.keywords}
                library = given.get("library") or getattr(call.args[0], "value", None)
                if isinstance(given["extra"], str) and library:
                    found.append((library.partition(".")[0].replace("_", "-"), given["extra"]))
    return found


def test_each_library_is_part_of_the_extra_that_its_message_names():
    named = [*named_libraries(), *packed.EXTRAS.items()]
    assert len(named) > 8
    for library, extra in named:
        assert library in [re.match("[A-Za-z0-9-]+", wanted)[0] for wanted in EXTRAS[extra]], (library, extra)
