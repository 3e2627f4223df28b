"""What editors and type checkers know of echopath is what is there."""
import importlib.util
import os
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import echopath

ROOT = Path(__file__).resolve().parents[3]


def _maker():
    spec = importlib.util.spec_from_file_location("make_stubs", ROOT / "python" / "bindings" / "make_stubs.py")
    maker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(maker)
    return maker


def test_stubs_of_the_extension_are_current():
    pytest.importorskip("pybind11_stubgen", reason="pybind11-stubgen, of the extra 'test', is not installed")
    maker = _maker()
    assert maker.TARGET.read_text(encoding="utf-8") == maker.stubs(), "run python python/bindings/make_stubs.py"


def test_stubs_use_plain_types():
    text = (ROOT / "python" / "echopath" / "_core.pyi").read_text(encoding="utf-8")
    assert "Supports" not in text and "Arg<" not in text and "echopath::" not in text
    assert "num_samples: int = 512" in text


def test_package_says_that_it_is_typed():
    assert (Path(echopath.__file__).parent / "py.typed").exists()


# What a user may write wrong, by the name of a file. The type checker would be content with anything if it did not find
# the stubs.
WRONG = {
    "name.py": "import echopath as ep\nep.simulat\nep.dataset.opem\nep.dataset.open('walkers').split('train')\n",
    "keyword.py": "import echopath as ep\nep.ChirpSequence(num_sample=5)\nep.ChirpSequence(num_samples='5')\n",
    "replaced.py": "import echopath as ep\nep.ChirpSequence().replace(num_chirp=4)\n"
                   "chirps: ep.ChirpSequence = ep.ChirpSequence().replace(num_chirps=4)\nchirps.num_chirps = 5\n",
    "errors.py": "import echopath as ep\nep.FileError('x').reason\nep.DeviceError('x').reason\n",
    "foreign.py": """import echopath as ep
def look(map: ep.RangeDoppler, film: ep.Spectrogram, labels: ep.Labels, truth: ep.Truth, stored: ep.StoredSequence) -> None:
    for axes in (map.plot(vmin=-120.0), film.plot(ax=map.plot()), labels.plot("objects")):
        axes.set_title("right")
        axes.set_titel("wrong")
    array: int = map.to_xarray().sel(range=3.0, method="nearest")
    dataset: int = stored.to_xarray()
    truth.to_xarray().data_vars
    film.plot(ax=3)
    labels.plot("ghosts")
""",
    "framed.py": """import echopath as ep
def look(frame: ep.Frame) -> None:
    frame.spectrum.valuez
    frame.labels["parts"].objects[0].state
    frame.paths + 1
    count: int = ep.num_bounces == 3
"""}


@pytest.fixture(scope="module")
def complaints(tmp_path_factory):
    """What mypy --strict says of files that use echopath, and of the stubs, by the name of the file: all in one run, since
    it reads the libraries for seconds. What it has read of them it keeps in the build folder, by their dates and contents."""
    pytest.importorskip("mypy", reason="mypy, of the extra 'test', is not installed")
    folder = tmp_path_factory.mktemp("typing")
    for name, text in WRONG.items():
        (folder / name).write_text(text)
    files = [ROOT / "tests" / "typing" / "first_experiment.py", ROOT / "tests" / "typing" / "with_frames.py",
             ROOT / "python" / "echopath" / "_core.pyi",
             *(folder / name for name in WRONG)]
    settings = ROOT / "tests" / "typing" / "mypy.ini"
    command = [sys.executable, "-m", "mypy", "--config-file", settings, "--cache-dir", ROOT / "build" / "mypy", *files]
    told = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=os.environ | {"MYPYPATH": "python"})
    assert told.stdout.rstrip().endswith(f"(checked {len(files)} source files)"), told.stdout + told.stderr
    errors = [line for line in told.stdout.splitlines() if ": error:" in line]
    return {file.name: [line for line in errors if Path(line.split(":")[0]).name == file.name] for file in files}


def test_type_checker_is_content_with_what_a_user_writes(complaints):
    assert complaints["first_experiment.py"] == []


def test_type_checker_is_content_with_what_pages_do_with_frames(complaints):
    assert complaints["with_frames.py"] == []


def test_type_checker_knows_what_a_frame_holds(complaints):
    told = complaints["framed.py"]
    words = '"RangeDoppler | Any" has no attribute "valuez"', '"ObjectLabel" has no attribute "state"', '"Paths"', '"Selection"'
    assert len(told) == 4 and all(word in line for word, line in zip(words, told)), told


def test_the_first_experiment_sees_its_ball():
    """At 11.7 m, the near side of a ball of 0.3 m radius at 12 m, and at -3 m/s, within a cell of the map."""
    experiment = runpy.run_path(str(ROOT / "tests" / "typing" / "first_experiment.py"))
    distance, velocity = experiment["seen_at"]
    cells = experiment["spectrum"].range[1], np.diff(experiment["spectrum"].velocity).mean()
    assert abs(distance - 11.7) < cells[0] and abs(velocity + 3.0) < cells[1]
    assert "ball" in experiment["found"].object


def test_type_checker_is_content_with_the_stubs_themselves(complaints):
    assert complaints["_core.pyi"] == []


def test_stubs_know_the_types_of_what_users_hold():
    """No Any for members of public classes."""
    text = (ROOT / "python" / "echopath" / "_core.pyi").read_text(encoding="utf-8")
    foreign = ("state__", "def replace(self, **kwargs: typing.Any) -> AntennaPattern")
    name, left = "", []
    for line in text.splitlines():
        name = line.split("(")[0].split(":")[0].removeprefix("class ") if line.startswith(("class ", "def ")) else name
        if "typing.Any" in line and name in echopath.__all__ and line.startswith("    def ") and "def _" not in line:
            left += [] if any(word in line for word in foreign) else [f"{name}: {line.strip()}"]
    assert not left, "\n".join(left)


def test_type_checker_knows_axes_and_arrays_of_other_libraries(complaints):
    told = "\n".join(complaints["foreign.py"])
    assert '"Axes" has no attribute "set_titel"' in told and 'has type "DataArray"' in told and 'has type "Dataset"' in told, told
    assert told.count("error:") == 5, told


def test_type_checker_knows_which_names_there_are(complaints):
    told = complaints["name.py"]
    assert len(told) == 2 and 'has no attribute "simulat"' in told[0] and 'has no attribute "opem"' in told[1], told


def test_type_checker_knows_the_errors(complaints):
    told = complaints["errors.py"]
    assert len(told) == 2 and '"FileError" has no attribute' in told[0] and '"DeviceError" has no attribute' in told[1], told


def test_replace_has_the_arguments_of_the_constructor(complaints):
    told = "\n".join(complaints["replaced.py"])
    assert 'Unexpected keyword argument "num_chirp"' in told and "read-only" in told and told.count("error:") == 2


def test_type_checker_finds_what_is_wrong(complaints):
    told = "\n".join(complaints["keyword.py"])
    assert 'Unexpected keyword argument "num_sample"' in told and told.count("error:") == 2
