# SPDX-License-Identifier: MIT
alpenglow info builtin:sphere-plane
alpenglow info builtin:cornell | grep '^light '
