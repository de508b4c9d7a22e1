# SPDX-License-Identifier: MIT
alpenglow bench --help
