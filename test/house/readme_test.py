"""What README and documents show is what their commands print. Usage: readme_test.py HIRES [--long]

Each console block (`$ scripts/run hires ...` or `$ scripts/run python3 ...`, and what it printed)
that needs no master is run, in order, by the program HIRES or this Python, in an empty folder that
shows the package's. With --long also those that play, which take minutes. `$ ... the same with
OPTIONS` is the command before with more options.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
PREFIX = "scripts/run "
PROGRAMS = ("hires", "python3")
LONG = ("imagine", "limits", "examples/best_speed.py")
SAME = "... the same with "
MEASURED = re.compile(r"[\d.]+ ms of processor time, \d+ MB|"  # and not the same twice
                      r"in [\d.]+ s, \d+ times as fast as real time")
DOCUMENTS = ("README.md", "docs/command_line.md", "docs/own_code.md", "docs/tutorial.md",
             "docs/your_files.md")
XACRO = os.path.join(ROOT, "test", "house", "xacro_stand_in.py")  # where there is no other
FEWEST = 8  # examples; documents whose blocks are not found any more must not pass
LARGEST = 8192  # bytes of a README that is read; the rest is for docs/


def console_blocks(text):
    """Lines of the fenced blocks that begin with a command."""
    for block in re.findall(r"^```\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        if block.startswith("$ "):
            yield block.splitlines()


def examples(text):
    """(words from the program on, lines shown) of each command that needs no master."""
    found, base = [], None
    for lines in console_blocks(text):
        lines = list(lines)
        while lines:
            command = lines.pop(0)[2:]
            while command.endswith("\\"):
                command = command[:-1] + lines.pop(0)
            shown = []
            while lines and not lines[0].startswith("$ "):
                shown.append(lines.pop(0))
            if command.startswith(SAME):
                words = base + shlex.split(command[len(SAME):])
            elif command.startswith(PREFIX):
                words = base = shlex.split(command[len(PREFIX):])
            if not command.startswith((SAME, PREFIX)) or words[0] not in PROGRAMS:
                continue
            found.append((words, shown))
    return found


def bare(text):
    """Lines without what was measured and what cannot be seen."""
    return [MEASURED.sub("...", line.rstrip()) for line in text.rstrip().splitlines()]


def provide_xacro(folder):
    """Puts the stand-in on PATH, for the examples that need xacro."""
    if shutil.which("xacro"):
        return
    os.mkdir(os.path.join(folder, "bin"))
    os.symlink(XACRO, os.path.join(folder, "bin", "xacro"))
    os.environ["PATH"] = os.path.join(folder, "bin") + os.pathsep + os.environ["PATH"]


def differences(program, path, words, shown, folder):
    """What is wrong, as lines; none if it prints what is shown."""
    done = subprocess.run([program[words[0]]] + words[1:], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, check=False)
    printed, wanted = bare(done.stdout), bare("\n".join(shown))
    if printed == wanted:
        return []
    return (["%s shows of `%s`:" % (path, " ".join(words))] + ["  " + w for w in wanted] +
            ["it prints (exit code %d):" % done.returncode] + ["  " + p for p in printed] +
            done.stderr.splitlines()[-5:])


def main():
    program = {"hires": os.path.abspath(sys.argv[1]), "python3": sys.executable}
    is_long = "--long" in sys.argv
    found, wrong = [], []
    for path in DOCUMENTS:
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            found += [(path, words, shown) for words, shown in examples(file.read())]
    if len(found) < FEWEST:
        wrong.append("%d examples found, wanted at least %d" % (len(found), FEWEST))
    size = os.path.getsize(os.path.join(ROOT, "README.md"))
    if size > LARGEST:
        wrong.append("README.md has %d bytes, wanted at most %d; move some of it to docs/" %
                     (size, LARGEST))
    with tempfile.TemporaryDirectory() as folder:
        for name in ("config", "worlds", "urdf", "examples"):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        provide_xacro(folder)
        for path, words, shown in found:
            if words[1] not in LONG or is_long:
                wrong += differences(program, path, words, shown, folder)
    print("\n".join(wrong) if wrong else "%d examples print what is shown" % len(found))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
