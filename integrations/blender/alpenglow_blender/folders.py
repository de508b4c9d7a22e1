# SPDX-License-Identifier: MIT
"""The temporary folder of a bake. A lock, which ends with Blender, keeps it from other Blenders:
each bake removes the folders of those that were killed."""

import os
import shutil
import tempfile

import bpy

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

PREFIX, LOCK = "alpenglow-bake-", "lock"


def parent():
    """The folder of Preferences > File Paths > Temporary Files, or else of the system. Blender has
    a folder of its own in it, which goes with Blender."""
    own = os.path.normpath(bpy.app.tempdir)
    return os.path.dirname(own) if os.path.basename(own).startswith("blender_") else own


def try_lock(file):
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True
    except OSError:
        return False


def remove_stale():
    """Removes folders of this user whose lock nobody holds. Those without a lock stay."""
    for entry in os.scandir(parent()):
        try:
            if not entry.name.startswith(PREFIX) or not entry.is_dir(follow_symlinks=False) or \
                    entry.stat(follow_symlinks=False).st_uid != os.getuid():
                continue
            with open(os.path.join(entry.path, LOCK), "rb") as file:
                if try_lock(file):
                    shutil.rmtree(entry.path, ignore_errors=True)
        except OSError:
            continue  # it is gone, or has no lock


class Folder:
    """A new folder, locked until remove() or the end of Blender."""

    def __init__(self):
        self.lock = None
        if fcntl is not None:
            remove_stale()
        self.path = tempfile.mkdtemp(prefix=PREFIX, dir=parent())
        if fcntl is not None:
            part = os.path.join(self.path, "part")
            self.lock = open(part, "wb")  # pylint: disable=consider-using-with
            try_lock(self.lock)
            os.rename(part, os.path.join(self.path, LOCK))  # others see it locked only

    def remove(self):
        shutil.rmtree(self.path, ignore_errors=True)
        if self.lock is not None:
            self.lock.close()

    def keep(self, blend):
        """Copies the baked scene and its maps beside the .blend, or to the temporary folder.
        Returns the path of the new folder, or None if no disk takes it."""
        name = os.path.splitext(os.path.basename(blend))[0] or "untitled"
        for place in (os.path.dirname(blend), parent()):
            try:
                if place:
                    return self.copy_to(tempfile.mkdtemp(prefix=f"{name}.baked-", dir=place))
            except OSError:
                continue
        return None

    def copy_to(self, target):
        try:
            for name in os.listdir(self.path):
                if name.startswith("baked"):
                    shutil.copy(os.path.join(self.path, name), target)
        except OSError:
            shutil.rmtree(target, ignore_errors=True)
            raise
        return target
