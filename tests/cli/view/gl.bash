# SPDX-License-Identifier: MIT
# Draws on the processor, wherever there is a graphics card. Skips where EGL has no OpenGL 4.5, and
# only there.
export LIBGL_ALWAYS_SOFTWARE=1
if ! alpenglow view builtin:cornell --with none --resolution 1x1 -q -o gl.png 2>message &&
    grep -q "OpenGL 4.5 is needed\|there is no EGL\|there is no OpenGL\|EGL has no display" message; then
    echo "skipped: $(cat message)" >&2
    exit 77
fi
