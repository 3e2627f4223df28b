"""A small dataset of plates and walls: its template, and what the tests of datasets share."""
import hashlib
from pathlib import Path

from echopath import dataset
from support.files.scene_text import SMALL_RADAR

HEAD = """
[dataset]
scenes = 6
frames = 2
interval = 0.05
keep = "labels"
seed = 3
split = {train = 0.5, test = 0.5}
"""
SCENE = """
[radar]
noise_figure_db = 12.0
""" + SMALL_RADAR + """\
[[objects]]
name = "plate"
count = {integer = [1, 3]}
apart = 0.5
actor = "plate"
parameters = {width = 0.2, height = {uniform = [0.1, 0.3]}}
position = [{uniform = [1.5, 4.0]}, {normal = [0.0, 0.4], within = [-1.5, 1.5]}, 1.0]
yaw_deg = 180.0
material = {choice = ["metal", "concrete"], weights = [1, 3]}
speed = {choice = [0.0, {log_uniform = [0.1, 4.0]}]}
[[objects]]
name = "wall"
chance = 0.5
actor = "wall"
parameters = {length = 6.0, height = 2.0}
material = "concrete"
position = [3.0, 2.0, 0.0]
[trace]
num_rays = 400
max_bounces = 2
[labels]
"""


def written(folder: Path, text: str = HEAD + SCENE) -> Path:
    """The path of a template with a text."""
    path = folder / "plates.toml"
    path.write_text(text)
    return path


def bytes_of(folder: Path) -> dict[str, str]:
    """{path in the folder: digest} of all its files."""
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in sorted(folder.rglob("*")) if file.is_file()}


def make(path: Path, folder: Path, **options) -> list[dataset.MadeScene]:
    """The scenes of a run."""
    return [one for one in dataset.make(path, folder, **options) if isinstance(one, dataset.MadeScene)]
