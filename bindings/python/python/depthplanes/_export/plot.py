"""A plot of Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _native
from .._optional import need

if TYPE_CHECKING:
    import matplotlib.axes

    from .._plane import Plane
    from .._planes import Planes

#: Planes of a smaller share of the picture have no number in it.
SHARE = 0.005
#: Numbers are no nearer to each other than this share of the picture's width; the larger plane has one.
APART = 0.04
#: Rows of the legend.
ROWS = 24
#: Inches along the longer side of a picture that has a figure of its own, and of the legend beside it.
INCHES, LEGEND_INCHES = 8.0, 1.8


def plot(planes: Planes, ax: matplotlib.axes.Axes | None) -> matplotlib.axes.Axes:
    """The picture with the labels of the larger planes on them, and a legend with their perpendicular distances."""
    pyplot = need("matplotlib.pyplot", "matplotlib", "plot()")
    patches = need("matplotlib.patches", "matplotlib", "plot()")
    width, height = planes.size
    if ax is None and not pyplot.get_fignums():
        inches = INCHES * np.array([width, height]) / max(width, height)
        _, ax = pyplot.subplots(figsize=inches + [LEGEND_INCHES, 0], layout="constrained")
    ax = pyplot.gca() if ax is None else ax
    ax.imshow(planes.draw())
    ax.set_axis_off()
    large = [plane for plane in planes if plane.pixel_count >= SHARE * width * height]
    places: list[tuple[int, int]] = []
    for plane in large:
        u, v = _place(plane)
        if all(np.hypot(u - column, v - row) >= APART * width for column, row in places):
            places.append((u, v))
            box = {"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 1}
            ax.text(u, v, str(plane.label), ha="center", va="center", size=7, bbox=box)
    colours = _native.colours(len(planes)) / 255
    rows = [patches.Patch(color=colours[plane.label], label=_row(plane)) for plane in large[:ROWS]]
    if rows:
        title = "plane" if np.isnan(planes.distances).all() else "plane, perpendicular\ndistance from the camera"
        ax.legend(handles=rows, title=title, loc="upper left", bbox_to_anchor=(1, 1), fontsize=7, title_fontsize=7, frameon=False)
    return ax


def _row(plane: Plane) -> str:
    return f"{plane.label}" if np.isnan(plane.distance) else f"{plane.label}:  {plane.distance:.2f} m"


def _place(plane: Plane) -> tuple[int, int]:
    """The pixel of the plane that is nearest to its middle, which need not lie on it."""
    rows, columns = np.nonzero(plane.mask)
    nearest = np.argmin(np.hypot(columns - plane.centroid_px[0], rows - plane.centroid_px[1]))
    return int(columns[nearest]), int(rows[nearest])
