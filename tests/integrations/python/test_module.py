# SPDX-License-Identifier: MIT
"""The module against the command ($ALPENGLOW_COMMAND) and closed forms. It writes in this folder."""
import gc
import logging
import math
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy

import alpenglow
from alpenglow import Context, Error, Mesh, Probes, Scene

QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
OUTSIDE = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]
INSIDE = [t[::-1] for t in OUTSIDE]
SQUARE = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], [[0, 1, 2], [0, 2, 3]]


def command(*words):
    subprocess.run([os.environ["ALPENGLOW_COMMAND"], *map(str, words), "-q", "-f"], check=True)


class SameBits(unittest.TestCase):
    """Maps and files of the module are those of the command."""

    def compare(self, scene, words, options, maps):
        command("bake", scene, "--maps-dir", "maps", "--maps", ",".join(options["maps"]), *words)
        lightmap = Scene.load(scene).bake(**options)
        for name, file in maps.items():
            with self.subTest(name):
                theirs = alpenglow.load_image(f"maps/{file}.exr")
                numpy.testing.assert_array_equal(lightmap.map(name), theirs)
                self.assertGreater(lightmap.map(name).std(), 0.01)
        return lightmap

    def test_defaults(self):
        made = self.compare("builtin:cornell", ["--size", 64], {"maps": ("ao", "light"), "size": 64},
                            {"ao": "ao", "light": "irradiance"})
        numpy.testing.assert_array_equal(made.ao, made.map("ao")[:, :, 1])
        numpy.testing.assert_array_equal(made.irradiance, made.map("light")[:, :, :3])
        self.assertEqual(sorted(numpy.unique(made.coverage)), [0.0, 1.0])
        report = made.report  # a texel may be covered, and wholly inside other geometry
        self.assertEqual(report["atlas"]["texels"] - report["dropped"], made.coverage.sum())

    def test_samples_and_lights(self):
        self.compare("builtin:sphere-plane",
                     ["--size", 48, "--samples", 64, "--ao-samples", 64, "--bounces", 2, "--seed", 7,
                      "--sky", "clear", "--sun", "150,40,60000", "--sun-size", 2,
                      "--lamp", "0,2,0,100,1,.5,.25", "--ao-distance", 1.5],
                     {"maps": ("ao", "light", "bent", "direction"), "size": 48, "samples": 64,
                      "bounces": 2, "seed": 7, "sky": "clear", "sun": (150, 40, 60000),
                      "sun_size": 2, "lamps": [(0, 2, 0, 100, 1, .5, .25)], "ao_distance": 1.5},
                     {"ao": "ao", "light": "irradiance", "bent": "bent", "direction": "direction"})

    def test_error(self):
        self.compare("builtin:cornell", ["--size", 32, "--error", "3"],
                     {"maps": ("ao", "light"), "size": 32, "error": 0.03},
                     {"ao": "ao", "light": "irradiance"})

    def test_skies(self):
        words = ["--size", 32, "--samples", 32, "--sky"]
        for sky, text in ((2.0, "2"), ((1, 2, 3), "1,2,3"), (((1, 2, 3), (3, 2, 1)), "1,2,3/3,2,1")):
            self.compare("builtin:sphere-plane", words + [text],
                         {"maps": ("light",), "size": 32, "samples": 32, "sky": sky},
                         {"light": "irradiance"})

    def test_sky_images(self):
        pixels = numpy.linspace(0, 1, 8 * 16 * 3, dtype=numpy.float32).reshape(8, 16, 3)
        alpenglow.save_image("sky.exr", pixels, overwrite=True)
        for sky in (pixels, "sky.exr"):
            self.compare("builtin:sphere-plane", ["--size", 32, "--samples", 32, "--sky", "sky.exr"],
                         {"maps": ("light",), "size": 32, "samples": 32, "sky": sky},
                         {"light": "irradiance"})

    def test_outputs(self):
        command("bake", "builtin:cornell", "theirs.glb", "--maps", "ao,light", "--size", 32,
                "--samples", 32, "--ao-samples", 32)
        Scene.load("builtin:cornell").bake(maps=("ao", "light"), size=32, samples=32, overwrite=True,
                                           output="ours.glb", maps_folder=None)
        with open("theirs.glb", "rb") as theirs, open("ours.glb", "rb") as ours:
            self.assertEqual(theirs.read(), ours.read())

    def test_probes(self):
        command("probes", "builtin:cornell", "theirs.probes.json", "--spacing", 0.15)
        probes = Probes.bake(Scene.load("builtin:cornell"), spacing=0.15)
        probes.save("ours.probes.json", overwrite=True)
        for ending in (".ktx2", ".moments.ktx2"):
            with open("theirs.probes" + ending, "rb") as theirs:
                with open("ours.probes" + ending, "rb") as ours:
                    self.assertEqual(theirs.read(), ours.read())


