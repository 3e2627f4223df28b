"""What tests of labels in files share."""
import pytest

import echopath as ep
from support.labelled_scene import DETECTIONS, LABELS, SCENE


@pytest.fixture(scope="session")
def scene_path(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "van.toml"
    path.write_text(SCENE + LABELS + DETECTIONS)
    return path


@pytest.fixture(scope="session")
def frame(scene_path):
    file = ep.load_scene(scene_path)
    return ep.simulate(file.scene, file.radar, trace=file.trace, signal=file.signal, parts=file.partitions(),
                       labels=file.labels, detections=file.detection_settings())


@pytest.fixture(scope="session")
def labels(frame):
    """With cells of objects, of ghosts and an object that is hidden, else these tests prove little."""
    made = frame.labels["by"]
    assert {label.status for label in made.objects} >= {"seen"} and any(label.occluders for label in made.objects)
    assert (made.object_map >= 0).any() and (made.ghost_map >= 0).any() and any(ghost.box is None for ghost in made.ghosts)
    assert len(set(made.dominant[made.mask])) > 1
    return made


@pytest.fixture
def saved(frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    return tmp_path / "frame.h5"
