"""Detections of supervision."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._optional import need

if TYPE_CHECKING:
    import supervision

    from .._planes import Planes


def to_supervision(planes: Planes) -> supervision.Detections:
    """Boxes and masks; what is known of the planes in space is in `data`."""
    package = need("supervision", "supervision", "to_supervision()")
    labels = np.arange(1, len(planes) + 1)
    detections: supervision.Detections = package.Detections(
        xyxy=planes.xyxy.astype(np.float32),
        mask=planes.labels[None] == labels[:, None, None],
        class_id=np.zeros(len(planes), dtype=int),
        data={
            "class_name": np.full(len(planes), "plane"),
            "label": labels,
            "normal": planes.normals,
            "distance": planes.distances,
            "area": planes.areas,
            "rms": planes.rms,
        },
    )
    return detections
