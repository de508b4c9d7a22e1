# SPDX-License-Identifier: MIT
# all options; the short help names some of them, in the same words
alpenglow render --help all
alpenglow render --help | grep -c '^  -'
