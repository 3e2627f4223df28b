"""What the viewer says where Qt, or a library of the system that Qt is linked with, is not there."""
import sys
import types

import pytest
import qtpy

import echopath_viewer


def _without(monkeypatch, error):
    """Imports of PySide6.QtWidgets raise `error`, and those of qtpy what it makes of that."""
    class Missing:
        @staticmethod
        def find_spec(name, path=None, target=None):
            if name == "PySide6.QtWidgets":
                raise error

    monkeypatch.setitem(sys.modules, "PySide6", types.ModuleType("PySide6"))
    sys.modules["PySide6"].__path__ = []
    monkeypatch.delitem(sys.modules, "PySide6.QtWidgets", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Missing, *sys.meta_path])


def test_a_missing_library_of_the_system_is_named_with_the_packages_that_bring_it(monkeypatch):
    _without(monkeypatch, ImportError("libxkbcommon.so.0: cannot open shared object file: No such file or directory"))
    with pytest.raises(OSError, match=r"library of the system: libxkbcommon.so.0: .*apt install libgl1 .*libxkbcommon-x11-0"):
        with echopath_viewer._told_what_to_install():
            raise qtpy.QtBindingsNotFoundError


def test_a_missing_qt_is_named_with_what_to_install(monkeypatch):
    _without(monkeypatch, ModuleNotFoundError("No module named 'PySide6'", name="PySide6"))
    with pytest.raises(ModuleNotFoundError, match=r"the viewer needs PySide6, which .*: pip install 'echopath\[viewer\]'"):
        with echopath_viewer._told_what_to_install():
            raise qtpy.QtBindingsNotFoundError
