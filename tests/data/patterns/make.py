"""Makes tiles.rad, the files beside it that tiles.rad names, and tiles.csv: what Radiance's rtrace shows of every tile;
the same of relay.rad, whose mirrors send light on, and of nested.rad, whose octrees Radiance's oconv makes.

usage: make.py RADIANCE_BIN RADIANCE_LIB   (Python's standard library; "RADIANCE 6.0a")

Every tile is a square of side 1 with a pattern, a texture or a material that functions or data decide, seen from above.
Patterns lie on surfaces that shine, so that what is seen is the pattern itself; materials lie between two suns of 1e-3
degrees, so that direct light has no noise. Rays go from (4, 3, 9) through the centres of 6 x 6 pixels a tile.
"""

import os
import pathlib
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
PIXELS = 6
COLUMNS = 8
ROWS = 6

SHINE = ["{0} light {0}_lit 0 0 3 1 1 1"]
WHITE = ["{0} plastic {0}_lit 0 0 5 .9 .8 .7 0 0"]

# name, primitives; "{0}" is the name, the last primitive's name ends in _lit and is the tile's modifier.
TILES = [
    ("wave", ["void brightfunc {0} 2 wave tiles.cal 0 1 6.5"] + SHINE),
    ("grain", ["void brightfunc {0} 2 grain tiles.cal 0 2 .5 4.3"] + SHINE),
    ("clouds", ["void brightfunc {0} 2 clouds tiles.cal 0 2 .4 3.137"] + SHINE),
    ("checks", ["void brightfunc {0} 6 checks tiles.cal -s .7 -rz 20 0 3 3 .9 .1"] + SHINE),
    ("rings", ["void brightfunc {0} 10 rings tiles.cal -rx 40 -t .2 .3 .1 -i 1 0 1 2.5"] + SHINE),
    ("steps", ["void brightfunc {0} 2 steps tiles.cal 0 0"] + SHINE),
    ("growth", ["void brightfunc {0} 2 growth tiles.cal 0 0"] + SHINE),
    ("tilted", ["void brightfunc {0} 4 tilted tiles.cal -s 2 0 0"] + SHINE),
    ("inline", ["void brightfunc {0} 2 if(noise3(2*Px,2*Py,.4),.8,.3*(1+sin(Px)^2)) . 0 0"] + SHINE),
    ("colours", ["void colorfunc {0} 4 red_part green_part blue_part tiles.cal 0 0"] + SHINE),
    ("line", ["void brightdata {0} 4 noop line.dat . frac(Px)*1.6-.3 0 0"] + SHINE),
    ("halved", ["void brightdata {0} 4 halved line.dat tiles.cal tile_v 0 0"] + SHINE),
    ("planes", ["void colordata {0} 9 noop noop noop plane_r.dat plane_g.dat plane_b.dat tiles.cal 2*tile_u tile_v 0 0"]
     + SHINE),
    ("mixed", ["void colordata {0} 9 mixed_r mixed_g mixed_b plane_r.dat plane_g.dat plane_b.dat tiles.cal "
               "2*tile_u 1-tile_v 0 0"] + SHINE),
    ("picture", ["void colorpict {0} 7 red green blue small.hdr tiles.cal tile_u tile_v 0 0"] + SHINE),
    ("gamma", ["void colorpict {0} 11 mixed_r mixed_g mixed_b small.hdr tiles.cal tile_u*1.5 tile_v -rz 30 -s 1.3 0 0"]
     + SHINE),
    ("text", ["void brighttext {0} 2 block.fnt text.txt 0 11 {x} {top} 0 .2 0 0 0 -.3 0 .1 .9"] + SHINE),
    ("letters", ["void colortext {0} 4 block.fnt . AoL LA 0 16 {x} {top} 0 .2 .02 0 .03 -.3 0 .1 .8 .3 .9 .4 .2 -.15"]
     + SHINE),
    ("columns", ["void brighttext {0} 2 block.fnt text.txt 0 12 {x} {top} 0 .25 0 0 0 -.3 0 .1 .9 .2"] + SHINE),
    ("two", ["void brightfunc {0}_a 2 wave tiles.cal 0 1 9", "{0}_a colorfunc {0} 4 red_part green_part 1 tiles.cal 0 0"]
     + SHINE),
    ("above", ["void brightfunc {0} 2 rings tiles.cal 0 1 4", "{0} light {0}_b 0 0 3 1 .5 .2",
               "void colorfunc {0}_c 4 red_part 1 green_part tiles.cal 0 0", "{0}_c alias {0}_lit {0}_b"]),
    ("again", ["void brightfunc {0} 2 wave tiles.cal 0 1 5", "void brightfunc {0} 2 steps tiles.cal 0 0"] + SHINE),
    ("kept", ["void brightfunc {0} 2 wave tiles.cal 0 1 5", "{0} light {0}_lit 0 0 3 1 1 1",
              "void brightfunc {0} 2 steps tiles.cal 0 0"]),
    ("blend", ["void brightfunc {0}_a 2 wave tiles.cal 0 1 6", "void colorfunc {0}_b 4 red_part .2 .3 tiles.cal 0 0",
               "void mixfunc {0} 4 {0}_a {0}_b half_way tiles.cal 0 0"] + SHINE),
    ("blend_data", ["void brightfunc {0}_a 2 wave tiles.cal 0 1 6",
                    "void mixdata {0} 6 {0}_a void noop line.dat tiles.cal tile_u 0 0"] + SHINE),
    ("blend_picture", ["void colorfunc {0}_b 4 red_part .2 .3 tiles.cal 0 0",
                       "void mixpict {0} 7 void {0}_b red small.hdr tiles.cal tile_u tile_v 0 0"] + SHINE),
    ("blend_text", ["void brightfunc {0}_a 2 wave tiles.cal 0 1 6",
                    "void mixtext {0} 4 {0}_a void block.fnt text.txt 0 9 {x} {top} 0 .2 0 0 0 -.3 0"] + SHINE),
    ("sides", ["void light {0}_a 0 0 3 .9 .1 .2", "void plastic {0}_b 0 0 5 .3 .4 .5 0 0",
               "void mixfunc {0}_lit 4 {0}_a {0}_b side tiles.cal 0 0"]),
    ("bumps", ["void texfunc {0} 6 bumps_x bumps_y 0 tiles.cal -s 1.5 0 1 .4"] + WHITE),
    ("turned", ["void texfunc {0} 8 bumps_x bumps_y .1 tiles.cal -rz 30 -s .8 0 1 .3"] + WHITE),
    ("swell", ["void texdata {0} 9 swell_x swell_y swell_z plane_r.dat plane_g.dat plane_b.dat tiles.cal 2*tile_u tile_v "
               "0 0"] + WHITE),
    ("wet", ["void texfunc {0} 4 bumps_x bumps_y 0 tiles.cal 0 1 .2", "{0} plastic {0}_lit 0 0 5 .4 .3 .2 .06 .15"]),
    ("plasfunc", ["void plasfunc {0}_lit 2 lobe tiles.cal 0 6 .5 .4 .3 .3 2 5"]),
    ("metfunc", ["void brightfunc {0} 2 wave tiles.cal 0 1 5", "{0} metfunc {0}_lit 4 lobe tiles.cal -rz 40 0 6 .5 .4 .3 "
                 ".6 1.5 8"]),
    ("transfunc", ["void transfunc {0}_lit 2 lobe tiles.cal 0 8 .5 .4 .3 .2 .4 .5 3 4"]),
    ("plasdata", ["void plasdata {0}_lit 4 noop gloss.dat tiles.cal angle 0 4 .5 .4 .3 .4"]),
    ("metdata", ["void metdata {0}_lit 4 noop gloss.dat tiles.cal angle 0 4 .5 .4 .3 .4"]),
    ("transdata", ["void transdata {0}_lit 4 noop gloss.dat tiles.cal angle 0 6 .5 .4 .3 .2 .5 .4"]),
    ("brtdfunc", ["void BRTDfunc {0}_lit 10 .2 .1 0 .3*CrP .2 .1 through lobe through tiles.cal "
                  "0 11 .3 .2 .1 .1 .2 .3 .2 .2 .1 2 3"]),
    ("plastic2", ["void plastic2 {0}_lit 4 along_x along_y 0 tiles.cal 0 6 .4 .3 .2 .08 .1 .3"]),
    ("metal2", ["void texfunc {0} 4 bumps_x bumps_y 0 tiles.cal 0 1 .1",
                "{0} metal2 {0}_lit 4 along_x along_y 0 tiles.cal 0 6 .4 .3 .2 .7 .15 .35"]),
    ("trans2", ["void trans2 {0}_lit 4 along_x along_y 0 tiles.cal 0 8 .5 .4 .3 .1 .2 .3 .5 .4"]),
    ("ashik2", ["void ashik2 {0}_lit 4 along_x along_y 0 tiles.cal 0 8 .4 .3 .2 .1 .15 .2 20 60"]),
]

