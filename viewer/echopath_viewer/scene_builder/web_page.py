"""The scene with its rays as one HTML file that needs nothing else, turned by the mouse, its rays picked by a click."""
from __future__ import annotations

import json
from html import escape

import numpy as np

from echopath.base.process.libraries import needed_module
from echopath.base.storage.files import written_whole
from echopath.base.storage.origin import origin_texts

from ..model.drawn_points import NEAR
from ..model.palette import objects_of
from .joined import joined_meshes

MESH_OPACITY, MIRROR_OPACITY, RAY_WIDTH, CHOSEN_WIDTH = 0.6, 0.18, 2, 7
CHOSEN_COLOUR = "#000000"
ROUND = 1000.0  # m, of the place where axes begin that is far from the origin of the world
EYE = np.array([-0.8, -0.9, 0.65])  # from behind, right and above, in sizes of what is looked at
HINT = ("Drag: turn. Wheel: zoom. Point at a ray or body: what it is. Click a ray: all of it. Legend: click hides, double click "
        "isolates.")
# Shows the ray that is clicked as a thick line, and what it is below the title.
ON_CLICK = """
const plot = document.getElementById('{plot_id}'), rays = plot.data[RAYS], chosen = CHOSEN;
plot.on('plotly_click', event => {
  const at = event.points[0];
  if (at.curveNumber !== RAYS) return;
  const path = rays.customdata[at.pointNumber], x = [], y = [], z = [];
  rays.customdata.forEach((other, index) => {
    if (other === path) { x.push(rays.x[index]); y.push(rays.y[index]); z.push(rays.z[index]); }
  });
  Plotly.restyle(plot, {x: [x], y: [y], z: [z]}, [chosen]);
  Plotly.relayout(plot, {'annotations[0].text': TEXTS[path]});
});
"""


