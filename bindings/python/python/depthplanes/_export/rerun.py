"""Entities of Rerun."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _native
from .._optional import need

if TYPE_CHECKING:
    from .._planes import Planes


def to_rerun(planes: Planes, path: str, recording: Any) -> None:
    """Camera, depth in metres and labels in the planes' colours; outlines in space where they are known."""
    rerun = need("rerun", "rerun-sdk", "to_rerun()")
    colours = _native.colours(len(planes))
    names = [(label, f"plane {label}" if label else "none", colour.tolist()) for label, colour in enumerate(colours)]

    def log(name: str, entity: Any) -> None:
        rerun.log(f"{path}/{name}" if name else path, entity, recording=recording)

    log("", rerun.AnnotationContext(names))
    log("camera/labels", rerun.SegmentationImage(planes.labels))
    if planes.camera is None:
        return
    fx, fy, cx, cy = planes.camera
    width, height = planes.size
    matrix = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]
    log("camera", rerun.Pinhole(image_from_camera=matrix, width=width, height=height, camera_xyz=rerun.ViewCoordinates.RDF))
    if np.isnan(planes.distances).all():
        return
    log("camera/depth", rerun.DepthImage(np.nan_to_num(planes._depth_m), meter=1.0))
    known = [k for k, area in enumerate(planes.areas) if not np.isnan(area)]
    rings = [(ring, k) for k in known for part in planes.polygons(k, metric=True) for ring in [part.outer, *part.holes]]
    strips = [np.concatenate([ring, ring[:1]]) for ring, _ in rings]
    log("outlines", rerun.LineStrips3D(strips, colors=[colours[k + 1] for _, k in rings], class_ids=[k + 1 for _, k in rings]))
