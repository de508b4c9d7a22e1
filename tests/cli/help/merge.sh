# SPDX-License-Identifier: MIT
alpenglow merge --help