class ScenePage:
    """An interactive picture of a scene with rays: notebooks show it, `save` writes it."""

    def __init__(self, session):
        """session: model.Session, of which what is drawn is taken. Raises ModuleNotFoundError without plotly."""
        self._plotly = needed_module("plotly.graph_objects", "the scene as HTML", extra="html")
        self._session, self._seed = session, session.paths.frame.seed
        self._origin = _origin_near(session.antennas_at(session.time)[0])
        self._traces = [*self._bodies(), self._antennas(), *self._ray_colours()]
        self._rays = len(self._traces)
        self._traces += [self._ray_lines(), self._chosen()]

    def html(self, whole: bool = True) -> str:
        """A page, or a piece of one; the library is inside, so that no network is needed."""
        figure = self._plotly.Figure(self._traces, self._layout())
        texts = {str(ray): self._text_of(int(ray)) for ray in self._session.listed_rays()}
        script = ON_CLICK.replace("CHOSEN", str(self._rays + 1)).replace("RAYS", str(self._rays))
        script = script.replace("TEXTS", json.dumps(texts))
        return figure.to_html(full_html=whole, include_plotlyjs=True, post_script=script, config={"displaylogo": False})

    def save(self, path) -> None:
        """Writes the page, whole or not at all. Raises ep.FileError."""
        notes = "".join(f'<meta name="{name.lower()}" content="{text}">' for name, text in origin_texts(self._seed).items())
        with written_whole(path) as temporary:
            temporary.write_text(self.html().replace("<head>", f"<head>{notes}", 1), encoding="utf-8")

    def _repr_html_(self) -> str:
        page = self.html().replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 620px; border: 0"></iframe>'

    # --- what is drawn ---

    def _bodies(self) -> list:
        """One for each object, in the shades of its meshes, and one for its mirrors, which are nearly clear, as in the window."""
        names, object_of_mesh = objects_of(self._session.scene)
        found = []
        for number, name in enumerate(names):
            meshes = [mesh for mesh in np.flatnonzero(object_of_mesh == number) if mesh not in self._session.hidden_meshes]
            mirrors = [mesh for mesh in meshes if self._session.scene.meshes[mesh].material.mirror]
            for own, opacity in ((sorted(set(meshes) - set(mirrors)), MESH_OPACITY), (mirrors, MIRROR_OPACITY)):
                if own:
                    found.append(self._body(name, own, opacity, is_listed=mirrors == meshes or own is not mirrors))
        return found

    def _body(self, name: str, meshes: list, opacity: float, is_listed: bool):
        session = self._session
        joined = joined_meshes(session, meshes)
        colour = {mesh: _css(session.palette[mesh]) for mesh in meshes}
        text = {mesh: escape(session.mesh_names[mesh]) for mesh in meshes}
        (x, y, z), (i, j, k) = self._drawn_at(joined.points).T, joined.triangles.T
        return self._plotly.Mesh3d(x=x, y=y, z=z, i=i, j=j, k=k, facecolor=[colour[mesh] for mesh in joined.mesh_of_triangle],
                                   hovertext=[text[mesh] for mesh in joined.mesh_of_point], hoverinfo="text", opacity=opacity,
                                   flatshading=True, showlegend=is_listed, name=escape(name), legendgroup=escape(name),
                                   showscale=False, color=colour[meshes[0]])

    def _antennas(self):
        x, y, z = self._drawn_at(self._session.antennas_at(self._session.time)).T
        return self._plotly.Scatter3d(x=x, y=y, z=z, mode="markers", name="antennas", hovertext=["transmitter", "receiver"],
                                      hoverinfo="text", marker={"size": 5, "color": ["#cc3311", "#0066cc"]})

    def _ray_colours(self) -> list:
        """What the colours of the rays mean: rows of the legend, or a scale."""
        legend = self._session.colouring(self._session.segments(self._drawn())).legend
        if legend.clim is not None:
            low, high = legend.clim
            scale = {"cmin": low, "cmax": high, "colorscale": legend.cmap if legend.cmap == "viridis" else "RdBu",
                     "reversescale": legend.cmap != "viridis", "showscale": True, "color": [low, high], "size": 0.1,
                     "colorbar": {"title": legend.title, "len": 0.5, "x": 0.0}}
            return [self._plotly.Scatter3d(x=[None] * 2, y=[None] * 2, z=[None] * 2, mode="markers", marker=scale,
                                           showlegend=False, hoverinfo="skip")]
        words = "rays to" if legend.title.startswith("Object") else f"rays, {legend.title.lower()}:"
        return [self._plotly.Scatter3d(x=[None], y=[None], z=[None], mode="lines", name=f"{words} {escape(label)}",
                                       line={"color": _css(rgb), "width": 4}) for label, rgb in legend.rows]

    def _drawn(self):
        session = self._session
        return session.listed_rays()[:session.max_rays]

    def _ray_lines(self):
        """All rays as one line with gaps; each point knows its path."""
        segments = self._session.segments(self._drawn())
        rgb = self._session.colouring(segments).rgb
        corners = self._drawn_at(segments.points)[segments.ends].reshape(-1, 3)
        rows = np.repeat(np.arange(segments.num_segments), 2)
        order = np.arange(len(corners)) + np.arange(len(corners)) // 2  # a gap behind each pair
        points = np.full((3 * segments.num_segments, 3), np.nan, np.float32)
        points[order] = corners
        paths = np.repeat(segments.rays[segments.ray], 3)
        texts = self._hover_texts(segments)
        x, y, z = points.T.tolist()  # lists, which the page's script can read: arrays are packed
        return self._plotly.Scatter3d(x=x, y=y, z=z, mode="lines", name="rays", customdata=paths.tolist(), showlegend=False,
                                      text=np.repeat(texts, 3), hoverinfo="text",
                                      line={"width": RAY_WIDTH, "color": [_css(rgb[row]) for row in np.repeat(rows[::2], 3)]})

    def _hover_texts(self, segments):
        texts = {int(ray): self._text_of(int(ray)) for ray in segments.rays}
        return np.array([texts[int(ray)] for ray in segments.rays[segments.ray]], object)

    def _text_of(self, path: int) -> str:
        return "<br>".join(f"{label}: {escape(text)}" for label, text in self._session.explain(path))

    def _chosen(self):
        return self._plotly.Scatter3d(x=[None], y=[None], z=[None], mode="lines", name="chosen ray", hoverinfo="skip",
                                      showlegend=False, line={"width": CHOSEN_WIDTH, "color": CHOSEN_COLOUR})

    def _layout(self) -> dict:
        axis = {"showbackground": False, "gridcolor": "#dddddd", "zeroline": False}
        low, high = self._ends()
        axes = {f"{name}axis": axis | {"title": _axis_title(name, begin), "range": [float(low[row]), float(high[row])]}
                for row, (name, begin) in enumerate(zip("xyz", self._origin))}
        note = {"text": "", "xref": "paper", "yref": "paper", "x": 0.01, "y": 0.98, "xanchor": "left", "yanchor": "top",
                "align": "left", "showarrow": False, "bgcolor": "rgba(255,255,255,.8)", "font": {"color": "black"}}
        title = {"text": f"{escape(self._session.title or 'Rays')}<br><sub>{HINT}</sub>", "font": {"size": 16}}
        return {"scene": axes | {"aspectmode": "manual"} | self._camera(low, high), "title": title, "annotations": [note],
                "margin": {"l": 0, "r": 0, "b": 0, "t": 60}, "legend": {"itemsizing": "constant"}, "paper_bgcolor": "white"}

    def _drawn_at(self, points) -> np.ndarray:
        """Points [..., 3] in m from where the axes begin: the page's library draws in single precision alone."""
        return (np.asarray(points, float) - self._origin).astype(np.float32)

    def _ends(self) -> tuple:
        """(lowest, highest), [3] m each, of all that is drawn."""
        traces = [trace for trace in self._traces if trace.type == "mesh3d" or trace.name in ("rays", "antennas")]
        points = np.concatenate([np.array([trace.x, trace.y, trace.z], float).T for trace in traces])
        return np.nanmin(points, axis=0) - 1e-3, np.nanmax(points, axis=0) + 1e-3

    def _camera(self, low, high) -> dict:
        """All axes to one scale, in which the eye looks at the rays: planes may reach far behind them."""
        unit = float((high - low).max())  # m
        rays = self._session.segments(self._drawn()).points
        seen = self._drawn_at(np.concatenate([rays, self._session.antennas_at(self._session.time)]))
        centre = (0.5 * (seen.min(axis=0) + seen.max(axis=0)) - 0.5 * (low + high)) / unit
        size = max(float(np.linalg.norm(seen.max(axis=0) - seen.min(axis=0))) / unit, 1e-2)
        return {"aspectratio": _xyz((high - low) / unit), "camera": {"center": _xyz(centre), "eye": _xyz(centre + size * EYE)}}


def _origin_near(place) -> np.ndarray:
    """[3] m, where the axes of a scene begin with a radar at a place [3] m: a round place by it where that is far."""
    return np.where(np.abs(place) > NEAR, np.round(np.asarray(place, float) / ROUND) * ROUND, 0.0)


def _axis_title(name: str, begin: float) -> str:
    return f"{name} in m" if begin == 0.0 else f"{name} in m from {begin:.0f}"


def _xyz(values) -> dict:
    return dict(zip("xyz", map(float, values)))


def _css(rgb) -> str:
    return "rgb({},{},{})".format(*map(int, rgb))
