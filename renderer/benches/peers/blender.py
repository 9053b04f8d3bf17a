"""Renders a scene of `equal_error.py` with Blender's Cycles, on one thread: called by that script.

    PYTHON blender.py SCENE.rad SCENE.vf WIDTHxHEIGHT OUT.exr SAMPLES [denoised]

where PYTHON is one with bpy (`pip install bpy==4.5.15`, Python 3.11). Prints the CPU seconds of rendering alone, after a first render of
one sample that loads what there is to load. Denoised is by Intel's Open Image Denoise with albedo and normal, as Blender ships it.
"""

import math
import sys
import time

import bpy
from mathutils import Matrix, Vector

from polygons import read as polygons_of, view_numbers


def material(name, kind, color):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    out = nodes.new("ShaderNodeOutputMaterial")
    if kind == "light":
        # Light from the front alone, as the other renderers have it.
        shader, side = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeNewGeometry")
        front = nodes.new("ShaderNodeMath")
        front.operation, front.inputs[0].default_value = "SUBTRACT", 1.0
        links.new(side.outputs["Backfacing"], front.inputs[1])
        links.new(front.outputs[0], shader.inputs["Strength"])
        made.cycles.emission_sampling = "FRONT"
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1.0)
    links.new(shader.outputs[0], out.inputs["Surface"])
    return made


def build(scene_path, view_path, size):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    materials, polygons = polygons_of(scene_path)
    for name, it in materials.items():
        made = [corners for _, modifier, corners in polygons if modifier == name]
        mesh = bpy.data.meshes.new(name)
        ends = [0]
        for corners in made:
            ends.append(ends[-1] + len(corners))
        mesh.from_pydata([corner for corners in made for corner in corners], [], [list(range(*it)) for it in zip(ends, ends[1:])])
        mesh.materials.append(material(name, *it))
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    number = lambda flag, n: view_numbers(view_path, flag, n)
    back, up = -Vector(number("-vd", 3)).normalized(), Vector(number("-vu", 3))
    right = up.cross(back).normalized()
    turn = Matrix((right, back.cross(right), back)).transposed().to_4x4()
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "HORIZONTAL", math.radians(number("-vh", 1)[0])
    seen = bpy.data.objects.new("camera", camera)
    seen.matrix_world = Matrix.Translation(number("-vp", 3)) @ turn
    scene.collection.objects.link(seen)
    scene.camera = seen
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = map(int, size.split("x"))
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles = scene.cycles
    cycles.device, cycles.pixel_filter_type = "CPU", "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = 5
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    return scene


def main():
    scene_path, view_path, size, out, samples = sys.argv[1:6]
    scene = build(scene_path, view_path, size)
    scene.render.filepath = out
    scene.cycles.use_denoising = "denoised" in sys.argv[6:]
    scene.cycles.denoiser = "OPENIMAGEDENOISE"
    for count in (1, int(samples)):
        scene.cycles.samples = count
        start = time.process_time()
        bpy.ops.render.render(write_still=True)
        seconds = time.process_time() - start
    print("CPU seconds:", seconds)


main()
