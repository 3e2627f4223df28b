"""The scene with its rays: the 3-D view, what is drawn in it, and lists of meshes and rays."""
