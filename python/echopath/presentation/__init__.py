"""Results as tables, notebooks, xarray and the viewer show them."""
