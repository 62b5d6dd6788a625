#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How does a LuxCore scene with thousands of instances become a file that setka reads?

    tests/tools/lux_to_gltf.py FOLDER/scene.scn OUT.gltf [--spin SECONDS]

Reads objects (mesh and transformation), the camera and matte materials of a scene in LuxCore's text format, and its binary PLY meshes. Writes glTF 2.0
with one mesh for each PLY file and one node for each object, so that nothing is copied. --spin adds an animation in which every instance turns
about its own z axis, once in so many seconds.
"""
import argparse
import json
import math
import pathlib
import struct
import sys


def read_properties(path):
    properties = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line.strip() or line.lstrip().startswith('#'):
            continue
        key, equals, value = line.partition('=')
        if not equals:
            sys.exit(f'{path}:{number}: no "=" in "{line[:60]}"')
        properties[key.strip()] = value.strip().strip('"')
    return properties


def numbers(text):
    return [float(word) for word in text.split()]


def read_ply(path):
    """Positions, normals and indices as bytes, and the positions' bounds."""
    data = path.read_bytes()
    header, _, body = data.partition(b'end_header\n')
    lines = header.decode('ascii').splitlines()
    if lines[:2] != ['ply', 'format binary_little_endian 1.0']:
        sys.exit(f'{path}: no little-endian PLY')
    vertices = faces = 0
    columns = []
    for line in lines:
        words = line.split()
        if words[:2] == ['element', 'vertex']:
            vertices = int(words[2])
        elif words[:2] == ['element', 'face']:
            faces = int(words[2])
        elif words[:2] == ['property', 'float']:
            columns.append(words[2])
    if columns[:6] != ['x', 'y', 'z', 'nx', 'ny', 'nz']:
        sys.exit(f'{path}: properties are {columns}; x y z nx ny nz have to come first')
    stride = 4 * len(columns)
    positions, normals = bytearray(), bytearray()
    low, high = [math.inf] * 3, [-math.inf] * 3
    for i in range(vertices):
        record = body[i * stride:i * stride + 24]
        for axis, value in enumerate(struct.unpack_from('<3f', record)):
            low[axis], high[axis] = min(low[axis], value), max(high[axis], value)
        positions += record[:12]
        normal = struct.unpack_from('<3f', record, 12)
        length = math.sqrt(sum(n * n for n in normal))
        normals += struct.pack('<3f', *([n / length for n in normal] if length > 0 else (0, 0, 1)))
    indices, at = bytearray(), vertices * stride
    for _ in range(faces):
        count = body[at]
        corners = struct.unpack_from(f'<{count}I', body, at + 1)
        at += 1 + 4 * count
        for k in range(1, count - 1):
            indices += struct.pack('<3I', corners[0], corners[k], corners[k + 1])
    return bytes(positions), bytes(normals), bytes(indices), low, high


def decompose(m):
    """Translation, rotation (x, y, z, w) and scale of a column-major matrix without shear."""
    columns = [m[0:3], m[4:7], m[8:11]]
    scale = [math.sqrt(sum(v * v for v in column)) for column in columns]
    x, y, z = [[v / s for v in column] for column, s in zip(columns, scale)]
    cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    if sum(a * b for a, b in zip(cross, z)) < 0:
        scale[0] = -scale[0]
        x = [-v for v in x]
    if abs(sum(a * b for a, b in zip(x, y))) + abs(sum(a * b for a, b in zip(y, z))) > 1e-3:
        sys.exit('an instance is sheared')
    trace = x[0] + y[1] + z[2]
    candidates = [1 + trace, 1 + 2 * x[0] - trace, 1 + 2 * y[1] - trace, 1 + 2 * z[2] - trace]
    best = max(range(4), key=lambda i: candidates[i])
    s = 2 * math.sqrt(max(candidates[best], 0))
    if best == 0:
        q = [(y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4]
    elif best == 1:
        q = [s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s]
    elif best == 2:
        q = [(y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s, (z[0] - x[2]) / s]
    else:
        q = [(z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4, (x[1] - y[0]) / s]
    length = math.sqrt(sum(v * v for v in q))
    return list(m[12:15]), [v / length for v in q], scale


def turned(q, angle):
    """q after a turn about the object's own z axis."""
    s, c = math.sin(angle / 2), math.cos(angle / 2)
    x, y, z, w = q
    return [x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s]


class Gltf:
    def __init__(self):
        self.json = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}], 'nodes': [], 'meshes': [],
                     'materials': [], 'accessors': [], 'bufferViews': [], 'buffers': []}
        self.data = bytearray()

    def accessor(self, data, component, kind, count, **extra):
        view = {'buffer': 0, 'byteOffset': len(self.data), 'byteLength': len(data)}
        self.data += data
        self.json['bufferViews'].append(view)
        self.json['accessors'].append({'bufferView': len(self.json['bufferViews']) - 1, 'componentType': component,
                                       'type': kind, 'count': count, **extra})
        return len(self.json['accessors']) - 1

    def add(self, kind, item):
        self.json.setdefault(kind, []).append(item)
        return len(self.json[kind]) - 1

    def add_node(self, node):
        index = self.add('nodes', node)
        self.json['scenes'][0]['nodes'].append(index)
        return index


