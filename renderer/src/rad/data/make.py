#!/usr/bin/env python3
"""Writes commands.rad: what Radiance's own programs print for the commands below, one primitive a line.

Made with the programs of PyPI's pyradiance 1.3.1 ("RADIANCE 6.0a"), whose folder is given as the argument:
    python3 make.py .../site-packages/pyradiance/bin
"""
import os
import subprocess
import sys

COMMANDS = """\
genbox m b 1 2 3
genbox m b 1 2 3 -i
genbox m b 1 2 3 -b .1
genbox m b 1 2 3 -i -b .25
genbox m b 1 2 3 -r .25
genbox m b 1 2 3 -r .25 -n 2
genbox m b 1 2 3 -r .25 -n 3
genbox m b 1 2 3 -i -r .125 -n 4
genbox m b 1e5 2e-3 3 -b 1e-4
genprism m p 3 0 0 .5 .866 1 0
genprism m p 4 0 0 0 1 1 1 1 0 -l 0 0 -2
genprism m p 4 0 0 0 1 1 1 1 0 -l .5 .25 2 -c
genprism m p 4 0 0 0 1 1 1 1 0 -e
genprism m p 4 0 0 0 1 1 1 1 0 -r .125
genprism m p 4 0 0 1 0 1 1 0 1 -r .125 -l 0 0 -1
genprism m p 6 0 0 0 2 1 2 1 1 2 1 2 0 -r .1 -l .3 .2 1.5
genprism m p 6 0 0 0 2 1 2 1 1 2 1 2 0 -r .1 -l -.3 .2 1.5 -c -e
genprism m p 6 2 0 2 1 1 1 1 2 0 2 0 0 -r .1 -l .3 .2 -1.5
genprism m p outline.txt -l 0 0 .5
genbox m b 1 2 3 | xform -n x -rz 30 -t 1 2 3
genprism m p 3 0 0 .5 .866 1 0 -r .05 | xform -rx 10 | xform -I -ry 20
xform everything.rad
xform -t 1 2 3 everything.rad
xform -rx 30 -ry 45 -rz 60 everything.rad
xform -s 2.5 everything.rad
xform -s -2 everything.rad
xform -mx everything.rad
xform -my -t 1 0 0 everything.rad
xform -mz -rz 90 everything.rad
xform -I everything.rad
xform -I -mx everything.rad
xform -n name -m gold -e -I -I -s 3 -t -1 -1e3 .5 everything.rad
xform -n one -n two -t 0 0 1 everything.rad
xform -i 3 -t 1 0 0 -rz 10 -i 1 -t 0 0 5 everything.rad
xform -i 0 -t 1 0 0 everything.rad
xform -a 3 -t 1 0 0 everything.rad
xform -n x -rz 10 -a 2 -t 1 0 0 -a 2 -t 0 1 0 -i 1 -t 0 0 5 everything.rad
xform -f args.txt everything.rad
xform -f args.txt -a 2 -mz -s 1.5 everything.rad
xform -s 2 nested.rad
xform -c -s 2 nested.rad
cat nested.rad | xform -t 0 0 1
xform -c -t 1 1 1 nested.rad | xform -a 2 -mx
""".splitlines()

OUTSIDE = {
    "outline.txt": "0 0\n0 1.5\n2 1.5\n2.5 .5\n",
    "args.txt": "# two places\n-t 1 0 0\n\n!xform -n z -rz 90 -s 2\n",
    "nested.rad": "void plastic m 0 0 5 1 1 1 0 0\nm sphere s 0 0 4 1 1 1 1\n"
    "!genbox m b 1 2 3 | \\\nxform -t 1 0 0\n!xform -n deep -rz 45 everything.rad\n",
}


def words(text):
    """The words of scene text, quoted where blanks demand it."""
    out, word, quote, some = [], "", "", False
    for letter in text + " ":
        if quote:
            if letter == quote:
                quote = ""
            else:
                word += letter
        elif letter in "\"'":
            quote, some = letter, True
        elif letter.isspace():
            if word or some:
                out.append(f'"{word}"' if " " in word or not word else word)
            word, some = "", False
        else:
            word += letter
    return out


def flatten(text):
    """One primitive a line, without comments."""
    all_words = words("\n".join(line for line in text.splitlines() if not line.startswith("#")))
    lines, at = [], 0
    while at < len(all_words):
        end = at + 4
        if all_words[at + 1] != "alias":
            end = at + 4 + int(all_words[at + 3])
            end += 2 + int(all_words[end + 1])
        lines.append(" ".join(all_words[at:end]))
        at = end
    return "\n".join(lines)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    os.environ["PATH"] = sys.argv[1] + os.pathsep + os.environ["PATH"]
    for name, text in OUTSIDE.items():
        with open(os.path.join(here, name), "w") as file:
            file.write(text)
    with open(os.path.join(here, "commands.rad"), "w") as out:
        out.write("# Written by make.py; do not edit.\n")
        for command in COMMANDS:
            text = subprocess.run(command, shell=True, cwd=here, capture_output=True, check=True, text=True).stdout
            if " -c " in command and "nested" in command:
                text = subprocess.run("xform", input=text, cwd=here, capture_output=True, check=True, text=True).stdout
            out.write(f"#= {command}\n{flatten(text)}\n")


main()
