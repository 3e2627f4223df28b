"""Files: written whole, locked, and what made them."""
