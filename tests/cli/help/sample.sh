# SPDX-License-Identifier: MIT
alpenglow sample --help
