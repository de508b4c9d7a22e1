# SPDX-License-Identifier: MIT
"""Finds the command alpenglow, checks its version, and runs it as a child process."""

import ctypes
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time

import bpy

VERSION = (0, 1)  # of the command: major and minor
PATIENCE = 10.0  # seconds for an interrupted child to end by itself
CHECK_SECONDS = 5  # for the version of the command
PR_SET_PDEATHSIG = 1  # prctl(2)
SHOWN_LINES = 50


class CommandError(Exception):
    """The command cannot be run, or failed. The message is one line for the user."""


def find_command(wanted):
    """The path of the command. A bare name is found on PATH; an empty one is alpenglow."""
    path = os.path.expanduser(bpy.path.abspath(wanted.strip()))  # "//" is the folder of the .blend
    name = path or "alpenglow"
    if os.path.basename(name) == name:
        path = shutil.which(name)
        if path is None:
            raise CommandError(f"there is no command {name} on PATH; install it, or name it in "
                               "the preferences of the add-on")
    if os.path.isdir(path):
        raise CommandError(f"{path}: is a folder; name the command alpenglow itself in the "
                           "preferences of the add-on")
    if not os.path.isfile(path):
        raise CommandError(f"{path}: there is no such file; name the command alpenglow in the "
                           "preferences of the add-on")
    if not os.access(path, os.X_OK):
        raise CommandError(f"{path}: is not executable; run chmod +x, or name another command in "
                           "the preferences of the add-on")
    return path


def check_command(wanted):
    """(path, version as text) of a command that this add-on can use."""
    path = find_command(wanted)
    try:
        ran = subprocess.run([path, "--version"], capture_output=True, timeout=CHECK_SECONDS,
                             check=False)
    except subprocess.TimeoutExpired:
        raise CommandError(f"{path} --version: no answer within {CHECK_SECONDS} s; install "
                           "alpenglow again") from None
    except OSError as error:
        raise CommandError(f"{path}: cannot be started ({error.strerror}); install alpenglow "
                           "again") from None
    words = ran.stdout.decode(errors="replace").split()
    if ran.returncode != 0:
        raise CommandError(f"{path} --version: {ending(ran.returncode)}{last_line(ran.stderr)}; "
                           "install alpenglow again")
    if len(words) < 2 or words[0] != "alpenglow":
        raise CommandError(f"{path}: is another program; name the command alpenglow in the "
                           "preferences of the add-on")
    numbers = words[1].split(".")
    wanted_version = ".".join(map(str, VERSION))
    if ".".join(numbers[:2]) != wanted_version:
        raise CommandError(f"{path}: is version {words[1]}, and this add-on needs "
                           f"{wanted_version}; install both from one release")
    return path, words[1]


def ending(status):
    """How a process ended, by its exit status."""
    if status < 0:
        try:
            return f"crashed ({signal.Signals(-status).name})"
        except ValueError:
            return f"ended by signal {-status}"
    return f"ended with {status}"


def last_line(data):
    lines = data.decode(errors="replace").strip().splitlines()
    return f": {lines[-1]}" if lines else ""


def dying_with_us():
    """A function for the child, by which Linux interrupts it once Blender has died; else None.
    Linux counts the end of the thread that started the child: here the main thread."""
    if not sys.platform.startswith("linux"):
        return None
    prctl, parent = ctypes.CDLL(None).prctl, os.getpid()

    def arrange():
        prctl(PR_SET_PDEATHSIG, signal.SIGINT)
        if os.getppid() != parent:  # it died before
            os._exit(130)
    return arrange


class Job:
    """One run of the command. poll() reads its progress; interrupt() and cancel() end it."""

    def __init__(self, arguments):
        self.stage, self.share, self.seconds_left = "starting", 0.0, None
        self.warnings, self.lines = [], []
        self.cancelled, self._deadline = False, None
        self._queue = queue.Queue()
        try:
            self.process = subprocess.Popen(
                arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE, start_new_session=True, preexec_fn=dying_with_us())
        except OSError as error:
            raise CommandError(f"{arguments[0]}: cannot be started ({error.strerror})") from None
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stderr:
            self._queue.put(line.decode(errors="replace").rstrip())

    def _take_lines(self):
        while not self._queue.empty():
            line = self._queue.get()
            if line.startswith("{"):
                self._take_progress(line)
            elif line:
                self.lines = (self.lines + [line])[-SHOWN_LINES:]
                if line.startswith("warning: "):
                    self.warnings.append(line.removeprefix("warning: "))

    def _take_progress(self, line):
        try:
            state = json.loads(line)
            self.stage = str(state["stage"])
            self.share = state["done"] / state["total"] if state["total"] else 0.0
            self.seconds_left = state["seconds_left"]
        except (ValueError, KeyError, TypeError):
            self.lines.append(line)

    def poll(self):
        """True once the command has ended. Kills one that did not heed the interrupt in time."""
        if self._deadline is not None and time.monotonic() > self._deadline:
            self.process.kill()
        ended = self.process.poll() is not None
        if ended:
            self._reader.join(PATIENCE)
        self._take_lines()
        return ended

    def wait(self):
        """Waits for the end. Ctrl-C cancels."""
        try:
            self.process.wait()
        except KeyboardInterrupt:
            self.cancel()
        self.poll()

    def interrupt(self):
        """Interrupts the command, which then writes nothing. poll() is True once it has ended."""
        if self.cancelled:
            return
        self.cancelled, self._deadline = True, time.monotonic() + PATIENCE
        if self.process.poll() is None:
            if os.name == "nt":
                self.process.terminate()
            else:
                self.process.send_signal(signal.SIGINT)

    def cancel(self):
        """Interrupts the command and waits for its end."""
        self.interrupt()
        if self.process.poll() is None:
            try:
                self.process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.poll()

    def check(self):
        """Raises CommandError unless the command ended well."""
        status = self.process.returncode
        if status == 0:
            return
        reason = next((line for line in reversed(self.lines) if line.startswith("alpenglow: ")),
                      self.lines[-1] if self.lines else "").removeprefix("alpenglow: ")
        raise CommandError(reason if status > 0 and reason else
                           f"the command {ending(status)}{': ' if reason else ''}{reason}")

    def describe(self):
        """Stage, share and time left, for the panel."""
        if self.cancelled:
            return "ending the command"
        text = f"{self.stage} {100 * self.share:.0f} %"
        if self.seconds_left is None:
            return text
        minutes, seconds = divmod(int(self.seconds_left + 0.5), 60)
        return text + (f", {minutes}:{seconds:02} min left" if minutes else f", {seconds} s left")
