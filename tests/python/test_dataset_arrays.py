"""Maps of datasets as arrays, which threads may read."""
import threading
from types import SimpleNamespace

import numpy as np

from echopath.dataset.arrays import KINDS, _Kinds


def test_classes_of_cells_are_those_of_their_scene_in_every_thread():
    """Two scenes whose objects of one name differ in class, of which the second is read while the first is."""
    drawn = {scene: SimpleNamespace(table={"objects": [{"name": "user", "actor": actor}]})
             for scene, actor in enumerate(("car", "pedestrian"))}
    kinds = _Kinds(SimpleNamespace(template=SimpleNamespace(draw=drawn.get, settings=SimpleNamespace(classes={}))))

    def frame(scene: int, labels) -> SimpleNamespace:
        return SimpleNamespace(scene=scene, frame=SimpleNamespace(labels={"parts": labels}))

    class Plain:
        object_map, ghost_map, ghosts = np.zeros((1, 1), int), np.full((1, 1), -1), []
        objects = [SimpleNamespace(name="user")]

    class Meanwhile(Plain):
        @property
        def objects(self):
            other = threading.Thread(target=kinds.of, args=(frame(1, Plain()),))
            other.start()
            other.join()
            return Plain.objects

    assert KINDS[kinds.of(frame(0, Meanwhile())).item()] == "car" and KINDS[kinds.of(frame(1, Plain())).item()] == "pedestrian"
