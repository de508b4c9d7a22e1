# SPDX-License-Identifier: MIT
# without OpenGL 4.5, and without any EGL, one line says what was found
. "$(dirname "$0")/gl.bash"
alpenglow view builtin:cornell --with none --resolution 1x1 -o mesa.png | grep llvmpipe >renderer || {
    echo "skipped: not Mesa, whose version can be set" >&2
    exit 77
}
view="alpenglow view missing.glb --with none -o out.png"
MESA_GL_VERSION_OVERRIDE=3.3 $view 2>&1 | sed 's/found .*, OpenGL 3.3 .*/found .../'
echo "exit ${PIPESTATUS[0]}"
__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null $view
echo "exit $?"
$view
