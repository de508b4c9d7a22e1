# SPDX-License-Identifier: MIT
alpenglow probes --help
