"""Scene files and antenna files."""
from __future__ import annotations

import tomllib
from pathlib import Path
from random import Random

import echopath as ep
from echopath.actors import surfaces
from echopath.scene_file.load import scene_file_of
from fuzz.folder import memory_folder
from fuzz.mutate import damaged, mistaken
from fuzz.tables import Tables

MANY_TRIANGLES = 1_000_000  # of an actor: up to 20 million are made, at a microsecond or two each, which is no fault of a reader
DATA = Path(__file__).parents[3] / "data"
ANTENNA = ("# of a patch\nazimuth_deg,elevation_deg,gain_db,phase_deg\n" +
           "\n".join(f"{azimuth},{elevation},{3 - abs(azimuth) / 20:g},0"
                     for azimuth in (-60, 0, 60) for elevation in (-30, 0, 30)))
SOLVER = ('Theta [deg.]  Phi   [deg.]  Abs(Dir.)[dBi   ]   Abs(Theta)[dBi   ]\n' + "-" * 60 + "\n" +
          "\n".join(f"{theta:8.3f} {phi:8.3f} {3 - theta / 20:.3e} -3.0" for phi in (0, 90, 180, 270) for theta in (0, 60, 180)))
FEKO = ('##File Type: Far Field\n#Result Type: Gain\n#  "Theta"  "Phi"  "Gain(Total)"\n' +
        "\n".join(f"{theta} {phi} -1" for phi in (0, 120, 240) for theta in (0, 90, 180)))
CUTS = ("NAME a\nGAIN 1 dBd\nHORIZONTAL 4\n" + "\n".join(f"{angle} {angle % 180 / 10}" for angle in range(0, 360, 90)) +
        "\nVERTICAL 3\n0 0\n120 9.5\n240.0 9\n")
RADAR = """title = "a street"
guard = true
[radar]
transmit_power = 0.01
noise_figure_db = 12.0
multiplexing = "tdm"
polarization = [0.0, 0.0, 1.0]
pattern = {kind = "cosine_power", exponent = 4.0, peak_gain = 10.0}
motion = {kind = "linear", velocity = [1.0, 0.0, 0.0], angular_velocity = [0.0, 0.0, 0.1]}
[radar.waveform]
start_frequency = 77e9
bandwidth = 150e6
num_samples = 16
sampling_rate = 5e6
num_chirps = 8
chirp_interval = 50e-6
real = false
[[radar.transmitters]]
position = [0.0, 0.0, 0.5]
yaw_deg = 10
[[radar.receivers]]
position = [0.0, 0.002, 0.5]
orientation = [1.0, 0.0, 0.0, 0.0]
pattern = {kind = "table", file = "antenna.csv"}
"""
OBJECTS = """[[objects]]
name = "wall"
mesh = "wall.obj"
unit = 0.001
material = {permittivity = [5.0, 0.3], scattering = 0.3, mirror = true}
position = [5.0, 0.0, 0.0]
yaw_deg = 20.0
smooth = false
[[objects]]
name = "ball"
actor = "sphere"
parameters = {radius = 0.3, subdivisions = 1}
material = "metal"
transform = [[1.0, 0.0, 0.0, 2.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
parent = "wall"
motion = {kind = "keyframes", times = [0.0, 1.0], translations = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], interpolation = "linear"}
"""
SETTINGS = """[trace]
num_rays = 1000
max_bounces = 4
seed = 1
start_time = 0.0
polarization = "auto"
footprint = "second_order"
sampler = "lattice"
batches = 2
target_error_db = 0.3
max_rays = 100000
[replay]
replay = "material"
evaluate = "chirps"
retrace = "never"
keyframes = 0
[spectrum]
window = ["chebyshev", 60.0]
zero_pad = 2
[angle]
method = "bartlett"
azimuth_deg = [-60.0, 60.0, 5.0]
elevation_deg = [0.0, 5.0]
velocity = 1.0
combine = "peak"
diagonal_loading = 0.01
range_neighbours = 2
[noise]
seed = 3
[parts.route]
direct = "T . R"
wall = "T .* 'wall' .* R"
[labels]
plane = "range_doppler"
objects = {ball = "wall/ball", wall = ["wall"]}
noise_margin_db = 10.0
[detections]
method = "ca"
false_alarm_rate = 1e-6
training_range = 4
rank = 0.75
"""
ACTORS = "".join(f'[[objects]]\nname = "{name}"\nactor = "{name}"\nmaterial = "metal"\nparameters = {{{keys}}}\n'
                 for name, keys in (
    ("wall", "length = 1.0, height = 2.0"), ("box", "size = [1.0, 2.0, 3.0]"), ("plate", "width = 0.2, height = 1.0"),
    ("trihedral", "size = 0.1, edge = 0.05")))
