"""What the frames of datasets cost: processor time of each stage, and bytes."""
from __future__ import annotations

import tempfile
import time
import warnings
from collections import Counter
from importlib.resources import as_file
from pathlib import Path

from ...base.process.threads import num_threads, set_num_threads
from ...base.storage.data_folder import data_folder
from ...dataset.folder import checksum
from ...dataset.template import Template
from ...sequence.keep import write_frame
from ..pace import told_at_reference, verdict

SCENES, QUICK_SCENES = 6, 2
STREET_LIMIT = 1.5  # s of a processor: a frame of a street with labels, 1e5 rays, 128 chirps, 3 x 4 antennas
TEMPLATES = ("crossing", "ghosts", "busy street", "paper's street")


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each template: processor seconds of a frame, its bytes, and the share of each stage."""
    before = num_threads()
    set_num_threads(1)
    try:
        with tempfile.TemporaryDirectory() as folder:
            return [_row(name, _template(name, Path(folder)), QUICK_SCENES if quick or name in STREETS else SCENES)
                    for name in TEMPLATES]
    finally:
        set_num_threads(before)


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    lines = [f"{'template':<16}{'frames':>7}{'frames/s and core':>19}{'s a frame':>11}{'kB a frame':>12}"]
    for row in rows:
        limit = row["limit"]
        judgement = "" if limit is None else f"  limit {limit} s: {verdict(row['seconds'], limit, row.get('paces'))}" + \
            told_at_reference(row["seconds"], row.get("paces"))
        lines.append(f"{row['template']:<16}{row['frames']:7d}{1.0 / row['seconds']:19.2f}{row['seconds']:11.3f}"
                     f"{row['bytes'] / 1e3:12.0f}{judgement}")
        lines.append("    " + ", ".join(f"{name} {100 * share:.0f} %" for name, share in row["shares"].items()))
    return lines


def _template(name: str, folder: Path) -> Template:
    """A template of `data/datasets`, or one of a street as STREET_LIMIT has it."""
    if name not in STREETS:
        with as_file(data_folder("datasets") / f"{name}.toml") as path:
            return Template(path)
    path = folder / f"{name}.toml"
    path.write_text(STREETS[name](), encoding="utf-8")
    return Template(path)


def _paper_street() -> str:
    """The street of the paper, whose walls and road are mirrors that scatter too: 11 paths a ray."""
    text = (data_folder("scenes") / "street.toml").read_text(encoding="utf-8")
    radar, objects = text[:text.index("[[radar.transmitters]]")], text[text.index("[[objects]]"):text.index("[parts.route]")]
    return (radar.replace("num_chirps = 256", "num_chirps = 128") + _antennas(1.0)
            + objects.replace("num_rays = 1_000_000", "num_rays = 100_000")
            + '[labels]\n[dataset]\nscenes = 1000\nframes = 1\n')


def _busy_street() -> str:
    """The street of `busy_street.toml`, dry, and with an ideal receiver."""
    text = (data_folder("datasets") / "busy_street.toml").read_text(encoding="utf-8")
    for begin, end in (("[weather]", "[radar]"), ("[radar.receiver]", "[radar.waveform]"),
                       ("[[radar.transmitters]]", "[[objects]]"), ("[detections]", "")):
        head, _, rest = text.partition(begin)
        text = head + (_antennas(0.0) if "transmitters" in begin else "") + (rest[rest.index(end):] if end else "")
    return text.replace("num_chirps = 32", "num_chirps = 128").replace("num_rays = 20_000", "num_rays = 100_000")


def _antennas(height: float) -> str:
    """Tables of 3 transmitters and 4 receivers in a row."""
    return ("".join(f"[[radar.transmitters]]\nposition = [0.0, {0.0078 * k}, {height}]\n" for k in range(3))
            + "".join(f"[[radar.receivers]]\nposition = [0.0, {0.03 + 0.00195 * k}, {height}]\n" for k in range(4)))


STREETS = {"busy street": _busy_street, "paper's street": _paper_street}


def _row(name: str, template: Template, scenes: int) -> dict:
    spent: Counter[str] = Counter()
    size = frames = 0
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for scene in range(scenes + 1):
            if scene == 1:  # the first warms up
                spent, size, frames = Counter(), 0, 0
            for path in _frames(template, scene, Path(folder), spent):
                size, frames = size + path.stat().st_size, frames + 1
    whole = sum(spent.values())
    return {"template": name, "frames": frames, "seconds": whole / frames, "bytes": size / frames,
            "limit": STREET_LIMIT if name in STREETS else None, "timed": name in STREETS,
            "shares": {stage: seconds / whole for stage, seconds in spent.most_common()}}


def _frames(template: Template, scene: int, folder: Path, spent: Counter):
    """Makes the frames of a scene, counts the processor seconds of each stage in `spent`, and yields the path of each."""
    with _counted("drawing and building the scene", spent):
        sequence = iter(template.sequence_of(template.draw(scene)))
    begin = time.process_time()
    for number, frame in enumerate(sequence):
        stages = {stage.name: stage.processor_seconds for stage in frame.stages}
        spent.update(stages)
        spent["between stages"] += time.process_time() - begin - sum(stages.values())
        path = folder / f"{scene}_{number}.h5"
        with _counted("writing", spent):
            write_frame(frame, path, template.settings.keep)
        with _counted("checksum", spent):
            checksum(path)
        yield path
        begin = time.process_time()


class _counted:
    def __init__(self, name: str, spent: Counter):
        self._name, self._spent = name, spent

    def __enter__(self) -> None:
        self._begin = time.process_time()

    def __exit__(self, *_) -> None:
        self._spent[self._name] += time.process_time() - self._begin
