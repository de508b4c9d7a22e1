# SPDX-License-Identifier: MIT
alpenglow render builtin:sphere-plane --with ao --ao-samples 8 --resolution 32x24 --samples 1 -q -o a.exr
alpenglow compare a.exr a.exr --max-rmse 0 | grep -E '^(rmse|bias|p99|maximum)'
