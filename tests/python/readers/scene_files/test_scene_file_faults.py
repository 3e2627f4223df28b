"""How faults of scene files are named."""
from __future__ import annotations

import math
import os
import re
import threading
from pathlib import Path

import pytest

import echopath as ep
from echopath.scene_file.lines import settings_told
from support.files.scene_files import RADAR, fault_of, mesh_object, without_line

CIRCLE = "".join(f"[[radar.receivers]]\nposition = [0.0, {0.01 * math.cos(0.7 * i)}, {1.0 + 0.01 * math.sin(0.7 * i)}]\n"
                 for i in range(9))
FAULTS = [
    (RADAR.replace("bandwidth", "bw"), "radar.waveform.bw: unknown key; did you mean 'bandwidth'?"),
    (RADAR.replace("bandwidth", "bandwith"), "radar.waveform.bandwith: unknown key; did you mean 'bandwidth'?"),
    (RADAR.replace("bandwidth = 1e9", ""), "radar.waveform.bandwidth: is missing"),
    (RADAR.replace("1e9", "'1e9'"), "radar.waveform.bandwidth: must be a number, got '1e9'"),
    (RADAR.replace("1e9", "0.0"), "radar.waveform: bandwidth: must be finite and not 0, negative where chirps fall, got 0"),
    (RADAR.replace("1e9", "nan"), "radar.waveform.bandwidth: must be finite, got nan"),
    (RADAR.replace("num_chirps = 8", "num_chirps = 8.5"), "radar.waveform.num_chirps: must be an integer, got 8.5"),
    (RADAR.replace("[0.0, 0.01, 1.0]", "[0.0, 1.0]"), "radar.receivers[0].position: must have at least 3 entries"),
    ("guard = 'off'\n" + RADAR, "guard: must be true or false, got 'off'"),
    ("guard = 0\n" + RADAR, "guard: must be true or false, got 0"),
    (RADAR + "[tracer]\nnum_rays = 3", "tracer: unknown key; did you mean 'trace'?"),
    (RADAR + "[trace]\nedges = 'yes'", "trace.edges: must be True, False or 'auto', got 'yes'"),
    (RADAR + "[trace]\nfaint_power = 'all'", "trace.faint_power: must be a number or 'auto', got 'all'"),
    (RADAR + "[trace]\nmax_bounces = 65", "trace.max_bounces: must be at most 64, got 65"),
    (RADAR + "[trace]\nnum_rays = true", "trace.num_rays: must be an integer, got True"),
    (RADAR + "[spectrum]\nwindow = 'hanning'", "spectrum.window: must be 'rect', 'hann', 'hamming', 'blackman', "
     "'blackman_harris', 'chebyshev', 'taylor', 'kaiser' or ('chebyshev', 'taylor' or 'kaiser', sidelobe level in dB, 20 to 300) "
     "(nearest: hann), got 'hanning'"),
    (RADAR + "[spectrum]\nwindow = ['chebyshev', 1000]", "spectrum.window: must be 'rect', "),
    (RADAR + "[replay]\nkeyframes = 4", "replay.keyframes: needs retrace = \"invalid\" or \"always\", got 4"),
    (RADAR + "[spectrum]\nwindow = ['chebyshev', -3]", "spectrum.window: must be 'rect', "),
    (RADAR + "[angle]\nwindow = 3", "angle.window: must be 'rect', "),
    (RADAR + "[angle]\nmethod = 'music'", "angle.method: must be 'bartlett' or 'capon', got 'music'"),
    (RADAR + "[angle]\nazimuth_deg = [10, -10, 1]", "angle.azimuth_deg: must be [first, last, step] in degrees"),
    (RADAR + "[angle]\nazimuth_deg = [0, 10, 0]", "angle.azimuth_deg: must be [first, last, step] in degrees"),
    (RADAR + "[angle]\nazimuth_deg = [-60, 60, 1e-12]",
     "angle.azimuth_deg: must be [first, last, step] in degrees, -360 <= first <= last <= 360, "
     "step > 0 and at most 36000 steps"),
    (RADAR + "[angle]\nazimuth_deg = [-60, 60, 1e-320]", "angle.azimuth_deg: must be [first, last, step] in degrees"),
    (RADAR + "[angle]\nazimuth_deg = [0, 10, 1" + 400 * "0" + "]", "angle.azimuth_deg: must be [first, last, step] in degrees"),
    (RADAR + "[angle]\nelevation_deg = [5, 5]", "angle.elevation_deg: must be a number or an ascending list"),
    (RADAR + "[angle]\nmethod = 'capon'\nwindow = 'hann'", "angle.window: must be \"rect\" for capon"),
    (RADAR + "[angle]\nvelocity = 10.0", "angle: velocity: must be within +-9.67"),
    (RADAR + "[angle]\nvelocity_gate = [10.0, 11.0]", "angle: velocity_gate: must hold a cell of the axis from -9.67"),
    (RADAR.replace("num_chirps = 8", "num_chirps = 2000000000") + "[angle]\nvelocity_gate = [10.0, 11.0]",  # 16 GB of cells
     "angle: velocity_gate: must hold a cell of the axis from -9.671 to 9.671 m/s in steps of 9.67e-09"),
    (RADAR + CIRCLE + "[angle]\nwindow = 'hann'", "angle: window: must be rect for an array that is no grid"),
    (RADAR + "[radar.receiver]\nreceiver_phase = [0.1, 0.2, 0.3]",
     "radar: receiver.receiver_phase: must be of the shape (1,) for this radar, got an array [3] of float64"),
    (RADAR + "[[interferers]]\nreceiver = {transmitter_gain_db = [0, 0]}\n" + RADAR.replace("[radar.", "[interferers."),
     "interferers[0]: receiver.transmitter_gain_db: must be of the shape (1,) for this radar, got an array [2] of float64"),
    (RADAR + "[parts]\na = 'T R'\nb = {c = 'T R'}",
     "parts: must be all selections (one partition) or all tables of selections (several), got ['a', 'b']"),
    (RADAR + "[parts]\na = 'T & R'",
     "parts.a: path expression: expected a hit (. 'mesh' S D E P [...]) or '(', got &\n  T & R\n    ^"),
    (RADAR + "[parts.b]\na = 'T . R & power > x'",
     "parts.b.a: path expression: expected a power in W, such as 1e-15, got x\n"),
    (RADAR + "[parts.b]\na = 'T . R & power > abc'",
     "parts.b.a: path expression: expected a power in W, such as 1e-15, got 'abc'\n"),
    (RADAR + mesh_object("material = 'metal'") + "\n[parts]\na = \"T 'wal' R\"",
     "parts.a: path expression: expected a glob that takes a mesh, got 'wal'; nearest names: "),
    (RADAR + "[parts]\nother = 'T . R'", "parts.other: must not use the name of the rest, got other"),
    (RADAR + mesh_object("material = 'concret'"), "objects[0].material: unknown material 'concret'"),
    (RADAR + '[[objects]]\nname = "a"\nactor = "runner"\nparameters = {skin = "jeans"}\n',
     "objects[0].parameters.skin: unknown material 'jeans'"),
    (RADAR + mesh_object("material = {scatering = 0.3}"),
     "objects[0].material.scatering: unknown key; did you mean 'scattering'?"),
    (RADAR + mesh_object("material = {scattering = 1.3}"), "objects[0].material.scattering: must be at most 1"),
    (RADAR + mesh_object("material = {base = 'plasterboard_wall', mirror = true}"),
     "objects[0].material: mirror: must be False for 'plasterboard_wall', which has layers, as flagged mirrors let nothing pass; "
     "'plasterboard' is the material without layers, got True"),
    (RADAR + mesh_object("material = {cross_polarization = 0.6}"),
     "objects[0].material.cross_polarization: must be at most 0.5"),
    (RADAR + mesh_object(""), "objects[0]"),
    (RADAR + mesh_object("material = 'metal'\nmotion = {kind = 'linaer'}"), "objects[0].motion: has an unknown kind"),
    (RADAR + mesh_object("material = 'metal'\nmotion = {kind = 'linear', speed = 3}"),
     "objects[0].motion.speed: unknown key"),
    (RADAR + mesh_object("material = 'metal'\nactor = 'plate'"),
     "objects[0].mesh: exactly one of mesh, model, actor and group must be given"),
    (RADAR + "[[objects]]\nname = 'a'\ngroup = true\nmaterial = 'metal'",
     "objects[0].material: must not be given for a group, whose parts have theirs, got 'metal'"),
    (RADAR + mesh_object("material = 'metal'\nparent = 'nobody'"),
     "objects[0]: parent: must be the full name of a node"),
    (RADAR + "[[objects]]\nname = 'a'\nactor = 'pedestrain'",
     "objects[0].actor: unknown actor 'pedestrain'; did you mean 'pedestrian'?"),
    (RADAR + "[[objects]]\nname = 'a'\nactor = 'pedestrian'\nparameters = {heigth = 2.0}",
     "objects[0].parameters.heigth: unknown key; did you mean 'height'?"),
    (RADAR + "[[objects]]\nname = 'a'\nactor = 'pedestrian'\nparameters = {height = 'tall'}",
     "objects[0].parameters: height: must be a finite number from 0.5 to 2.5 m, got 'tall'"),
]


