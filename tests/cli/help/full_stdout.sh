# SPDX-License-Identifier: MIT
# a full disk behind standard output is a failure
alpenglow --help >/dev/full
