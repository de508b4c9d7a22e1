#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the tests of one preset and ends in a line that counts them.

    scripts/test.py PRESET [fast|integrations] [ctest arguments ...]

fast leaves out what is labelled slow or integration, and slow cases of other files. integrations
runs only those that need big installs, such as Blender or a browser, and those labelled often, which
repeat a test of all runs many times. Counted are the cases inside
our test programs (each writes a line per case) and, one each, the tests that only CTest knows.
Skipped cases are listed with the reason they gave. Exit status: 0 if nothing failed and something
passed (of integrations all may be skipped), else 1.
"""
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

TIERS = {"all": ["--label-exclude", "^often$"],
         "fast": ["--label-exclude", "^(slow|integration|often)$"],
         "integrations": ["--label-regex", "^(integration|often)$"]}
CASE = re.compile(r"^\[\s*(RUN|OK|SKIPPED|FAILED|ERROR)\s*\] (\w+)")


def cases_of(output):
    """(name, outcome, what was printed between) of each case in a program's output."""
    cases, name, said = [], None, []
    for line in output.splitlines():
        match = CASE.match(line.strip())
        if match and match[1] == "RUN":
            if name:  # the line of its end is missing
                cases.append((name, "FAILED", said))
            name, said = match[2], []
        elif match and match[2] == name:  # later mentions are the summary
            cases.append((name, match[1], said))
            name = None
        elif name and line.strip():
            said.append(line.strip())
    if name:
        cases.append((name, "FAILED", said))  # the program ended in the middle
    return cases


def count(report):
    """Outcomes of a JUnit file that CTest wrote: passed, and lists of failed and skipped."""
    passed, failed, skipped = 0, [], []
    for test in ElementTree.parse(report).getroot().iter("testcase"):
        program, status = test.get("name"), test.get("status")
        cases = cases_of(test.findtext("system-out") or "")
        for name, outcome, said in cases:
            if outcome == "OK":
                passed += 1
            elif outcome == "SKIPPED":
                skipped.append(f"{program}: {name}: {' '.join(said) or 'no reason given'}")
            else:
                failed.append(f"{program}: {name}")
        no_case_failed = not any(outcome in ("FAILED", "ERROR") for _, outcome, _ in cases)
        if status == "run" and not cases:
            passed += 1
        elif status == "fail" and no_case_failed:
            failed.append(f"{program}: {'outside its cases' if cases else 'as a whole'} (see above)")
        elif status in ("notrun", "disabled"):
            reason = test.find("skipped")
            lines = (test.findtext("system-out") or "").strip().splitlines()
            why = lines[-1] if lines else reason.get("message") if reason is not None else "not run"
            if "Unable to find executable" in why or "Required Files" in why:
                failed.append(f"{program}: {why}")
            else:
                skipped.append(f"{program}: {why}")
    return passed, failed, skipped


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    preset, arguments = sys.argv[1], sys.argv[2:]
    tier = arguments.pop(0) if arguments and arguments[0] in TIERS else "all"
    arguments = TIERS.get(tier, []) + arguments
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    report = os.path.abspath(f"build/{preset}/tests.xml")
    if os.path.exists(report):
        os.remove(report)
    jobs = str(len(os.sched_getaffinity(0)))
    command = ["ctest", "--preset", preset, "-j", jobs, "--output-junit", report]
    command += ["--test-output-size-passed", "10000000", "--test-output-size-failed", "10000000"]
    environment = dict(os.environ, TEST_FAST="1") if tier == "fast" else None
    status = subprocess.run(command + arguments, check=False, env=environment).returncode
    if not os.path.exists(report):
        sys.exit(f"test: ctest wrote no report (exit status {status})")
    passed, failed, skipped = count(report)
    for line in skipped:
        print(f"skipped: {line}")
    for line in failed:
        print(f"failed: {line}")
    if tier != "all":
        print(f"{tier} tests only; 'make test' runs all")
    print(f"alpenglow: {passed} tests passed, {len(failed)} failed, {len(skipped)} skipped")
    nothing = passed == 0 and tier != "integrations"
    sys.exit(1 if failed or status != 0 or nothing else 0)


if __name__ == "__main__":
    main()