# A floor that the sun lights, and what two mirrors send on of it: one under a pattern; the other is a
# mixture, which sends nothing on.
RELAY = """void light sun 0 0 3 2e9 1.6e9 1.2e9
sun source from_side 0 0 4 .7 .5 .6 1e-3
void plastic grey 0 0 5 .5 .5 .5 0 0
grey polygon floor 0 0 12 0 0 0 8 0 0 8 6 0 0 6 0
void colorfunc hatched 8 wave .6 .5+.2*sin(3*Py) tiles.cal -rz 30 -rx 50 0 1 2.5
hatched mirror behind 0 0 3 .8 .7 .6
behind polygon left 0 0 12 -.5 0 .2 -.5 5.47 .2 -.5 5.47 2.2 -.5 0 2.2
void mirror silver 0 0 3 .9 .9 .9
void plastic black 0 0 5 0 0 0 0 0
void mixfunc partly 6 silver black half_way tiles.cal -rz 10 0 0
partly polygon front 0 0 12 0 -.3 .3 0 -.3 1.8 6 -.3 1.8 6 -.3 .3
"""

# An octree, one that holds two instances of it, and a scene of three of those: patterns, textures, what has no material of
# its own, materials of instances in the coordinates in which each is defined.
INNER = """void brightfunc wave 2 wave tiles.cal 0 1 6.5
wave light wave_lit 0 0 3 1 1 1
wave_lit polygon left 0 0 12 0 0 0 .5 0 0 .5 1 0 0 1 0
void texfunc bumps 4 bumps_x bumps_y 0 tiles.cal 0 1 .4
bumps plastic white 0 0 5 .9 .8 .7 0 0
white polygon right 0 0 12 .5 0 0 1 0 0 1 1 0 .5 1 0
void polygon bare 0 0 12 .1 .1 .1 .4 .1 .1 .4 .4 .1 .1 .4 .1
"""
MIDDLE = """void instance first 5 inner.oct -s 2 -rz 10 0 0
void brightfunc checks 2 checks tiles.cal 0 3 3 .9 .1
checks light checks_lit 0 0 3 1 1 1
checks_lit instance second 5 inner.oct -t 2.5 0 0 0 0
"""
NESTED = """void light sun 0 0 3 2e9 1.6e9 1.2e9
sun source from_above 0 0 4 .3 .5 1 1e-3
void instance a 5 middle.oct -t .5 .5 0 0 0
void instance b 9 middle.oct -s 1.2 -rz 25 -t 3.5 2.5 .3 0 0
void colorfunc colours 4 red_part green_part blue_part tiles.cal 0 0
colours light colours_lit 0 0 3 1 1 1
colours_lit instance c 9 middle.oct -s .7 -ry 20 -t .4 3.2 0 0 0
"""


