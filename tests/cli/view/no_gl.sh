# SPDX-License-Identifier: MIT
# without OpenGL 4.5, without its libraries, and without any EGL, one line says what was found
. "$(dirname "$0")/gl.bash"
alpenglow view builtin:cornell --with none --resolution 1x1 -o mesa.png | grep llvmpipe >renderer || {
    echo "skipped: not Mesa, whose version can be set" >&2
    exit 77
}
view="alpenglow view missing.glb --with none -o out.png"
MESA_GL_VERSION_OVERRIDE=3.3 $view 2>&1 | sed 's/found .*, OpenGL 3.3 .*/found .../'
echo "exit ${PIPESTATUS[0]}"
# Empty files are found first, and are no libraries.
mkdir no_egl no_opengl
: >no_egl/libEGL.so.1 >no_opengl/libOpenGL.so.0 >no_opengl/libGL.so.1
for folder in no_egl no_opengl; do
    LD_LIBRARY_PATH=$PWD/$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} $view
    echo "exit $?"
done
__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null $view
echo "exit $?"
$view
