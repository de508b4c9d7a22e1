# SPDX-License-Identifier: MIT
alpenglow view --help
