"""The page about a dataset."""
import base64
import shutil
import subprocess
import sys
from html.parser import HTMLParser

from echopath import dataset


class _Page(HTMLParser):
    """The texts of the cells of all rows, and the pictures."""

    def __init__(self, text: str):
        super().__init__()
        self.rows: list[list[str]] = []
        self.pictures: list[bytes] = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
        elif tag == "img":
            kind, _, code = dict(attributes)["src"].partition(",")
            assert kind == "data:image/png;base64"
            self.pictures.append(base64.b64decode(code))

    def handle_data(self, data):
        if self.rows and self.rows[-1]:
            self.rows[-1][-1] += data.strip()


def test_the_report_counts_what_is_there(small_dataset, tmp_path):
    _, folder = small_dataset
    dataset.write_report(folder, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    page = _Page(text)
    facts = {row[0]: row[1:] for row in page.rows if len(row) > 1}
    opened = dataset.open(folder)
    assert facts["scenes done"] == ["6 of 6"] and facts["frames done"] == ["12"]
    assert facts["frames of 'train'"] == [str(len(opened.split("train")))]
    labels = [one.frame.labels["parts"] for one in opened]
    assert int(facts["static"][-2]) == sum(one.cells for label in labels for one in label.objects) > 0
    assert sum(map(int, facts["static"][:2])) == sum(len(label.objects) for label in labels)
    assert len(page.pictures) == 6 and all(picture.startswith(b"\x89PNG") for picture in page.pictures)
    assert "http" not in text.replace("base64", "")


def test_the_command_writes_the_report_beside_the_frames(small_dataset, tmp_path):
    copied = tmp_path / "copy"
    shutil.copytree(small_dataset[1], copied)
    done = subprocess.run([sys.executable, "-m", "echopath", "dataset-report", copied], capture_output=True, text=True)
    assert done.returncode == 0 and "wrote" in done.stdout and (copied / "report.html").stat().st_size > 10_000
