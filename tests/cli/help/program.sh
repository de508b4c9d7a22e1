# SPDX-License-Identifier: MIT
alpenglow --help
