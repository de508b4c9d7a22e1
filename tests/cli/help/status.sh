# SPDX-License-Identifier: MIT
alpenglow status --help
