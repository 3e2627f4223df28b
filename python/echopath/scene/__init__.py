"""Scenes: a tree of named objects with meshes, materials and motions, and remarks on what they are made of."""
