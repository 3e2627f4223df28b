"""Hits of paths in a session of the viewer."""
from __future__ import annotations


def hit_names(session, path: int) -> list[str]:
    """Names of the meshes that a path hits, in its order."""
    first = session.paths.offsets[path]
    return [session.mesh_names[mesh] for mesh in session.paths.mesh_id[first:first + session.paths.num_bounces[path]]]