@pytest.mark.parametrize("text, message", FAULTS, ids=[message[:40] for _, message in FAULTS])
def test_faults_name_the_file_the_dotted_path_and_the_rule(write, text, message):
    path = write(text, radar="")
    assert without_line(fault_of(path)).startswith(f"{path}: {message}")


def test_every_fault_is_named_at_once(write):
    path = write(RADAR.replace("bandwidth", "bandwith") + "[trace]\nseed = -1", radar="")
    assert [line.split(": ")[2] for line in fault_of(path).splitlines()] == ["radar.waveform.bandwith", "trace.seed"]


# Faults in lines that are counted by hand: the text begins with an empty line, which is line 1.
LINES = {
    "an unknown key": ("\n[trace]\nmax_bounces = 3\nnum_ray = 5\n", 4),
    "a key behind arrays and texts of several lines": (
        "\ntitle = \"\"\"a\nb\"\"\"\n[angle]\nelevation_deg = [\n 1, # one\n 2,\n]\nwindow = 'han'\n", 9),
    "a key of the second object": (
        "\n[[objects]]\nname = 'a'\ngroup = true\n[[objects]]\nname = 'b'\ngroup = true\nspeed = 'fast'\n", 8),
    "what the core refuses of a key": ("\n[[objects]]\ngroup = true\nparent = 'nobody'\nname = 'a'\n", 4),
    "a table below an object": (
        "\n[[objects]]\nname = 'a'\ngroup = true\n[objects.motion]\nkind = 'linear'\nvelocity = [1, 2]\n", 7),
    "a table whose parent is misspelt": ("\n[part.route]\na = 'T . R'\n", 2),
    "within a value": ("\n[[objects]]\nname = 'a'\ngroup = true\nmotion = {kind = 'linear', velocity = [1, 2]}\n", 5),
    "a key that is missing, at its table": ("\n[parts]\n[sequence]\nframes = 3\n", 3),
    "a part in quotes": ("\n[parts]\na = 'T . R'\n\"my part\" = 'T R R'\n", 4),
    "a dotted key": ("\ntrace.num_rays = 5\ntrace.seed = -1\n", 3)}


