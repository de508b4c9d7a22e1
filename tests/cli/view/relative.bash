# SPDX-License-Identifier: MIT
# relative NAME LIMIT A B: prints whether the RMSE of two images is below a share of the mean of B.
relative() {
    alpenglow compare "$3" "$4" | awk -v name="$1" -v limit="$2" '
        $1 == "relative" { print name ":", ($2 < limit ? "below" : "above"), limit }
        $1 == "means" && $4 <= 0 { print "the other image is black" }'
}
