"""What README.md says of the program is so: its Python runs as it stands and prints what it says."""
import re
from pathlib import Path

import numpy as np
import pytest

import echopath as ep

TEXT = (Path(__file__).parents[3] / "README.md").read_text()


@pytest.fixture(scope="module")
def blocks():
    return re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_the_table_of_packages_names_every_package_and_the_home_of_every_public_name():
    named = set(re.findall(r"`(\w+)`", " ".join(row.split("|")[1] for row in TEXT.splitlines() if row.startswith("| `"))))
    folder = Path(ep.__file__).parent
    packages = {path.parent.name for path in folder.glob("*/__init__.py")}
    homes = {getattr(ep, name).__module__.split(".")[1] for name in ep.__all__
             if getattr(getattr(ep, name), "__module__", "").startswith("echopath.")} - {"_core"}
    assert packages | homes <= named
    there = {path.stem for path in folder.iterdir()} | {path.name for path in (folder.parents[1] / "cpp" / "echopath").iterdir()}
    assert named <= there


MEASURED = re.compile(r"[+-]?\d+\.(\d+)|[+-]?\d+(?= dBm|,? to )|\d+(?= cells?\b| above| labelled)(?! cells:)")


def assert_prints_the_same(found, printed):
    """The same words, and what is measured to one in its last digit: machines with other instructions round otherwise."""
    found, printed = (" ".join(text.split()) for text in (found, printed))
    assert MEASURED.sub("#", found) == MEASURED.sub("#", printed)
    for one, other in zip(MEASURED.finditer(found), MEASURED.finditer(printed), strict=True):
        unit = 10.0 ** -len(other[1] or "")
        assert abs(float(one[0]) - float(other[0])) < 1.5 * unit, f"{one[0]} in place of {other[0]}"


@pytest.fixture(scope="module")
def names():
    return {}


def test_the_example_prints_what_stands_below_it(blocks, names, capsys):
    exec(blocks[0], names)
    printed = re.search(r"```python\n.*?```\nprints\n```\n(.*?)```", TEXT, re.DOTALL)[1]
    assert_prints_the_same(capsys.readouterr().out, printed)


def test_labels_of_the_example_print_what_stands_below_them(names):
    printed = re.search(r"`print\(labels\)` prints\n```\n(.*?)\n```", TEXT, re.DOTALL)[1]
    assert_prints_the_same(str(ep.annotate(names["paths"], names["parts"])), printed)


def test_detections_of_the_example_are_what_the_scene_holds(blocks, names):
    """The map has noise, so that what is found is the person or, at rest, the wall."""
    exec(blocks[1], names)
    points = names["points"]
    assert len(points) > 0 and set(points.part) <= {*names["parts"], "noise"} and "direct" in points.part
    direct = points.part == "direct"
    assert np.all((points.range[direct] > 9.0) & (points.range[direct] < 11.0))  # m: the person stands at 10
