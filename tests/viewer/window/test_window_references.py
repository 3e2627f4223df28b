"""References of Python's own values, which some versions of PySide6 give back without having taken them."""
from __future__ import annotations

import sys

import pytest

NUM_CALLS = 2000


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="None is immortal from Python 3.12 on: its count says nothing")
def test_calls_of_qt_keep_the_references_of_none(window):
    before = sys.getrefcount(None)
    for number in range(NUM_CALLS):
        window.view3d.render_soon()
        window.filter_box.count_label.setText(str(number))
    assert sys.getrefcount(None) > before - NUM_CALLS // 2
