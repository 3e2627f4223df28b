"""What a ghost is called in pictures, tables and files."""
from __future__ import annotations


def ghost_name(ghost) -> str:
    """Of a GhostLabel in few words: walker, type 2, order 3 via wall, floor."""
    return f"{ghost.object}, type {ghost.ghost_type}, order {ghost.order} via {', '.join(ghost.via)}"
