"""Sources: files that comments name are there, lines are as narrow as clang-format holds them, names stand for one thing."""
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
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


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_documents_that_comments_name_are_there():
    kept = [path for path in (ROOT, ROOT / "data", *(ROOT / "python" / "docs").rglob("*")) if path.is_dir()]
    documents = {path.name for folder in kept for path in folder.glob("*.md")}
    python = [path for folder in ("python", "viewer", "tests") for path in (ROOT / folder).rglob("*.py")]
    named = {(path.relative_to(ROOT).as_posix(), name) for path in (*SOURCES, *python) if path != Path(__file__)
             for line in path.read_text(encoding="utf-8").splitlines() for name in re.findall(r"\b[A-Z]+\.md\b", line)}
    assert named and not {(path, name) for path, name in named if name not in documents}


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_no_source_takes_views_of_ranges():
    """Clang 14, with which Debian 12 builds the fuzzers, cannot compile those of the library of GCC 12."""
    assert not [path.relative_to(ROOT).as_posix() for path in SOURCES if "std::views::" in path.read_text(encoding="utf-8")]


def bound_twice(text: str) -> list[str]:
    """Constants that a module in Python binds more than once, outside of branches."""
    names = re.findall(r"^([A-Z][A-Z0-9_]*)(?:: [^=\n]*)? = ", text, re.M)
    return sorted({name for name in names if names.count(name) > 1})


def test_constants_bound_twice_are_found():
    assert bound_twice("ROUNDING = 1e-13\nOTHER: int = 2\nROUNDING = 1e-12  # the last one counts\n") == ["ROUNDING"]


def test_no_constant_is_bound_twice():
    """The last value would quietly count for what stands above it, too."""
    paths = [path for folder in ("python", "viewer", "tests") for path in (ROOT / folder).rglob("*.py")]
    wrong = {path.relative_to(ROOT).as_posix(): names for path in paths
             if (names := bound_twice(path.read_text(encoding="utf-8")))}
    assert len(paths) > 500 and not wrong


def test_comments_are_as_narrow_as_the_code():
    wide = [f"{path.relative_to(ROOT)}:{number}" for path in SOURCES
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
            if len(line) > MOST_COLUMNS and re.match(r"\s*// ", line)]
    assert not wide


# Comments in front of declarations of headers, and what makes a first sentence a fragment: it begins as none can that has a
# subject, or has neither an auxiliary verb nor a word that may be a verb of the third person.
COMMENT = re.compile(r"^((?: {0,4}// ?.*\n)+)(?= {0,4}(?:struct|class|enum|union|template|using|inline|constexpr|static|explicit"
                     r"|virtual|friend|#include|ECHOPATH_INLINE|[\w:<>,&* ]+\())", re.M)
NO_SUBJECT = re.compile(r"(?:Whether|How|To be|Is|Are|Not|Same|Between|The same (?:as|for|about|where|of|at|with|in))\b")
PRONOUN = re.compile(r"(?:These|Those|They|All|Both|Some)\b")
AUXILIARY = {"are", "were", "have", "had", "may", "must", "can", "could", "did", "will", "would", "should", "might"}
NO_VERB = {"this", "its", "as", "across", "always", "less", "plus", "minus", "thus"}


def fragments(text: str) -> list[str]:
    """First sentences of comments in front of declarations that have no subject or no verb."""
    found = []
    for comment in COMMENT.findall(text):
        lines = [line.strip().removeprefix("//").strip() for line in comment.splitlines()]
        sentence = re.split(r"(?<=[.;:])\s", " ".join(lines[:lines.index("")] if "" in lines else lines))[0]
        if not re.match(r"[A-Z]", sentence) or sentence.startswith("NOLINT") or PRONOUN.match(sentence):
            continue
        words = [word for word in re.findall(r"[A-Za-z]+", sentence) if word.lower() not in NO_VERB]
        if NO_SUBJECT.match(sentence) or not any(word.endswith("s") or word in AUXILIARY for word in words):
            found.append(sentence)
    return found


def test_fragments_are_found():
    text = """#pragma once
// How long a signal takes.
#include <vector>
// Returns the power, W: what it is made of.
double power(int group);
// A cell on a flat triangle.
struct FlatCell {
  // Is told of blocks.
  void end_blocks();
  // These return nothing new.
  int size() const;
  // m: sum of all
  double length = 0.0;
  // An antenna may stand anywhere.
  void stand(int antenna);
};
"""
    assert fragments(text) == ["How long a signal takes.", "A cell on a flat triangle.", "Is told of blocks."]


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_comments_in_front_of_declarations_are_sentences():
    found = {f"{path.relative_to(ROOT)}: {sentence}" for path in SOURCES
             if path.suffix == ".h" and ROOT / "cpp" in path.parents
             for sentence in fragments(path.read_text(encoding="utf-8"))}
    assert not found


def test_each_test_file_has_a_namespace_of_its_own():
    """Files of a module are compiled as one: what they name for themselves must not meet."""
    tests = [path for path in SOURCES if ROOT / "tests" / "cpp" in path.parents and path.match("test_*.cpp")]
    wrong = [path.relative_to(ROOT).as_posix() for path in tests
             if f"namespace echopath::{path.stem} {{\n" not in path.read_text(encoding="utf-8")]
    assert len(tests) > 90 and not wrong


UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace\n", re.M | re.S)
CLASS = re.compile(r"^(?:struct|class|enum class|enum|union) (\w+)(?: final)?(?: : [^;{]*)? \{|^using (\w+) =", re.M)
FUNCTION = re.compile(r"^(?!using|struct|class|enum|template|namespace|return|static_assert)(?=\w)[\w:<>,&* ]*?[ &*>]"
                      r"(\w+)\([^;={}]*\)[^;={}()]* \{", re.M)
CONSTANT = re.compile(r"^(?:inline |static )*(?:constexpr|const) [\w:<>,&* ]+? (\w+)(?:\[\w*\])* ?[={]([^;]*);", re.M)


def own_names(text: str) -> set[str]:
    """Constants, functions and classes that a file defines in unnamed namespaces."""
    names: set[str] = set()
    for body in UNNAMED.findall(text):
        names |= {name for pair in CLASS.findall(body) for name in pair if name} | set(FUNCTION.findall(body))
        for first, rest in CONSTANT.findall(body):
            names |= {first, *re.findall(r", (k[A-Z]\w*)(?:\[\w*\])* =", rest)}
    return names


def test_own_names_are_found():
    text = """namespace {
constexpr int kA = 1, kB = 2;
const std::vector<int> kTable = {1, 2};
struct Part : Base {
  void member() {}
};
using Row = std::vector<double>;
std::vector<int> of(const Part& part,
                    int size) {
  return part.get(size);
}
}  // namespace
int outside(int value) { return value; }
"""
    assert own_names(text) == {"kA", "kB", "kTable", "Part", "Row", "of"}


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_names_of_unnamed_namespaces_are_unique_within_a_module():
    """Files of a module are compiled as one: what they name for themselves must not meet."""
    homes, total = defaultdict(list), 0
    for path in SOURCES:
        parts = path.relative_to(ROOT).parts
        if parts[:2] == ("cpp", "echopath") and len(parts) > 3 and path.suffix == ".cpp":
            names = own_names(path.read_text(encoding="utf-8"))
            total += len(names)
            for name in names:
                homes[parts[2], name].append("/".join(parts[3:]))
    assert total > 800 and not {key: files for key, files in homes.items() if len(files) > 1}


# Strings and comments; then what opens a scope: a namespace, a type, or anything else; and constants outside of functions.
UNREAD = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.S)
SCOPE = re.compile(r"namespace\s*(?P<namespace>[\w:]*)\s*\{"
                   r"|\b(?:enum class|enum|struct|class|union)\s+(?P<type>[\w:]+\w)(?:\s+final)?(?:\s*:(?!:)[^;{()=]*)?\s*\{"
                   r"|\binline constexpr [\w:<>,&* ]*?\b(?P<constant>k[A-Z]\w*)|(?P<open>\{)|(?P<close>\})")


def defined_names(text: str) -> list[str]:
    """Types and constants that a file defines where other files see them, with the namespaces and types around them."""
    scopes, found = [], []
    for match in SCOPE.finditer(UNREAD.sub(" ", text)):
        if match["close"]:
            scopes.pop()
        elif match["open"]:
            scopes.append("{")
        elif match["namespace"] is not None:
            scopes.append(match["namespace"] or "{")
        else:
            name = match["type"] or match["constant"]
            if "{" not in scopes:
                found.append("::".join([*scopes, name]))
            if match["type"]:
                scopes.append(name)
    return found


def test_defined_names_are_found():
    text = """namespace one::two {
inline constexpr double kLeast = 1e-3;  // struct NotThis {
enum class Kind : int { kFirst };
template <class T>
struct Row final : Base<T> {
  struct Part {};
  void member() { struct Local {}; }
};
struct Owner::Inner {};
struct Declared;
namespace {
struct Own {};
}  // namespace
}  // namespace one::two
"""
    names = ["kLeast", "Kind", "Row", "Row::Part", "Owner::Inner"]
    assert defined_names(text) == [f"one::two::{name}" for name in names]


@pytest.mark.skipif(not SOURCES, reason="the sources are not there")
def test_no_name_is_defined_twice():
    """The one-definition rule: the linker would take either of two types or constants for both."""
    homes = defaultdict(list)
    for path in SOURCES:
        for name in defined_names(path.read_text(encoding="utf-8")):
            homes[name].append(path.relative_to(ROOT).as_posix())
    assert len(homes) > 600 and not {name: files for name, files in homes.items() if len(files) > 1}


def test_files_that_are_run_first_are_there():
    tests = ROOT / "tests" / "python"
    text = (tests / "conftest.py").read_text(encoding="utf-8")
    names = re.findall(r'"(.*?)"', re.search(r"^LONGEST_FILES = \((.*?)\)$", text, re.DOTALL | re.MULTILINE)[1])
    assert len(names) > 5 and [name for name in names if not (tests / name).is_file()] == []
