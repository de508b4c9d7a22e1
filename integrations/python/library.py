# SPDX-License-Identifier: MIT
"""Where the installed library is, by pkg-config."""
import subprocess
import sys

NEEDED = "0.1"


def pkg_config(*arguments):
    """Words that pkg-config prints about the library. Ends with one line where it is missing."""
    try:
        done = subprocess.run(["pkg-config", *arguments, f"alpenglow >= {NEEDED}"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    except FileNotFoundError:
        sys.exit("alpenglow: pkg-config is missing; install it (apt-get install pkg-config)")
    if done.returncode != 0:
        sys.exit(f"alpenglow: pkg-config does not find the library alpenglow {NEEDED} or newer; "
                 "run 'make install', and set PKG_CONFIG_PATH to its lib/pkgconfig")
    return done.stdout.split()
