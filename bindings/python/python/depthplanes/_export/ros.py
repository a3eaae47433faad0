"""Messages of ROS 2."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from .._errors import MissingPackageError
from .._optional import need

if TYPE_CHECKING:
    from .._planes import Planes


def to_ros(planes: Planes, frame_id: str, stamp: tuple[int, int], types: Any) -> dict[str, Any]:
    """The label image, and the equation of each plane."""
    make = _of_typestore(types) if types is not None else _of_ros() or _of_typestore(_rosbags())
    width, height = planes.size
    seconds, nanoseconds = stamp
    header = make("std_msgs/msg/Header", stamp=make("builtin_interfaces/msg/Time", sec=seconds, nanosec=nanoseconds), frame_id=frame_id)
    data = np.ascontiguousarray(planes.labels, dtype="<u2").view(np.uint8).reshape(-1)
    labels = make(
        "sensor_msgs/msg/Image",
        header=header, height=height, width=width, encoding="16UC1", is_bigendian=0, step=2 * width, data=data,
    )  # fmt: skip
    models = [make("shape_msgs/msg/Plane", coef=planes.plane_model(k)) for k in range(len(planes))]
    return {"labels": labels, "planes": models}


def _of_ros() -> Any:
    """Makes messages of the ROS that is installed; None if there is none."""

    def make(name: str, **fields: Any) -> Any:
        package, _, message = name.split("/")
        return getattr(importlib.import_module(f"{package}.msg"), message)(**{key: _plain(value) for key, value in fields.items()})

    try:
        make("shape_msgs/msg/Plane")
    except ImportError:
        return None
    return make


def _plain(value: Any) -> Any:
    """ROS takes bytes in an array of Python's."""
    import array

    return array.array("B", value.tobytes()) if isinstance(value, np.ndarray) and value.dtype == np.uint8 else value


def _of_typestore(store: Any) -> Any:
    def make(name: str, **fields: Any) -> Any:
        return store.types[name](**fields)

    return make


def _rosbags() -> Any:
    try:
        typesys = need("rosbags.typesys", "rosbags", "to_ros()")
    except MissingPackageError as error:
        text = "to_ros() needs the messages of ROS 2: source a ROS installation, or pip install rosbags"
        raise MissingPackageError(text, name="rosbags") from error
    return typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
