# SPDX-License-Identifier: MIT
# all options; the short help names some of them, in the same words
alpenglow bake --help all
alpenglow bake --help | grep -c '^  -'
