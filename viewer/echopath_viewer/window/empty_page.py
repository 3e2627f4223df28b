"""What is shown as long as there is no frame."""
from __future__ import annotations

from .qt import Qt, QtWidgets, Signal

TEXT = """<h2>No frame is open</h2>
<p>A frame file holds a simulated radar frame: its scene, what every ray touched, and its signals.</p>
<p>Drop one here, open one with the button, or make one:</p>
<pre>echopath demo                        # -> out/demo/frame.h5
echopath run SCENE.toml --out DIR    # -> DIR/frame.h5
ep.view(scene, paths, parts)         # from a script</pre>"""


class EmptyPage(QtWidgets.QWidget):
    """Says what to do."""

    open_wanted, demo_wanted = Signal(), Signal()

    def __init__(self, parent=None):
        super().__init__(parent)
        text = QtWidgets.QLabel(TEXT)
        self.open_button = QtWidgets.QPushButton("Open a frame ...")
        self.demo_button = QtWidgets.QPushButton("Simulate the street demo (seconds)")
        self.open_button.setToolTip("A frame file, or several as a time line")
        self.demo_button.setToolTip("A person who walks in a street between two walls")
        self.open_button.clicked.connect(self.open_wanted)
        self.demo_button.clicked.connect(self.demo_wanted)
        column = QtWidgets.QVBoxLayout(self)
        # Behind the views of a frame it does not keep a window from becoming as narrow as a small screen.
        self.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)
        column.addStretch()
        for widget in (text, self.open_button, self.demo_button):
            column.addWidget(widget, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch()
