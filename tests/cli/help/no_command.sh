# SPDX-License-Identifier: MIT
alpenglow
