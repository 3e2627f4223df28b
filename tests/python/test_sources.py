"""Comments of the C++ sources: files that they name exist, and no line is longer than what clang-format holds the code to."""
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MOST_COLUMNS = 125
FILE_NAME = re.compile(r"(?<![\w/])((?:\w+/)*\w{2,}\.(?:h|cpp))\b")
SOURCES = sorted(path for folder in ("cpp", "python/bindings", "tests") for path in (ROOT / folder).rglob("*")
                 if path.suffix in (".h", ".cpp"))


def missing_names(text: str, paths: list[str]) -> list[str]:
    """Files that comments name by the end of their path and that are not among `paths`."""
    named = [name for comment in re.findall(r"//(.*)", text) for name in FILE_NAME.findall(comment)]
    return [name for name in named if not any(path.endswith("/" + name) for path in paths)]


def test_missing_names_are_found():
    text = "int a;  // as in trace/ray.h and wave.h\n#include \"gone.h\"\n// L(x) = x.h x, see sum.cpp"
    assert missing_names(text, ["cpp/echopath/trace/ray.h"]) == ["wave.h", "sum.cpp"]


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_comments_name_files_that_exist():
    paths = [path.as_posix() for path in SOURCES]
    missing = {path.relative_to(ROOT).as_posix(): found for path in SOURCES
               if (found := missing_names(path.read_text(encoding="utf-8"), paths))}
    assert not missing


def test_comments_are_as_narrow_as_the_code():
    wide = [f"{path.relative_to(ROOT)}:{number}" for path in SOURCES
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
            if len(line) > MOST_COLUMNS and re.match(r"\s*// ", line)]
    assert not wide


def test_each_test_file_has_a_namespace_of_its_own():
    """Files of a module are compiled as one: what they name for themselves must not meet."""
    tests = [path for path in SOURCES if path.parent.parent == ROOT / "tests" / "cpp" and path.suffix == ".cpp"]
    wrong = [path.relative_to(ROOT).as_posix() for path in tests
             if f"namespace echopath::{path.stem} {{\n" not in path.read_text(encoding="utf-8")]
    assert len(tests) > 90 and not wrong
