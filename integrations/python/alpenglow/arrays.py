# SPDX-License-Identifier: MIT
"""Arrays between numpy and the library."""
import numpy

from .native import ffi

_KINDS = {numpy.float32: "float[]", numpy.float64: "double[]", numpy.uint32: "uint32_t[]"}


def given(values, columns, name, kind=numpy.float32):
    """Values of a caller as contiguous [n][columns]."""
    array = numpy.asarray(values)
    if kind is numpy.uint32 and array.size > 0:
        if not numpy.issubdtype(array.dtype, numpy.integer):
            raise TypeError(f"{name}: {array.dtype} values; give integers")
        if array.min() < 0 or array.max() > 0xFFFFFFFF:
            raise ValueError(f"{name}: an index is negative or above 4294967295")
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: an array of shape {array.shape}; give [n, {columns}]")
    return numpy.ascontiguousarray(array, dtype=kind)


def color(value, name):
    """One number, or three, as three floats."""
    try:
        return [float(part) for part in numpy.broadcast_to(value, 3)]
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {value!r} is not a colour; give one number or three") from None


def put(struct, field, value, name):
    """Sets a number of a struct of the library. Faults name the argument of the caller."""
    kind = dict(ffi.typeof(struct).fields)[field].type
    is_real = kind.cname in ("float", "double")
    most = 2 ** (8 * ffi.sizeof(kind)) - 1
    wanted = "a number" if is_real else f"a whole number from 0 to {most}"
    try:
        setattr(struct, field, value)
    except TypeError:
        raise TypeError(f"{name}: {value!r}; give {wanted}") from None
    except OverflowError:
        raise ValueError(f"{name}: {value!r}; give {wanted}") from None


def pointer(array):
    """The address of an array for a call, which the caller keeps alive."""
    return ffi.NULL if array is None else ffi.from_buffer(_KINDS[array.dtype.type], array)


class _Memory:
    """Memory of the library, as numpy reads it."""

    def __init__(self, address, shape, kind, owner):
        self.owner = owner  # alive as long as the array
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": numpy.dtype(kind).str,
                                    "data": (int(ffi.cast("uintptr_t", address)), True)}


def view(address, shape, kind, owner):
    """Memory of the library as a read-only array, which keeps the handle `owner` alive."""
    if address == ffi.NULL or 0 in shape:
        return numpy.zeros(shape, kind)
    return numpy.asarray(_Memory(address, shape, kind, owner))
