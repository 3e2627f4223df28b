"""What tests of scene files share."""
import pytest

from support.files.scene_files import QUAD, RADAR


@pytest.fixture
def write(tmp_path):
    """Writes a scene file with that text after a small radar and returns its path; quad.obj lies beside it."""
    (tmp_path / "quad.obj").write_text(QUAD)

    def write_text(text: str, radar: str = RADAR):
        path = tmp_path / "scene.toml"
        path.write_text(radar + text)
        return path

    return write_text
