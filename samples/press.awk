# Poses of a probe that presses a surface and lets go of it: TUM lines, `time tx ty tz qx qy qz qw`, one a frame.
#     awk -v x=0.08 -v y=0.04 -v z=0.08 -v depth=0.015 -v seconds=2 -f press.awk
# It goes down along -z from 2 mm above the point given, in a third of the time, stays, and goes up again. (1 0 0 0 is half a turn
# about x: the probe's +z looks down.) With -v into=+z it goes along +z instead, as into an image whose first rows are skin.
BEGIN {
    rate = rate ? rate : 30
    frames = seconds * rate
    way = into == "+z" ? 1 : -1
    turn = into == "+z" ? "0 0 0 1" : "1 0 0 0"
    for (i = 0; i < frames; i++) {
        part = 3 * i / (frames - 1)
        down = part < 1 ? part : part > 2 ? 3 - part : 1
        printf "%.6g %.6g %.6g %.6g %s\n", i / rate, x, y, z + way * ((depth + 0.002) * down - 0.002), turn
    }
}
