"""Tables of a scene file as the schema has them: keys, rules and descriptions (data/README.md)."""
