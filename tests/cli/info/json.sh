# SPDX-License-Identifier: MIT
alpenglow info builtin:cornell --json >info.json
json_shape info.json
