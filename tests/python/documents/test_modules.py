"""Arrows between the modules of the core: what the text of the sources includes, and what CMake links, go one way."""
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
CORE = ROOT / "cpp" / "echopath"
# What works on a record of paths, whoever made it: none of it needs rays, or the library that finds what they meet.
WITHOUT_RAYS = ("record", "signal", "replay", "power", "spectrum")
RAYS = {"trace", "embree"}

pytestmark = pytest.mark.skipif(not CORE.is_dir(), reason="the sources are not there")


def links_of(text: str) -> set[str]:
    """Modules and third parties that a call of echopath_module names."""
    call = re.search(r"^echopath_module\(\w+([^)]*)\)", text, re.M)[1]
    named = re.sub(r"\bOPTIONS\b.*", "", call, flags=re.S).split()
    return set(named) - {"DEPENDS", "PUBLIC", "PRIVATE"}


def closure_of(name: str, links: dict[str, set[str]]) -> set[str]:
    """All that is linked with a module, by however many arrows."""
    found, next_ones = set(), [name]
    while next_ones:
        for one in links.get(next_ones.pop(), set()) - found:
            found.add(one)
            next_ones.append(one)
    return found


def modules_named(text: str) -> set[str]:
    """Modules whose headers a file includes."""
    return set(re.findall(r'^#include "echopath/(\w+)/', text, re.M))


@pytest.fixture(scope="module")
def links():
    return {file.parent.name: links_of(file.read_text(encoding="utf-8")) for file in CORE.glob("*/CMakeLists.txt")}


def test_links_and_includes_are_found():
    text = "# of echopath_module\nechopath_module(c DEPENDS b PRIVATE rays OPTIONS -fast ${more})\nechopath_kernels(c one.h)"
    assert links_of(text) == {"b", "rays"}
    links = {"a": set(), "b": {"a"}, "c": {"b", "rays"}, "d": {"c"}}
    assert closure_of("d", links) == {"a", "b", "c", "rays"} and closure_of("b", links) == {"a"}
    assert modules_named('#include <b/e.h>\n#include "echopath/b/e.h"\n// #include "echopath/c/f.h"') == {"b"}


def test_modules_are_linked_in_no_circle(links):
    assert len(links) > 15 and [name for name in links if name in closure_of(name, links)] == []


@pytest.mark.parametrize("name", WITHOUT_RAYS)
def test_what_works_on_records_is_linked_without_rays(links, name):
    assert name in links and closure_of(name, links) & RAYS == set()


def test_modules_include_what_they_are_linked_with(links):
    """A header of another module may do without its library for a while, until somebody calls what it declares."""
    wrong = {}
    for name in links:
        allowed = closure_of(name, links) | {name}
        for file in (CORE / name).rglob("*"):
            if file.suffix in (".h", ".cpp") and (found := modules_named(file.read_text(encoding="utf-8")) - allowed):
                wrong[file.relative_to(CORE).as_posix()] = found
    assert wrong == {}


def test_embree_is_asked_by_those_who_link_it(links):
    users = {file.relative_to(CORE).parts[0] for file in CORE.rglob("*.*")
             if file.suffix in (".h", ".cpp") and "/embree_device.h\"" in file.read_text(encoding="utf-8")}
    assert users == {name for name in links if "embree" in links[name]}


@pytest.mark.parametrize("folder", ["cpp/echopath", "tests/cpp"])
def test_every_module_has_its_tests(links, folder):
    """A folder is a module is a folder of tests: both lists of CMake have all modules."""
    text = (ROOT / folder / "CMakeLists.txt").read_text(encoding="utf-8")
    assert set(re.search(r"^foreach\(module ([\w ]+)\)", text, re.M)[1].split()) == set(links)
