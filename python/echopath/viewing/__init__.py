"""The way from results to the viewer: ep.view and ep.plot_rays."""