class Arrays(unittest.TestCase):
    """Scenes from arrays, against closed forms."""

    def test_furnace(self):
        scene = Scene.from_arrays(CUBE, INSIDE, albedo=0.5, emission=(1, 2, 0))
        lightmap = scene.bake(size=64, maps=("ao", "light"))
        covered = lightmap.coverage > 0.5
        mean = lightmap.irradiance[covered].mean(axis=0)
        # E = pi L / (1 - albedo); the bake stops at a stated error of 1 %
        numpy.testing.assert_allclose(mean, numpy.array([1, 2, 0]) * 2 * math.pi, rtol=0.02)
        self.assertEqual(lightmap.maps, ("ao", "light"))
        probes = Probes.bake(scene, spacing=0.3)
        normals = numpy.eye(3)
        light = probes.sample(numpy.full((3, 3), 0.5), normals)
        # nine harmonics hold a constant exactly
        numpy.testing.assert_allclose(light, numpy.tile([2, 4, 0], (3, 1)) * math.pi, rtol=0.02)

    def test_open_square(self):
        scene = Scene.from_arrays(*SQUARE, normals=[[0, 1, 0]] * 4, albedo=(1, 0, 0))
        lightmap = scene.bake(size=16, maps=("ao", "light"), sky=1.0, samples=32)
        self.assertTrue((lightmap.ao == 1).all())
        # pi L: 32 stratified rays meet nothing but the sky
        numpy.testing.assert_allclose(lightmap.irradiance, math.pi, rtol=1e-3)

    def test_geometry_and_uvs(self):
        uvs = numpy.array([[0.1, 0.1], [0.1, 0.9], [0.9, 0.9], [0.9, 0.1]], numpy.float32)
        square = Mesh(*SQUARE, [[0, 1, 0]] * 4, uvs, name="square")
        scene = Scene.from_meshes([square], Context(threads=1))
        lightmap = scene.bake(size=32, samples=4, atlas="keep")
        numpy.testing.assert_allclose(lightmap.uvs, uvs[numpy.array(SQUARE[1])], atol=1e-6)
        numpy.testing.assert_array_equal(lightmap.triangle_pages, [0, 0])
        numpy.testing.assert_array_equal(scene.positions, SQUARE[0])
        numpy.testing.assert_array_equal(scene.triangles, SQUARE[1])
        numpy.testing.assert_array_equal(scene.normals, [[0, 1, 0]] * 4)
        self.assertEqual(scene.info["triangles"], 2)
        self.assertEqual(lightmap.report["threads"], 1)

    def test_several_meshes_and_pages(self):
        far = numpy.array(SQUARE[0]) + [0, 2, 0]
        scene = Scene.from_meshes([Mesh(*SQUARE, name="floor"), Mesh(far, SQUARE[1], name="roof")])
        lightmap = scene.bake(size=24, samples=4, only="floor")
        numpy.testing.assert_array_equal(lightmap.triangle_pages, [0, 0, 2**32 - 1, 2**32 - 1])
        lightmap = scene.bake(size=24, samples=4, texels_per_metre=20)
        self.assertEqual(lightmap.page_count, 2)
        self.assertEqual(lightmap.map("ao", 1).shape, (24, 24, 4))
        self.assertRaises(KeyError, lightmap.map, "ao", 2)
        self.assertRaises(KeyError, lightmap.map, "light")

    def test_strided_and_other_types(self):
        wide = numpy.zeros((4, 6), numpy.float64)
        wide[:, ::2] = SQUARE[0]
        scene = Scene.from_arrays(wide[:, ::2], numpy.array(SQUARE[1], numpy.int64))
        self.assertEqual(scene.info["bounds_max"], [1, 0, 1])

    def test_views_outlive_everything(self):
        ao = Scene.from_arrays(CUBE, OUTSIDE).bake(size=64, samples=16).ao
        kept = ao.copy()
        gc.collect()
        junk = [numpy.full((64, 64), 7.0) for _ in range(100)]
        numpy.testing.assert_array_equal(ao, kept)
        self.assertRaises(ValueError, ao.__setitem__, 0, 0)
        del junk

    def test_cycles_are_freed_in_order(self):
        code = """
import alpenglow, gc, sys
def cycle():
    scene = alpenglow.Scene.load("builtin:cornell")
    held = [scene.context, scene, scene.bake(size=16, samples=4)]
    held.append(alpenglow.Probes.bake(scene, spacing=0.3, rays=384))
    held.append(held[2].ao)
    held.append(held)
    return held
cycle()
assert gc.collect() > 0
kept = cycle()  # until the interpreter ends
"""
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_probe_lists(self):
        scene = Scene.load("builtin:cornell")
        places = [[0.1, 0.3, 0.1], [0.3, 0.4, 0.3]]
        probes = Probes.bake(scene, positions=places, rays=384, basis="sh4", visibility=False)
        self.assertEqual(probes.info["count"], 2)
        self.assertEqual(probes.coefficients.shape, (2, 4, 3))
        numpy.testing.assert_allclose(probes.positions, places, atol=1e-6)
        probes.save("list.probes.json", overwrite=True)
        again = Probes.load("list.probes.json")
        up = [[0, 1, 0]] * 2
        # files hold half floats: 2^-11 of the largest coefficient
        numpy.testing.assert_allclose(again.sample(places, up), probes.sample(places, up), rtol=2e-3)
        bounded = Probes.bake(scene, bounds=([0, 0, 0], [0.2, 0.2, 0.2]), spacing=0.1, rays=384)
        self.assertEqual(bounded.info["size"], [2, 2, 2])


