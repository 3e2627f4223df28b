"""Weather: what air, fog and rain do to the echoes of a scene, and the echoes of rain itself."""
from .weather import Weather

__all__ = ["Weather"]
