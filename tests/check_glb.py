#!/usr/bin/env python3
"""Compares a GLB of `sunder export` with the poses and shapes of the run, and prints the largest
differences. Shares no code with the program: reads the file with json, struct and numpy alone.

Usage: check_glb.py X.glb POSES [BOXES [CHIPS]] [--metres M] [--degrees D]

POSES has rows of 12 numbers of 64 bits: frame, key, centre of mass in the world (3), rotation x, y, z,
w, centre of mass in the rest frame of the body (3). BOXES has rows of 9: frame, key, number of
vertices drawn on the body, least (3) and greatest (3) coordinates of these in the world.
CHIPS has rows of 8: frame, number of pieces of debris, least and greatest coordinates of their centres.
Exit code 1 if a pose differs by more than M or D, or if a body is visible in other frames. Read first:
main().
"""
import argparse
import json
import struct
import sys

import numpy as np

COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32,
              5126: np.float32}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Document:
    """A GLB: its JSON, and its accessors as arrays."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert magic == b"glTF" and version == 2 and length == len(data), "not a whole GLB"
        json_length, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json = json.loads(data[20:20 + json_length])
        binary_length, kind = struct.unpack_from("<I4s", data, 20 + json_length)
        assert kind == b"BIN\0" and 28 + json_length + binary_length == length
        self.binary = data[28 + json_length:]
        assert len(self.binary) == self.json["buffers"][0]["byteLength"]
        self.arrays = {}

    def array(self, number):
        """Returns an accessor as an array of rows, dequantised as glTF says."""
        if number not in self.arrays:
            accessor = self.json["accessors"][number]
            view = self.json["bufferViews"][accessor["bufferView"]]
            kind = np.dtype(COMPONENTS[accessor["componentType"]])
            columns = SIZES[accessor["type"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            stride = view.get("byteStride", kind.itemsize * columns)
            raw = np.ndarray((accessor["count"], columns), kind, self.binary, start,
                             (stride, kind.itemsize))
            rows = raw.astype(np.float64) if kind.kind == "f" or accessor.get("normalized") else raw
            if accessor.get("normalized"):
                rows = np.maximum(rows / np.iinfo(kind).max, -1)
            self.arrays[number] = rows
        return self.arrays[number]


def slerp(a, b, share):
    """Returns the spherical interpolation of rows of quaternions."""
    b = np.where((a * b).sum(1, keepdims=True) < 0, -b, b)
    angle = 2 * np.arctan2(np.linalg.norm(b - a, axis=1), np.linalg.norm(a + b, axis=1))
    sine = np.sin(angle)
    flat = sine < 1e-9
    sine = np.where(flat, 1, sine)
    from_a = np.where(flat, 1 - share, np.sin((1 - share) * angle) / sine)
    from_b = np.where(flat, share, np.sin(share * angle) / sine)
    return from_a[:, None] * a + from_b[:, None] * b


def sample(times, values, at, path, step):
    """Returns the values of an animation sampler at times."""
    index = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 1)
    if step:
        return values[index]
    after = np.minimum(index + 1, len(times) - 1)
    span = times[after] - times[index]
    share = np.clip((at - times[index]) / np.where(span > 0, span, 1), 0, 1)
    if path == "rotation":
        unit = values / np.linalg.norm(values, axis=1, keepdims=True)
        return slerp(unit[index], unit[after], share)
    return values[index] + share[:, None] * (values[after] - values[index])


def rotate(q, v):
    """Returns rows of vectors rotated by rows of quaternions x, y, z, w."""
    cross = np.cross(q[..., :3], v) + q[..., 3:] * v
    return v + 2 * np.cross(q[..., :3], cross)


class Motion:
    """Translation, rotation and scale of all nodes at times."""

    def __init__(self, document):
        self.document = document
        self.channels = {}
        for animation in document.json.get("animations", []):
            for channel in animation["channels"]:
                target = channel["target"]
                sampler = animation["samplers"][channel["sampler"]]
                self.channels[target["node"], target["path"]] = sampler

    def at(self, node, path, times):
        """Returns rows of a node's property at times."""
        sampler = self.channels.get((node, path))
        if sampler is None:
            fixed = self.document.json["nodes"][node].get(
                path, [0, 0, 0, 1] if path == "rotation" else
                [1, 1, 1] if path == "scale" else [0, 0, 0])
            return np.tile(np.asarray(fixed, np.float64), (len(times), 1))
        return sample(self.document.array(sampler["input"])[:, 0],
                      self.document.array(sampler["output"]), times, path,
                      sampler.get("interpolation") == "STEP")

    def is_visible(self, node, time):
        return self.at(node, "scale", np.array([time]))[0, 0] != 0

    def vertices(self, node, time):
        """Returns the visible vertices of a node and its children, in the node's parent."""
        described = self.document.json["nodes"][node]
        if not self.is_visible(node, time):
            return np.zeros((0, 3))
        parts = [self.vertices(child, time) for child in described.get("children", [])]
        if "mesh" in described:
            mesh = self.document.json["meshes"][described["mesh"]]
            parts.append(self.document.array(mesh["primitives"][0]["attributes"]["POSITION"]))
        points = np.concatenate(parts) if parts else np.zeros((0, 3))
        now = np.array([time])
        scaled = points * self.at(node, "scale", now)
        turn = np.broadcast_to(self.at(node, "rotation", now), (len(points), 4))
        return rotate(turn, scaled) + self.at(node, "translation", now)


