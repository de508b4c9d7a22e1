# SPDX-License-Identifier: MIT
alpenglow info builtin:sphere-plane