class Failures(unittest.TestCase):
    """Errors have the library's message, or name the argument."""

    def refused(self, code, message, function, *arguments, **options):
        with self.assertRaises(Error) as caught:
            function(*arguments, **options)
        self.assertEqual(caught.exception.code, code)
        self.assertRegex(str(caught.exception), message)

    def test_library_messages(self):
        square = Scene.from_arrays(*SQUARE)
        self.refused("IO", "no-such.glb", Scene.load, "no-such.glb")
        self.refused("INVALID_ARGUMENT", "lamp|light", square.bake, maps="light", size=16)
        self.refused("INVALID_ARGUMENT", "size", square.bake, size=0)
        self.refused("INVALID_ARGUMENT", "rof", square.bake, size=16, only="rof")
        self.refused("INVALID_DATA", "vertex 9", Scene.from_arrays, SQUARE[0], [[0, 1, 9]])
        self.refused("INVALID_ARGUMENT", "5000 threads", Context, threads=5000)
        self.refused("IO", "none.probes.json", Probes.load, "none.probes.json")
        self.refused("INVALID_ARGUMENT", "maps", square.bake, maps=(), size=16)
        with open("there.glb", "w", encoding="utf-8"):
            pass
        self.refused("IO", "there.glb: exists already .*; give overwrite=True or name",
                     square.bake, size=16, output="there.glb")
        self.refused("INVALID_ARGUMENT", r"for example sky=1\.0$", square.bake, maps="light", size=16)
        self.assertRaisesRegex(KeyError, "this bake made 1 page of ao",
                               square.bake(size=16, samples=4).map, "ao", 7)

    def test_arguments(self):
        square = Scene.from_arrays(*SQUARE)
        for message, function, arguments, options in (
                (r"positions.*\(4, 2\)", Mesh, (numpy.zeros((4, 2)), SQUARE[1]), {}),
                ("negative", Mesh, (SQUARE[0], [[0, 1, -1]]), {}),
                ("normals: 3 of 4", Mesh, (*SQUARE, [[0, 1, 0]] * 3), {}),
                ("albedo", Mesh, SQUARE, {"albedo": (1, 2)}),
                ("maps: 'aos'; give one of ao", square.bake, (), {"maps": "aos"}),
                ("give one of them", square.bake, (), {"samples": 4, "error": 0.1}),
                ("error: 0", square.bake, (), {"error": 0}),
                ("size: -5; give a whole number from 0 to 4294967295", square.bake, (),
                 {"size": -5}),
                ("samples: -1; give a whole", square.bake, (), {"samples": -1}),
                ("seed: -1; give a whole", square.bake, (), {"seed": -1}),
                ("bounces: -1; give a whole", square.bake, (), {"bounces": -1}),
                ("rays: -1; give a whole", Probes.bake, (square,), {"rays": -1}),
                (r"albedo: 1\.5; give values from 0 to 1", Mesh, SQUARE, {"albedo": 1.5}),
                (r"albedo: \(0, nan, 0\); give values", Scene.from_arrays, SQUARE,
                 {"albedo": (0, math.nan, 0)}),
                ("meshes: no triangle in 1 mesh; give at least one", Scene.from_arrays,
                 (numpy.zeros((0, 3)), numpy.zeros((0, 3), int)), {}),
                ("meshes: no triangle in 0 meshes", Scene.from_meshes, ([],), {}),
                ("needs a sun", square.bake, (), {"maps": "light", "sky": "clear"}),
                ("azimuth", square.bake, (), {"maps": "light", "sun": (1, 2)}),
                ("candela", square.bake, (), {"maps": "light", "lamps": [(1, 2)]}),
                ("needs an output", square.bake, (), {"lightmap_as": "moz"}),
                ("null character", Scene.load, ("a\0b",), {}),
                ("normals: 1 of 2", Probes.bake(Scene.load("builtin:cornell"), rays=384,
                                                positions=[[0.1, 0.3, 0.1]]).sample,
                 ([[0, 0, 0]] * 2, [[0, 1, 0]]), {})):
            with self.subTest(message):
                self.assertRaisesRegex(ValueError, message, function, *arguments, **options)
        self.assertRaisesRegex(TypeError, "give integers", Mesh, SQUARE[0], [[0.0, 1.0, 2.0]])
        for name, value in (("size", "big"), ("size", 2.5), ("samples", "many"), ("error", "low"),
                            ("ao_distance", "far"), ("texels_per_metre", None), ("sun_size", "big"),
                            ("bounces", "two")):
            with self.subTest(name):
                self.assertRaisesRegex(TypeError, f"^{name}: .*; give a ", square.bake,
                                       **{name: value})
        self.assertRaisesRegex(TypeError, "^spacing: 'wide'; give a number", Probes.bake, square,
                               spacing="wide")

    def test_warnings_are_logged(self):
        with self.assertLogs("alpenglow", logging.WARNING) as logged:
            Scene.from_arrays(*SQUARE, emission=-1.0, name="Größe")
        self.assertRegex("\n".join(logged.output), r"material 0 .*\(material-range\)")


