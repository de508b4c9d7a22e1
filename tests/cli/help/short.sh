# SPDX-License-Identifier: MIT
# -h is --help, anywhere on the line, and wins over what else is wrong
alpenglow -h | cmp - <(alpenglow --help) &&
    alpenglow bake -h | cmp - <(alpenglow bake --help) &&
    alpenglow bake x y z --nonsense --help | cmp - <(alpenglow bake --help)
