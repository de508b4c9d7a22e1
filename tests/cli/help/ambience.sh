# SPDX-License-Identifier: MIT
alpenglow ambience --help
