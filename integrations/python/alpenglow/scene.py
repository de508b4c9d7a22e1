# SPDX-License-Identifier: MIT
"""Scenes: of files, or of arrays."""
import numpy

from . import lightmap
from .arrays import color, given, pointer, view
from .native import Context, as_dict, chars, ffi, lib


class Mesh:
    """A mesh as arrays, in world space.

    positions: [n, 3] metres; triangles: [t, 3] vertices, counter-clockwise from outside.
    normals: [n, 3] unit, or None: flat normals of the triangles.
    uvs: [n, 2] lightmap coordinates in [0, 1] for atlas="keep", or None.
    albedo: linear diffuse colour in [0, 1]; emission: radiance, W/(sr m2). One number, or three.
    """

    def __init__(self, positions, triangles, normals=None, uvs=None, *, albedo=0.8, emission=0.0,
                 double_sided=False, name=None):
        self.positions = given(positions, 3, "positions")
        self.triangles = given(triangles, 3, "triangles", numpy.uint32)
        self.normals = None if normals is None else given(normals, 3, "normals")
        self.uvs = None if uvs is None else given(uvs, 2, "uvs")
        for array, what in ((self.normals, "normals"), (self.uvs, "uvs")):
            if array is not None and len(array) != len(self.positions):
                raise ValueError(f"{what}: {len(array)} of {len(self.positions)} vertices")
        self.albedo, self.emission = color(albedo, "albedo"), color(emission, "emission")
        if not all(0.0 <= part <= 1.0 for part in self.albedo):
            raise ValueError(f"albedo: {albedo!r}; give values from 0 to 1")
        self.double_sided, self.name = double_sided, name

    def _fill(self, mesh):
        kept = [pointer(array) for array in (self.positions, self.normals, self.uvs, self.triangles)]
        mesh.positions, mesh.normals, mesh.uvs, mesh.indices = kept
        mesh.vertex_count, mesh.triangle_count = len(self.positions), len(self.triangles)
        mesh.base_color, mesh.emission = self.albedo, self.emission
        mesh.double_sided = self.double_sided
        if self.name is not None:
            kept.append(chars(self.name))
            mesh.name = kept[-1]
        return kept


class Scene:
    """Triangles in world space with materials and lights: Scene.load or Scene.from_arrays."""

    def __init__(self, handle, context):
        self.handle, self.context = handle, context

    @classmethod
    def load(cls, path, context=None):
        """Reads a .gltf, .glb, .obj, .dae or .zae, or makes a built-in scene ("builtin:cornell")."""
        context = context or Context()
        return cls(context.make("alp_scene", lib.alp_scene_destroy, (), lib.alp_scene_load,
                                context.handle, chars(path), ...), context)

    @classmethod
    def from_arrays(cls, positions, triangles, normals=None, uvs=None, *, albedo=0.8, emission=0.0,
                    double_sided=False, name=None, context=None):
        """Makes a scene of one mesh; the arguments are those of Mesh."""
        return cls.from_meshes([Mesh(positions, triangles, normals, uvs, albedo=albedo,
                                     emission=emission, double_sided=double_sided, name=name)],
                               context)

    @classmethod
    def from_meshes(cls, meshes, context=None):
        """Makes a scene of several meshes, whose triangles follow each other. Copies the arrays."""
        context, meshes = context or Context(), list(meshes)
        if not any(len(mesh.positions) and len(mesh.triangles) for mesh in meshes):
            raise ValueError(f"meshes: no triangle in {len(meshes)} mesh"
                             f"{'' if len(meshes) == 1 else 'es'}; give at least one")
        structs = ffi.new("alp_mesh[]", len(meshes))
        kept = [mesh._fill(struct) for mesh, struct in zip(meshes, structs)]
        made = context.make("alp_scene", lib.alp_scene_destroy, (), lib.alp_scene_create_from_meshes,
                            context.handle, structs, len(meshes), ...)
        del kept
        return cls(made, context)

    @property
    def info(self):
        """Counts, bounds in metres and origin, as a dict."""
        return as_dict(lib.alp_scene_get_info(self.handle.pointer))

    @property
    def positions(self):
        """[n, 3] positions of vertices in metres, float32. A flat mesh has three a triangle."""
        return self._rows(lib.flat_positions, "vertices", numpy.float32)

    @property
    def normals(self):
        """[n, 3] unit normals of vertices, float32."""
        return self._rows(lib.flat_normals, "vertices", numpy.float32)

    @property
    def triangles(self):
        """[t, 3] vertices of the triangles, uint32, in the order of Lightmap.uvs."""
        return self._rows(lib.flat_triangles, "triangles", numpy.uint32)

    def _rows(self, read, count, kind):
        return view(read(self.handle.pointer), (self.info[count], 3), kind, self.handle)

    bake = lightmap.bake
