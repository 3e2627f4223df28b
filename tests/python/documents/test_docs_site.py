"""The documentation site: no public name is missing, pages run, notebooks carry no outputs, the gallery is whole."""
from __future__ import annotations

import ast
import inspect
import json
import re
import runpy
import warnings
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure

import echopath as ep
import echopath.dataset

matplotlib.use("agg")
ROOT = Path(__file__).parents[3]
DOCS, EXAMPLES = ROOT / "python" / "docs", ROOT / "python" / "examples"
PAGES = sorted((DOCS / "how_do_i").rglob("*.md"))
TRAINING = EXAMPLES / "training"  # needs PyTorch, and takes minutes: no part of the gallery
SCRIPTS = sorted(path for path in EXAMPLES.glob("*/*.py") if path.parent != TRAINING)
NOTEBOOKS = sorted((EXAMPLES / "notebooks").glob("*.ipynb"))
TASKS = (*(f"scenes/{name}" for name in ("own_mesh", "through_a_pane", "liquid_level", "foreign_scene", "other_frequencies",
                                         "car_with_speed", "trajectories", "ego_motion", "live_scene")),
         *(f"radars/{name}" for name in ("antenna_pattern", "transmit_codes", "receiver_faults", "sensor_file", "snr",
                                         "scanning_radar")),
         *(f"results/{name}" for name in ("angle_map", "spectrogram", "breath_and_heartbeat", "arms_only", "rcs_over_angle",
                                          "polarimetry", "label_masks", "detections", "truth_and_tracks",
                                          "synthetic_aperture", "rays_of_a_peak", "own_processing", "pictures")),
         *(f"runs/{name}" for name in ("scene_file", "frames_in_time", "several_processes", "dataset")))
LARGEST_FILE = 200_000  # bytes


def documented_names(text: str) -> list[str]:
    """The names that the summaries of a reference page list."""
    blocks = re.findall(r"\.\. autosummary::\n(?: +:.*\n)*\n((?: +\S+\n)+)", text)
    return [name for block in blocks for name in block.split()]


def titles_and_labels(figure) -> list[str]:
    """What a person reads about a figure and its axes, but for numbers."""
    texts = [text.get_text() for text in figure.texts]
    for axes in figure.get_axes():
        legend = axes.get_legend()
        texts += [axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
        texts += [text.get_text() for text in legend.get_texts()] if legend else []
    return [text for text in texts if text]


def code_of(page: Path) -> str:
    """The Python lines of a page in Markdown."""
    return "\n".join(re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE))


def wanted_names() -> set[str]:
    """What the reference must list: the names of the package but for its modules, bodies and pictures."""
    own = {name for name in ep.__all__ if not inspect.ismodule(getattr(ep, name))}
    bodies = {f"actors.{name}" for name in ep.actors.__all__ if name[0].islower()}
    return own | bodies | {f"{module}.{name}" for module in ("dataset", "plots") for name in getattr(ep, module).__all__}


def test_names_of_a_summary_are_found():
    text = ".. autosummary::\n   :toctree: x\n   :nosignatures:\n\n   Scene\n   actors.wall\n\nText\n"
    assert documented_names(text) == ["Scene", "actors.wall"]


def test_reference_lists_every_public_name_once():
    pages = [page.read_text(encoding="utf-8") for page in (DOCS / "reference").glob("*.rst")]
    listed = [name for page in pages for name in documented_names(page)]
    assert sorted(listed) == sorted(set(listed))
    assert wanted_names() - set(listed) == set()
    assert set(listed) - wanted_names() == set()


def test_docstrings_become_lists_and_paragraphs():
    converter = runpy.run_path(str(DOCS / "_extensions" / "house_docstrings.py"))
    lines = ["Adds noise.", "", "cube: [tx, rx] in sqrt(W),", "or a part of it", "seed: as in `add`", "    \"a\": first",
             "Returns a*b.", "Raises ValueError."]
    assert [line for line in converter["as_rst"](lines) if line] == [
        "Adds noise.", "* **cube**: [tx, rx] in sqrt(W), or a part of it", "* **seed**: as in ``add``", '  * ``"a"``: first',
        r"Returns a\*b.", "Raises ValueError."]