@pytest.mark.parametrize("text, line", LINES.values(), ids=LINES)
def test_faults_are_told_with_the_line(write, text, line):
    path = write("", radar=text + RADAR)
    assert fault_of(path).startswith(f"{path}: line {line}: ")


def test_lines_that_windows_ends_are_counted_alike(write):
    path = write("", radar="\n[trace]\nnum_ray = 5\n" + RADAR)
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert fault_of(path).startswith(f"{path}: line 3: trace.num_ray: ")


def test_a_pipe_of_the_shell_is_read_once():
    """As of `echopath run <(m4 scene.toml)`, without a name: read again, for the lines of its faults, it is empty."""
    reading, writing = os.pipe()
    os.write(writing, f"\n[trace]\nnum_ray = 5\n{RADAR}".encode())
    os.close(writing)
    assert fault_of(Path(f"/dev/fd/{reading}")).startswith(f"/dev/fd/{reading}: line 3: trace.num_ray: ")
    os.close(reading)


def test_settings_of_a_pipe_that_a_run_refuses_are_told_without_the_line(tmp_path):
    """It has been read, and would wait for ever to be read again."""
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=(tmp_path / "pipe").write_text, args=("[labels]\nerrors = true\n",))
    writer.start()
    with pytest.raises(ValueError, match="^errors: need batches$"), settings_told(tmp_path / "pipe"):
        raise ValueError("errors: need batches")
    (tmp_path / "pipe").read_text()
    writer.join()


