"""Each scene file that comes with echopath loads, shows its objects to the radar, and has a line in the documentation."""
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import echopath as ep

ROOT = Path(__file__).parents[4]
SCENES = sorted((ROOT / "data" / "scenes").glob("*.toml"))
HIDDEN = {"ghost_corner": {"person"}}     # what no straight line reaches, and is meant so


@cache
def loaded(path):
    return ep.load_scene(path)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scene_is_traced_and_its_parts_take_paths(path):
    scene_file = loaded(path)
    paths = ep.trace(scene_file.scene, scene_file.radar, num_rays=1000, max_bounces=2)
    assert paths.num_paths > 20
    assert np.all(np.isfinite(np.abs(paths.amplitude)))
    assert scene_file.title and scene_file.partitions()


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_surfaces_of_a_scene_do_not_lie_on_each_other(path):
    assert loaded(path).scene.coplanar_overlaps() == []


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_objects_of_a_scene_are_in_view_but_those_that_are_meant_to_be_hidden(path):
    scene_file = loaded(path)
    seen = {one.name: one.transmitter.visible_share
            for one in ep.visibility(scene_file.scene, scene_file.radar, num_directions=256)}
    hidden = {name for name, share in seen.items() if share < 0.005}
    assert hidden == HIDDEN.get(path.stem, set())


def test_the_documentation_has_a_line_for_each_scene():
    page = (ROOT / "python" / "docs" / "actors.md").read_text(encoding="utf-8")
    missing = [path.stem for path in SCENES if f"| `{path.stem}` |" not in page]
    assert not missing
