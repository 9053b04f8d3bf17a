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
genrev m r 'sin(2*PI*t)' '2+cos(2*PI*t)' 12
genrev m r 'sin(2*PI*t)' '2+cos(2*PI*t)' 12 -s
genrev m r 'if(t-.5,1,2*t)' 'if(t-.5,2-2*t,1)' '2*4' -s
genrev m r 'hermite(0,3,0,-5,t)' 'hermite(0,1.5,4,3,t)' 8
genrev m r 'z(t)' 'bezier(1,2,0,1,t)' 6 -e 'z(t) = -3*t^2; unused = 1' -s
genworm m w 'cos(t*PI/2)+4' 'sin(t*PI/2)+1' '0' .25 5
genworm m w t 't*t' 'bspline(0,1,3,2,t)' '.1+.2*t' 7
genworm m w 'f(t)' 0 0 1 3 -f funcs.txt
gensurf m s '-87+200*s' '-91+200*t' '3*sin(9*s)*cos(7*t)' 4 5
gensurf m s '5*s' '4*t' '0' 2 3
gensurf m s 's' 't' 's*s+t*t' 3 3 -s
gensurf m s 's' 't' '.3*s' 2 2 -s
gensurf m s 'cos(PI*s)' 'sin(PI*s)' '2*t' 6 2 -s -i
gensurf m s 's' 't' 's*t' 4 4 -e 'valid(s,t)=.9-s*t'
gensurf m s '2*s' 't' heights.txt 2 3
gensurf m s '2*s' 't' heights.txt 3 4 -s
gensurf m s points.txt points.txt points.txt 1 2
gensky 1 11 10 -a 52.53 -o 118.05 -m 105 -g .7
gensky 12 3 13 -g .2
gensky 7 12 19 -a 52.53 -o 118.05 -m 105 -g .2
gensky 6 21 12:30EST -a 40 -o 75 +i
gensky 6 21 +9:15 -a 40 -o 75 -i -t 4
gensky 3 21 15 -a 40 -o 75 -m 75 -c
gensky 3 21 15 -a 40 -o 75 -m 75 -u -B 100
gensky 10 2 14.25CET -y 2004 -a 51.5 -o -2.6 +s -t 3
gensky -ang 35 -40 -R 500 -b 20
gensky -ang 89 10 -r 0
gensky -ang -5 10
genblinds m bl 1 48 18 6 0
genblinds m bl 1 48 18 3 30 -r 2
genblinds m bl .1 1 2 2 -45 +r .06
""".splitlines()

OUTSIDE = {
    "outline.txt": "0 0\n0 1.5\n2 1.5\n2.5 .5\n",
    "funcs.txt": "f(t) = g(2*t); g(x) = x + 1;\n",
    "heights.txt": "0 1 0\n.5 0 .25\n1 2 3\n-1 -2 .125\n",
    "points.txt": "0 0 0  1 0 .5\n0 1 0  1 1 .25\n0 2 1  1 2 0\n",
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