def test_every_task_has_a_page():
    assert {page.relative_to(DOCS / "how_do_i").with_suffix("").as_posix() for page in PAGES} == {*TASKS, "index"}
    contents = (DOCS / "how_do_i" / "index.md").read_text(encoding="utf-8")
    assert all(re.search(rf"^{task}$", contents, re.MULTILINE) for task in TASKS)


@pytest.mark.parametrize("task", TASKS)
def test_lines_of_a_page_run(task, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    corners = "v 0 0 0\nv 4000 0 0\nv 0 2000 0\nv 0 0 1500\n"
    Path("car.obj").write_text(corners + "g body\nf 1 2 3\nf 1 2 4\ng roof\nf 2 3 4\n", encoding="utf-8")
    names = {"__name__": "a_page"}
    exec(compile(code_of(DOCS / "how_do_i" / "index.md"), "index.md", "exec"), names)
    exec(compile(with_little_work(code_of(DOCS / "how_do_i" / f"{task}.md")), f"{task}.md", "exec"), names)
    if task == "runs/several_processes":  # a worker of its own would need the page as a file
        assert ep.load_frame(names["one_frame"](0.1)).paths.frame.start_time == 0.1
        ep.set_num_threads(0)


def test_the_gallery_has_its_pages():
    assert len(SCRIPTS) >= 20
    own_file = re.compile(r"(?<![\w.])__file__")  # of a script, which the gallery runs without it
    assert [script.name for script in SCRIPTS if own_file.search(script.read_text())] == []
    for script in SCRIPTS:
        text = script.read_text(encoding="utf-8")
        title, underline = ast.get_docstring(ast.parse(text)).splitlines()[:2]
        assert underline == "=" * len(title), script
        assert 15 <= len([line for line in text.splitlines() if line.strip()]) <= 65, script


def test_the_page_on_breathing_finds_the_way_of_the_chest():
    """Chirps are 50 ms apart, the first of them with its middle at half of its 51.2 us."""
    names = {"np": np, "ep": ep}
    exec(compile(code_of(DOCS / "how_do_i" / "results" / "breath_and_heartbeat.md"), "a_page", "exec"), names)
    time = 0.05 * np.arange(400) + 25.6e-6
    chest = 4e-3 * np.sin(2.0 * np.pi * 0.25 * time) + 0.2e-3 * np.sin(2.0 * np.pi * 1.2 * time)
    assert np.std(names["way"] - chest) < 0.15e-3
    assert names["ranges"][names["cell"]] == pytest.approx(1.88, abs=0.05)  # 12 cm before the middle of the body


def test_the_page_on_liquids_has_the_echoes_of_images():
    """Of the oil, of it and the roof, and of the water through the oil: Fresnel's coefficients, and lengths of light."""
    names = {"np": np, "ep": ep}
    exec(compile(code_of(DOCS / "how_do_i" / "scenes" / "liquid_level.md"), "a_page", "exec"), names)
    air_oil, oil_water = ((np.sqrt(one) - np.sqrt(other)) / (np.sqrt(one) + np.sqrt(other))
                          for one, other in ((1.0, 2.2), (2.2, 12 - 18j)))
    horn = 2.0 * 1138.0 * ep.speed_of_light / 78e9 / (8.0 * np.pi)
    in_oil = names["below"]
    for paths, share, spread, seen, tolerance_db in (
            (names["paths"].select("T 'oil' R"), air_oil, 1.9, 1.9, 0.01),
            (names["paths"].select("T 'oil' 'roof' 'oil' R"), air_oil**2, 3.9, 3.9, 0.01),
            (in_oil, (1.0 - air_oil**2) * oil_water, 1.9 + 0.06 / np.sqrt(2.2), 1.9 + 0.06 * np.sqrt(2.2), 0.01)):
        echo = np.sqrt(1e-3) * horn * abs(share) / spread * (10.0 ** (-0.09 / 20.0) if paths is in_oil else 1.0)
        assert 20.0 * np.log10(abs(paths.amplitude.sum()) / echo) == pytest.approx(0.0, abs=tolerance_db)
        last_layer = ep.speed_of_light / 78e9 / 4.0 if paths is in_oil else 0.0
        assert paths.lengths([0.0], 0, 0)[0, 0] / 2.0 == pytest.approx(seen + last_layer, abs=1e-4)


def with_little_work(text: str) -> str:
    """The text of a script, a page or a notebook with a thirty-second of its rays and an eighth to a half of its frames, where
    they are many: the site is built, and read, with all of them."""
    for name, many, part in (("num_rays", 5000, 32), ("frames", 20, 4), ("frames", 8, 2)):
        text = re.sub(rf"\b{name}=(\d[\d_]*)", lambda found: f"{name}={fewer(int(found[1].replace('_', '')), many, part)}", text)
    return text


def fewer(count: int, many: int, part: int) -> int:
    return count if count < many else count // part


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_scripts_of_the_gallery_run_without_a_warning_and_show_their_figures(script, monkeypatch):
    shown = []
    monkeypatch.setattr(plt, "show", lambda: shown.extend(map(plt.figure, plt.get_fignums())))
    names = {"__name__": "a_script"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exec(compile(with_little_work(script.read_text(encoding="utf-8")), str(script), "exec"), names)
    figures = [value for value in names.values() if isinstance(value, Figure)]
    assert figures and all(any(figure is one for one in shown) for figure in figures)
    assert all(len(titles_and_labels(figure)) >= 2 for figure in figures)
    plt.close("all")


def test_sections_of_the_gallery_are_those_of_its_configuration():
    configuration = (DOCS / "conf.py").read_text(encoding="utf-8")
    sections = ast.literal_eval(re.search(r"^SECTIONS = (\(.*?\))", configuration, re.MULTILINE)[1])
    assert sorted(sections) == sorted({script.parent.name for script in SCRIPTS})


def test_no_file_of_the_site_is_large():
    files = [path for folder in (DOCS, EXAMPLES) for path in folder.rglob("*")
             if path.is_file() and "generated" not in path.parts]
    assert [path for path in files if path.stat().st_size > LARGEST_FILE] == []


def cells_of(notebook: Path) -> list[dict]:
    """The code cells of a notebook."""
    return [cell for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_kept_without_outputs(notebook):
    assert len(cells_of(notebook)) >= 5
    assert [cell for cell in cells_of(notebook) if cell["outputs"] or cell["execution_count"] is not None] == []


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_cells_of_a_notebook_run(notebook, monkeypatch):
    monkeypatch.setattr(plt, "show", lambda: None)
    names = {"__name__": "a_notebook"}
    for number, cell in enumerate(cells_of(notebook)):
        lines = "".join(line for line in cell["source"] if not line.startswith("%"))  # without what IPython alone knows
        exec(compile(with_little_work(lines), f"{notebook.name}, cell {number}", "exec"), names)
    plt.close("all")


def test_lines_of_the_first_page_run():
    names = {"__name__": "a_page"}
    exec(compile(code_of(DOCS / "index.md"), "index.md", "exec"), names)
    assert names["frame"].paths.num_paths > 0


def test_links_between_pages_lead_somewhere():
    for page in sorted(DOCS.rglob("*.md")):
        if "generated" in page.parts:
            continue
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert is_a_page(page.parent, target), f"{page.name}: {target}"


def is_a_page(folder: Path, target: str) -> bool:
    """Whether a link leads to a page, or to one that is made of a script."""
    above = len(folder.relative_to(DOCS).parts)
    gallery = above * "../" + "generated/gallery/"
    if target.startswith(gallery):
        rest = target.removeprefix(gallery)
        return rest == "index" or (EXAMPLES / f"{rest}.py").is_file()
    return any((folder / f"{target}{suffix}").is_file() for suffix in ("", ".md", ".rst"))
