# SPDX-License-Identifier: MIT
alpenglow web --help
