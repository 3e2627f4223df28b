"""What the keys and menus do to the view."""
from __future__ import annotations

from ..model import COLOUR_MODES
from ..model.view_state import apply_state
from .busy import waiting_cursor
from .command_palette import CommandPalette
from .keys import help_dialog


class ViewActions:
    """Part of MainWindow: actions, by the names in keys.py, that change what is shown and no file."""

    def look_fit(self) -> None:
        self.view3d.look("fit")

    def look_radar(self) -> None:
        self.view3d.look("radar")

    def look_top(self) -> None:
        self.view3d.look("top")

    def look_side(self) -> None:
        self.view3d.look("side")

    def toggle_hits(self) -> None:
        self.filter_box.hits_check.toggle()

    def find_mesh(self) -> None:
        self.open_panel("Scene")
        self.scene_box.begin()

    def next_colour(self) -> None:
        box = self.filter_box.colour_box
        box.setCurrentIndex((box.currentIndex() + 1) % len(COLOUR_MODES))

    def toggle_layout(self) -> None:
        self.map_area.show_one(self.map_area.layout_box.currentIndex() == 0)

    def toggle_play(self) -> None:
        self.time_bar.play_button.toggle()

    def previous_chirp(self) -> None:
        self.session.set_chirp(self.session.chirp - 1)

    def next_chirp(self) -> None:
        self.session.set_chirp(self.session.chirp + 1)

    def previous_frame(self) -> None:
        self.time_line.step(-1)

    def next_frame(self) -> None:
        self.time_line.step(1)

    def toggle_play_frames(self) -> None:
        if self.time_line.line is not None:
            self.frame_bar.play_button.toggle()

    def remove_part(self) -> None:
        try:
            self.session.remove_part(self.session.part_key)
        except ValueError as error:
            self.show_message(str(error))

    def clear_selection(self) -> None:
        self.session.select_cells(None)
        if self.session.node is not None:
            self.session.select_node(None)

    def undo(self) -> None:
        self._restore(self.history.back())

    def redo(self) -> None:
        self._restore(self.history.forward())

    def _restore(self, state: dict | None) -> None:
        if state is None:
            return
        try:
            with waiting_cursor():
                misfits = apply_state(self.session, state)
        except ValueError as error:
            misfits = [str(error)]
        self.filter_box.read(self.session)
        self.show_layer_checks()
        self.show_message("; ".join(misfits))

    def show_help(self) -> None:
        help_dialog(self).show()

    def show_commands(self) -> None:
        CommandPalette(self, [*self.actions(), *self.window_menu.actions()]).show()

    def quit(self) -> None:
        self.close()