def add_camera(gltf, properties):
    eye, target, up = (numbers(properties['scene.camera.' + key])
                       for key in ('lookat.orig', 'lookat.target', 'up'))
    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return [c / length for c in v]
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    back = unit([e - t for e, t in zip(eye, target)])
    right = unit(cross(up, back))
    matrix = [*right, 0, *cross(back, right), 0, *back, 0, *eye, 1]
    # The field of view is that of the longer side; a picture of 16:9 is taken.
    half = math.tan(math.radians(float(properties['scene.camera.fieldofview'])) / 2)
    camera = gltf.add('cameras', {'type': 'perspective', 'perspective': {
        'yfov': 2 * math.atan(half * 9 / 16), 'aspectRatio': 16 / 9, 'znear': 0.1}})
    gltf.add_node({'name': 'camera', 'camera': camera, 'matrix': matrix})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('scene', type=pathlib.Path)
    parser.add_argument('output', type=pathlib.Path)
    parser.add_argument('--spin', type=float, metavar='SECONDS', help='every instance turns once in so many seconds')
    options = parser.parse_args()
    properties = read_properties(options.scene)
    objects = {}
    materials = {}
    for key, value in properties.items():
        words = key.split('.')
        if words[:2] == ['scene', 'objects']:
            objects.setdefault(words[2], {})['.'.join(words[3:])] = value
        elif words[:2] == ['scene', 'materials'] and words[3:] == ['kd']:
            materials[words[2]] = value
    gltf = Gltf()
    meshes, material_numbers, moving = {}, {}, []
    for name, color in materials.items():
        rgb = numbers(color)
        rgb = rgb * 3 if len(rgb) == 1 else rgb
        material_numbers[name] = gltf.add('materials', {'name': name, 'pbrMetallicRoughness': {
            'baseColorFactor': [*rgb, 1], 'metallicFactor': 0, 'roughnessFactor': 1}})
    for name, item in objects.items():
        key = (item['ply'], item['material'])
        if key not in meshes:
            positions, normals, indices, low, high = read_ply(options.scene.parent / item['ply'])
            meshes[key] = gltf.add('meshes', {'name': item['ply'], 'primitives': [{
                'attributes': {
                    'POSITION': gltf.accessor(positions, 5126, 'VEC3', len(positions) // 12, min=low, max=high),
                    'NORMAL': gltf.accessor(normals, 5126, 'VEC3', len(normals) // 12)},
                'indices': gltf.accessor(indices, 5125, 'SCALAR', len(indices) // 4),
                'material': material_numbers[item['material']]}]})
        node = {'mesh': meshes[key]}
        if 'transformation' in item:
            matrix = numbers(item['transformation'])
            if options.spin:
                translation, rotation, scale = decompose(matrix)
                node.update(translation=translation, rotation=rotation, scale=scale)
                moving.append((gltf.add_node(node), rotation))
                continue
            node['matrix'] = matrix
        gltf.add_node(node)
    if moving:
        steps = 8
        times = gltf.accessor(struct.pack(f'<{steps + 1}f', *(options.spin * i / steps for i in range(steps + 1))),
                              5126, 'SCALAR', steps + 1, min=[0], max=[options.spin])
        animation = {'name': 'spin', 'samplers': [], 'channels': []}
        for node, rotation in moving:
            keys = b''.join(struct.pack('<4f', *turned(rotation, 2 * math.pi * i / steps)) for i in range(steps + 1))
            animation['samplers'].append({'input': times, 'output': gltf.accessor(keys, 5126, 'VEC4', steps + 1)})
            animation['channels'].append({'sampler': len(animation['samplers']) - 1,
                                          'target': {'node': node, 'path': 'rotation'}})
        gltf.add('animations', animation)
    add_camera(gltf, properties)
    data = options.output.with_suffix('.bin')
    gltf.json['buffers'].append({'uri': data.name, 'byteLength': len(gltf.data)})
    data.write_bytes(gltf.data)
    options.output.write_text(json.dumps(gltf.json))
    print(f'{options.output}: {len(objects)} objects of {len(meshes)} meshes')


main()
