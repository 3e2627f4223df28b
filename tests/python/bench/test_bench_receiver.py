"""`echopath bench receiver`: faults beside closed forms, codes, and their cost."""
import json

import echopath as ep
from echopath.bench import receiver


def test_a_quick_run_holds_its_bounds_and_writes_them(tmp_path, monkeypatch):
    monkeypatch.setattr(receiver.faults, "DISTANCES", (10.0,))
    monkeypatch.setattr(receiver.street, "QUICK_NUM_RAYS", 4_000)
    monkeypatch.setattr(receiver.street, "NUM_CHIRPS", 32)
    monkeypatch.setattr(receiver.cost, "FAULTS", {"none": None, "filters": {"high_pass": [1e5]}})
    monkeypatch.setattr(receiver.off, "CASES", {"a Receiver without faults": ep.Receiver()})
    results = receiver.run_receiver(tmp_path, quick=True)
    assert json.loads((tmp_path / "receiver.json").read_text()) == results
    assert [row for row in results["rows"]["faults"] if not row["holds"]] == []
    assert [row for row in results["rows"]["laws"] if not row["holds"]] == []
    assert [row for row in results["rows"]["codes"] if not row["holds"]] == []
    assert [row["holds"] for row in results["rows"]["off"]] == [True, None]  # the bits; a single turn knows no time
    lines = receiver.describe(results)
    assert any("quantisation, 12 bits" in line for line in lines) and any("demultiplex ddm" in line for line in lines)