def test_a_table_that_is_nowhere_has_no_line(write):
    path = write("title = 'no radar'\n", radar="")
    assert fault_of(path) == f"{path}: radar: is missing"


def test_syntax_errors_name_the_file_and_the_line(write):
    path = write("[trace\n", radar="title = 'ok'\n")
    assert str(path) in fault_of(path) and "line 2" in fault_of(path)


def test_a_scene_file_may_begin_with_a_byte_order_mark(write):
    path = write("")
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert ep.load_scene(path).title == ""


def test_a_gain_instead_of_a_loss_is_shown_as_the_file_has_it(write):
    fault = fault_of(write(mesh_object("material = {permittivity = [5, -0.1]}")))
    assert "objects[0].material.permittivity: " in fault and fault.endswith("must not be negative, got [5, -0.1]")


def test_names_must_not_hold_nul(write):
    fault = fault_of(write('[[objects]]\nname = "a\\u0000b"\nactor = "sphere"\nparameters = {radius = 1.0}\n'))
    assert "objects[0].name: must not hold a NUL character, got 'a\\x00b'" in fault


@pytest.mark.parametrize("text, message", [("a = " + "[" * 100_000, "nested too deeply"),
                                           ('\n{"radar": {}}', "must be TOML, .* begins with a brace, as JSON does"),
                                           ("a = " + "1" * 10_000, "digits")])
def test_texts_that_the_parser_cannot_take_name_the_file(tmp_path, text, message):
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(ValueError, match=f"^{re.escape(str(tmp_path))}.*{message}"):
        ep.load_scene(tmp_path / "scene.toml")


def test_a_template_of_a_dataset_is_told_with_the_command_that_takes_it(write):
    assert fault_of(write("[dataset]\nscenes = 2\n")).endswith(
        ": a template of a dataset, where a scene file is asked for; `echopath dataset " + str(write("[dataset]\nscenes = 2\n"))
        + " --out DIR` makes its frames")


def test_a_missing_scene_file_is_a_file_error(tmp_path):
    with pytest.raises(ep.FileError, match="nowhere.toml"):
        ep.load_scene(tmp_path / "nowhere.toml")


def told_with(path, message: str) -> str:
    return rf"^{re.escape(str(path))}: line \d+: {re.escape(message)}"


@pytest.mark.parametrize("text, key", [
    (mesh_object('material = "metal"').replace("quad.obj", "gone.obj"), "objects[0].mesh"),
    ('[[objects]]\nname = "a"\nmodel = "gone.glb"\n', "objects[0].model"),
    ('[[objects]]\nname = "a"\nactor = "bicycle"\ntrajectory = "gone.csv"\n', "objects[0].trajectory"),
    ('[[objects]]\nname = "a"\nactor = "captured_pedestrian"\nparameters = {path = "gone.bvh"}\n', "objects[0].parameters.path"),
    ('[[traffic]]\nfile = "gone.xml"\n', "traffic[0].file"),
    ('[[interferers]]\nsensor = "gone.cfg"\n', "interferers[0].sensor")])
def test_a_file_that_is_missing_is_told_with_the_key_that_names_it(write, text, key):
    path = write(text)
    with pytest.raises(ep.FileError, match=told_with(path, f"{key}: {path.parent}") + ".gone"):
        ep.load_scene(path)


