# SPDX-License-Identifier: MIT
alpenglow lpv --help