class Cancelling(unittest.TestCase):
    """Progress, cancelling and Ctrl-C."""

    LONG = {"maps": ("light",), "size": 512, "samples": 65536}

    def setUp(self):
        self.scene = Scene.load("builtin:cornell")

    def bake_again(self):
        self.assertEqual(self.scene.bake(size=16, samples=4).ao.shape, (16, 16))

    def test_progress(self):
        seen = []
        self.scene.bake(size=128, samples=256, maps=("ao", "light"), progress=seen.append)
        self.assertIn("light", {state.stage for state in seen})
        light = [state for state in seen if state.stage == "light"]
        self.assertTrue(all(0 <= state.done <= state.total for state in light))

    def test_false_cancels(self):
        with self.assertRaises(alpenglow.Cancelled) as caught:
            self.scene.bake(**self.LONG, output="cancelled.glb",
                            progress=lambda state: state.stage != "light")
        self.assertEqual(caught.exception.code, "CANCELLED")
        self.assertFalse(os.path.exists("cancelled.glb"))
        self.bake_again()

    def test_exceptions_pass(self):
        def faulty(_state):
            raise ZeroDivisionError("mine")
        self.assertRaisesRegex(ZeroDivisionError, "mine", self.scene.bake, **self.LONG, progress=faulty)
        self.bake_again()

    def test_calls_inside_progress(self):
        def inside(_state):
            Scene.load("builtin:bowl").bake(size=16, samples=4)  # another context
            self.scene.bake(size=16, samples=4)
        self.assertRaisesRegex(Error, "in another call", self.scene.bake, **self.LONG, progress=inside)
        self.bake_again()

    def interrupted(self, function, *arguments, **options):
        sent = []

        def send():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)
        timer = threading.Timer(0.5, send)
        timer.start()
        self.assertRaises(KeyboardInterrupt, function, *arguments, **options)
        # 100 ms by the library; more on a machine that is busy
        self.assertLess(time.monotonic() - sent[0], 2.0)
        self.bake_again()

    def test_interrupt(self):
        self.interrupted(self.scene.bake, **self.LONG)
        self.interrupted(Probes.bake, self.scene, spacing=0.01, rays=100000)

    def test_threads_run_beside(self):
        counted, going = [0], [True]

        def count():
            while going[0]:
                counted[0] += 1
                time.sleep(0.001)
        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        self.scene.bake(size=128, samples=512, maps=("light",))
        during = counted[0] - before
        going[0] = False
        thread.join()
        self.assertGreater(during, 10)  # progress alone gives some 20 turns a second


if __name__ == "__main__":
    logging.getLogger("alpenglow").addHandler(logging.NullHandler())
    unittest.main(argv=sys.argv[:1], verbosity=2)
