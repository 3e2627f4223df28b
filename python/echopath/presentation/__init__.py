"""Results as tables, in notebooks and as xarray show them."""
