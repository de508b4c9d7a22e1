# SPDX-License-Identifier: MIT
alpenglow sh --help
