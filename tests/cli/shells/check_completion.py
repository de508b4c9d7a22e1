#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Completion as its users meet it: lines are typed into a real shell.

    check_completion.py SHELL ALPENGLOW     SHELL: bash, zsh or fish

bash and zsh run on a terminal of their own; a key inserts everything that is offered, and a function
in alpenglow's place writes down the words that the line then has, so that quoting is tested too.
fish is asked by its own `complete -C`. Exit status: 0 good, 1 not, 77 the shell is not there.
"""
import os
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PATIENCE = 60  # seconds; only a shell that hangs takes them
FILES = ["scene.glb", "other.gltf", "my scene.glb", "notes.txt", "report.json", "map.exr", "pic.png"]
FOLDERS = ["maps", "my maps"]
SCENES = ["scene.glb", "other.gltf", "my scene.glb", "maps", "my maps"]

# What is typed, what is offered. {commands}, {options of ...} and {scenes} are asked of alpenglow.
CASES = [
    ("alpenglow ", "{commands} help"),
    ("alpenglow re", "render"),
    ("alpenglow --v", "--version"),
    ("alpenglow --comp", "--completion"),
    ("alpenglow --completion ", "bash zsh fish"),
    ("alpenglow help ba", "bake"),
    ("alpenglow bake --", "{options of bake}"),
    ("alpenglow render --", "{options of render}"),
    ("alpenglow info --", "{options of info}"),
    ("alpenglow compare --", "{options of compare}"),
    ("alpenglow bake --max-r", ""),  # of another command
    ("alpenglow probes --spl", ""),  # in the contract, not built
    ("alpenglow bake --atlas b", "blend"),
    ("alpenglow bake --ao-falloff ", "none linear smooth exp"),
    ("alpenglow bake --ao-falloff s", "smooth"),
    ("alpenglow bake --ao-falloff=s", "smooth"),
    ("alpenglow bake scene.glb --existing-ao ", "replace multiply keep"),
    ("alpenglow render --progress ", "auto plain json off"),
    ("alpenglow bake --ao-distance ", "auto inf"),
    ("alpenglow bake --ao-cone ", ""),  # a number: nobody knows which
    ("alpenglow bake --maps a", "ao"),
    ("alpenglow bake builtin:", "{scenes}"),
    ("alpenglow bake built", "{scenes}"),
    ("alpenglow info --json builtin:tea", "builtin:teapot-room"),
    ("alpenglow bake ", SCENES + ["{scenes}"]),
    ("alpenglow bake s", "scene.glb"),
    ("alpenglow bake --seed 3 o", "other.gltf"),
    ("alpenglow bake my\\ s", ["my scene.glb"]),
    ("alpenglow bake scene.glb -o o", "other.gltf"),
    ("alpenglow bake scene.glb --output=o", "other.gltf"),
    ("alpenglow bake scene.glb --json r", "report.json"),
    ("alpenglow bake scene.glb --json n", {"zsh": "notes.txt", "else": ""}),  # zsh: better than none
    ("alpenglow bake --maps-dir ma", "maps"),
    ("alpenglow render scene.glb -o ", ["map.exr", "pic.png", "maps", "my maps"]),
    ("alpenglow compare map.exr p", "pic.png"),
    ("alpenglow compare map.exr pic.png --heatmap p", "pic.png"),
    ("alpenglow frobnicate --", ""),
]


def ask(command, *words):
    return subprocess.run([command, *words], capture_output=True, text=True, check=False)


def long_options(command, name):
    """What --help all says stands under a command, without what it says is not built."""
    text = ask(command, name, "--help", "all").stdout.split("\nNot built yet")[0]
    lines = [line for line in text.splitlines() if re.match(r"  -", line)]
    return [word.strip(",") for line in lines for word in line.split() if word.startswith("--")]


def scenes(command):
    """The built-in scenes that the library knows: it lists them when asked for another."""
    said = ask(command, "info", "builtin:no-such-scene").stderr
    names = re.findall(r"[a-z-]+", said.split("there are:")[1].splitlines()[0])
    return ["builtin:" + name for name in names if name != "builtin"]


def expected(command, wanted):
    words = [wanted] if "{options" in wanted else wanted.split() if isinstance(wanted, str) else wanted
    result = []
    for word in words:
        if word == "{commands}":
            result += ask(command, "--commands").stdout.split()
        elif word == "{scenes}":
            result += scenes(command)
        elif word.startswith("{options of "):
            result += long_options(command, word[len("{options of "):-1])
        else:
            result.append(word)
    return sorted(result)


# --- shells --------------------------------------------------------------------------------------

# The prompt is made at run time, so that the echo of this set-up does not look like it.
SETUP = {
    "bash": r"""
PS1='re''ady> '; bind 'set enable-bracketed-paste off' 2>/dev/null
bind '"\C-t": insert-completions'
alpenglow() { printf '%s\n' "$@" >words; printf '\n' >done; }
""",
    "zsh": r"""
