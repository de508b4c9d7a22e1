# SPDX-License-Identifier: MIT
# -h is --help, anywhere on the line, and wins over what else is wrong; so is the word help
alpenglow -h | cmp - <(alpenglow --help) &&
    alpenglow bake -h | cmp - <(alpenglow bake --help) &&
    alpenglow bake x y z --nonsense --help | cmp - <(alpenglow bake --help) &&
    alpenglow help | cmp - <(alpenglow --help) &&
    alpenglow help bake | cmp - <(alpenglow bake --help) &&
    alpenglow help bake all | cmp - <(alpenglow bake --help all) &&
    alpenglow render --help all | cmp - <(alpenglow render --help)
