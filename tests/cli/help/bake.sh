# SPDX-License-Identifier: MIT
alpenglow bake --help