def test_the_first_key_beside_a_sensor_is_told_with_its_value(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('[radar]\nsensor = "radar.cfg"\nempty_slots = 2\npolarization = [0.0, 1.0, 0.0]\n')
    told = told_with(path, "radar.polarization: must not stand beside sensor, got [0.0, 1.0, 0.0]")
    with pytest.raises(ValueError, match=told):
        ep.load_scene(path)


@pytest.mark.parametrize("place, key", [("radar", "radar.pattern.file"), ("transmitter", "radar.transmitters[0].pattern.file")])
def test_a_missing_pattern_is_told_with_the_radar_or_the_antenna_that_has_it(write, place, key):
    path, pattern = write(""), 'pattern = {kind = "table", file = "gone.csv"}\n'
    head = "[radar]\n" if place == "radar" else "[[radar.transmitters]]\n"
    text = path.read_text()
    path.write_text(text.replace(head, head + pattern, 1) if head in text else f"{head}{pattern}{text}")
    with pytest.raises(ep.FileError, match=told_with(path, f"{key}: {path.parent}") + ".gone"):
        ep.load_scene(path)


def test_a_mirror_of_layers_without_a_whole_material_of_its_name_gets_no_name_instead(write):
    """Nor does another fault of a material that is to be a mirror, and the name that the message gives is taken."""
    for name, fault in (("curtain", "mirror = true"), ("plasterboard", "mirror = true, reflectivity = 0.5")):
        told = fault_of(write(mesh_object(f"material = {{base = '{name}', {fault}}}")))
        assert "objects[0].material: " in told and "instead" not in told
    scene = ep.load_scene(write(mesh_object("material = {base = 'plasterboard', mirror = true}"))).scene
    assert scene.meshes[0].material.mirror


@pytest.mark.parametrize("text, told", [
    ("num_rays = 5\n" + RADAR, "num_rays: unknown key; it belongs to [trace]"),
    (RADAR + "[labels]\nmark_mirrors = true",
     "labels.mark_mirrors: unknown key; it belongs to the top of the file, above all tables"),
    (RADAR + "[trace]\ntitle = 'a street'", "trace.title: unknown key; it belongs to the top of the file, above all tables"),
    ("seed = 5\n" + RADAR, "seed: unknown key; it belongs to [trace] or [noise]"),
    (RADAR.replace("num_samples", "transmit_power = 1.0\nnum_samples"),
     "radar.waveform.transmit_power: unknown key; it belongs to [radar]"),
    (RADAR + mesh_object("material = 'metal'\nvelocity = [1, 0, 0]"),
     "objects[0].velocity: unknown key; it belongs to [objects.motion] or [angle]"),
    (RADAR + mesh_object("conductor = true"), "objects[0].conductor: unknown key; it belongs to [objects.material]"),
    (RADAR + "[[objects]]\nname = 'a'\nfile = 'a.obj'\n",
     "objects[0].file: unknown key; an object names its file by mesh (OBJ, PLY, STL, OFF) or model"),
    (RADAR + "[[objects]]\nname = 'a'\nactor = 'sphere'\nradius = 1\n",
     "objects[0].radius: unknown key; actors have it in parameters = {radius = ...}"),
    (RADAR + "[[objects]]\nname = 'a'\nactor = 'sphere'\nparameters = {radius = 1, visible = false}\n",
     "objects[0].parameters.visible: unknown key; it belongs to [[objects]]"),
    (RADAR + "[objects]\nname = 'a'\n", "objects: must be an array, under [[objects]], got {'name': 'a'}"),
    ("[[radar]]\ntransmit_power = 1.0\n", "radar: must be a table, under [radar], got [{'transmit_power': 1.0}]"),
    ("position = [0, 0, 0]\n" + RADAR, "position: unknown key; known keys: title, ")])
def test_a_key_that_belongs_to_another_table_is_told_with_that(write, text, told):
    assert f": {told}" in fault_of(write("", radar=text))


@pytest.mark.parametrize("typed", ["data/scenes/corners.toml", "corners.toml", "data/datasets/crossing.toml"])
def test_a_scene_that_comes_along_is_told_where_nothing_stands(typed, tmp_path, monkeypatch):
    """Who has the package alone types the path of the documentation."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ep.FileError, match="No such file.*; the one that comes with echopath is ") as told:
        ep.load_scene(typed)
    named = Path(str(told.value).split(" is ")[-1])
    assert named.is_file() and named.name == Path(typed).name
    with pytest.raises(ep.FileError, match=r"nothing\.toml: cannot be read \(No such file or directory\)$"):
        ep.load_scene("nothing.toml")
