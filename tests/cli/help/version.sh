# SPDX-License-Identifier: MIT
alpenglow --version
