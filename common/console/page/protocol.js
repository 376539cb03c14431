// What comes over the WebSocket, as objects. Texts are JSON; binary messages are little-endian and begin with their
// kind.
//
// A text {"type": "state", ...} is all that the page shows but for what moves:
//     cases      [{name, picture}]            picture: its address, or null
//     case       the name of the one that is open, or null; kind: "ultrasound", "face" or null
//     tool       {name, method, methods, settings}, of the tool that computes
//     image      {settings}, of us-slice      settings: {KEY: {value, unit, default, help, min, max, choices}}
//     probe      {shape, pose, from}          pose: tx ty tz qx qy qz qw, in metres, or null; from: what has moved it
//                                             last, "hand", "3D mouse", "tracker" or "lines"
//     muscles    [{name, side, level}]        pulls: [{id, point, radius, target, stiffness}]
//                "@NAME" of side "expression" is an expression
//     colour     what surfaces are coloured by: "own" or one of colours      units: {COLOUR: its unit}
//     paused, recording, replaying            false, or what they are
//     device     in words                     children: [{tool, alive, why}]      why: why no case is open
// {"type": "frame", index, time, force, torque, contacts, lag, ratio, pose} comes with each frame of the model, and
// {"type": "said", level, tool, text} with each line that a tool says; {"type": "saved", name, url} when a file is
// there. What is not known is null. Lengths are in metres, times in seconds but for lag (ms).

// The page says "got image" and "got positions" when it is ready for the next, and "pixels raw" where it takes images
// that are not compressed.

const IMAGE = 1;
const GEOMETRY = 2;
const POSITIONS = 3;
const PIXELS = 4;  // an image whose pixels are grey or RGB

const padded = (size) => (size + 3) & ~3;

const HEADER = 96;

// Behind the header is a JPEG, of which link.js makes pixels.
function decodeImage(buffer, view) {
    const plane = [];
    for (let i = 0; i < 9; i++) plane.push(view.getFloat64(24 + 8 * i, true));
    return {
        kind: "image",
        index: view.getUint32(4, true),
        columns: view.getUint32(8, true),
        rows: view.getUint32(12, true),
        time: view.getFloat64(16, true),
        origin: plane.slice(0, 3),  // the centre of pixel 0 0, m
        column: plane.slice(3, 6),  // the step to the next column
        row: plane.slice(6, 9),
    };
}

function decodePixels(buffer, view) {
    const image = decodeImage(buffer, view);
    const pixels = new Uint8Array(buffer, HEADER);
    if (pixels.length !== image.columns * image.rows && pixels.length !== 3 * image.columns * image.rows)
        throw new Error(
            `an image of ${pixels.length} bytes; expected ${image.columns} x ${image.rows}, or three times that`);
    return {...image, pixels};
}

function decodeGeometry(buffer, view) {
    const length = view.getUint32(4, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
    let at = 8 + padded(length);
    const meshes = header.meshes.map((mesh) => {
        const positions = new Float32Array(buffer, at, 3 * mesh.vertices);
        at += positions.byteLength;
        const triangles = new Uint32Array(buffer, at, 3 * mesh.triangles);
        at += triangles.byteLength;
        return {...mesh, count: mesh.vertices, positions, triangles};
    });
    return {kind: "geometry", meshes, box: header.box, up: header.up};
}

function decodePositions(buffer, view) {
    const parts = [];
    let at = 12;
    for (let left = view.getUint32(8, true); left > 0; left--) {
        const count = view.getUint32(at + 4, true);
        const part = {id: view.getUint32(at, true), count, box: [...new Float32Array(buffer, at + 8, 6)]};
        part.positions = new Int16Array(buffer, at + 32, 3 * count);
        at += 32 + padded(6 * count);
        const values = view.getUint32(at + 8, true);
        if (values) {
            part.low = view.getFloat32(at, true);
            part.high = view.getFloat32(at + 4, true);
            part.values = new Uint8Array(buffer, at + 12, values);
        }
        at += 12 + padded(values);
        parts.push(part);
    }
    return {kind: "positions", frame: view.getUint32(4, true), parts};
}

const decoders = {
    [IMAGE]: decodeImage,
    [PIXELS]: decodePixels,
    [GEOMETRY]: decodeGeometry,
    [POSITIONS]: decodePositions
};

// Throws where the message is cut short, or of no kind that this page knows.
export function decode(buffer) {
    const view = new DataView(buffer);
    const decoder = decoders[view.getUint32(0, true)];
    if (!decoder) throw new Error(`a message of kind ${view.getUint32(0, true)}; expected 1 to 4`);
    return decoder(buffer, view);
}

// Positions as fractions of a box: -32767 is its lower corner, 32767 its upper one.
export const SCALE = 32767;

export function isEqual(a, b) {
    if (a.length !== b.length) return false;
    for (let i = 0; i < a.length; i++)
        if (a[i] !== b[i]) return false;
    return true;
}

export function boxMiddle(box) {
    return [0, 1, 2].map((i) => (box[i] + box[i + 3]) / 2);
}

export function boxHalf(box) {
    return [0, 1, 2].map((i) => (box[i + 3] - box[i]) / 2);
}

// The place of one vertex, m.
export function placeOf(positions, box, vertex) {
    return [0, 1, 2].map((i) => {
        const fraction = Math.max(positions[3 * vertex + i] / SCALE, -1);
        return (box[i] + box[i + 3]) / 2 + (fraction * (box[i + 3] - box[i])) / 2;
    });
}

export function boxOf(positions) {
    const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; i++) {
        box[i % 3] = Math.min(box[i % 3], positions[i]);
        box[3 + (i % 3)] = Math.max(box[3 + (i % 3)], positions[i]);
    }
    return box;
}

export function quantised(positions, box) {
    const middle = boxMiddle(box);
    const half = boxHalf(box);
    return Int16Array.from(
        positions, (x, i) => half[i % 3] > 0 ? Math.round((SCALE * (x - middle[i % 3])) / half[i % 3]) : 0);
}
