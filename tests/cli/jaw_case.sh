#!/bin/sh
# jaw_case.sh FOLDER: a face for `sinew console` whose bone moves. FOLDER gets mesh.sinew, a cube of 20 mm that body jaw holds at z = 20 mm,
# body.txt, and teeth.obj, which goes with the jaw: it lies on the cube.
cd "$1" || exit 1
{
    printf 'v %s\n' '0 0 0' '20 0 0' '20 20 0' '0 20 0' '0 0 20' '20 0 20' '20 20 20' '0 20 20'
    printf 'g skin\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\ng skull_jaw\nf 5 6 7 8\n'
} >cube.obj
voxelise -q --unit mm -s 5 cube.obj | attach -q --part jaw=skull_jaw | sinew bind -q >mesh.sinew || exit 1
rm cube.obj
{
    printf 'v %s\n' '0 0 0' '10 0 0' '10 10 0' '0 10 0'
    printf 'f 1 2 3 4\n'
} >teeth.obj
printf 'volume\nsurface teeth.obj unit=mm in=jaw move=5mm,5mm,20mm\n' >body.txt
