# SPDX-License-Identifier: MIT
"""Builds the binding; its version is that of the installed library."""
import os
import sys

from setuptools import setup

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from library import pkg_config  # noqa: E402

setup(version=" ".join(pkg_config("--modversion")), cffi_modules=["build_binding.py:builder"])
