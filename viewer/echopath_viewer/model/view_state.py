"""Saving and loading what a view shows, as JSON."""
from __future__ import annotations

import dataclasses
import json

import echopath as ep

from .colours import COLOUR_MODES
from .maps.cell_index import CellBox
from .maps.layers import LAYERS
from .maps.part_set import MESH_GROUP, OWN_GROUP, WHOLE
from .rays.filters import Filters
from .view_format import FORMAT, VERSION, check_state


def state_of(session) -> dict:
    """What the session shows, in plain JSON values."""
    return {
        "format": FORMAT, "version": VERSION, "frame": session.title, "seed": session.paths.frame.seed,
        "filters": dataclasses.asdict(session.filters),
        "own_parts": {part.name: part.recipe for part in session.parts.of_group(OWN_GROUP)},
        "node": session.node, "node_base": list(session.node_base),
        "part": list(session.part_key), "partition": session.partition, "channel": list(session.channel),
        "color_by": session.color_by, "max_rays": session.max_rays, "sampling": session.sampling,
        "dynamic_range_db": session.dynamic_range_db,
        "chirp": session.chirp, "box": dataclasses.astuple(session.box) if session.box else None,
        "cell": None if session.cell is None or session.tells_highest_cell else list(session.cell),
        "beam": None if session.beam is None else [float(angle) for angle in session.beam], "ray": session.ray,
        "layers": sorted(session.layers),
        "hidden_meshes": sorted(session.mesh_names[mesh] for mesh in session.hidden_meshes),
        "mesh_colours": {name: [int(value) for value in rgb] for name, rgb in zip(session.mesh_names, session.palette)},
    }


def apply_state(session, state: dict) -> list[str]:
    """Takes over a state as far as it fits the frame; returns what did not. Raises ValueError for what is no state, and
    has changed nothing then."""
    check_state(state)
    misfits = []
    channel = _channel(session, state, misfits)
    if channel != session.channel:
        session.set_channel(*channel)
    _attempt(misfits, "partition", lambda: _set_partition(session, state.get("partition")))
    for name, recipe in state.get("own_parts", {}).items():
        _attempt(misfits, f"part '{name}'", lambda: _add_part(session, name, recipe))
    _attempt(misfits, "filters", lambda: session.set_filters(Filters(**state.get("filters", {}))))
    _attempt(misfits, "mesh", lambda: _set_node(session, state.get("node"), state.get("node_base", (WHOLE, WHOLE))))
    _attempt(misfits, "part", lambda: _set_part(session, state.get("part", (WHOLE, WHOLE))))
    _apply_looks(session, state, misfits)
    session.set_chirp(state.get("chirp", session.chirp))
    _attempt(misfits, "cells", lambda: _select_cells(session, state.get("box"), state.get("cell"), state.get("beam")))
    _apply_layers(session, state, misfits)
    ray = state.get("ray")
    if ray is not None and ray < session.paths.num_paths and session.visible[ray]:
        session.select_ray(ray)
    return misfits


def save_state(state: dict, path) -> None:
    """Writes a state to a file, whole or not at all."""
    from echopath.base.storage.files import written_whole

    with written_whole(path) as temporary:
        temporary.write_text(json.dumps(state, indent=1), encoding="utf-8")


def load_state(path) -> dict:
    """Reads a state. Raises ep.FileError."""
    try:
        with open(path, encoding="utf-8") as file:
            state = json.load(file)
        check_state(state)
    except OSError as error:
        raise ep.FileError(f"{path}: cannot be read ({error.strerror})") from None
    except ValueError as error:
        raise ep.FileError(f"{path}: no view of echopath ({error})") from None
    return state


def _attempt(misfits: list, what: str, work) -> None:
    try:
        work()
    except ValueError as error:
        misfits.append(f"{what}: {error}")


def _channel(session, state: dict, misfits: list) -> tuple:
    tx, rx = state.get("channel", (0, 0))
    if 0 <= tx < len(session.radar.transmitters) and 0 <= rx < len(session.radar.receivers):
        return tx, rx
    misfits.append(f"channel: there is no transmitter {tx} with receiver {rx}")
    return 0, 0


def _add_part(session, name: str, recipe: dict) -> None:
    if (OWN_GROUP, name) in session.parts:
        return
    before = session.part_key, session.filters
    try:
        session.set_filters(Filters(**recipe["filters"]))
        _set_part(session, recipe["part"])
        if recipe.get("node") is not None:
            _set_node(session, recipe["node"], recipe["part"])
            _set_part(session, (MESH_GROUP, recipe["node"]))
        session.add_part(name)
    finally:
        session.select_node(None)
        session.set_part(before[0] if before[0] in session.parts else (WHOLE, WHOLE))
        session.set_filters(before[1])


def _select_cells(session, box, cell, beam) -> None:
    """cell: (range index, velocity index) whose contributions are told, None: the highest of the box; beam: (azimuth, elevation)
    in rad of those of its echoes that are meant, None: all."""
    spectrum = session.parts.whole.spectrum
    if box is not None and not (box[0] < len(spectrum.range) and box[2] < len(spectrum.velocity)):
        raise ValueError(f"the map has no cells {list(box)}")
    chosen = None if box is None else CellBox(*box).within(len(spectrum.range), len(spectrum.velocity))
    is_told = chosen is not None and cell is not None and chosen.holds(*cell)
    session.select_cells(chosen, tuple(cell) if is_told else None)
    if chosen is not None and beam is not None:
        session.light_beam(*beam)


def _set_node(session, name: str | None, base) -> None:
    if name is not None and name not in [node.name for node in session.scene.nodes]:
        raise ValueError(f"there is no '{name}'")
    _set_part(session, base)
    session.select_node(name)


def _set_part(session, key) -> None:
    key = tuple(key)
    if key not in session.parts:
        raise ValueError(f"there is no part '{key[-1]}'")
    session.set_part(key)


def _set_partition(session, partition) -> None:
    if partition is not None and partition not in session.parts.partitions:
        raise ValueError(f"there is no partition '{partition}'")
    session.set_partition(partition)


def _apply_layers(session, state: dict, misfits: list) -> None:
    wanted = state.get("layers")
    for layer in LAYERS if wanted is not None else ():
        if (layer in wanted) != (layer in session.layers):
            _attempt(misfits, layer, lambda: session.set_layer(layer, layer in wanted))


def _apply_looks(session, state: dict, misfits: list) -> None:
    if state.get("color_by") in COLOUR_MODES:
        session.set_color_by(state["color_by"])
    session.set_sampling(state.get("sampling", session.sampling))
    session.set_max_rays(state.get("max_rays", session.max_rays))
    session.set_dynamic_range(state.get("dynamic_range_db", session.dynamic_range_db))
    number_of = {name: number for number, name in enumerate(session.mesh_names)}
    unknown = [name for name in state.get("hidden_meshes", []) if name not in number_of]
    misfits += [f"hidden mesh: there is no '{name}'" for name in unknown]
    session.set_mesh_visible(list(number_of.values()), True)
    session.set_mesh_visible([number_of[name] for name in state.get("hidden_meshes", []) if name in number_of], False)
    colours = state.get("mesh_colours", {})
    session.set_mesh_colours({number_of[name]: rgb for name, rgb in colours.items() if name in number_of})