def compare_poses(document, motion, rows, fps):
    """Returns the largest distance, the largest angle and messages about wrong visibility."""
    nodes = {node["extras"]["key"]: number for number, node in enumerate(document.json["nodes"])
             if "key" in node.get("extras", {})}
    messages, farthest, widest = [], 0.0, 0.0
    frames = int(rows[:, 0].max()) + 1
    all_times = (np.arange(frames) / fps).astype(np.float32).astype(np.float64)
    order = np.argsort(rows[:, 1], kind="stable")
    keys, starts = np.unique(rows[order, 1], return_index=True)
    if set(keys.astype(int)) != set(nodes):
        messages.append("the file and the run have different bodies")
    for key, of_body in zip(keys.astype(int), np.split(rows[order], starts[1:])):
        if key not in nodes:
            continue
        node = nodes[key]
        drawn = motion.at(node, "scale", all_times)[:, 0] > 0.5
        there = np.zeros(frames, bool)
        there[of_body[:, 0].astype(int)] = True
        if (drawn != there).any():
            messages.append(f"body {key} is visible in other frames than in the run")
        times = all_times[of_body[:, 0].astype(int)]
        rotation = of_body[:, 5:9] / np.linalg.norm(of_body[:, 5:9], axis=1, keepdims=True)
        # The origin of the node is the centre of mass in the body's first frame.
        place = of_body[:, 2:5] + rotate(rotation, of_body[0, 9:12] - of_body[:, 9:12])
        farthest = max(farthest, np.linalg.norm(
            motion.at(node, "translation", times) - place, axis=1).max())
        found = motion.at(node, "rotation", times)
        found /= np.linalg.norm(found, axis=1, keepdims=True)
        chord = np.minimum(np.linalg.norm(found - rotation, axis=1),
                           np.linalg.norm(found + rotation, axis=1))
        widest = max(widest, np.degrees(4 * np.arcsin(np.minimum(1, chord / 2))).max())
    return farthest, widest, messages


def compare_boxes(document, motion, rows, fps):
    """Returns the largest difference of a body's box, and messages about missing vertices."""
    nodes = {node["extras"]["key"]: number for number, node in enumerate(document.json["nodes"])
             if "key" in node.get("extras", {})}
    messages, farthest = [], 0.0
    for frame, key, count, *box in rows:
        time = float(np.float32(frame / fps))
        points = motion.vertices(nodes[int(key)], time)
        if len(points) != count:
            messages.append(f"body {int(key)} has {len(points)} vertices in frame {int(frame)}, "
                            f"not {int(count)}")
        elif count > 0:
            found = np.concatenate([points.min(0), points.max(0)])
            farthest = max(farthest, np.abs(found - box).max())
    return farthest, messages


def compare_chips(document, motion, rows, fps):
    """Returns messages about frames whose debris is not that of the run."""
    messages = []
    for frame, count, *box in rows:
        time = float(np.float32(frame / fps))
        points = [np.zeros((0, 3))]
        for number, node in enumerate(document.json["nodes"]):
            if not node.get("name", "").startswith("debris_") or not motion.is_visible(number, time):
                continue
            for child in node["children"]:
                described = document.json["nodes"][child]
                attributes = described["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
                points.append(document.array(attributes["TRANSLATION"]) * described["scale"])
        points = np.concatenate(points)
        if len(points) != count:
            messages.append(f"frame {int(frame)} has {len(points)} pieces of debris, not {int(count)}")
        elif count and np.abs(np.concatenate([points.min(0), points.max(0)]) - box).max() > 1e-4:
            messages.append(f"the debris of frame {int(frame)} is elsewhere")
    return messages


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("glb")
    parser.add_argument("poses")
    parser.add_argument("boxes", nargs="?")
    parser.add_argument("chips", nargs="?")
    parser.add_argument("--metres", type=float, default=1e-3)
    parser.add_argument("--degrees", type=float, default=0.1)
    given = parser.parse_args()
    document = Document(given.glb)
    motion = Motion(document)
    fps = document.json["asset"]["extras"]["sunder"]["fps"]
    rows = np.fromfile(given.poses, np.float64).reshape(-1, 12)
    farthest, widest, messages = compare_poses(document, motion, rows, fps)
    print(f"{len(rows)} poses: largest distance {1e3 * farthest:.4f} mm, "
          f"largest angle {widest:.4f} degrees")
    if given.boxes:
        boxes = np.fromfile(given.boxes, np.float64).reshape(-1, 9)
        difference, more = compare_boxes(document, motion, boxes, fps)
        print(f"{len(boxes)} boxes: largest difference {1e3 * difference:.4f} mm")
        messages += more
        if difference > 10 * given.metres:
            messages.append("a shape is not where it is in the run")
    if given.chips:
        chips = np.fromfile(given.chips, np.float64).reshape(-1, 8)
        print(f"{int(chips[:, 1].sum())} pieces of debris in {len(chips)} frames")
        messages += compare_chips(document, motion, chips, fps)
    for message in messages[:20]:
        print(message)
    return 1 if messages or farthest > given.metres or widest > given.degrees else 0


if __name__ == "__main__":
    sys.exit(main())
