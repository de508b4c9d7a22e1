# SPDX-License-Identifier: MIT
alpenglow info --help
