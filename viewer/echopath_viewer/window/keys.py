"""Keys of the window: one table that makes the shortcuts and the help."""
from __future__ import annotations

from .qt import Qt, QtWidgets

# Key, name of the method of MainWindow, what it does.
KEYS = (
    ("Ctrl+O", "open_dialog", "Open a frame file, or several as a time line"),
    ("Ctrl+Shift+O", "open_folder_dialog", "Open a folder of frames as a time line"),
    ("Ctrl+S", "save_view_dialog", "Save this view"),
    ("Ctrl+L", "load_view_dialog", "Load a view"),
    ("Ctrl+P", "screenshot_dialog", "Save a picture, maps, a film or a page"),
    ("Ctrl+E", "export_rays_dialog", "Export the rays (VTK)"),
    ("F5", "reload", "Read the file, or the frame of a sequence, anew"),
    ("Ctrl+K", "show_commands", "Find a command by typing"),
    ("Ctrl+Z", "undo", "Undo what the view shows"),
    ("Ctrl+Shift+Z", "redo", "Redo it"),
    ("Ctrl+Q", "quit", "Close the window"),
    ("Ctrl+F", "find_mesh", "Find a mesh by a part of its name"),
    ("F", "look_fit", "Look at everything"),
    ("R", "look_radar", "The radar's eye"),
    ("T", "look_top", "From above"),
    ("S", "look_side", "From the side"),
    ("H", "toggle_hits", "Hit points on or off"),
    ("C", "next_colour", "Next colouring of the rays"),
    ("M", "toggle_layout", "All maps or a large one"),
    ("Space", "toggle_play", "Play or pause"),
    ("Left", "previous_chirp", "One chirp back"),
    ("Right", "next_chirp", "One chirp on"),
    ("PgUp", "previous_frame", "The frame before, of a time line"),
    ("PgDown", "next_frame", "The next frame"),
    ("Shift+Space", "toggle_play_frames", "Play or pause the frames"),
    ("Del", "remove_part", "Remove the chosen part, if it was named here"),
    ("Esc", "clear_selection", "Select nothing"),
    ("?", "show_help", "This list"),
    ("", "export_meshes_dialog", "Export the meshes (VTK)"),
)
NEEDS_NO_FRAME = ("open_dialog", "open_folder_dialog", "show_help", "show_commands", "quit")
MENUS = {
    "File": ("open_dialog", "open_folder_dialog", "reload", "save_view_dialog", "load_view_dialog", "screenshot_dialog",
             "export_rays_dialog", "export_meshes_dialog"),
    "View": ("undo", "redo", "find_mesh", "look_fit", "look_radar", "look_top", "look_side", "toggle_hits", "next_colour",
             "toggle_layout", "toggle_play", "previous_chirp", "next_chirp", "previous_frame", "next_frame",
             "toggle_play_frames", "remove_part", "clear_selection"),
    "Help": ("show_help", "show_commands"),
}
MOUSE = (
    ("1, 2, 3, 4, 5, 6", "layers: labels, objects and ghosts, detections, truth, ghost twins, names"),
    ("Map: click a detection", "its paths"), ("Legend: click an object", "shows it alone, or all again"),
    ("Map: click, drag", "the rays of a cell, of a rectangle"),
    ("Map: wheel, right button, double click", "zoom, move, what moves or everything"),
    ("Scene: drag, wheel, middle button", "turn, zoom, move"), ("Scene: click", "a ray, or the body under the cursor"),
    ("Scene: Ctrl + click", "the mesh under the cursor, walls too"),
    ("Scene: Shift + drag", "moves an object, where the panel Live is started"),
    ("Tree: click or Enter, right button", "map of a mesh, more"),
    ("Table: click a heading, Ctrl+C", "sort, copy rows"),
)


_KEYS_OF_WIDGETS = (
    (QtWidgets.QAbstractButton, frozenset({Qt.Key.Key_Space})),
    (QtWidgets.QComboBox, frozenset({Qt.Key.Key_Space})),
    (QtWidgets.QAbstractItemView, frozenset({Qt.Key.Key_Space})),
    (QtWidgets.QTreeView, frozenset({Qt.Key.Key_Left, Qt.Key.Key_Right})),
    (QtWidgets.QAbstractSlider, frozenset({Qt.Key.Key_Left, Qt.Key.Key_Right})),
)


def uses_key(widget, event) -> bool:
    """Whether a widget that has the focus does something of its own with a key, so that it is no shortcut."""
    if event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier:
        return False
    return any(isinstance(widget, kind) and event.key() in keys for kind, keys in _KEYS_OF_WIDGETS)


def help_dialog(parent) -> QtWidgets.QDialog:
    """The keys and what the mouse does."""
    dialog = QtWidgets.QDialog(parent)
    dialog.setWindowTitle("Keys and mouse")
    rows = [(key, text) for key, _, text in KEYS if key] + list(MOUSE)
    html = "".join(f"<tr><td><b>{key}</b>&nbsp;&nbsp;</td><td>{text}</td></tr>" for key, text in rows)
    QtWidgets.QVBoxLayout(dialog).addWidget(QtWidgets.QLabel(f"<table>{html}</table>"))
    return dialog
