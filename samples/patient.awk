# An ultrasound volume of an upper arm that never was, from equations: DICOM, a file a slice, into `folder`, numbered in another order
# than they lie in. 72 x 56 pixels of 0.8 mm, 48 slices 1 mm apart; the skin at y = 0, deeper is more y. Millimetres.
# LC_ALL=C awk -v folder=FOLDER -f patient.awk

function number(n, bytes) { # little-endian
    for (; bytes; bytes--) {
        printf "%c", n % 256 > file
        n = int(n / 256)
    }
}

function element(group, place, vr, text) {
    if (length(text) % 2)
        text = text (vr == "UI" ? "" : " ")
    number(group, 2)
    number(place, 2)
    printf "%s", vr > file
    number(length(text) + length(text) % 2, 2)
    printf "%s", text > file
    if (length(text) % 2)
        number(0, 1)
}

function short(group, place, n) {
    number(group, 2)
    number(place, 2)
    printf "US" > file
    number(2, 2)
    number(n, 2)
}

function noise(n) { # 0 to 1
    n = sin(n * 12.9898) * 43758.5453
    return n - (n < 0 ? int(n) - 1 : int(n))
}

function ellipse(x, y, cx, cy, a, b) {
    return (x - cx) * (x - cx) / (a * a) + (y - cy) * (y - cy) / (b * b)
}

# Brightness at a place: bone, the two vessels and their walls, a nerve, skin, muscle.
function tissue(x, y, z) {
    if (ellipse(x, y, 0, 30, 8, 8) < 1)
        return 235
    if (ellipse(x, y, 9, 11, 4, 2.5) < 1 || ellipse(x, y, -8.1, 13.9, 2.5, 2.5) < 1)
        return 15
    if (ellipse(x, y, -8.1, 13.9, 3.5, 3.5) < 1 || ellipse(x, y, 1, 17, 2, 2) < 1)
        return 175
    return y < 2 ? 150 : 85 + 20 * sin(1.3 * y + .1 * x + .05 * z)
}

function slice(k,    i, j) {
    file = folder "/" sprintf("im%02d.dcm", k * 29 % 48)
    for (i = 0; i < 128; i++)
        number(0, 1)
    printf "DICM" > file
    element(2, 16, "UI", "1.2.840.10008.1.2.1")
    element(8, 22, "UI", "1.2.840.10008.5.1.4.1.1.6.1")
    element(16, 16, "PN", "Nobody^Sample")
    element(32, 14, "UI", "2.25.4242")
    element(32, 50, "DS", "-28.4\\0\\" k - 23.5)
    element(32, 55, "DS", "1\\0\\0\\0\\1\\0")
    short(40, 2, 1)
    element(40, 4, "CS", "MONOCHROME2")
    short(40, 16, 56)
    short(40, 17, 72)
    element(40, 48, "DS", "0.8\\0.8")
    short(40, 256, 8)
    short(40, 257, 8)
    short(40, 258, 7)
    short(40, 259, 0)
    number(32736, 2)
    number(16, 2)
    printf "OW" > file
    number(0, 2)
    number(72 * 56, 4)
    for (j = 0; j < 56; j++)
        for (i = 0; i < 72; i++)
            number(int(tissue(.8 * i - 28.4, .8 * j, k - 23.5) + 16 * noise((k * 56 + j) * 72 + i)), 1)
    close(file)
}

BEGIN {
    for (k = 0; k < 48; k++)
        slice(k)
}
