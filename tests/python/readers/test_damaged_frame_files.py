"""Frame files that are damaged, foreign or contradict themselves are refused, each with its reason."""
from __future__ import annotations

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.frame_file import paths as frame_paths
from support.files.frame_edits import edited


def refuse(path, reason):
    with pytest.raises(ep.FileError, match=reason):
        ep.load_frame(path)


def test_a_fault_of_a_reader_stays_behind_the_error(saved, monkeypatch):
    """Else a bug of ours looks like a damaged file."""
    def broken(*arguments):
        raise TypeError("no such argument")

    monkeypatch.setattr(frame_paths, "read_array", broken)
    with pytest.raises(ep.FileError, match="no such argument") as told:
        ep.load_frame(saved)
    causes = [told.value]
    while causes[-1].__cause__ is not None:
        causes.append(causes[-1].__cause__)
    assert type(causes[-1]) is TypeError and causes[-1].__traceback__.tb_next is not None


def test_other_files_are_refused(tmp_path):
    refuse(tmp_path / "nowhere.h5", "no such file")
    (tmp_path / "text.h5").write_text("no HDF5 at all")
    refuse(tmp_path / "text.h5", "damaged or not an HDF5 file")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["data"] = np.arange(3)
    refuse(tmp_path / "other.h5", "no frame file of echopath")


def change(path, edit):
    with edited(path) as file:
        edit(file)


def replace(file, name, values):
    del file[name]
    file[name] = values


def replace_by_group(file, name):
    del file[name]
    file.create_group(name)


def replace_by_nothing(file, name, shape):
    """A dataset that says it is very long and has no values."""
    dtype = file[name].dtype
    del file[name]
    file.create_dataset(name, shape, dtype, chunks=(1 << 20,))


EDITS = {
    "newer layout": (lambda file: file.attrs.modify("schema_version", 99), "schema version 99"),
    "no weights": (lambda file: file.__delitem__("record/paths/weight"), "record/paths/weight: no such dataset"),
    "wrong type": (lambda file: replace(file, "record/hits/u", np.zeros(3)), "must hold float32"),
    "short column": (lambda file: replace(file, "record/hits/u", np.zeros(3, np.float32)), "must have the shape"),
    "wild offset": (lambda file: file["record/paths/offsets"].__setitem__(0, 10**9), "must lie within"),
    "wild mesh": (lambda file: file["record/hits/mesh_id"].__setitem__(0, 77), "must be below"),
    "wild triangle": (lambda file: file["record/hits/triangle_id"].__setitem__(0, 7777), "must be below"),
    "wild parent": (lambda file: file["scene/parent"].__setitem__(0, 3), "must name an earlier node"),
    "bad material": (lambda file: file["scene/materials/0"].attrs.modify("scattering", 7.0), "scattering"),
    "unknown replay": (lambda file: file["signal"].attrs.modify("replay", np.bytes_("newton")), "'replay' must be one of"),
    "unknown setting": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_('{"windw": 1}')), "no keys but window"),
    "settings of another map": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_('{"zero_pad": 4000000}')),
                                "make a map of 16 velocities"),
    "settings that are no table": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_("[1]")), "no keys but"),
    "wild part": (lambda file: file["partitions/0/part_of_path"].__setitem__(0, 9), "must be below 3, the number of parts"),
    "last offset": (lambda file: file["record/paths/offsets"].__setitem__(0, 2**63 - 1), "must lie within"),
    "array as setting": (lambda file: file["record/frame"].attrs.create("seed", [1, 2]), "'seed' must be a int"),
    "negative seed": (lambda file: file["signal"].attrs.create("noise_seed", -1), "'noise_seed' must not be negative, is -1"),
    "group as array": (lambda file: replace_by_group(file, "record/paths/offsets"), "offsets: no such dataset"),
    "array as group": (lambda file: replace(file, "scene/materials", np.zeros(3)), "scene/materials: no such group"),
    "values without end": (lambda file: replace_by_nothing(file, "record/hits/u", (1 << 40,)), "record/hits"),
    "unknown column": (lambda file: file["record/paths"].move("flags", "flogs"), "flogs: unknown column|flags: no such"),
    "damaged keyframes": (lambda file: file["scene/motions/0/times"].__setitem__(0, np.nan), "/scene/motions/0: times"),
    "cube of another radar": (lambda file: file["radar/waveform"].attrs.modify("num_chirps", 5), "must have the shape"),
}


@pytest.mark.parametrize("name", EDITS)
def test_files_that_contradict_themselves_are_refused(saved, name):
    edit, reason = EDITS[name]
    change(saved, edit)
    refuse(saved, reason)


def position_of(path, name: str) -> int:
    """Byte of the file at which the values of a dataset begin."""
    with h5py.File(path) as file:
        dataset = file[name].id
        return dataset.get_offset() if file[name].chunks is None else dataset.get_chunk_info(0).byte_offset


@pytest.mark.parametrize("name", ["record/paths/weight", "record/paths/offsets", "signal/cube", "scene/name", "scene/parent",
                                  "radar/receivers/position"])
def test_a_flipped_bit_is_noticed(saved, name):
    position = position_of(saved, name)
    content = bytearray(saved.read_bytes())
    content[position + 5] ^= 0x10
    saved.write_bytes(content)
    refuse(saved, name)


def test_values_that_a_lost_sector_made_zeros_are_noticed(saved):
    """A check sum of sums, such as Fletcher's, is that of zeros for zeros."""
    with h5py.File(saved) as file:
        size = file["scene/parent"].nbytes
    position = position_of(saved, "scene/parent")
    content = bytearray(saved.read_bytes())
    content[position:position + size] = bytes(size)
    saved.write_bytes(content)
    refuse(saved, "scene/parent: damaged")


def test_settings_of_a_file_are_checked_bytes(saved):
    """HDF5 keeps attributes in headers, whose check sums it holds against them."""
    content = saved.read_bytes()
    position = content.index(b'"zero_pad": 1')
    saved.write_bytes(content[:position + 12] + b"2" + content[position + 13:])
    refuse(saved, "incorrect metadata checksum")


def test_no_text_of_a_file_has_a_variable_length(saved):
    def look(_, item):
        kinds = [item.attrs.get_id(name).dtype.kind for name in item.attrs]
        assert "O" not in (kinds if isinstance(item, h5py.Group) else [*kinds, item.dtype.kind]), item.name

    with h5py.File(saved) as file:
        file.visititems(look)


def test_texts_of_variable_length_are_not_read(saved):
    """The library runs in circles in damaged ones."""
    change_without_check_sums(saved, lambda file: replace(file, "scene/name", ["wall", "fan", "carrier", "a", "b"]))
    refuse(saved, "scene/name must hold texts of fixed length")
    with h5py.File(saved, "r+") as file:
        file.attrs["format"] = "echopath frame"
    refuse(saved, "attribute 'format' must be a str")


def change_without_check_sums(path, edit):
    with h5py.File(path, "r+") as file:
        edit(file)


@pytest.mark.parametrize("version, told", [(3, "check sums"), (5, "later release")])
def test_files_of_other_layouts_are_told_why_not(tmp_path, version, told):
    with h5py.File(tmp_path / "frame.h5", "w") as file:
        file.attrs["format"], file.attrs["schema_version"] = "echopath frame", version
    refuse(tmp_path / "frame.h5", f"has schema version {version}, this program reads 4; .*{told}")


@pytest.mark.hard
@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
def test_a_truncated_file_is_refused(saved, share):
    content = saved.read_bytes()
    saved.write_bytes(content[:int(share * len(content))])
    refuse(saved, "damaged")
