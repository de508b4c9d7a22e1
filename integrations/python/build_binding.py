# SPDX-License-Identifier: MIT
"""Builds alpenglow._binding. The C compiler checks each declaration against the installed headers."""
import os
import sys

import cffi

folder = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, folder)
from library import pkg_config  # noqa: E402


def stripped(option):
    """Values of one option of the library's flags: -L/usr/lib gives /usr/lib for "-L"."""
    words = pkg_config("--cflags", "--libs")
    return [word[len(option):] for word in words if word.startswith(option)]


def read(name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return file.read()


builder = cffi.FFI()
builder.cdef(read("declarations.h"))
builder.set_source("alpenglow._binding", read("flat.h"), include_dirs=stripped("-I"),
                   library_dirs=stripped("-L"), libraries=stripped("-l"),
                   # folders that the loader may not search by itself, such as ~/.local/lib
                   runtime_library_dirs=stripped("-L"))
