"""What the package says of itself: its licence is that of its parts, and the source archive holds what its rules name."""
import fnmatch
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
MANIFEST = ROOT / "MANIFEST.in"
# The licences under which FFTW and Embree, with which the extension is linked, may be passed on together: FFTW is under the
# GPL from version 2 on, and the Apache License 2.0 of Embree fits version 3 alone.
LICENCES = {"MIT": "LICENSE", "GPL-3.0-or-later": "LICENSE-GPL-3.0"}


def project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_the_licence_is_that_of_source_and_wheels():
    named = project()["license"].split(" AND ")
    assert named == list(LICENCES) and project()["license-files"] == list(LICENCES.values())
    assert (ROOT / LICENCES["MIT"]).read_text(encoding="utf-8").startswith("MIT License")
    assert "GNU GENERAL PUBLIC LICENSE\n                       Version 3" in (
        ROOT / LICENCES["GPL-3.0-or-later"]).read_text(encoding="utf-8")


def test_texts_name_the_licences_of_the_package():
    readme = (ROOT / "README.md").read_text(encoding="utf-8").partition("\n## Licence\n")[2].partition("\n## ")[0]
    note = (ROOT / "LICENSE").read_text(encoding="utf-8").partition("Note on binaries.")[2]
    readme, note = " ".join(readme.split()), " ".join(note.split())
    assert "under the MIT licence" in readme and "under the GPL, version 3 or later" in readme
    assert "version 3 of the GPL, or a later one" in note


def unmatched(manifest: str, files: list[str]) -> list[str]:
    """Patterns of inclusion that match none of `files`, which stand relative to the root."""
    missing = []
    for line in manifest.splitlines():
        verb, *words = line.split() or [""]
        if verb == "include":
            missing += [word for word in words if not fnmatch.filter(files, word)]
        elif verb == "recursive-include":
            below = [file for file in files if file.startswith(words[0] + "/")]
            missing += [f"{words[0]}: {word}" for word in words[1:]
                        if not any(fnmatch.fnmatch(Path(file).name, word) for file in below)]
    return missing


def test_unmatched_patterns_are_found():
    manifest = "include README.md gone.txt\n# a comment\nrecursive-include cpp *.h *.supp\nprune out\n"
    assert unmatched(manifest, ["README.md", "cpp/base/a.h"]) == ["gone.txt", "cpp: *.supp"]


@pytest.mark.skipif(not MANIFEST.exists(), reason="the sources are not there")
def test_each_rule_of_the_source_archive_matches_a_file():
    folders = re.findall(r"^recursive-include (\S+)", MANIFEST.read_text(encoding="utf-8"), re.M)
    files = [path.name for path in ROOT.iterdir() if path.is_file()]
    for folder in set(folders):
        files += [path.relative_to(ROOT).as_posix() for path in (ROOT / folder).rglob("*") if path.is_file()]
    assert folders and not unmatched(MANIFEST.read_text(encoding="utf-8"), files)


@pytest.mark.skipif(not MANIFEST.exists(), reason="the sources are not there")
def test_the_source_archive_has_all_files_of_the_tests():
    rules = re.findall(r"^recursive-include (tests\S*) (.+)$", MANIFEST.read_text(encoding="utf-8"), re.M)
    taken = {path for folder, words in rules for word in words.split() for path in (ROOT / folder).rglob(word)}
    there = {path for path in (ROOT / "tests").rglob("*") if path.is_file() and path.parent.name != "__pycache__"}
    assert taken and not [path.relative_to(ROOT).as_posix() for path in there - taken]
