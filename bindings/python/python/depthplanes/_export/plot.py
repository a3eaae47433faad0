"""A plot of Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._optional import need

if TYPE_CHECKING:
    import matplotlib.axes

    from .._planes import Planes

#: Planes of a smaller share of the picture have no number in it.
SHARE = 0.005


def plot(planes: Planes, ax: matplotlib.axes.Axes | None) -> matplotlib.axes.Axes:
    """The picture, with the label and the distance of the larger planes at their middles."""
    pyplot = need("matplotlib.pyplot", "matplotlib", "plot()")
    ax = pyplot.gca() if ax is None else ax
    ax.imshow(planes.draw())
    ax.set_axis_off()
    width, height = planes.size
    for plane in planes:
        if plane.pixel_count < SHARE * width * height:
            break
        text = f"{plane.label}" if plane.distance != plane.distance else f"{plane.label}\n{plane.distance:.2f} m"
        # On the plane, which its middle need not be.
        rows, columns = np.nonzero(plane.mask)
        nearest = np.argmin(np.hypot(columns - plane.centroid_px[0], rows - plane.centroid_px[1]))
        u, v = columns[nearest], rows[nearest]
        ax.text(u, v, text, ha="center", va="center", size=7, bbox={"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 1})
    return ax
