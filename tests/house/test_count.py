#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The line that counts the tests: cases, programs without cases, crashes, skips and their reasons."""
import importlib.util
import io
import pathlib
import sys

root = pathlib.Path(__file__).resolve().parent.parent.parent
spec = importlib.util.spec_from_file_location("test_script", root / "scripts" / "test.py")
test_script = importlib.util.module_from_spec(spec)
spec.loader.exec_module(test_script)

REPORT = """<testsuite>
<testcase name="good" status="run"><system-out>
[==========] Running 3 test(s).
[ RUN      ] one
[       OK ] one
[ RUN      ] two
no file: skipped
[  SKIPPED ] two
[ RUN      ] three
[       OK ] three
[  SKIPPED ] two
</system-out></testcase>
<testcase name="bad" status="fail"><system-out>
[ RUN      ] one
[  ERROR   ] --- 0x1 != 0x2
[  FAILED  ] one
[ RUN      ] two
[       OK ] two
[  FAILED  ] one
</system-out></testcase>
<testcase name="crashes" status="fail"><system-out>
[ RUN      ] one
[       OK ] one
[ RUN      ] two
</system-out></testcase>
<testcase name="leaks" status="fail"><system-out>
[ RUN      ] one
[       OK ] one
ERROR: leaked
</system-out></testcase>
<testcase name="script" status="run"><system-out>fine</system-out></testcase>
<testcase name="broken_script" status="fail"><system-out>oh</system-out></testcase>
<testcase name="no_tool" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
<system-out>no node here</system-out></testcase>
<testcase name="missing" status="notrun"><skipped message="Unable to find executable"/>
<system-out>Unable to find executable: missing</system-out></testcase>
</testsuite>"""

passed, failed, skipped = test_script.count(io.StringIO(REPORT))
expected = (6, ["bad: one", "crashes: two", "leaks: outside its cases (see above)",
                "broken_script: as a whole (see above)",
                "missing: Unable to find executable: missing"],
            ["good: two: no file: skipped", "no_tool: no node here"])
if (passed, failed, skipped) != expected:
    print(f"counted   {(passed, failed, skipped)}\nexpected  {expected}")
    sys.exit(1)
