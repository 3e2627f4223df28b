"""The page about a dataset."""
import base64
import shutil
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

from echopath import dataset
from echopath.cli import main
from echopath.dataset import report
from echopath.dataset.statistics import _error_db
from echopath.paths.resolution import Interval


class _Page(HTMLParser):
    """The texts of the cells of all rows, and the pictures."""

    def __init__(self, text: str):
        super().__init__()
        self.rows: list[list[str]] = []
        self._is_in_cell = False
        self.pictures: list[bytes] = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
            self._is_in_cell = True
        elif tag == "img":
            kind, _, code = dict(attributes)["src"].partition(",")
            assert kind == "data:image/png;base64"
            self.pictures.append(base64.b64decode(code))

    def handle_data(self, data):
        if self._is_in_cell:
            self.rows[-1][-1] += data.strip()

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self._is_in_cell = False


def test_the_report_that_the_command_writes_beside_the_frames_counts_what_is_there(small_dataset, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(report, "EXAMPLES", 2)
    monkeypatch.setattr(report, "MOST_DRAWN", 3)
    folder = tmp_path / "copy"
    shutil.copytree(small_dataset[1], folder)
    assert main(["dataset-report", str(folder)]) == 0
    assert "wrote" in capsys.readouterr().out
    text = (folder / "report.html").read_text()
    page = _Page(text)
    facts = {row[0]: row[1:] for row in page.rows if len(row) > 1}
    opened = dataset.open(folder)
    assert facts["scenes done"] == ["6 of 6"] and facts["frames done"] == ["12"]
    assert facts["frames of 'train'"] == [str(len(opened.split("train")))]
    labels = [one.frame.labels["parts"] for one in opened]
    counts = next(row for row in page.rows if row[0] == "static")  # of the first table of classes
    assert int(counts[-2]) == sum(one.cells for label in labels for one in label.objects) > 0
    assert sum(map(int, counts[1:3])) == sum(len(label.objects) for label in labels)
    assert len(page.pictures) == 4 and all(picture.startswith(b"\x89PNG") for picture in page.pictures)
    assert "http" not in text.replace("base64", "")
    received = [one.received for label in labels for one in label.objects if one.cells]
    with np.errstate(divide="ignore"):
        errors = [10.0 * np.log10(max(one.high / one.power, np.float64(one.power) / one.low)) for one in received]
    head = next(row for row in page.rows if row[:2] == ["class", "half within"])
    known = page.rows[page.rows.index(head) + 1]
    assert known[0] == "static" and f"{100 * np.mean(np.array(errors) <= 0.3):.0f} %" == known[-1]
    median = sorted(errors)[len(errors) // 2]  # the upper one of two
    assert known[1] == (f"{median:.1f} dB" if np.isfinite(median) else "not known")
    assert text.count("Validity: ") == 2  # of each frame that is shown


def test_numbers_that_were_drawn_have_no_empty_axes_beside_them(monkeypatch):
    figures = []
    monkeypatch.setattr(report, "_image", lambda figure: figures.append(figure) or "")
    for several in (4, 5, 6):
        drawn = {f"objects.car.position[{number}]": [0.5 * number, 1.0, 7.0] for number in range(several)}
        list(report._drawn(SimpleNamespace(drawn=drawn)))
        shown = [axes for axes in figures[-1].axes if axes.axison]
        assert len(shown) == several and all(axes.has_data() for axes in shown)


@pytest.mark.parametrize("writer", [name for name in dataset.__all__ if name.startswith("write_")])
def test_each_writer_takes_the_opened_dataset(tmp_path, writer):
    with pytest.raises(TypeError, match="dataset: must be a Dataset of ep.dataset.open"):
        getattr(dataset, writer)(tmp_path, tmp_path / "out")


@pytest.mark.parametrize("low, high, db", [(0.5, 1.25, 3.0103), (0.8, 4.0, 6.0206), (0.0, 1.5, float("inf"))])
def test_an_interval_reaches_as_far_as_its_farther_side(low, high, db):
    assert _error_db(Interval(1.0, low, high)) == pytest.approx(db, abs=1e-4)
