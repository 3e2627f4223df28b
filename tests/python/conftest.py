"""Fixtures of several tests."""
import os
import signal
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from support.files import small_dataset as small
from support.labelled import trace_plates_and_wall
from support.pictures import plain

# Seconds each: whoever comes to one of them last would be waited for by all others.
LONGEST_FILES = ("signal/cfar/test_cfar.py", "documents/test_docs_site.py", "readers/test_fuzz_readers.py",
                 "replay/test_reference.py", "bench/test_hard.py", "actors/test_crowds.py",
                 "labels/detections/test_paths_of_detections.py", "labels/detections/test_detections_in_beams.py",
                 "dataset/test_dataset_kills.py", "trace/cross_sections/test_rcs.py", "trace/cross_sections/test_published.py",
                 "trace/test_chain_glints.py", "bench/test_bench_measured.py", "dataset/test_dataset_exports.py",
                 "edges/test_corners.py", "trace/rough/test_surface_scatterers.py")
FOLDER = Path(__file__).parent


class _LastFirst(pytest.Dir):
    """A folder whose files and folders are read from the last to the first."""

    def collect(self):
        return reversed(list(super().collect()))


def pytest_collect_directory(path, parent):
    """Every other process of xdist begins at the end: on a fresh machine, where all that tests import has yet to be compiled,
    each then compiles one half and finds the other one done."""
    is_odd = os.environ.get("PYTEST_XDIST_WORKER", "gw0")[-1] in "13579"
    return _LastFirst.from_parent(parent, path=path) if is_odd else None


def pytest_collection_modifyitems(items):
    """Begins with the longest files; all others come by name, in all processes alike."""
    place = {name: index for index, name in enumerate(LONGEST_FILES)}
    items.sort(key=lambda item: (place.get(os.path.relpath(item.path, FOLDER), len(place)), item.path))


@pytest.fixture
def blank_pictures(monkeypatch):
    """The figures and films of commands are made but not drawn, which they spend most of their time with: for tests of all else.
    Their files are there, and empty."""
    monkeypatch.setattr(ep.plots, "save_png", lambda figure, path, **_: Path(path).write_bytes(b""))
    monkeypatch.setattr("echopath.cli.run_sequence.write_film_of", lambda drive, path: Path(path).write_bytes(b""))


@pytest.fixture
def plain_pictures():
    """The figures of commands are drawn but not laid out."""
    with plain():
        yield


@pytest.fixture
def ctrl_c_is_heard():
    """Python's usual handler of Ctrl-C, which a process started in the background does not have."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(autouse=True)
def threads_stay_as_they_are():
    """A test that changes the number of threads gives it back: later ones would quietly run in another way."""
    before = ep.num_threads()
    yield
    left = ep.num_threads()
    if left != before:
        ep.set_num_threads(0)
    assert left == before, f"the test leaves {left} threads for parallel loops where there were {before}"


@pytest.fixture(scope="session")
def plates_and_wall():
    """(paths, selections, {part: (range, velocity)} by closed form) of two plates beside a mirror wall."""
    return trace_plates_and_wall()


@pytest.fixture(scope="session")
def labels(plates_and_wall):
    """Labels of `plates_and_wall` on a map whose cells are half as wide."""
    paths, parts, _ = plates_and_wall
    return ep.annotate(paths, parts, window="blackman_harris", zero_pad=2, dynamic_range_db=80.0)


SMALL = 1e-5  # an expected value below this is compared by its ratio alone
_approx = pytest.approx


def approx_by_ratio(expected, rel=None, abs=None, nan_ok=False):
    """pytest.approx, but for powers in W: its absolute tolerance of 1e-12 would take any of them for right."""
    if abs is None and isinstance(expected, (float, complex, np.ndarray)):
        largest = np.max(np.abs(expected), initial=0.0)
        if 0.0 < largest < SMALL:
            return _approx(expected, rel=1e-6 if rel is None else rel, abs=0.0, nan_ok=nan_ok)
    return _approx(expected, rel=rel, abs=abs, nan_ok=nan_ok)


pytest.approx = approx_by_ratio


@pytest.fixture(scope="session")
def small_dataset(tmp_path_factory):
    """(template, folder) of a dataset that one process made without a break; nobody changes it."""
    folder = tmp_path_factory.mktemp("small_dataset")
    path = small.written(folder)
    small.make(path, folder / "out")
    return path, folder / "out"
