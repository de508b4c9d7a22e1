# SPDX-License-Identifier: MIT
echo "just text" >text.png
: >empty.exr
for pair in "missing.png missing.exr" "text.png text.png" "empty.exr empty.exr" ". ."; do
    alpenglow compare $pair
    echo $?
done
