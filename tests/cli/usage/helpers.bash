# SPDX-License-Identifier: MIT
# try WORDS...: runs alpenglow and prints its exit status and the first line of its message.
try() {
    local message code=0
    message=$(alpenglow "$@" 2>&1 >/dev/null) || code=$?
    printf '%s | %s | %s\n' "$*" "$code" "${message%%$'\n'*}"
}
# helpers for numbers: in a range the missing scene is the fault (1), out of it the number is (2)
accepted() { # command, option, value
    local code=0
    alpenglow "$1" missing.glb $(outputs "$1") "$2" $3 >/dev/null 2>&1 || code=$?
    printf '%s %s %s | %s\n' "$1" "$2" "$3" "$code"
}
outputs() {
    case $1 in
    bake) echo -o out.glb ;;
    render) echo -o out.png --with ao ;;
    compare) echo missing.glb ;;
    esac
}
