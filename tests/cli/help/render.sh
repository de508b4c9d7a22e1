# SPDX-License-Identifier: MIT
alpenglow render --help
