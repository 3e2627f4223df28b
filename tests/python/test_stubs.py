"""What editors and type checkers know of echopath is what is there."""
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

import echopath

ROOT = Path(__file__).resolve().parents[2]


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


def _complaints(path) -> str:
    """What mypy --strict says of a file that uses echopath."""
    pytest.importorskip("mypy", reason="mypy, of the extra 'test', is not installed")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", os.devnull, path]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=os.environ | {"MYPYPATH": "python"}).stdout


def test_type_checker_is_content_with_what_a_user_writes():
    assert _complaints(ROOT / "tests" / "typing" / "first_experiment.py").startswith("Success")


def test_type_checker_finds_what_is_wrong(tmp_path):
    """It would be content with anything if it did not find the stubs."""
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import echopath as ep\nep.ChirpSequence(num_sample=5)\nep.ChirpSequence(num_samples='5')\n")
    told = _complaints(wrong)
    assert 'Unexpected keyword argument "num_sample"' in told and told.count("error:") == 2
