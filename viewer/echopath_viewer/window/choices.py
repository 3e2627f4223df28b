"""What tree, legend and filter box choose, with the work that it takes."""
from __future__ import annotations

import dataclasses

from .busy import run_with_progress


class Choices:
    """Part of MainWindow: objects and parts that are chosen by name."""

    def _choose_node(self, name: str) -> None:
        wanted = None if name == self.session.node else name
        self._work_on_node(f"Map of {name}", lambda progress: self.session.select_node(wanted, progress))

    def _work_on_node(self, title: str, work) -> None:
        try:
            run_with_progress(self, title, work)
        except ValueError as error:
            self.show_message(str(error))

    def _isolate(self, name: str) -> None:
        """Shows the object of a row of the legend alone, or everything where it is alone already."""
        session = self.session
        meshes = session.meshes_below(name)
        others = set(range(len(session.mesh_names))) - meshes
        if not meshes:
            return
        is_alone = session.hidden_meshes == others
        session.set_mesh_visible(others, is_alone)
        session.set_mesh_visible(meshes, True)

    def _name_part(self, name: str) -> None:
        self.filter_box.apply()
        try:
            part = run_with_progress(self, f"Map of {name}", lambda progress: self.session.add_part(name, progress))
        except ValueError as error:
            self.filter_box.show_name_error(str(error))
            return
        self.filter_box.show_name_error("")
        if part is not None:
            self.filter_box.name_edit.clear()

    def _only_over(self, name: str) -> None:
        self.session.set_filters(dataclasses.replace(self.session.filters, mesh=name))
        self.filter_box.read(self.session)