def scene():
    lines = ["# Made by make.py: one square a pattern, texture or material.", "",
             "void light sun 0 0 3 2e9 1.6e9 1.2e9", "sun source from_above 0 0 4 .3 .5 1 1e-3",
             "sun source from_below 0 0 4 -.2 .4 -1 1e-3", ""]
    for index, (name, parts) in enumerate(TILES):
        x, y = index % COLUMNS, index // COLUMNS
        for part in parts:
            lines.append(part.format(name, x=x + 0.05, top=y + 0.95))
        last = next(part.split()[2].format(name) for part in reversed(parts) if "_lit" in part.split()[2])
        lines.append(f"{last} polygon {name}.tile 0 0 12 {x} {y} 0 {x + 1} {y} 0 {x + 1} {y + 1} 0 {x} {y + 1} 0")
        lines.append("")
    return "\n".join(lines)


def picture():
    """5 x 3 pixels, flat RGBE."""
    pixels = bytearray()
    for row in range(3):
        for column in range(5):
            pixels += struct.pack("4B", 60 + 40 * column, 200 - 55 * row, 30 + 35 * ((column * 2 + row) % 6), 128)
    return b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 5\n" + bytes(pixels)


def main(binaries, library):
    os.environ["PATH"] = f"{binaries}:{os.environ['PATH']}"
    os.environ["RAYPATH"] = f".:{library}"
    os.chdir(HERE)
    pathlib.Path("tiles.rad").write_text(scene())
    pathlib.Path("small.hdr").write_bytes(picture())
    pathlib.Path("text.txt").write_text("AoL\nL A\noo\n")
    for name, text in [("inner", INNER), ("middle", MIDDLE)]:
        frozen = subprocess.run(["oconv", "-f", "-"], check=True, capture_output=True, input=text.encode()).stdout
        pathlib.Path(f"{name}.oct").write_bytes(frozen)
    pathlib.Path("nested.rad").write_text(NESTED)
    shown("tiles", [name for name, _ in TILES])
    pathlib.Path("relay.rad").write_text(RELAY)
    shown("relay", [f"cell {number}" for number in range(COLUMNS * ROWS)], relays=1)
    shown("nested", [f"cell {number}" for number in range(COLUMNS * ROWS)])


