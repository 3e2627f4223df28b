"""The meshes of the scene as a tree."""
from __future__ import annotations

from echopath.base.text.node_names import composed

from ..qt import Qt, QtGui, QtWidgets, Signal
from ..swatch import swatch

NAME, COUNT = 0, 1
MOST_OPEN = 24  # rows: more objects than that show their own alone
HINT = "Check box: show or hide. Click, Enter: map of the paths that hit it. Right button: more."
NODE_ROLE = Qt.ItemDataRole.UserRole


class SceneTree(QtWidgets.QTreeWidget):
    """Check boxes hide meshes, a click asks for the spectrum, the menu for colours and for the rays over a mesh."""

    node_clicked = Signal(str)
    rays_wanted = Signal(str)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session, self._marked = None, None  # the name of the row whose map was asked for
        self._found_by, self._found = "", []     # part of a name, rows that were found by it
        self.setHeaderLabels(["Mesh", "Paths"])
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names differ at their ends
        self.header().setStretchLastSection(False)
        self.header().setSectionResizeMode(NAME, QtWidgets.QHeaderView.ResizeMode.Stretch)
        self.header().setSectionResizeMode(COUNT, QtWidgets.QHeaderView.ResizeMode.ResizeToContents)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._menu)
        self.itemChanged.connect(self._checked)
        self.itemClicked.connect(self._clicked)
        self.setToolTip(HINT)

    def show_session(self, session) -> None:
        self.session = self._marked = None
        self.clear()
        self._items, self._mesh_items, items = {}, {}, []
        mesh_of_node = {mesh.node: mesh.id for mesh in session.scene.meshes}
        for number, node in enumerate(session.scene.nodes):
            item = QtWidgets.QTreeWidgetItem(self if node.parent < 0 else items[node.parent], [node.name.rpartition("/")[2]])
            item.setData(NAME, NODE_ROLE, node.name)
            item.setToolTip(NAME, f"{node.name}\n{HINT}")  # there may be no room for all of its name
            item.setTextAlignment(COUNT, Qt.AlignmentFlag.AlignRight)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            if number in mesh_of_node:
                self._mesh_items[mesh_of_node[number]] = item
            item.setCheckState(NAME, Qt.CheckState.Checked)
            self._items[node.name] = item
            items.append(item)
        if self._found_by:
            self.show_found(self._found_by)
        elif sum(1 + self.topLevelItem(row).childCount() for row in range(self.topLevelItemCount())) <= MOST_OPEN:
            self.expandToDepth(0)
        self.session = session
        self.refresh()

    def show_found(self, text: str) -> None:
        """Rows whose full names hold a text alone, with those above them; "": all rows. Capitals and small letters are alike."""
        self._found_by, self._found = _plain(text), []
        above = set()  # names of rows above those that were found
        self.setUpdatesEnabled(False)
        for name, item in reversed(self._items.items()):  # what is below a row comes before it
            parent, is_above, holds = name.rpartition("/")[0], name in above, self._found_by in _plain(name)
            is_found = holds and self._found_by not in _plain(parent)
            if is_found:
                self._found.insert(0, item)
            if is_found or is_above:
                above.add(parent)
            item.setHidden(not (holds or is_above))
            if is_above:
                item.setExpanded(True)
        self.setUpdatesEnabled(True)

    def first_found(self):
        """The first row that was found; None where there is none."""
        return self._found[0] if self._found else None

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame: rows that are open stay so where its scene has the same. is_passing: the next one comes at once, and
        rows of the same scene keep what they tell."""
        same = self.session is not None and [node.name for node in session.scene.nodes] == list(self._items)
        if not same:
            self.show_session(session)
            return
        self.session = session
        if not is_passing:
            self.refresh()

    def refresh(self) -> None:
        """Check marks, colours and counts as they are now."""
        session, self.session = self.session, None
        for item, count in zip(self._items.values(), session.node_counts()):
            item.setText(COUNT, f"{count:,}")
        for mesh, item in self._mesh_items.items():
            item.setIcon(NAME, swatch(QtGui.QColor(*map(int, session.palette[mesh]))))
            hidden = mesh in session.hidden_meshes
            item.setCheckState(NAME, Qt.CheckState.Unchecked if hidden else Qt.CheckState.Checked)
        with_mesh = set(session.mesh_names)
        for name, item in reversed(self._items.items()):
            if item.childCount():
                item.setCheckState(NAME, _state_of_all(item, name in with_mesh))
        self.session = session
        self._mark(session.node)

    def _mark(self, name: str | None) -> None:
        """Shows the row of what is chosen, wherever it was: in the scene, where its row may be closed and out of sight."""
        if name == self._marked:
            return
        self._marked = name
        if name in self._items:
            self.setCurrentItem(self._items[name])
            self.scrollToItem(self._items[name])
        else:
            self.clearSelection()

    def _checked(self, item, column: int) -> None:
        if self.session is None or column != NAME:
            return
        name, is_on = item.data(NAME, NODE_ROLE), item.checkState(NAME) != Qt.CheckState.Unchecked
        self.session.set_mesh_visible(self.session.meshes_below(name), is_on)

    def _clicked(self, item, _column: int) -> None:
        if self.session is not None and not self._is_on_check_box(item):
            self.node_clicked.emit(item.data(NAME, NODE_ROLE))

    def keyPressEvent(self, event):
        item = self.currentItem()
        if item is not None and event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.node_clicked.emit(item.data(NAME, NODE_ROLE))
        else:
            super().keyPressEvent(event)

    def _is_on_check_box(self, item) -> bool:
        at = self.viewport().mapFromGlobal(QtGui.QCursor.pos())
        return 0 <= at.x() - self.visualItemRect(item).left() < 18

    def _menu(self, at) -> None:
        item = self.itemAt(at)
        if item is None:
            return
        name = item.data(NAME, NODE_ROLE)
        menu = QtWidgets.QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Map of the paths that hit it", lambda: self.node_clicked.emit(name))
        menu.addAction("Only rays that hit it", lambda: self.rays_wanted.emit(name))
        menu.addAction("Show it alone", lambda: self._show_alone(name))
        menu.addAction("Show all", lambda: self.session.set_mesh_visible(range(len(self.session.mesh_names)), True))
        if name in self.session.mesh_names:
            menu.addAction("Colour ...", lambda: self._choose_colour(self.session.mesh_names.index(name)))
        menu.popup(self.viewport().mapToGlobal(at))

    def _show_alone(self, name: str) -> None:
        self.session.set_mesh_visible(range(len(self.session.mesh_names)), False)
        self.session.set_mesh_visible(self.session.meshes_below(name), True)

    def _choose_colour(self, mesh: int) -> None:
        colour = QtWidgets.QColorDialog.getColor(QtGui.QColor(*map(int, self.session.palette[mesh])), self)
        if colour.isValid():
            self.session.set_mesh_colour(mesh, (colour.red(), colour.green(), colour.blue()))


def _state_of_all(item, has_mesh: bool) -> Qt.CheckState:
    """Of what is below a row and, where it has one, of its own mesh, as a house has beside its windows."""
    states = {item.child(row).checkState(NAME) for row in range(item.childCount())}
    states |= {item.checkState(NAME)} if has_mesh else set()
    return states.pop() if len(states) == 1 else Qt.CheckState.PartiallyChecked


def _plain(name: str) -> str:
    """A name as it is looked for."""
    return composed(name).casefold()
