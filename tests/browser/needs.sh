# SPDX-License-Identifier: MIT
# need PACKAGE...: ends the test as skipped unless a browser and these npm packages are there.
need() {
    for tool in node "${CHROMIUM:-chromium}"; do
        if ! command -v "$tool" >/dev/null; then
            echo "$tool is absent: skipped"
            exit 77
        fi
    done
    for package in "$@"; do
        if [ ! -d "$here/node_modules/$package" ]; then
            echo "the npm package $package is absent: skipped (npm ci in tests/browser)"
            exit 77
        fi
    done
}