def shown(scene, names, relays=0):
    """Writes what rtrace shows of a scene."""
    rays = "".join(
        f"4 3 9 {(x + .5) / PIXELS - 4} {(y + .5) / PIXELS - 3} -9\n"
        for y in range(ROWS * PIXELS) for x in range(COLUMNS * PIXELS))
    octree = pathlib.Path("all.oct")
    octree.write_bytes(subprocess.run(["oconv", f"{scene}.rad"], check=True, capture_output=True).stdout)
    options = "-h -ab 0 -lr 1 -lw 2 -st 0 -dt 0 -dc 1 -dj 0 -ds 0".split() + ["-dr", str(relays)]
    found = subprocess.run(["rtrace", *options, octree], check=True, capture_output=True, input=rays, text=True)
    octree.unlink()
    values = [line.split() for line in found.stdout.splitlines() if line.strip()]
    assert len(values) == ROWS * COLUMNS * PIXELS * PIXELS, (len(values), found.stderr)
    with open(f"{scene}.csv", "w") as file:
        # Pixels are counted from the lower left.
        file.write("tile,x,y,red,green,blue\n")
        for index, value in enumerate(values):
            x, y = index % (COLUMNS * PIXELS), index // (COLUMNS * PIXELS)
            tile = y // PIXELS * COLUMNS + x // PIXELS
            if tile < len(names):
                file.write(f"{names[tile]},{x},{y},{','.join(value)}\n")
    print(found.stderr, end="")


main(*sys.argv[1:])
