# SPDX-License-Identifier: MIT
"""Images in memory and in files."""
import numpy

from .arrays import view
from .native import Context, chars, ffi, lib


def make(context, pixels):
    """A handle of an image: an array [height, width] or [height, width, 1 to 4]."""
    pixels = numpy.asarray(pixels)
    pixels = pixels[:, :, None] if pixels.ndim == 2 else pixels
    if pixels.ndim != 3 or not 1 <= pixels.shape[2] <= 4:
        raise ValueError(f"pixels: an array of shape {pixels.shape}; give [height, width] or "
                         "[height, width, 1 to 4]")
    is_bytes = pixels.dtype == numpy.uint8
    info = ffi.new("alp_image_info *", {
        "width": pixels.shape[1], "height": pixels.shape[0], "channels": pixels.shape[2],
        "component": lib.ALP_COMPONENT_U8 if is_bytes else lib.ALP_COMPONENT_FLOAT})
    image = context.make("alp_image", lib.alp_image_destroy, (), lib.alp_image_create,
                         context.handle, info[0], ...)
    target = (lib.alp_image_bytes if is_bytes else lib.alp_image_floats)(image.pointer)
    source = numpy.ascontiguousarray(pixels, numpy.uint8 if is_bytes else numpy.float32)
    ffi.memmove(target, ffi.from_buffer(source), source.nbytes)
    return image


def load(context, path):
    """A handle of an image: a file."""
    return context.make("alp_image", lib.alp_image_destroy, (), lib.alp_image_load,
                        context.handle, chars(path), ...)


def load_image(path):
    """Reads a .png or .jpg as uint8, a .exr or .hdr as float32: [height, width, channels], read-only."""
    image = load(Context(threads=1), path)
    info = lib.alp_image_get_info(image.pointer)
    is_bytes = info.component == lib.ALP_COMPONENT_U8
    address = (lib.alp_image_bytes if is_bytes else lib.alp_image_floats)(image.pointer)
    return view(address, (info.height, info.width, info.channels),
                numpy.uint8 if is_bytes else numpy.float32, image)


def save_image(path, pixels, overwrite=False):
    """Writes an array [height, width] or [height, width, 1 to 4], row 0 on top.

    path: .png for uint8 values as they are; .exr or .hdr for linear floats.
    """
    context = Context(threads=1)
    context.call(lib.alp_image_save, make(context, pixels), chars(path), overwrite)
