# SPDX-License-Identifier: MIT
# the lines that people type first, on gazebo.obj
. "$(dirname "$0")/lines.bash"
copy architecture/gazebo.obj
lines gazebo.obj gazebo .obj
