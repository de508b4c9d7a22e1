# SPDX-License-Identifier: MIT
alpenglow compare --help
