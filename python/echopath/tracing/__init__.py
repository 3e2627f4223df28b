"""From a scene to the record of its rays: the model that a trace takes, and what it says of the scene."""