unsetopt zle_bracketed_paste 2>/dev/null; unset zle_bracketed_paste
setopt no_prompt_sp; PS1='re''ady> '; PS2=; RPS1=
autoload -Uz compinit && compinit -u -D
all_matches() { _main_complete; compstate[insert]=all; compstate[list]=; }
zle -C all-matches complete-word all_matches
bindkey -e; bindkey '^T' all-matches
alpenglow() { print -rl -- "$@" >words; print >done; }
""",
}
COMMAND_LINE = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"]}


class Terminal:
    """A shell on a terminal of its own."""

    def __init__(self, shell, folder, script):
        self.seen = b""
        self.pid, self.handle = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", HISTFILE="/dev/null", LC_ALL="C.UTF-8", HOME=folder)
            os.execvp(shell, COMMAND_LINE[shell])
        setup = os.path.join(os.path.dirname(script), "setup")
        with open(setup, "w", encoding="utf-8") as out:
            out.write(SETUP[shell])
        self.type(f". {setup}; . {script}\r")
        self.wait_for_prompt()

    def type(self, text):
        os.write(self.handle, text.encode())

    def wait_for_prompt(self):
        end = time.monotonic() + PATIENCE
        while b"ready> " not in self.seen:
            if not select.select([self.handle], [], [], max(0, end - time.monotonic()))[0]:
                sys.exit(f"the shell hangs after {self.seen[-2000:]!r}")
            self.seen += os.read(self.handle, 65536)
        self.seen = b""

    def close(self):
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        os.close(self.handle)


def offered_on_terminal(terminal, folder, line):
    words = os.path.join(folder, "words")
    open(words, "w", encoding="utf-8").close()
    terminal.type(line + "\x14\r")
    terminal.wait_for_prompt()
    with open(words, encoding="utf-8") as lines:
        result = lines.read().splitlines()
    os.remove(words)
    fixed = [word for word in re.sub(r"\\ ", "_", line).split(" ")[1:]]
    begun = fixed.pop()
    result = result[len(fixed):]
    unfinished = [begun.replace("_", " ")] if begun else []
    if result == unfinished:
        return []  # the line is as it was
    if re.match(r"--[a-z-]+=", begun):
        result = [re.sub(r"^--[a-z-]+=", "", word) for word in result]
    # bash puts what stands before a colon in front of the first word only
    before = begun[:begun.rfind(":") + 1]
    return [word if word.startswith(before) else before + word for word in result]


def offered_by_fish(folder, script, line):
    asked = ["fish", "--no-config", "-c", 'source $argv[1]; complete -C $argv[2]', script, line]
    environment = {**os.environ, "HOME": folder, "LC_ALL": "C.UTF-8"}
    run = subprocess.run(asked, cwd=folder, env=environment, capture_output=True, text=True,
                         check=False, timeout=PATIENCE)
    if run.returncode != 0 or run.stderr:
        sys.exit(f"fish: {line!r}: {run.stderr}")
    words = [answer.split("\t")[0].replace("\\ ", " ") for answer in run.stdout.splitlines()]
    begun = line.split(" ")[-1]
    return [re.sub(r"^--[a-z-]+=", "", word) if "=" in begun else word for word in words]


def syntax_is_good(shell, script):
    return subprocess.run([shell, "-n", script], check=False).returncode == 0


def differences(shell, command, folder, script):
    """A line for each case in which something else is offered."""
    terminal = Terminal(shell, folder, script) if shell != "fish" else None
    lines = []
    for line, wanted in CASES:
        if terminal:
            offered = offered_on_terminal(terminal, folder, line)
        else:
            offered = offered_by_fish(folder, script, line)
        # Folders end in a slash or not, and files are found twice that are offered once.
        offered = sorted({word.rstrip("/") for word in offered})
        if isinstance(wanted, dict):
            wanted = wanted.get(shell, wanted["else"])
        wanted = expected(command, wanted)
        if offered != wanted:
            lines.append(f"{line!r}\n  offers {offered}\n  and not {wanted}")
    if terminal:
        terminal.close()
    return lines


def main():
    shell, command = sys.argv[1], os.path.abspath(sys.argv[2])
    if shutil.which(shell) is None:
        print(f"there is no {shell} here")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as place:
        folder, script = os.path.join(place, "work"), os.path.join(place, "script")
        for name in FOLDERS:
            os.makedirs(os.path.join(folder, name))
        for name in FILES:
            open(os.path.join(folder, name), "w", encoding="utf-8").close()
        with open(script, "w", encoding="utf-8") as out:
            out.write(ask(command, "--completion", shell).stdout)
        lines = differences(shell, command, folder, script)
        if not syntax_is_good(shell, script):
            lines.append(f"{shell} does not take the script")
    print("\n".join(lines) if lines else f"{shell}: {len(CASES)} lines completed")
    sys.exit(1 if lines else 0)


if __name__ == "__main__":
    main()