SCENES = [RADAR + OBJECTS + SETTINGS, RADAR + OBJECTS,
          RADAR + ACTORS + SETTINGS.replace("wall/ball", "box"), RADAR + SETTINGS.partition("[parts")[0]]


def _small_tables() -> list[dict]:
    """What the seeds say, each table or object in a file of its own: most of what a case costs goes by what its file holds."""
    full = [tomllib.loads(text) for text in SCENES]
    radar = full[0]["radar"]
    antennas = [{"position": [0.0, 0.0, 0.0]}]
    least = {"waveform": radar["waveform"], "transmitters": antennas, "receivers": antennas}
    found = [{"radar": least | {key: value}} for key, value in radar.items()]
    for objects in (table["objects"] for table in full if "objects" in table):
        found += [{"radar": least, "objects": [{key: value for key, value in one.items() if key != "parent"}]} for one in objects]
    plate = {"actor": "plate", "material": "metal", "parameters": {"width": 0.2, "height": 1.0}}
    named = [plate | {"name": "wall"}, plate | {"name": "ball", "parent": "wall"}]
    found += [{"radar": least, "objects": named, key: value} for key, value in full[0].items() if key not in ("radar", "objects")]
    return found


def _text_case(folder: Path, name: str, texts: list, random: Random) -> Path:
    """Writes a text of the seeds with mistakes, or with damaged bytes."""
    path = folder / name
    text = random.choice(texts)
    if random.random() < 0.8:
        path.write_bytes(mistaken(text, texts, random).encode("utf-8", "surrogatepass"))
    else:
        path.write_bytes(damaged(text.encode("utf-8"), random))
    return path


def _accepts(load, path: Path, errors: tuple) -> bool:
    try:
        load(path)
    except errors as error:
        assert str(error).startswith(f"{path}") or str(path.parent) in str(error), f"names no file: {error}"
        return False
    return True


def feed_scene():
    """Cases of scene files: they load, or are refused by an error that names the file.

    One in sixteen is a text with mistakes; the others are tables with mistakes, which reach the reader behind the syntax of
    TOML, and one in eight of them is as full as the texts.
    """
    surfaces.MAX_TRIANGLES = MANY_TRIANGLES
    folder = memory_folder()
    base = Path(folder.name)
    (base / "wall.obj").write_text("v 0 0 0\nv 1000 0 0\nv 1000 1000 0\nv 0 1000 0\ng left\nf 1 2 3 4\n")
    (base / "antenna.csv").write_text(ANTENNA)
    path = base / "scene.toml"
    for text in SCENES:
        path.write_text(text)
        ep.load_scene(path)
    small = _small_tables()
    for table in small:
        scene_file_of(table, path)
    few, all_together = Tables(small), Tables([tomllib.loads(text) for text in SCENES])

    def case(number: int) -> None:
        random = Random(f"scene {number}")
        if random.random() < 1 / 16:
            _accepts(ep.load_scene, _text_case(base, path.name, SCENES, random), (ValueError, ep.FileError))
        else:
            table = random.choice((few,) * 7 + (all_together,)).mistaken(random)
            _accepts(lambda path: scene_file_of(table, path), path, (ValueError, ep.FileError))

    case.folder = folder
    return case


def feed_antenna():
    """Cases of antenna files: they load, or are refused by ep.FileError."""
    folder = memory_folder()
    texts = [ANTENNA, ANTENNA.replace(",phase_deg", "").replace(",0\n", "\n").removesuffix(",0"),
             "\n".join((DATA / "antennas" / "patch_77ghz.csv").read_text().split("\n")[:60]), SOLVER, FEKO, CUTS]

    def case(number: int) -> None:
        path = _text_case(Path(folder.name), "antenna.csv", texts, Random(f"antenna {number}"))
        _accepts(ep.load_antenna, path, (ep.FileError,))

    case.folder = folder
    return case
