"""Recordings as other people's programs write them, and an RVL encoder after its paper."""

import struct

import cv2
import numpy as np
from mcap.writer import CompressionType
from mcap_ros2.writer import Writer

HEADER = """std_msgs/Header header
"""
TIME = """================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
IMAGE = HEADER + """uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
""" + TIME
COMPRESSED_IMAGE = HEADER + """string format
uint8[] data
""" + TIME
CAMERA_INFO = HEADER + """uint32 height
uint32 width
string distortion_model
float64[] d
float64[9] k
float64[9] r
float64[12] p
uint32 binning_x
uint32 binning_y
sensor_msgs/RegionOfInterest roi
================================================================================
MSG: sensor_msgs/RegionOfInterest
uint32 x_offset
uint32 y_offset
uint32 height
uint32 width
bool do_rectify
""" + TIME

COMPRESSIONS = {"none": CompressionType.NONE, "lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD}


def rvl(values):
    """A. D. Wilson, "Fast Lossless Depth Image Compression", ISS 2017, section 3: runs of zeros and of values, differences
    as zigzag numbers, three bits a nibble with one that says whether more follow, eight nibbles a word from its top."""
    nibbles = []

    def number(value):
        while True:
            low, value = value & 7, value >> 3
            nibbles.append(low | (8 if value else 0))
            if not value:
                return

    values = values.ravel().astype(int)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], values != 0, [False]]).astype(int)))
    previous, at = 0, 0
    for start, end in edges.reshape(-1, 2):
        number(start - at)
        number(end - start)
        for value in values[start:end]:
            difference = value - previous
            number(2 * difference if difference >= 0 else -2 * difference - 1)
            previous = value
        at = end
    if at < len(values):
        number(len(values) - at)
        number(0)
    nibbles += [0] * (-len(nibbles) % 8)
    words = np.array(nibbles, dtype=np.uint32).reshape(-1, 8)
    return (words << np.arange(28, -1, -4, dtype=np.uint32)).sum(axis=1, dtype=np.uint32).astype("<u4").tobytes()


def png(values):
    return cv2.imencode(".png", values)[1].tobytes()


def payload(values, codec, a=0.0, b=0.0):
    """A compressedDepth payload: i32 format, A, B, then PNG, or RVL behind its size."""
    packed = png(values) if codec == "png" else struct.pack("<II", values.shape[1], values.shape[0]) + rvl(values)
    return struct.pack("<iff", 0, a, b) + packed


def quantised(depth_m, quantization=100.0, farthest_m=10.0):
    """A 32FC1 map as compressed_depth_image_transport quantises it: values, A and B."""
    a = quantization * (quantization + 1.0)
    b = 1.0 - a / farthest_m
    with np.errstate(divide="ignore"):
        values = np.where(depth_m > 0, a / np.where(depth_m > 0, depth_m, 1.0) + b, 0)
    return np.clip(values, 0, 65535).astype(np.uint16), a, b


def stamp(time_ns, frame_id="depth_optical"):
    return {"stamp": {"sec": time_ns // 10**9, "nanosec": time_ns % 10**9}, "frame_id": frame_id}


def image(values, encoding, time_ns, big_endian=False, padding=0):
    height, width = values.shape
    rows = values.astype(values.dtype.newbyteorder(">" if big_endian else "<")).view(np.uint8).reshape(height, -1)
    rows = np.pad(rows, ((0, 0), (0, padding)), constant_values=7)
    return {"header": stamp(time_ns), "height": height, "width": width, "encoding": encoding,
            "is_bigendian": int(big_endian), "step": rows.shape[1], "data": rows.tobytes()}


def camera_info(width, height, fx, fy, cx, cy, time_ns, d=(0.0,) * 5, binning=0, roi=(0, 0, 0, 0)):
    x, y, w, h = roi
    return {"header": stamp(time_ns), "height": height, "width": width, "distortion_model": "plumb_bob", "d": list(d),
            "k": [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0], "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            "p": [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0], "binning_x": binning, "binning_y": binning,
            "roi": {"x_offset": x, "y_offset": y, "height": h, "width": w, "do_rectify": False}}


TYPES = {"sensor_msgs/msg/Image": IMAGE, "sensor_msgs/msg/CompressedImage": COMPRESSED_IMAGE,
         "sensor_msgs/msg/CameraInfo": CAMERA_INFO}


def write_ros2(path, messages, compression="zstd", chunk_size=1024 * 1024):
    """Messages are (topic, type, message, log time in nanoseconds)."""
    with open(path, "wb") as file:
        writer = Writer(file, chunk_size=chunk_size, compression=COMPRESSIONS[compression])
        schemas = {name: writer.register_msgdef(name, TYPES[name]) for name in {message[1] for message in messages}}
        for topic, name, message, log_time in messages:
            writer.write_message(topic, schemas[name], message, log_time=log_time, publish_time=log_time)
        writer.finish()
